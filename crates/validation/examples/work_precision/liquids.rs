//! Water under gravity in a tank, in two dimensions: at rest, in a standing wave, and as a column that falls.
//! The first two have exact answers, the hydrostatic pressure and the period of theory; the third has its own finest run.

use super::problem::{Problem, Text, liquid, plain_viscosity, sweep, with};
use meshfree::boundary::Wall;
use meshfree::integrator::DriftKickDrift;
use meshfree::kernel::CubicSpline;
use meshfree::material::{Material, SoundSpeed, catalogue};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::simulation::ParticleView;
use meshfree::study::dam_break::Column;
use meshfree::study::standing_wave::StandingWave;
use meshfree::study::work_precision::{
    Case, Failure, History, Method, Outcome, Quantity, WorkPrecision,
};
use meshfree::term::{Antuono, Fourtakas};

const TANK: Text = Text {
    key: "tank",
    title: "Water at rest in a tank",
    setting: "Water of 1 m depth and 0.5 m width at rest for 1.6 s: root mean square error of pressure over ρgH in the last \
              0.32 s, after it was released with the pressure of rest. Two dimensions.",
    words: include_str!("words/tank.md"),
};
const WAVE: Text = Text {
    key: "wave",
    title: "A standing wave",
    setting: "Half a wavelength of 2 m on 1 m of water, amplitude 5 cm, from a flat surface through one period; error of that \
              period against theory of third order. Two dimensions.",
    words: include_str!("words/wave.md"),
};
const DAM: Text = Text {
    key: "dam",
    title: "The front of a dam break",
    setting: "A column of water twice as high as wide, the one of Martin & Moyce (1952, 57 mm wide), falls onto a dry bed without \
              friction; the place of its front at t √(2g/a) = 2.5, against that of 112 particles over the width. Two \
              dimensions.",
    words: include_str!("words/dam.md"),
};
const GRAVITY: f64 = 9.81;
/// The step factor of all schemes.
const STEP: f64 = 0.55;
const PRESSURE: &str = "pressure of water at rest";
const PERIOD: &str = "period";
pub const CREST: &str = "lost height of the crest in one period";

const FRONT: &str = "place of the front";
const REAR: &str = "height at the rear wall";

/// How long water rests \[s\], and the last part of that, ten passages of sound over the depth, over which its error is taken: at
/// one time it would be that of a phase of what sound is left.
const REST: f64 = 1.6;
const LAST: f64 = 0.32;

fn methods() -> Vec<Method> {
    vec![
        liquid("h/dx 1.5, α 0.02, δ 0.1 (default)", "C2", 1.5, 0.02, 0.1),
        liquid("h/dx 1.3, α 0.02, δ 0.1", "C2", 1.3, 0.02, 0.1),
        liquid("h/dx 2.0, α 0.02, δ 0.1", "C2", 2.0, 0.02, 0.1),
        liquid("h/dx 2.0, α 0.005, δ 0.1", "C2", 2.0, 0.005, 0.1),
        liquid("h/dx 2.0, α 0.02, δ 0.02", "C2", 2.0, 0.02, 0.02),
        liquid("h/dx 1.5, Antuono δ 0.1", "Antuono", 1.5, 0.02, 0.1),
        liquid("cubic spline, h/dx 1.2", "cubic", 1.2, 0.02, 0.1),
    ]
}

/// What is tried on water at rest alone, where it is cheap: another integrator, step and precision.
fn more_methods() -> Vec<Method> {
    let more = [
        liquid("h/dx 1.5, half the step", "half", 1.5, 0.02, 0.1),
        liquid("h/dx 1.5, drift–kick–drift", "dkd", 1.5, 0.02, 0.1),
        liquid("h/dx 1.5, f32", "f32", 1.5, 0.02, 0.1),
    ];
    methods().into_iter().chain(more).collect()
}

/// The scheme of liquids with the numbers of a case.
fn usual<T: Real>(case: &Case<'_>, step: f64) -> Result<Scheme<T, 2>, Failure> {
    let scheme = schemes::weakly_compressible()
        .with_viscosity(plain_viscosity(case)?)
        .h_over_dx(case.number("h/dx")?)
        .density_diffusion(Fourtakas {
            delta: case.number("delta")?,
        });
    Ok(scheme.step_factor(step).compose())
}

