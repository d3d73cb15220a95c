//! What a picture shows, pixel by pixel, and what it refuses.
//! Small pictures of the cube from −1 to 1 m, seen from above: 50 pixels are a metre.

use super::*;

const RED: Color = Color(200, 0, 0);
const BLUE: Color = Color(0, 0, 200);
const WHITE: [u8; 3] = [255; 3];

/// The cube of 2 m is to fill 96 % of the sides.
fn cube() -> Picture {
    let picture = Picture::new(104, 104).view(-90.0, 90.0);
    let half = 104.0 * 0.96 / 50.0 / 2.0;
    picture.bounds([-half; 3], [half; 3])
}

/// The pixel around a place, 50 pixels a metre from the middle.
fn pixel(picture: &Picture, x: f64, y: f64) -> [u8; 3] {
    let rgb = picture.pixels().unwrap();
    let (column, row) = ((52.0 + 50.0 * x) as usize, (52.0 - 50.0 * y) as usize);
    core::array::from_fn(|c| rgb[3 * (row * 104 + column) + c])
}

#[test]
fn spheres_have_their_size_and_place() {
    let picture = cube().plain(RED, 1.0, 0.8, [[0.3, -0.2, 0.1]]);
    let rgb = picture.pixels().unwrap();
    let inside = rgb.chunks(3).enumerate().filter(|(_, rgb)| *rgb != WHITE);
    let (mut count, mut sums) = (0.0, [0.0; 2]);
    for (index, rgb) in inside {
        assert!(rgb[0] >= 90 && rgb[1] == 0, "{rgb:?}");
        count += 1.0;
        sums[0] += (index % 104) as f64 + 0.5;
        sums[1] += (index / 104) as f64 + 0.5;
    }
    let disc = std::f64::consts::PI * 20.0 * 20.0;
    assert!((count / disc - 1.0).abs() < 0.02, "{count} of {disc}");
    assert!((sums[0] / count - 67.0).abs() < 0.05 && (sums[1] / count - 62.0).abs() < 0.05);
    // Light comes from the left and above.
    let [left, right] = [(0.1, 0.0), (0.5, -0.4)].map(|(x, y)| pixel(&picture, x, y)[0]);
    assert!(left > right + 40, "{left} {right}");
}

#[test]
fn the_nearer_sphere_hides_the_other_whatever_the_order() {
    let (low, high) = ([[0.0, 0.0, -0.3]], [[0.2, 0.0, 0.3]]);
    let one = cube().plain(RED, 1.0, 0.5, low).plain(BLUE, 1.0, 0.5, high);
    let other = cube().plain(BLUE, 1.0, 0.5, high).plain(RED, 1.0, 0.5, low);
    assert_eq!(one.pixels().unwrap(), other.pixels().unwrap());
    assert_eq!(pixel(&one, 0.1, 0.0)[0], 0);
    // From below it is the other way round.
    assert_eq!(pixel(&one.view(-90.0, -90.0), 0.1, 0.0)[2], 0);
    // Where spheres cut each other, each pixel has the one that is nearer there.
    let cut =
        cube()
            .plain(RED, 1.0, 0.8, [[-0.1, 0.0, 0.0]])
            .plain(BLUE, 1.0, 0.8, [[0.1, 0.0, 0.0]]);
    assert_eq!(pixel(&cut, -0.02, 0.0)[2], 0);
    assert_eq!(pixel(&cut, 0.03, 0.0)[0], 0);
}

#[test]
fn clear_particles_let_those_behind_show_through_once() {
    let red = || cube().plain(RED, 1.0, 0.8, [[0.0; 3]]);
    let alone = pixel(&red(), 0.0, 0.0);
    let wall = [[0.0, 0.0, 0.6], [0.0, 0.0, 0.7], [0.0, 0.0, 0.9]];
    let over = pixel(&red().plain(BLUE, 0.25, 0.2, wall), 0.0, 0.0);
    let blue = pixel(&cube().plain(BLUE, 1.0, 0.2, wall), 0.0, 0.0);
    for c in 0..3 {
        let mixed = 0.75 * f64::from(alone[c]) + 0.25 * f64::from(blue[c]);
        assert!((f64::from(over[c]) - mixed).abs() <= 1.0, "{over:?}");
    }
    let behind = [[0.0, 0.0, -0.9]];
    let under = pixel(&red().plain(BLUE, 0.25, 0.2, behind), 0.0, 0.0);
    assert_eq!(under, alone);
}

#[test]
fn values_have_the_colours_of_the_bar() {
    let row = [-0.6, 0.0, 0.6].map(|x| [x, 0.0, 0.0]);
    let values = [3.0, f64::NAN, 900.0];
    let axis = Axis::linear("speed", "m/s").range(3.0, 7.0);
    let picture = cube().particles(axis, 0.5, row.into_iter().zip(values));
    // Viridis begins at (68, 1, 84) and ends at (253, 231, 37).
    let [low, unknown, high] = [-0.6, 0.0, 0.6].map(|x| pixel(&picture, x - 0.05, 0.05));
    assert!(low[2] > low[0] && low[0] > 10 * low[1], "{low:?}");
    assert!(high[0] > high[1] && high[1] > 3 * high[2], "{high:?}");
    assert!(unknown[0] == unknown[1] && unknown[1] == unknown[2]);
}

