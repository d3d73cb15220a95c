//! Water on a plate by penalty springs in place of the wall that the plate is by default: what each form keeps and costs.
//! The plate bears the same weight by both; `docs/contact.md` has the table.

use super::structures::{DEPTH, DX, GRAVITY, LENGTH, deflection, middle, scene};
use meshfree::coupling::Penalty;
use meshfree::prelude::*;

/// Artificial sound speed of the water of the scene \[m/s\].
const SOUND: f64 = 20.0;
const UNTIL: f64 = 0.4;

/// What a form of coupling gives.
struct Outcome {
    /// Mean deflection over that of plate theory.
    deflection: f64,
    /// Mean force of the water on the plate over its weight.
    force: f64,
    /// Momentum that is nobody's, over the weight's impulse.
    momentum: f64,
    /// Change of kinetic, elastic and potential energy and that of compression and springs, over the work of gravity on a
    /// plate that is loaded at once.
    energy: f64,
    /// How much nearer than a mean spacing water and plate are at most, in spacings, at times when samples are taken.
    penetration: f64,
    steps: u64,
    seconds: f64,
}

fn energy(now: &Simulation<f64, 2>) -> f64 {
    let whole = now.ledger().whole;
    let elastic = whole.total("elastic energy").unwrap_or(0.0);
    let stored = whole.total("energy of couplings").unwrap_or(0.0);
    let height: f64 = now
        .all()
        .map(|p| p.mass() * GRAVITY * p.position()[1])
        .sum();
    let water = now.body("water").unwrap();
    let compressed = water.map(|p| 0.5 * p.mass() * (p.pressure() / (p.density() * SOUND)).powi(2));
    whole.kinetic + elastic + stored + height + compressed.sum::<f64>()
}

fn nearest(now: &Simulation<f64, 2>) -> f64 {
    let plate: Vec<_> = now.body("plate").unwrap().map(|p| p.position()).collect();
    let water = now.body("water").unwrap().map(|p| p.position());
    let near = water.filter(|x| x[1] < 2.0 * DX).map(|x| {
        let gaps = plate.iter().map(|y| (x[0] - y[0]).hypot(x[1] - y[1]));
        gaps.fold(f64::INFINITY, f64::min)
    });
    1.0 - near.fold(f64::INFINITY, f64::min) / DX
}

fn outcome(scene: Scene<f64, 2>) -> Outcome {
    let started = std::time::Instant::now();
    let mut simulation = scene.build().unwrap();
    let first = energy(&simulation);
    let (mut sums, mut count, mut penetration) = ([0.0; 2], 0.0, f64::NEG_INFINITY);
    let mut next = 0.0;
    while simulation.time() < UNTIL {
        simulation.step().unwrap();
        // Two periods of the plate and more.
        if simulation.time() > 0.5 * UNTIL {
            sums[0] += middle(&simulation);
            sums[1] -= simulation.force_between("plate", "water").unwrap()[1];
            count += 1.0;
        }
        if simulation.time() >= next {
            penetration = penetration.max(nearest(&simulation));
            next += 0.02 * UNTIL;
        }
    }
    let ledger = simulation.ledger();
    let weight = GRAVITY * simulation.time() * ledger.whole.mass;
    let [_, walls] = simulation.wall_impulse("tank").unwrap();
    let held = simulation.clamps()[0].impulse[1];
    Outcome {
        deflection: sums[0] / count / deflection(),
        force: sums[1] / count / (GRAVITY * 1000.0 * DEPTH * LENGTH),
        momentum: (ledger.whole.momentum[1] - (held - walls - weight)) / weight,
        energy: (energy(&simulation) - first) / (GRAVITY * 1000.0 * DEPTH * LENGTH * deflection()),
        penetration,
        steps: simulation.steps(),
        seconds: started.elapsed().as_secs_f64(),
    }
}

#[test]
fn penalty_springs_bear_the_water_as_a_wall_does() {
    let forms: [(&str, Scene<f64, 2>); 2] = [
        ("wall", scene()),
        ("penalty", scene().couple("water", "plate", Penalty::new())),
    ];
    for (name, scene) in forms {
        let own = outcome(scene);
        println!(
            "{name}: deflection {:.3}, force {:.3}, momentum {:.1e}, energy {:+.3}, penetration {:.3}, {} steps, {:.1} s",
            own.deflection,
            own.force,
            own.momentum,
            own.energy,
            own.penetration,
            own.steps,
            own.seconds
        );
        assert!(own.momentum.abs() < 1e-10, "{name}: {:e}", own.momentum);
        assert!(
            (own.deflection - 1.0).abs() < 0.15,
            "{name}: {}",
            own.deflection
        );
        assert!((own.force - 1.0).abs() < 0.1, "{name}: {}", own.force);
        assert!(own.penetration < 0.2, "{name}: {}", own.penetration);
    }
    let nothing = Penalty::new().scale(0.0);
    let refused = scene()
        .couple("water", "plate", nothing)
        .build()
        .unwrap_err();
    assert!(
        refused.to_string().contains("scale of the stiffness"),
        "{refused}"
    );
}
