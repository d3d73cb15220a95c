//! Films: a browser draws the frames of a tank's film, and plays in the animated PNG the same pixels in their order.
//! Needs Chromium; without it the test says so and passes.

#[path = "../common/browser.rs"]
mod headless;

use headless::in_a_browser;
use meshfree::output::film::Film;
use meshfree::output::picture::Picture;
use meshfree::prelude::*;
use std::fs;
use std::path::Path;

/// Decodes the film and the frames, compares their pixels, and leaves in the page what it finds.
const SCRIPT: &str = r#"
async function decoded(bytes) {
  const decoder = new ImageDecoder({ data: new Uint8Array(bytes), type: "image/png" });
  await decoder.tracks.ready;
  const frames = [];
  for (let k = 0; k < decoder.tracks.selectedTrack.frameCount; k++) {
    const { image } = await decoder.decode({ frameIndex: k });
    const context = new OffscreenCanvas(image.displayWidth, image.displayHeight).getContext("2d");
    context.drawImage(image, 0, 0);
    frames.push(context.getImageData(0, 0, image.displayWidth, image.displayHeight).data);
  }
  return frames;
}
const same = (a, b) => a.length === b.length && a.every((value, k) => value === b[k]);
function coloured(pixels) {
  let count = 0;
  for (let k = 0; k < pixels.length; k += 4) {
    const [r, g, b] = pixels.subarray(k, k + 3);
    count += Math.max(r, g, b) - Math.min(r, g, b) > 60;
  }
  return count;
}
(async () => {
  const film = await decoded(FILM);
  const frames = (await Promise.all(FRAMES.map(decoded))).flat();
  const shown = document.querySelector("img");
  await shown.decode();
  document.body.dataset.width = shown.naturalWidth;
  document.body.dataset.frames = film.length;
  document.body.dataset.same = film.length === frames.length && film.every((own, k) => same(own, frames[k]));
  document.body.dataset.moves = !same(film[0], film[film.length - 1]);
  document.body.dataset.coloured = Math.min(...film.map(coloured));
})();
"#;

/// Three frames of a column of water that begins to fall, and the film of them.
fn film(path: &Path) -> Result<(), Error> {
    let water = catalogue::weakly_compressible_water(2.0);
    let sides = [[true, true], [true, false]];
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.2, 0.2], 0.02))
        .wall(Wall::around("tank", [0.0; 2], [0.4, 0.3], 0.02, 3, sides))
        .acceleration(|_| [0.0, -9.81])
        .build()?;
    let mut film = Film::new(path);
    Run::new(&mut tank, 0.1)
        .observe(Schedule::every(0.05), |now| {
            let pressure = Axis::linear("pressure", "Pa").range(0.0, 2000.0);
            let water = now.all().map(|own| (own.position(), own.pressure()));
            let picture = Picture::new(400, 300)
                .bounds([0.0; 2], [0.4, 0.3])
                .edges([0.0; 2], [0.4, 0.3]);
            film.frame(
                now.time(),
                picture.particles(pressure, now.spacing(), water),
            )?;
            Ok(())
        })
        .go()?;
    film.finish()
}

#[test]
fn a_browser_plays_the_film_of_a_tank() {
    let folder = std::env::temp_dir().join(format!("meshfree-played-{}", std::process::id()));
    let path = folder.join("tank.png");
    film(&path).unwrap();
    let frames = [0, 1, 2].map(|k| fs::read(folder.join(format!("tank_{k:05}.png"))).unwrap());
    // The bytes themselves: a page may not read files beside it.
    let bytes = format!(
        "const FILM = {:?}, FRAMES = {frames:?};",
        fs::read(&path).unwrap()
    );
    let page = folder.join("page.html");
    let html = format!(
        "<body><img src=\"tank.png\"><script type=\"module\">{bytes}{SCRIPT}</script></body>"
    );
    fs::write(&page, html).unwrap();
    let shown = in_a_browser(&page, "", 20);
    fs::remove_dir_all(&folder).unwrap();
    let Some((dom, console)) = shown else {
        println!("skipped a_browser_plays_the_film_of_a_tank: there is no chromium");
        return;
    };
    let found = |name: &str| {
        let (_, rest) = dom
            .split_once(&format!("data-{name}=\""))
            .unwrap_or_else(|| {
                panic!("the page has no {name}: {console}");
            });
        rest.split('"').next().unwrap_or_default().to_owned()
    };
    assert_eq!(found("frames"), "3");
    assert_eq!(found("same"), "true", "pixels of the film and its frames");
    assert_eq!(found("moves"), "true", "the water falls");
    // A hundred particles of 20 mm fill a third of the picture.
    let coloured: u32 = found("coloured").parse().unwrap();
    assert!(coloured > 10_000, "{coloured} coloured pixels");
    assert!(found("width").parse::<u32>().unwrap() >= 400);
    assert!(!console.contains("CONSOLE"), "{console}");
}
