//! A wave maker from rows of time and place: its force does not depend on the interval of the rows as long as these resolve
//! the motion, and advice says where they do not.

use approx::assert_relative_eq;
use meshfree::boundary::{Motion, Recorded, Wall};
use meshfree::material::{Material, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::advice::{Known, Need};
use std::f64::consts::TAU;

const DX: f64 = 0.05;
const DEPTH: f64 = 0.5;
const PERIOD: f64 = 1.2;
const END: f64 = 2.0 * PERIOD;

/// Where the piston is: from rest at zero to a stroke of 0.1 m and back.
fn stroke(t: f64) -> f64 {
    0.05 * (1.0 - (TAU * t / PERIOD).cos())
}

fn rows(interval: f64) -> Vec<(f64, [f64; 2])> {
    let count = (END / interval).round() as u32;
    let times = (0..=count).map(|k| f64::from(k) * interval);
    times.map(|t| (t, [stroke(t), 0.0])).collect()
}

fn recorded(interval: f64) -> Recorded<2> {
    Recorded::translation(&rows(interval)).expect("a motion")
}

/// A flume with a piston at its left end.
fn flume(motion: impl Motion<2> + 'static) -> Scene<f64, 2> {
    let c = 10.0 * (9.81_f64 * DEPTH).sqrt();
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(c));
    let body = Body::block("water", water, [0.0; 2], [2.0, DEPTH], DX)
        .hydrostatic([0.0, -9.81], [0.0, DEPTH]);
    let sides = [[false, true], [true, false]];
    let place = |i: u32, j: u32| [DX * (f64::from(i) - 4.5), DX * (f64::from(j) + 0.5)];
    let piston = (0..5).flat_map(|i| (0..16).map(move |j| place(i, j)));
    let piston = Wall::of("piston", piston.collect(), DX);
    Scene::new(schemes::weakly_compressible())
        .body(body)
        .wall(Wall::around("tank", [-0.25, 0.0], [2.0, 0.8], DX, 5, sides))
        .wall(piston.motion(motion))
        .acceleration(|_| [0.0, -9.81])
}

/// Amplitude \[N/m\] of the force on the piston at the frequency of the waves over the second period, and half the range of
/// the force.
fn wave_force(motion: impl Motion<2> + 'static) -> [f64; 2] {
    let mut run = flume(motion).build().expect("a flume");
    let (mut sums, mut before) = ([0.0; 2], None::<f64>);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    run.run_with(END, |now| {
        let (time, force) = (now.time(), now.wall_force("piston").expect("a piston")[0]);
        if let Some(before) = before.filter(|before| *before >= PERIOD) {
            let (sin, cos) = (TAU * time / PERIOD).sin_cos();
            let weight = 2.0 / PERIOD * (time - before) * force;
            sums = [sums[0] + weight * sin, sums[1] + weight * cos];
            range = [range[0].min(force), range[1].max(force)];
        }
        before = Some(time);
    })
    .expect("waves");
    [sums[0].hypot(sums[1]), 0.5 * (range[1] - range[0])]
}

#[test]
fn the_force_on_a_wave_maker_does_not_depend_on_the_interval_of_its_rows() {
    let omega = TAU / PERIOD;
    let [exact, most] = wave_force(Translation::new(
        |t| [stroke(t), 0.0],
        move |t| [0.05 * omega * (omega * t).sin(), 0.0],
        move |t| [0.05 * omega * omega * (omega * t).cos(), 0.0],
    ));
    for (interval, part) in [(0.1, 0.03), (0.02, 0.01), (0.005, 0.01)] {
        let [force, peak] = wave_force(recorded(interval).at_rest_beyond());
        println!("rows every {interval} s: {force} of {exact} N/m, {peak} of {most} N/m");
        assert_relative_eq!(force, exact, max_relative = 0.01);
        // Twelve rows a period have the greatest accelerations to 2.3 %.
        assert_relative_eq!(peak, most, max_relative = part);
    }
    // Straight pieces between the same rows: the velocity jumps at each.
    let rows = rows(0.1);
    let place = move |t: f64| {
        let k = ((t / 0.1) as usize).min(rows.len() - 2);
        let v = (rows[k + 1].1[0] - rows[k].1[0]) / 0.1;
        [rows[k].1[0] + v * (t - rows[k].0), v]
    };
    let velocity = place.clone();
    let straight = Translation::new(
        move |t| [place(t)[0], 0.0],
        move |t| [velocity(t)[1], 0.0],
        |_| [0.0; 2],
    );
    let [_, peak] = wave_force(straight);
    println!("straight pieces: {peak} of {most} N/m");
    assert!(peak > 2.0 * most);
}

#[test]
fn advice_warns_of_rows_that_do_not_resolve_a_motion() {
    let line = |interval: f64| {
        let advice = flume(recorded(interval)).advise(END, &Known::default());
        let line = advice.of("rows of a recorded motion").next().cloned();
        line.expect("a line on rows")
    };
    assert_eq!(line(0.02).need, Need::Skip);
    assert_eq!(line(0.1).need, Need::Recommend);
    let coarse = line(0.2);
    assert_eq!(
        (coarse.need, coarse.of.as_str()),
        (Need::Impossible, "piston")
    );
    assert!(coarse.value > 0.1, "{coarse}");
}

#[test]
fn a_run_beyond_the_rows_ends_with_what_to_do() {
    let mut run = flume(recorded(0.1)).build().expect("a flume");
    run.run_until(0.5).expect("within the rows");
    let rows: Vec<_> = rows(0.1).into_iter().take(6).collect();
    let short = || Recorded::translation(&rows).expect("a motion");
    let mut run = flume(short()).build().expect("a flume");
    run.run_until(0.5).expect("up to the last row");
    let message = run.run_until(0.6).expect_err("no rows").to_string();
    assert!(
        message.contains("wall `piston`") && message.contains("at_rest_beyond"),
        "{message}"
    );
    let late: Vec<_> = rows.iter().map(|&(t, x)| (t + 0.1, x)).collect();
    let late = Recorded::translation(&late).expect("a motion");
    let problems = flume(late).problems();
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert!(
        problems[0]
            .to_string()
            .contains("first time of the motion of wall `piston`")
    );
}
