//! x″ = −x, the smallest system that an integrator can advance: whether it is stable up to the step that it states.
//! The limit is measured, since a step above the stable one ends a run only some time later.

use super::{Integrator, System};
use crate::error::Result;

/// Steps that are tried.
const STEPS: i32 = 64;

/// Growth per step above which a claim does not hold. An unstable leapfrog grows by a third at 1 % above its limit; a midpoint rule,
/// which grows without damping whatever the step, by an eighth at its own.
const GROWTH: f64 = 1.2;

/// Share of the claim that is tried, so that a limit met to rounding holds.
const SHARE: f64 = 0.99;

#[derive(Debug)]
struct Oscillator {
    state: [f64; 2],
    rates: Option<[f64; 2]>,
    before_prediction: f64,
    kept: Vec<[f64; 2]>,
}

impl Oscillator {
    fn rate(&self) -> [f64; 2] {
        self.rates.unwrap_or_default()
    }
    fn slot(&mut self, slot: usize) -> &mut [f64; 2] {
        if self.kept.len() <= slot {
            self.kept.resize(slot + 1, [0.0; 2]);
        }
        &mut self.kept[slot]
    }
}

impl System for Oscillator {
    fn evaluate(&mut self, _offset: f64) -> Result<()> {
        let [x, v] = self.state;
        self.rates = Some([v, -x]);
        Ok(())
    }
    fn kick(&mut self, dt: f64) {
        self.state[1] += dt * self.rate()[1];
    }
    fn drift(&mut self, dt: f64, _offset: f64) -> Result<()> {
        self.state[0] += dt * self.state[1];
        Ok(())
    }
    fn shift(&mut self, dv: f64, da: f64) {
        self.state[0] += dv * self.state[1] + da * self.rate()[1];
    }
    fn predict(&mut self, dt: f64) {
        self.before_prediction = self.state[1];
        self.kick(dt);
    }
    fn restore(&mut self) {
        self.state[1] = self.before_prediction;
    }
    fn save(&mut self, slot: usize) {
        let state = self.state;
        *self.slot(slot) = state;
    }
    fn load(&mut self, slot: usize) {
        self.state = *self.slot(slot);
    }
    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let (kept, rate) = (*self.slot(slot), self.rate());
        for (k, own) in self.state.iter_mut().enumerate() {
            *own = a * kept[k] + b * *own + dt * rate[k];
        }
    }
    fn accumulate(&mut self, slot: usize, dt: f64) {
        let rate = self.rate();
        for (kept, rate) in self.slot(slot).iter_mut().zip(rate) {
            *kept += dt * rate;
        }
    }
    fn has_rates(&self) -> bool {
        self.rates.is_some()
    }
}

/// How much the amplitude of an undamped oscillator grows per step, where ω dt is the limit that the integrator states; and
/// whether it asked for rates at all. What ends in an error grows without bound.
fn growth(integrator: &dyn Integrator) -> (f64, bool) {
    let mut system = Oscillator {
        state: [1.0, 0.3],
        rates: None,
        before_prediction: 0.0,
        kept: Vec::new(),
    };
    let dt = SHARE * 2.0 * integrator.stability();
    let begin = system.state[0].hypot(system.state[1]);
    for _ in 0..STEPS {
        if integrator.step(&mut system, dt).is_err() {
            return (f64::INFINITY, system.has_rates());
        }
    }
    let end = system.state[0].hypot(system.state[1]);
    let growth = (end / begin).powf(1.0 / f64::from(STEPS));
    (
        if growth.is_nan() {
            f64::INFINITY
        } else {
            growth
        },
        system.has_rates(),
    )
}

/// What is wrong with the stability that an integrator says it has, which is finite and positive.
pub(crate) fn problem_of(integrator: &dyn Integrator) -> Option<(&'static str, f64, &'static str)> {
    let (growth, evaluates) = growth(integrator);
    if !evaluates {
        let must_be =
            "its steps must ask for rates, by System::evaluate: those of the start do not last";
        return Some(("number of evaluations in a step", 0.0, must_be));
    }
    let must_be = "an undamped oscillator grows in steps of that: it must be the largest stable ω dt of the integrator, over 2";
    (growth > GROWTH).then_some(("stability", integrator.stability(), must_be))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::{
        DriftKickDrift, KickDriftKick, LamLeapfrog, Midpoint, PositionVerlet, Predictor,
        RungeKutta4, StrongStabilityPreserving3,
    };

    /// An integrator that says something else of itself.
    #[derive(Debug)]
    struct Claims(Box<dyn Integrator>, f64);

    impl Integrator for Claims {
        fn name(&self) -> String {
            self.0.name()
        }
        fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
            self.0.step(system, dt)
        }
        fn stability(&self) -> f64 {
            self.1 * self.0.stability()
        }
    }

    /// The limits of theory: 2 of a leapfrog, √3 of the third order, 2√2 of the fourth. Those of Lam's leapfrog were measured.
    #[test]
    fn own_claims_hold_and_a_tenth_more_does_not() {
        let all: [fn() -> Box<dyn Integrator>; 7] = [
            || Box::new(KickDriftKick),
            || Box::new(DriftKickDrift),
            || Box::new(PositionVerlet),
            || Box::new(StrongStabilityPreserving3),
            || Box::new(RungeKutta4),
            || {
                Box::new(LamLeapfrog {
                    predictor: Predictor::Fresh,
                })
            },
            || {
                Box::new(LamLeapfrog {
                    predictor: Predictor::Lagged,
                })
            },
        ];
        for make in all {
            let own = make();
            assert_eq!(problem_of(own.as_ref()), None, "{}", own.name());
            for more in [1.3, 10.0, 1e9] {
                let more = Claims(make(), more);
                assert!(problem_of(&more).is_some(), "{} {}", more.name(), more.1);
            }
        }
        assert_eq!(problem_of(&Midpoint), None);
        assert!(problem_of(&Claims(Box::new(Midpoint), 2.0)).is_some());
    }
}
