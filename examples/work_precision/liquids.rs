//! Water under gravity in a tank, in two dimensions: at rest, and in a standing wave.
//! Both have exact answers: the hydrostatic pressure, and the period of theory at finite amplitude.

use crate::problem::{Problem, Text, liquid, sweep};
use meshfree::boundary::Wall;
use meshfree::material::{Material, SoundSpeed, catalogue};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::standing_wave::StandingWave;
use meshfree::study::work_precision::{Case, Failure, History, Method, Outcome, Quantity};
use meshfree::term::Fourtakas;
use meshfree::term::viscosity::MonaghanGingold;

const TANK: Text = Text {
    key: "tank",
    title: "Water at rest in a tank",
    setting: "Water of 1 m depth and 0.5 m width at rest for 1.6 s: root mean square error of pressure over ρgH, after it was \
              released with the pressure of rest. Two dimensions.",
    words: include_str!("words/tank.md"),
    errors: &[0.01, 0.003, 0.001],
    seconds: &[1.0, 60.0],
};
const WAVE: Text = Text {
    key: "wave",
    title: "A standing wave",
    setting: "Half a wavelength of 2 m on 1 m of water, amplitude 5 cm, from a flat surface through one period; error of that \
              period against theory of third order. Two dimensions.",
    words: include_str!("words/wave.md"),
    errors: &[0.01, 0.003],
    seconds: &[1.0, 60.0],
};
const GRAVITY: f64 = 9.81;
const PRESSURE: &str = "pressure of water at rest";
const PERIOD: &str = "period";
const CREST: &str = "lost height of the crest in one period";

fn methods() -> Vec<Method> {
    vec![
        liquid("h/dx 1.5, α 0.02, δ 0.1 (default)", 1.5, 0.02, 0.1),
        liquid("h/dx 1.3, α 0.02, δ 0.1", 1.3, 0.02, 0.1),
        liquid("h/dx 2.0, α 0.02, δ 0.1", 2.0, 0.02, 0.1),
        liquid("h/dx 2.0, α 0.005, δ 0.1", 2.0, 0.005, 0.1),
        liquid("h/dx 2.0, α 0.02, δ 0.02", 2.0, 0.02, 0.02),
    ]
}

fn of_case(
    case: &Case<'_>,
    length: f64,
    flow: impl Fn([f64; 2]) -> [f64; 2],
) -> Result<Simulation<f64, 2>, Failure> {
    let scheme = schemes::weakly_compressible()
        .with_viscosity(MonaghanGingold {
            alpha: case.number("alpha")?,
            beta: 0.0,
        })
        .density_diffusion(Fourtakas {
            delta: case.number("delta")?,
        })
        .h_over_dx(case.number("h/dx")?);
    tank(scheme.compose(), case.spacing(), length, flow)
}

/// Water at rest by the scheme as it stands.
pub fn plain(dx: f64, length: f64) -> Result<Simulation<f64, 2>, Failure> {
    tank(schemes::weakly_compressible().compose(), dx, length, |_| {
        [0.0; 2]
    })
}

fn tank(
    scheme: Scheme<f64, 2>,
    dx: f64,
    length: f64,
    flow: impl Fn([f64; 2]) -> [f64; 2],
) -> Result<Simulation<f64, 2>, Failure> {
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(10.0 * GRAVITY.sqrt()));
    let law = water.clone();
    let body = Body::block("water", water, [0.0; 2], [length, 1.0], dx);
    let body = body.start(|x, start| Start {
        velocity: flow(x),
        density: law
            .eos()
            .density_at(1000.0 * GRAVITY * (1.0 - x[1]), 0.0)
            .unwrap_or(start.density),
        ..start
    });
    // The sides go on above the surface, which swings, by a whole number of spacings.
    let top = 1.0 + (0.3 / dx).round() * dx;
    let sides = [[true; 2], [true, false]];
    Ok(Scene::new(scheme)
        .body(body)
        .wall(Wall::around("tank", [0.0; 2], [length, top], dx, 5, sides))
        .acceleration(|_| [0.0, -GRAVITY])
        .build()?)
}

fn rest(case: &Case<'_>) -> Result<Outcome, Failure> {
    let mut water = of_case(case, 0.5, |_| [0.0; 2])?;
    water.run_until(1.6)?;
    let squares = water.all().map(|particle| {
        let exact = 1.0 - particle.position()[1];
        (particle.pressure() / (1000.0 * GRAVITY) - exact).powi(2)
    });
    let error = (squares.sum::<f64>() / water.particles() as f64).sqrt();
    Ok(Outcome::of(&water).value(PRESSURE, error))
}

fn swing(case: &Case<'_>) -> Result<Outcome, Failure> {
    let wave = StandingWave::new(2.0, 1.0, 0.05)?.with_gravity(GRAVITY)?;
    let flat = -0.25 * wave.period();
    let mut water = of_case(case, 1.0, |x| wave.velocity(x, flat))?;
    let height = |now: &Simulation<f64, 2>| -> f64 {
        let share = |x: f64| (wave.wavenumber() * x).cos();
        let own = now
            .all()
            .map(|p| p.mass() / p.density() * share(p.position()[0]));
        2.0 * own.sum::<f64>()
    };
    let mut crests = History::new();
    crests.push(0.0, height(&water));
    let period = wave.finite_amplitude_period()?;
    water.run_with(1.6 * period, |now| crests.push(now.time(), height(now)))?;
    // From the first fall through zero to the second: the start is the first rise.
    let falls: Vec<f64> = crests
        .times()
        .windows(2)
        .zip(crests.values().windows(2))
        .filter(|(_, v)| v[0] > 0.0 && v[1] <= 0.0)
        .map(|(t, v)| t[0] + (t[1] - t[0]) * v[0] / (v[0] - v[1]))
        .collect();
    let [first, second, ..] = falls[..] else {
        return Err("the wave does not swing".into());
    };
    let highest = |from: f64, to: f64| {
        let own = crests.times().iter().zip(crests.values());
        let own = own.filter(|(t, _)| (from..to).contains(*t));
        own.fold(0.0_f64, |most, (_, v)| most.max(*v))
    };
    let lost = 1.0 - highest(period, 1.6 * period) / highest(0.0, 0.6 * period);
    Ok(Outcome::of(&water)
        .value(PERIOD, second - first)
        .value(CREST, lost))
}

pub fn rest_problem(quick: bool) -> Problem {
    let study = sweep(TANK, &[10, 16, 24, 32, 48], quick, methods(), rest);
    Problem {
        text: TANK,
        study: study.quantity(Quantity::measured(PRESSURE)),
    }
}

pub fn wave_problem(quick: bool) -> Result<Problem, Failure> {
    let wave = StandingWave::new(2.0, 1.0, 0.05)?.with_gravity(GRAVITY)?;
    let study = sweep(WAVE, &[10, 16, 24, 32, 40], quick, methods(), swing)
        .quantity(Quantity::exact(PERIOD, wave.finite_amplitude_period()?))
        .quantity(Quantity::measured(CREST));
    Ok(Problem { text: WAVE, study })
}
