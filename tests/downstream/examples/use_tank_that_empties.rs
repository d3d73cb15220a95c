//! A tank that a leak empties until little is left, from *What enters and leaves* and *Output in time*.

use meshfree::boundary::Drain;
use meshfree::prelude::*;

fn main() -> Result<(), Error> {
    let (dx, gravity) = (0.02, [0.0, -9.81]);
    let water = catalogue::weakly_compressible_water(2.0);
    let leak = Drain::within(Cuboid::new([0.16, 0.0], [0.24, 0.06]), 40.0);
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(
            Body::block("water", water, [0.0; 2], [0.4, 0.2], dx).hydrostatic(gravity, [0.0, 0.2]),
        )
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.4, 0.3],
            dx,
            3,
            [[true, true], [true, false]],
        ))
        .drain(leak)
        .acceleration(move |_| gravity)
        .build()?;

    let before = tank.ledger().whole.mass;
    let mut levels = Vec::new();
    let summary = Run::new(&mut tank, 2.0)
        .observe(Schedule::every(0.05), |now| {
            levels.push([now.time(), now.ledger().whole.mass]);
            Ok(())
        })
        .stop(Stop::when("empty", move |now| {
            let low = now.ledger().whole.mass < 0.7 * before;
            Ok(low.then(|| "less than 70 % is left".into()))
        }))
        .go()?;
    println!("{summary}");
    CsvWriter::create("out/leak.csv", &["time_s", "mass_kg_m"])?.rows(&levels)?;

    let after = tank.ledger().whole.mass;
    assert!((before - after - tank.removed().mass).abs() < 1e-9 * before);
    assert!(after < 0.7 * before && tank.time() < 2.0);
    Ok(())
}
