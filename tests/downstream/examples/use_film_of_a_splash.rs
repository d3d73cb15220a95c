//! A film of a drop that falls into a shallow basin, from *ParaView and films* and *Output in time*.

use meshfree::output::film::Film;
use meshfree::output::picture::Picture;
use meshfree::prelude::*;

fn main() -> Result<(), Error> {
    let (dx, gravity) = (0.01, [0.0, -9.81]);
    let water = || catalogue::weakly_compressible_water(3.0);
    let pool =
        Body::block("pool", water(), [0.0; 2], [0.4, 0.1], dx).hydrostatic(gravity, [0.0, 0.1]);
    let drop = Body::fill("drop", water(), &Ball::new([0.2, 0.2], 0.04), dx).velocity([0.0, -2.0]);
    let mut splash = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(pool)
        .body(drop)
        .wall(Wall::around(
            "basin",
            [0.0; 2],
            [0.4, 0.3],
            dx,
            3,
            [[true, true], [true, false]],
        ))
        .acceleration(move |_| gravity)
        .build()?;

    let mut film = Film::new("out/splash.png");
    let summary = Run::new(&mut splash, 0.1)
        .label("splash")
        .observe(Schedule::every(0.02), |now| {
            let speed = Axis::linear("speed", "m/s").range(0.0, 3.0);
            let points = now.all().map(|own| {
                let [u, v] = own.velocity();
                (own.position(), u.hypot(v))
            });
            let picture = Picture::new(640, 480)
                .bounds([0.0; 2], [0.4, 0.3])
                .edges([0.0; 2], [0.4, 0.3]);
            film.frame(now.time(), picture.particles(speed, now.spacing(), points))?;
            Ok(())
        })
        .go()?;
    assert_eq!(film.len(), 6);
    film.finish()?;
    println!("{summary}");
    Ok(())
}
