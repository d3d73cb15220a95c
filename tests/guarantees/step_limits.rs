//! The step is the least that its criteria ask for at any particle, and the first of those that ask for it is named.
//! Held against the formulas of their sources, particle by particle.

use meshfree::boundary::Wall;
use meshfree::effect::Laminar;
use meshfree::material::catalogue;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::simulation::{Criterion, StepControl};
use meshfree::term::LaminarViscosity;
use meshfree::term::viscosity::Inviscid;

/// A dam that breaks, without artificial viscosity, which would add a signal to the speed of sound.
fn dam<T: Real>([force, viscous]: [f64; 2]) -> (Simulation<T, 2>, StepControl) {
    let scheme: Scheme<T, 2> = schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity))
        .compose();
    let water = catalogue::weakly_compressible_water((2.0 * 9.81 * 0.5_f64).sqrt());
    let mut used = StepControl::default();
    let simulation = Scene::new(scheme)
        .body(Body::block("water", water, [0.0; 2], [1.0, 0.5], 0.02))
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [2.0, 1.0],
            0.02,
            3,
            [[true; 2], [true, false]],
        ))
        .acceleration(|_| [0.0, -9.81])
        .steps(|own| {
            used = StepControl {
                force,
                viscous,
                ..own
            };
            used
        })
        .build()
        .unwrap();
    (simulation, used)
}

/// C h/c (Courant, Friedrichs & Lewy 1928), C_a √(h/|a|) (Monaghan 1992) and C_v h² ρ/μ (Morris, Fox & Zhu 1997) \[s\]: each at its
/// least, with the particle where it is.
fn least_of_each<T: Real>(
    simulation: &Simulation<T, 2>,
    control: &StepControl,
) -> [(f64, usize); 3] {
    let mut least = [(f64::INFINITY, 0); 3];
    for p in simulation.all() {
        let h = p.smoothing_length();
        let [c, mu] = [Field::SOUND_SPEED, Field::DYNAMIC_VISCOSITY]
            .map(|field| p.scalar(field).expect("a field of a viscous liquid"));
        let a = p.acceleration().iter().map(|a| a * a).sum::<f64>().sqrt();
        let own = [
            control.courant * h / c,
            control.force * (h / a).sqrt(),
            control.viscous * h * h * p.density() / mu,
        ];
        for (least, own) in least.iter_mut().zip(own) {
            if own < least.0 {
                *least = (own, p.id());
            }
        }
    }
    least
}

fn the_least_wins<T: Real>(rounding: f64) {
    let kinds = [Criterion::Acoustic, Criterion::Force, Criterion::Viscous];
    // The usual factors, under which sound limits, and those that let one of the others do so.
    let factors = [[0.25, 0.125], [0.003, 0.125], [0.25, 2e-7]];
    for (k, criterion) in kinds.into_iter().enumerate() {
        let (mut simulation, control) = dam::<T>(factors[k]);
        let mut winners = std::collections::BTreeSet::new();
        for step in 0..60 {
            simulation.step().unwrap();
            let vote = simulation.vote().unwrap();
            let least = least_of_each(&simulation, &control);
            let (shortest, particle) = least[k];
            assert!(least.iter().all(|own| own.0 >= shortest), "{least:?}");
            assert_eq!(vote.criterion, criterion, "step {step}: {vote:?}");
            assert!(
                (vote.step / shortest - 1.0).abs() <= rounding,
                "step {step}: {vote:?}, {shortest} at {particle}"
            );
            winners.insert(vote.particle);
        }
        // Not one particle for all, by chance the first that was asked.
        assert!(winners.len() > 3, "{criterion:?}: {winners:?}");
    }
}

#[test]
fn the_step_is_the_least_of_all_criteria_at_all_particles() {
    the_least_wins::<f64>(1e-12);
    the_least_wins::<f32>(1e-5);
}
