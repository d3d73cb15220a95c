//! A standing wave in a tank of half a wavelength: its period, against theory of finite amplitude.
//! `cargo validate standing_wave -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Own, Shade, picture};
use meshfree::boundary::Wall;
use meshfree::material::{Material, SoundSpeed, catalogue};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::scene::Start;
use meshfree::scheme::Shifting;
use meshfree::study::standing_wave::StandingWave;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "standing_wave",
    about: "A standing wave, 2 m long on 1 m of water, in a tank of half its length.",
    schemes: &["plain", "shifting", "renormalised"],
    own: &[Own {
        name: "--amplitude",
        value: "M",
        help: "amplitude; 0.05",
    }],
};

const LENGTH: f64 = 2.0;
const DEPTH: f64 = 1.0;
const GRAVITY: f64 = 9.81;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

fn scene<T: Real>(options: &Options, wave: StandingWave, spacing: f64) -> Scene<T, 2> {
    let sound_speed = SoundSpeed::artificial(2.0 * (GRAVITY * DEPTH).sqrt());
    let water: Material<T> = catalogue::water_at(sound_speed);
    let side = 0.5 * LENGTH;
    // A quarter of a period before its crest: the surface is flat, and the water at its fastest.
    let flat = -0.25 * wave.period();
    let body = Body::block("water", water, [0.0; 2], [side, DEPTH], spacing);
    let body = body
        .hydrostatic([0.0, -GRAVITY], [0.0, DEPTH])
        .start(|x, start| Start {
            velocity: wave.velocity(x, flat),
            ..start
        });
    let sides = [[true; 2], [true, false]];
    let top = DEPTH + 0.3;
    let tank = Wall::around("tank", [0.0; 2], [side, top], spacing, 4, sides);
    // At h/dx 1.5 disorder makes forces stronger than the lattice promises, and periods two thirds of a per
    // cent too short.
    let scheme = schemes::weakly_compressible().h_over_dx(2.0);
    let scheme: Scheme<T, 2> = match options.scheme.as_str() {
        "shifting" => scheme.with(Shifting::STANDARD).compose(),
        "renormalised" => scheme.renormalised().compose(),
        _ => scheme.compose(),
    };
    Scene::new(scheme)
        .body(body)
        .wall(tank)
        .acceleration(|_| [0.0, -GRAVITY])
}

/// Amplitude of the wave's own shape: (4/λ) ∫∫ cos(kx) dx dz over one wavelength of water.
fn amplitude<T: Real>(now: &Simulation<T, 2>, wavenumber: f64) -> f64 {
    let share = |x: [f64; 2]| (wavenumber * x[0]).cos();
    let volumes = now
        .all()
        .map(|particle| particle.mass() / particle.density() * share(particle.position()));
    4.0 / LENGTH * volumes.sum::<f64>()
}

/// Times at which a sampled function rises through zero, the start left out.
fn rises(samples: &[(f64, f64)]) -> Vec<f64> {
    let pairs = samples.windows(2).skip(1);
    pairs
        .filter(|pair| pair[0].1 < 0.0 && pair[1].1 >= 0.0)
        .map(|pair| {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            a - from * (b - a) / (to - from)
        })
        .collect()
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let wave = StandingWave::new(LENGTH, DEPTH, options.number("--amplitude", 0.05)?)?;
    let wave = wave.with_gravity(GRAVITY)?;
    let period = wave.finite_amplitude_period()?;
    let spacing = options.spacing_or(0.0125, 0.05);
    let until = options.until_or(5.2 * period, 2.2 * period);
    let mut simulation = scene::<T>(options, wave, spacing).build()?;

    let columns = ["time_s", "amplitude_m", "linear_theory_m"];
    let mut csv = CsvWriter::create(options.file("wave.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("wave.pvd"))?;
    let exact = |t: f64| wave.elevation(0.0, t - 0.25 * wave.period());
    let mut samples = Vec::new();
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(
            Schedule::evenly(1 + (until / period * 40.0).round() as usize),
            |now| {
                let height = amplitude(now, wave.wavenumber());
                csv.row(&[now.time(), height, exact(now.time())])?;
                if samples.len() % 10 == 0 {
                    movie.frame(now.time(), &now.vtu_with_walls())?;
                }
                samples.push((now.time(), height));
                Ok(())
            },
        )
        .go()?;

    let rises = rises(&samples);
    let theory = samples.iter().map(|&(t, _)| (t, exact(t)));
    Figure::new()
        .panel(
            Panel::new(Axis::linear("time", "s"), Axis::linear("amplitude", "m"))
                .series(Series::line("linear theory", theory).reference())
                .series(Series::line(&options.scheme, samples)),
        )
        .panel(picture(&simulation, Shade::Pressure, [0, 1], spacing))
        .save(options.file("wave.svg"))?;
    println!("{summary}");
    if let Some(&last) = rises.last() {
        let measured = last / rises.len() as f64;
        println!(
            "period {measured:.5} s, theory {period:.5} s (linear {:.5} s): {:+.2} % (bar 0.5 %)",
            wave.period(),
            100.0 * (measured / period - 1.0)
        );
    }
    println!("written to {}", options.folder().display());
    Ok(())
}