#[test]
fn edges_are_hidden_by_what_is_before_them() {
    let beam = cube().edges([-0.8, 0.0, 0.0], [0.8, 0.0, 0.0]);
    assert!(pixel(&beam, 0.0, 0.0)[0] < 120);
    assert_eq!(pixel(&beam, 0.0, 0.1), WHITE);
    assert_eq!(pixel(&beam, 0.9, 0.0), WHITE);
    let hidden = beam.plain(RED, 1.0, 0.4, [[0.0, 0.0, 0.3], [0.5, 0.0, -0.3]]);
    assert_eq!(pixel(&hidden, 0.0, 0.0)[1], 0);
    assert!(pixel(&hidden, 0.5, 0.0)[0] < 120);
    // Ends far outside cost nothing and do no harm.
    let long = cube().edges([-1e6, -0.5, -1e6], [1e6, 0.5, 1e6]);
    assert!(pixel(&long, 0.3, 0.5)[0] < 160 && pixel(&long, 0.3, 0.0) == WHITE);
}

#[test]
fn bounds_keep_frames_alike() {
    let frame = |x| {
        cube()
            .plain(RED, 1.0, 0.2, [[0.0; 3]])
            .plain(BLUE, 1.0, 0.2, [[x, 0.0, 0.0]])
    };
    assert_eq!(pixel(&frame(0.5), 0.0, 0.0), pixel(&frame(400.0), 0.0, 0.0));
    // Without bounds all spheres are within the picture, and reach what is filled of it.
    let free = Picture::new(100, 50).plain(RED, 1.0, 0.5, [[7.0, 7.0], [9.0, 7.5]]);
    let rgb = free.pixels().unwrap();
    let columns = rgb.chunks(300).map(|row| {
        row.chunks(3)
            .position(|rgb| rgb != WHITE)
            .unwrap_or(usize::MAX)
    });
    assert_eq!(columns.min(), Some(2));
}

#[test]
fn particles_without_a_place_are_left_out() {
    let broken = [[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0], [0.0; 3]];
    let [one, other] =
        [&broken[..], &broken[2..]].map(|at| cube().plain(RED, 1.0, 0.3, at.iter().copied()));
    assert_eq!(one.pixels().unwrap(), other.pixels().unwrap());
}

#[test]
fn wrong_arguments_are_named() {
    let ball = |diameter, opacity| cube().plain(RED, opacity, diameter, [[0.0; 3]]);
    let point = || Picture::new(9, 9).bounds([1.0; 3], [1.0; 3]);
    for (picture, says) in [
        (Picture::new(0, 5), "width of the picture is 0"),
        (
            ball(-0.1, 1.0),
            "diameter of particles of the picture is -0.1",
        ),
        (ball(f64::NAN, 1.0), "is NaN"),
        (ball(0.1, 0.0), "opacity of particles of the picture is 0"),
        (ball(0.1, 1.5), "opacity of particles of the picture is 1.5"),
        (
            cube().view(0.0, f64::INFINITY),
            "elevation of the picture is inf",
        ),
        (cube().edges([f64::NAN; 3], [0.0; 3]), "corner of the edges"),
        (Picture::new(9, 9), "nothing with an extent"),
        (point(), "nothing with an extent"),
    ] {
        let error = picture.pixels().unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[cfg(feature = "pictures")]
#[test]
fn pages_hold_the_picture_with_title_and_bar() {
    let axis = Axis::linear("pressure", "kPa").range(0.0, 4.0);
    let picture = cube()
        .title("a < b")
        .particles(axis, 0.1, [([0.0; 3], 1.0)]);
    let file = b"the file of the picture";
    let svg = picture.svg(file);
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    for text in [">a &lt; b</text>", ">pressure [kPa]</text>", ">4</text>"] {
        assert!(svg.contains(text), "{text}");
    }
    let text = svg.split("base64,").nth(1).unwrap();
    let text = text.split('"').next().unwrap();
    assert_eq!(text, base64(file));
}

#[cfg(feature = "pictures")]
#[test]
fn base64_is_that_of_its_standard() {
    // RFC 4648, section 10.
    for (bytes, text) in [
        ("", ""),
        ("f", "Zg=="),
        ("fo", "Zm8="),
        ("foo", "Zm9v"),
        ("foob", "Zm9vYg=="),
        ("fooba", "Zm9vYmE="),
        ("foobar", "Zm9vYmFy"),
    ] {
        assert_eq!(base64(bytes.as_bytes()), text);
    }
    assert_eq!(base64(&[0xfb, 0xff, 0xfe]), "+//+");
}
