//! What an entry of a step is given: the sums of its own sweep, and the time.
//! By effects of this file, with the published surface alone.

use super::filled::{FILLED, WHERE_DENSITIES_ARE};
use meshfree::effect::{During, Effect, Evolved, Limit, Rate, Setting, StepProgram, View, When};
use meshfree::integrator::{DriftKickDrift, Integrator, KickDriftKick};
use meshfree::name;
use meshfree::particles::{Field, Fields, Outputs};
use meshfree::prelude::*;
use meshfree::scheme::DensityForm;

/// Two copper rods that meet at 200 m/s, and what becomes of them.
fn impact(scheme: Scheme<f64, 1>) -> Simulation<f64, 1> {
    let rod = |name, low: f64, v: f64| {
        Body::block(name, catalogue::copper(), [low], [low + 0.01], 1e-4).velocity([v])
    };
    let mut now = Scene::new(scheme)
        .body(rod("left", 0.0, 100.0))
        .body(rod("right", 0.0101, -100.0))
        .build()
        .unwrap();
    now.run_until(4e-6).unwrap();
    now
}

#[test]
fn sums_at_the_densities_leave_contacts_alone() {
    let plain = impact(schemes::impact_by_continuity().compose());
    let filled = impact(
        schemes::impact_by_continuity()
            .with(WHERE_DENSITIES_ARE)
            .compose(),
    );
    let velocities =
        |of: &Simulation<f64, 1>| of.all().map(|p| p.velocity()[0]).collect::<Vec<_>>();
    assert_eq!(velocities(&plain), velocities(&filled));
    // The rods do not pass through each other: their momentum has been exchanged.
    let middle = filled.all().map(|p| p.velocity()[0].abs());
    assert!(middle.fold(f64::INFINITY, f64::min) < 1.0);
    let inner = filled.all().filter_map(|p| p.scalar(FILLED));
    assert!(inner.fold(0.0, f64::max) > 0.9);
}

/// A field whose rate is cos ωt.
#[derive(Clone, Copy, Debug)]
struct Swings {
    omega: f64,
    when: When,
}

const SWUNG: Field = Field::scalar(name!("swung", "1"));

impl<const D: usize> Effect<D> for Swings {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(SWUNG, 0.0);
        program.evolve(Evolved::kicked(SWUNG).at(self.when).by(*self));
    }
}

impl<T: Real, const D: usize> Rate<T, D> for Swings {
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        Outputs::NONE
    }
    fn source(&self, at: &View<'_, T, D>, _first: usize, source: &mut [T]) {
        let rate = T::from_f64((self.omega * at.around.time).cos());
        for source in source {
            *source += rate;
        }
    }
}

/// ∫ cos ωt dt ω over 2/ω, by steps of a rod at rest.
fn swung(when: When, integrator: impl Integrator + 'static, form: DensityForm) -> f64 {
    let omega = 1e5;
    let scheme = schemes::impact().density(form).with(Swings { omega, when });
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4);
    let scene = Scene::<f64, 1>::new(scheme).body(rod);
    let mut now = scene.integrator(integrator).build().unwrap();
    now.run_until(2.0 / omega).unwrap();
    let last = now.all().next().and_then(|p| p.scalar(SWUNG));
    last.unwrap() * omega
}

#[test]
fn rates_see_the_time() {
    // Of these two forms one alone sums in the middle of a drift.
    for form in [DensityForm::NumberDensity, DensityForm::Continuity] {
        for when in [When::Kick, When::Drift] {
            let swung = [
                swung(when, KickDriftKick, form),
                swung(when, DriftKickDrift, form),
            ];
            for swung in swung {
                let off = (swung - 2.0_f64.sin()).abs();
                assert!(off < 1e-4, "{swung} at {when:?}, {form}");
            }
        }
    }
}

/// A step \[s\] that is not to be exceeded.
#[derive(Clone, Copy, Debug)]
struct AtMost(f64);

impl<const D: usize> Effect<D> for AtMost {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.limit(*self);
    }
}

impl<T: Real, const D: usize> Limit<T, D> for AtMost {
    fn name(&self) -> &'static str {
        "at most"
    }
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn step(&self, _at: &View<'_, T, D>, _slot: usize) -> f64 {
        self.0
    }
}

#[test]
fn limits_act_within_their_window_of_time() {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4);
    let [from, until, most] = [1e-6, 2e-6, 2e-9];
    let window = During {
        effect: AtMost(most),
        from,
        until,
    };
    let scene = Scene::<f64, 1>::new(schemes::impact().with(window)).body(rod);
    let mut now = scene.build().unwrap();
    let (mut within, mut outside) = (0, 0);
    while now.time() < 3e-6 {
        let before = now.time();
        let dt = now.step().unwrap();
        if (from..until).contains(&before) {
            assert!(dt <= most, "{dt} at {before}");
            within += 1;
        } else {
            outside += usize::from(dt > 2.0 * most);
        }
    }
    assert!(within > 400 && outside > 20, "{within}, {outside}");
}