fn scheme(case: &Case<'_>) -> Result<Scheme<f64, 2>, Failure> {
    let (ratio, delta) = (case.number("h/dx")?, case.number("delta")?);
    Ok(match case.text("scheme")? {
        "cubic" => SchemeBuilder::liquid(CubicSpline, plain_viscosity(case)?)
            .with(DensityDiffusion(Fourtakas { delta }))
            .h_over_dx(ratio)
            .compose(),
        "Antuono" => schemes::weakly_compressible()
            .with_viscosity(plain_viscosity(case)?)
            .h_over_dx(ratio)
            .density_diffusion(Antuono { delta })
            .compose(),
        "half" => usual(case, 0.5 * STEP)?,
        _ => usual(case, STEP)?,
    })
}

/// Pressure of water at rest over ρ₀gH at a depth \[m\]: what is above is compressed, by 1 % at the bottom where c² = 100 gH, so
/// it is heavier than ρ₀gz, by 0.22 % of ρ₀gH in root mean square.
fn at_rest(depth: f64) -> f64 {
    100.0 * (0.01 * depth).exp_m1()
}

/// Water at rest by the scheme as it stands.
pub fn plain(dx: f64, length: f64) -> Result<Simulation<f64, 2>, Failure> {
    let scheme = schemes::weakly_compressible().compose();
    Ok(tank(scheme, dx, length, |_| [0.0; 2]).build()?)
}

fn tank<T: Real>(
    scheme: Scheme<T, 2>,
    dx: f64,
    length: f64,
    flow: impl Fn([f64; 2]) -> [f64; 2],
) -> Scene<T, 2> {
    let water: Material<T> = catalogue::water_at(SoundSpeed::Chosen(10.0 * GRAVITY.sqrt()));
    let body = Body::block("water", water, [0.0; 2], [length, 1.0], dx)
        .hydrostatic([0.0, -GRAVITY], [0.0, 1.0])
        .start(|x, start| Start {
            velocity: flow(x),
            ..start
        });
    // The sides go on above the surface, which swings, by a whole number of spacings.
    let top = 1.0 + (0.3 / dx).round() * dx;
    let sides = [[true; 2], [true, false]];
    Scene::new(scheme)
        .body(body)
        .wall(Wall::around("tank", [0.0; 2], [length, top], dx, 5, sides))
        .acceleration(|_| [0.0, -GRAVITY])
}

fn rest(case: &Case<'_>) -> Result<Outcome, Failure> {
    fn of<T: Real>(case: &Case<'_>, scheme: Scheme<T, 2>) -> Result<Outcome, Failure> {
        let scene = tank(scheme, case.spacing(), 0.5, |_| [0.0; 2]);
        let mut water = match case.text("scheme")? {
            "dkd" => scene.integrator(DriftKickDrift).build()?,
            _ => scene.build()?,
        };
        let (mut squares, mut steps) = (0.0, 0.0);
        water.run_with(REST, |now| {
            if now.time() > REST - LAST {
                let square = |particle: ParticleView<'_, T, 2>| {
                    let exact = at_rest(1.0 - particle.position()[1]);
                    (particle.pressure() / (1000.0 * GRAVITY) - exact).powi(2)
                };
                squares += now.all().map(square).sum::<f64>() / now.particles() as f64;
                steps += 1.0;
            }
        })?;
        let error = (squares / steps).sqrt();
        Ok(Outcome::of(&water).value(PRESSURE, error))
    }
    match case.text("scheme")? {
        "f32" => of(case, usual::<f32>(case, STEP)?),
        _ => of(case, scheme(case)?),
    }
}

