//! Wrong input of the tank, each with the message that names it.
//! What a right tank does is in `tests/liquids/sloshing.rs`.

use super::pulse::Pulse;
use super::surface::{Occupancy, Space};
use super::tank::{Case, H_OVER_DX, WATER};
use meshfree::error::{BuildError, Error};
use meshfree::material::SoundSpeed;

fn case() -> Case {
    Case {
        size: [0.5, 0.3, 0.3],
        fill: 0.6,
        spacing: 0.04,
        pulse: Pulse::HalfSine,
        peak_g: 30.0,
        cut_off: 0.0,
        sound_speed: SoundSpeed::artificial(17.2),
        scheme: "standard".into(),
        probes: vec![[0.5, 0.15, 0.05]],
        youngs: None,
        in_frame: false,
        until: 0.08,
        step: None,
    }
}

/// What [`Case::build`] refuses before it builds: the crate's own checks are tested where they are.
fn message(case: &Case) -> String {
    let problems = case.problems();
    let refused = if problems.is_empty() {
        case.pulse.motion::<3>(case.peak()).err()
    } else {
        Some(Error::Build(BuildError { problems }))
    };
    refused.map_or_else(String::new, |error| error.to_string())
}

#[test]
fn a_right_tank_is_not_refused() {
    assert_eq!(message(&case()), "");
}

#[test]
fn wrong_tanks_are_refused_with_the_field() {
    let outside = vec![[0.5, 0.15, 0.35]];
    let off_the_wall = vec![[0.4, 0.15, 0.05]];
    let wrong: [(&str, &str, Case); 6] = [
        (
            "fill is 1.1",
            "100 %",
            Case {
                fill: 1.1,
                ..case()
            },
        ),
        (
            "fill is NaN",
            "100 %",
            Case {
                fill: f64::NAN,
                ..case()
            },
        ),
        (
            "spacing is 0.06",
            "quarter",
            Case {
                spacing: 0.06,
                ..case()
            },
        ),
        (
            "coordinate z",
            "inside",
            Case {
                probes: outside,
                ..case()
            },
        ),
        (
            "probe at [0.4",
            "on a wall",
            Case {
                probes: off_the_wall,
                ..case()
            },
        ),
        (
            "length of the tank is -1",
            "positive",
            Case {
                size: [-1.0, 0.3, 0.3],
                ..case()
            },
        ),
    ];
    for (field, remedy, case) in wrong {
        let text = message(&case);
        assert!(
            text.contains(field) && text.contains(remedy),
            "{field}: {text}"
        );
    }
    let elastic = |spacing: f64, youngs: f64| {
        message(&Case {
            spacing,
            youngs: Some(youngs),
            ..case()
        })
    };
    for (text, field) in [
        (elastic(0.02, 3e9), "half the thickness"),
        (elastic(0.0075, 3e9), "length of the tank over the spacing"),
        (elastic(0.015, -3e9), "Young's modulus of the walls is -3"),
    ] {
        assert!(text.contains(field), "{field}: {text}");
    }
}

#[test]
fn a_pulse_file_with_a_gap_is_refused_with_its_row() {
    let path = std::env::temp_dir().join(format!("meshfree_pulse_{}.csv", std::process::id()));
    let with = |text: &str| {
        std::fs::write(&path, text).unwrap();
        message(&Case {
            pulse: Pulse::File(path.clone()),
            ..case()
        })
    };
    assert_eq!(with("time_s,acceleration\n0,0\n0.01,100\n0.08,0\n"), "");
    let text = with("time_s,acceleration\n0,0\n0.01,NaN\n0.08,0\n");
    assert!(
        text.contains("acceleration in row 2") && text.contains("NaN"),
        "{text}"
    );
    let text = with("time_s,acceleration\n0,0\n0.01,1\n0.01,0\n");
    assert!(text.contains("time in row 3"), "{text}");
    let text = with("time_s,speed\n0,0\n0.01,1\n");
    assert!(text.contains("acceleration"), "{text}");
    std::fs::remove_file(&path).unwrap();
}

/// The space of particles on a lattice in the tank of [`case`], each moved by `place`.
fn space_of(place: impl Fn([usize; 3], [f64; 3]) -> [f64; 3]) -> Space {
    let (case, dx, layers) = (case(), 0.02, 3);
    let counts = case.size.map(|size| (size / dx).round() as usize);
    let surface = (case.depth() / dx).round() as usize;
    let mut particles = Vec::new();
    for k in 0..counts[2] + 2 * layers {
        for j in 0..counts[1] + 2 * layers {
            for i in 0..counts[0] + 2 * layers {
                let at = [i, j, k].map(|n| n.wrapping_sub(layers));
                let x = [i, j, k].map(|n| (n as f64 - layers as f64 + 0.5) * dx);
                if (0..3).any(|d| at[d] >= counts[d]) {
                    particles.push((x, dx.powi(3), true));
                } else if at[2] < surface {
                    particles.push((place(at, x), dx.powi(3), false));
                }
            }
        }
    }
    let occupied = Occupancy::of_particles(&case, H_OVER_DX * dx, particles.into_iter());
    occupied.space(case.mass() / WATER)
}

#[test]
fn space_misses_what_overlaps_and_counts_spray() {
    let dx = 0.02;
    let resting = space_of(|_, x| x);
    assert!(resting.half_full.abs() < 0.005, "{resting:?}");
    assert!(resting.with_spray.abs() < 0.005, "{resting:?}");
    // A twentieth of each particle lies in its neighbours.
    let overlapping = space_of(|_, [x, y, z]| [x, y, 0.95 * z]);
    assert!(
        (overlapping.with_spray + 0.05).abs() < 0.01,
        "{overlapping:?}"
    );
    // Two thirds of the uppermost of nine layers are in the air, a drop in each block of 2 x 2 x 2 places.
    let splashing = space_of(|at, x| {
        let (n, columns) = (at[1] * 25 + at[0], 12 * 7);
        if at[2] < 8 || n >= 3 * columns {
            return x;
        }
        let place = [n % 12, n / 12 % 7, n / columns].map(|n| 2.0 * dx * (n as f64 + 0.5));
        [place[0], place[1], 8.0 * dx + place[2]]
    });
    assert!(splashing.half_full < -0.05, "{splashing:?}");
    assert!(splashing.with_spray.abs() < 0.01, "{splashing:?}");
}
