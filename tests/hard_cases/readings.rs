//! A plate and a beam that swing without damping, read at many rates. Control: steps that are cut to end at each reading.
//! A leapfrog whose steps vary periodically resonates far below its limit of stability; readings cut no step.

use super::harness::Row;
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scene::Start;

/// Particles through the thickness, and columns of them that are held.
const THROUGH: f64 = 6.0;
const HELD: f64 = 3.0;

/// The plate of Gray, Monaghan & Swift 2001, plane or as a square beam, with a shape of its first mode: a parabola, which is close to it.
fn swinging<const D: usize>(
    scheme: Scheme<f64, D>,
    [length, height, _]: [f64; 3],
) -> Simulation<f64, D> {
    let (youngs, poisson, density): (f64, f64, f64) = (2e6, 0.3975, 1000.0);
    let shear = youngs / (2.0 * (1.0 + poisson));
    let law = Linear::from_elastic_constants(density, youngs, poisson);
    let material = Material::new("elastic", law).with_shear_modulus(shear);
    let dx = height / THROUGH;
    let corner = |x: f64, other: f64| core::array::from_fn(|d| if d == 0 { x } else { other });
    let speed = 0.01 * (youngs / (3.0 * (1.0 - 2.0 * poisson)) / density).sqrt();
    let plate = Body::block(
        "plate",
        material,
        corner(-HELD * dx, 0.0),
        corner(length, height),
        dx,
    );
    let plate = plate.start(move |x: [f64; D], own| Start {
        velocity: core::array::from_fn(|d| match d {
            1 => speed * (x[0] / length).max(0.0).powi(2),
            _ => 0.0,
        }),
        ..own
    });
    Scene::<f64, D>::new(scheme)
        .body(plate)
        .fix("plate", |x| x[0] < 0.0)
        .build()
        .unwrap()
}

/// Kinetic energy and what is stored \[J\].
fn energy<const D: usize>(now: &Simulation<f64, D>) -> f64 {
    let whole = now.ledger().whole;
    let stored = ["elastic energy", "hourglass energy"].map(|name| whole.total(name).unwrap());
    whole.kinetic + stored[0] + stored[1]
}

/// Steps to an end by cutting the last two short.
fn cut_until<const D: usize>(own: &mut Simulation<f64, D>, end: f64) {
    while end - own.time() > 1e-12 * end {
        let left = end - own.time();
        let step = own.vote().unwrap().step;
        let limit = if left < 2.0 * step && left > 1.000_001 * step {
            0.5 * left
        } else {
            left
        };
        own.step_at_most(limit).unwrap();
    }
}

/// The largest energy over that at the start, less one, of `readings` in `time` \[s\]; above ten it has broken.
fn gained<const D: usize>(
    mut own: Simulation<f64, D>,
    (time, readings): (f64, u32),
    to: impl Fn(&mut Simulation<f64, D>, f64),
) -> f64 {
    // The control is to run until it has broken.
    own.limit_stored_energy(f64::INFINITY);
    let (start, mut most) = (energy(&own), 0.0_f64);
    for k in 1..=readings {
        to(&mut own, time * f64::from(k) / f64::from(readings));
        most = most.max((energy(&own) / start - 1.0).abs());
        if most > 10.0 {
            break;
        }
    }
    most
}

fn read<const D: usize>(own: &mut Simulation<f64, D>, end: f64) {
    own.run_until(end).unwrap();
}

/// Length, height \[m\] and first period \[s\].
const PLATE: [f64; 3] = [0.2, 0.02, 0.2552];
const BEAM: [f64; 3] = [0.4, 0.06, 0.40];

fn plate() -> Simulation<f64, 2> {
    swinging(
        schemes::total_lagrangian().with(NeoHookean).compose(),
        PLATE,
    )
}

fn beam() -> Simulation<f64, 3> {
    swinging(schemes::total_lagrangian().with(NeoHookean).compose(), BEAM)
}

#[test]
fn a_plate_does_not_know_how_often_it_is_read() {
    let rate = (1.0 * PLATE[2], 800);
    Row {
        case: "undamped plate, read 800 times a period, 1 period",
        criterion: "largest change of kinetic and stored energy over the first; control: steps cut at readings",
        value: gained(plate(), rate, read),
        control: gained(plate(), rate, cut_until),
    }
    .at_most(1e-3);
}

/// The bits of a state.
fn bits<const D: usize>(own: &Simulation<f64, D>) -> Vec<[u64; D]> {
    let of = own.all();
    of.flat_map(|p| [p.position(), p.velocity()].map(|v| v.map(f64::to_bits)))
        .collect()
}

/// Equal states of five reading rates after 300 steps.
fn ends_alike<const D: usize>(start: impl Fn() -> Simulation<f64, D>, period: f64) {
    let mut whole = start();
    for _ in 0..300 {
        whole.step().unwrap();
    }
    let end = whole.time();
    for rate in [400.0, 500.0, 600.0, 800.0, 1000.0] {
        let (mut own, mut k) = (start(), 1.0);
        while period * k / rate < end {
            own.run_until(period * k / rate).unwrap();
            k += 1.0;
        }
        own.run_until(end).unwrap();
        assert_eq!(own.steps(), 300);
        assert!(bits(&own) == bits(&whole), "{rate} readings a period");
        assert!(own.ledger().whole.kinetic == whole.ledger().whole.kinetic);
    }
}

#[test]
fn five_reading_rates_end_alike() {
    ends_alike(plate, PLATE[2]);
    ends_alike(beam, BEAM[2]);
}

#[test]
#[ignore = "takes 10 minutes"]
fn a_plate_and_a_beam_do_not_know_it_for_five_periods() {
    for rate in [400, 450, 500, 600, 800, 900, 1000] {
        let at = (5.0 * PLATE[2], 5 * rate);
        Row {
            case: "undamped plate, 5 periods, seven rates of readings",
            criterion: "largest change of kinetic and stored energy over the first; control: steps cut at readings",
            value: gained(plate(), at, read),
            control: gained(plate(), at, cut_until),
        }
        .at_most(1e-3);
    }
    let at = (5.0 * BEAM[2], 1000);
    Row {
        case: "undamped beam in space, 5 periods, read 200 times each",
        criterion: "the same",
        value: gained(beam(), at, read),
        control: gained(beam(), at, cut_until),
    }
    .at_most(1e-3);
}
