//! Waves of a flap hinged at the floor, read by two gauges, from *Paddles, wave gauges and sponges*.

use meshfree::prelude::*;
use std::f64::consts::TAU;

const DX: f64 = 0.04;
const DEPTH: f64 = 0.4;
const PERIOD: f64 = 1.0;

fn main() -> Result<(), Error> {
    let rows: Vec<(f64, f64)> = (0..=80)
        .map(|k| 0.05 * f64::from(k))
        .map(|t| (t, -0.06 * (1.0 - (TAU * t / PERIOD).cos())))
        .collect();
    let flap = Recorded::rotation([0.0; 2], &rows)?.at_rest_beyond();
    let place = |i: u32, j: u32| [DX * (f64::from(i) - 4.5), DX * (f64::from(j) + 0.5)];
    let points = (0..5).flat_map(|i| (0..16).map(move |j| place(i, j)));

    let gravity = [0.0, -9.81];
    let water = catalogue::weakly_compressible_water((9.81_f64 * DEPTH).sqrt());
    let body = Body::block("water", water, [0.0; 2], [3.0, DEPTH], DX);
    let mut flume = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(body.hydrostatic(gravity, [0.0, DEPTH]))
        .wall(Wall::around(
            "tank",
            [-0.4, 0.0],
            [3.0, 0.8],
            DX,
            5,
            [[false, true], [true, false]],
        ))
        .wall(Wall::of("flap", points.collect(), DX).motion(flap))
        .acceleration(move |_| gravity)
        .build()?;

    let near = WaveGauge::upwards(&flume, "near", [0.8, 0.0], 1)?;
    let far = WaveGauge::upwards(&flume, "far", [2.0, 0.0], 1)?;
    let mut table = CsvWriter::create("out/flap.csv", &["time_s", "near_m", "far_m"])?;
    let mut crest: f64 = 0.0;
    Run::new(&mut flume, 2.0)
        .observe(Schedule::every(0.02), |now| {
            crest = crest.max(near.height(now));
            table.row(&[now.time(), near.height(now), far.height(now)])?;
            Ok(())
        })
        .go()?;
    println!(
        "the highest crest near the flap is {:.1} mm above rest",
        1e3 * (crest - DEPTH)
    );
    assert!(crest > DEPTH + 0.005 && crest < DEPTH + 0.2);
    Ok(())
}