fn swing(case: &Case<'_>) -> Result<Outcome, Failure> {
    let wave = StandingWave::new(2.0, 1.0, 0.05)?.with_gravity(GRAVITY)?;
    let flat = -0.25 * wave.period();
    let mut water = tank(scheme(case)?, case.spacing(), 1.0, |x| {
        wave.velocity(x, flat)
    })
    .build()?;
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
    let study = sweep(TANK, &[10, 16, 24, 32, 48, 64], quick, more_methods(), rest);
    Problem {
        text: TANK,
        study: study.quantity(Quantity::measured(PRESSURE)),
    }
}

/// One run of one method on any spacing.
pub fn rest_again(name: &str, spacing: f64) -> Problem {
    let methods = more_methods().into_iter().filter(|own| own.name == name);
    let study = with(WorkPrecision::new(TANK.title, rest), methods.collect());
    Problem {
        text: TANK,
        study: study
            .spacings([spacing])
            .quantity(Quantity::measured(PRESSURE)),
    }
}

pub fn wave_problem(quick: bool) -> Result<Problem, Failure> {
    let wave = StandingWave::new(2.0, 1.0, 0.05)?.with_gravity(GRAVITY)?;
    let counts: &[u32] = if quick {
        &[8, 10, 16]
    } else {
        &[10, 16, 24, 32, 40]
    };
    let study = sweep(WAVE, counts, quick, methods(), swing)
        .quantity(Quantity::exact(PERIOD, wave.finite_amplitude_period()?))
        .quantity(Quantity::measured(CREST));
    Ok(Problem { text: WAVE, study })
}

/// Width of the column \[m\], and how long it falls in units of its front, √(a/2g).
const WIDTH: f64 = 0.057;
const FALL: f64 = 2.5;

/// Front and height at the rear wall of a column that has fallen, in its width and height; and the work.
fn fall(scheme: Scheme<f64, 2>, across: f64) -> Result<(f64, f64, Outcome), Failure> {
    let (dx, high) = (WIDTH / across, 2.0 * WIDTH);
    let column = Column::new(WIDTH, high)?;
    // Ten times the speed of free fall over its height.
    let sound = SoundSpeed::Chosen(10.0 * (2.0 * GRAVITY * high).sqrt());
    let water: Material<f64> = catalogue::water_at(sound).with_pressure_cut_off(0.0);
    let body = Body::block("water", water, [0.0; 2], [WIDTH, high], dx)
        .hydrostatic([0.0, -GRAVITY], [0.0, high]);
    let sides = [[true; 2], [true, false]];
    let mut water = Scene::new(scheme)
        .body(body)
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [5.0 * WIDTH, 1.25 * high],
            dx,
            5,
            sides,
        ))
        .acceleration(|_| [0.0, -GRAVITY])
        .build()?;
    water.run_until(FALL * column.front_time_unit())?;
    let most = |own: fn([f64; 2]) -> f64, within: f64| {
        let all = water.all().map(|particle| particle.position());
        let all = all.filter(|x| x[0] < within).map(own);
        all.fold(0.0, f64::max) + 0.5 * dx
    };
    let front = most(|x| x[0], f64::INFINITY) / WIDTH;
    let rear = most(|x| x[1], 0.1 * WIDTH) / high;
    Ok((front, rear, Outcome::of(&water)))
}

pub fn dam_problem(quick: bool) -> Result<Problem, Failure> {
    let finest = schemes::weakly_compressible().compose();
    let (front, rear, _) = fall(finest, if quick { 28.0 } else { 112.0 })?;
    // Particles over the width, as particles a metre.
    let counts = [8.0, 12.0, 16.0, 24.0, 36.0].map(|n| n / WIDTH);
    let counts = &counts[..if quick { 3 } else { counts.len() }];
    let study = WorkPrecision::new(DAM.title, |case| {
        let across = (WIDTH / case.spacing()).round();
        let (front, rear, outcome) = fall(scheme(case)?, across)?;
        Ok(outcome.value(FRONT, front).value(REAR, rear))
    });
    let study = study.spacings(counts.iter().map(|n| 1.0 / n));
    let study = with(study, methods())
        .quantity(Quantity::exact(FRONT, front))
        .quantity(Quantity::exact(REAR, rear));
    Ok(Problem { text: DAM, study })
}
