//! Rods in one dimension: contact that chatters and opens, and release from compression.
//! Others let tension through a contact, so that bodies stick, or lose the energy of a rebound.

use super::harness::{Row, Varied, lasting, same_bits, seed};
use meshfree::prelude::*;
use meshfree::scheme::EnergyForm;
use meshfree::simulation::Thresholds;

const DX: f64 = 2e-4;

/// A copper striker of 10 mm at 20 m/s on a target of 40 mm, whose wave comes back: the gap \[m\] between both at 30 µs
/// over the spacing, and how often the sign of their force changed, which is chatter.
fn strike(interaction: Interaction) -> f64 {
    let rod = |name, low: f64, high: f64| {
        Body::block(name, catalogue::copper(), [low], [high], DX).jitter(0.01, seed(2))
    };
    let scheme = schemes::impact().between_bodies(interaction);
    let mut rods = Scene::<f64, 1>::new(scheme)
        .body(rod("striker", 0.0, 0.01).velocity([20.0]))
        .body(rod("target", 0.01, 0.05))
        .varied()
        .build()
        .expect("rods");
    rods.keep_stability(Thresholds {
        energy_closure: 1e-10,
        ..Thresholds::default()
    });
    let mut pulled = 0.0_f64;
    let end = rods.run_with(30e-6, |now| {
        let force = now.force_between("target", "striker").map_or(0.0, |f| f[0]);
        // A pull, over the force of the plateau ρ c v/2.
        pulled = pulled.max(-force / (8930.0 * 3940.0 * 10.0));
    });
    end.expect("a run");
    let report = rods.stability();
    println!("{interaction:?}: pull {pulled}\n{report}");
    assert!(
        interaction == Interaction::Bonded || report.verdict.is_stable(),
        "{report}"
    );
    pulled
}

#[test]
fn a_contact_opens_and_does_not_pull() {
    Row {
        case: "rods in repeated contact, 50:200",
        criterion: "largest pull over ρ c v/2; control: bonded",
        value: strike(Interaction::Unilateral),
        control: strike(Interaction::Bonded),
    }
    .at_most(1e-3);
}

/// A rod that starts compressed by a hundredth and springs free: the change of its energy after some fifty crossings.
fn release(form: EnergyForm) -> f64 {
    let law = catalogue::copper::<f64>();
    let density = law.reference_density() * 1.01;
    let body = Body::block("rod", law, [0.0], [0.02], DX)
        .jitter(0.01, seed(4))
        .density(density);
    let scheme = schemes::impact_by_continuity().energy(form);
    let mut rod = Scene::<f64, 1>::new(scheme)
        .body(body)
        .varied()
        .build()
        .expect("a rod");
    rod.keep_stability(Thresholds::default());
    rod.run_until(lasting(2.5e-4)).expect("a run");
    let report = rod.stability();
    println!("{form:?}\n{report}");
    report.energy_closure.unwrap_or(f64::NAN)
}

#[test]
fn a_released_rod_keeps_its_energy() {
    Row {
        case: "release of a rod compressed by 1 %",
        criterion: "change of energy; control: symmetric energy",
        value: release(EnergyForm::Compatible),
        control: release(EnergyForm::Symmetric),
    }
    .at_most(1e-9);
    same_bits(|| {
        let body = Body::block("rod", catalogue::copper(), [0.0], [0.02], DX).density(9000.0);
        let scene = Scene::<f64, 1>::new(schemes::impact_by_continuity()).body(body);
        let mut rod = scene.varied().build().expect("a rod");
        rod.run_until(2e-6).expect("a run");
        rod
    });
}
