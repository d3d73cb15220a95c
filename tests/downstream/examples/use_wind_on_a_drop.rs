//! A drop in a wind that drags each particle, as an effect of its own, from *A force on single particles*.

use meshfree::effect::{Effect, Point, PointLaw, Reach, Setting, StepProgram};
use meshfree::particles::{Field, Fields};
use meshfree::prelude::*;
use meshfree::term::Stage;

/// F = m (w − v)/τ, with w along x.
#[derive(Clone, Copy, Debug)]
struct Wind {
    speed: f64,
    time: f64,
}

impl<const D: usize> Effect<D> for Wind {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Rates, *self);
    }
}

impl<const D: usize> PointLaw<D> for Wind {
    const NAME: &'static str = "wind";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::MASS]);
    const WRITES: Fields = Fields::of(&[Field::FORCE]);
    const ADDS: Fields = Fields::of(&[Field::FORCE]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let rate = at.get(Field::MASS) * L::of(1.0 / self.time);
        for d in 0..D {
            let wind = if d == 0 { self.speed } else { 0.0 };
            at.add_at(
                Field::FORCE,
                d,
                rate * (L::of(wind) - at.get_at(Field::VELOCITY, d)),
            );
        }
    }
}

fn main() -> Result<(), Error> {
    let water = catalogue::weakly_compressible_water(5.0);
    let wind = Wind {
        speed: 5.0,
        time: 0.05,
    };
    let mut drop = Scene::<f64, 2>::new(schemes::weakly_compressible().with(wind))
        .body(Body::fill("drop", water, &Ball::new([0.0; 2], 0.02), 0.002))
        .build()?;
    drop.run_until(0.05)?;
    let whole = drop.ledger().whole;
    let speed = whole.momentum[0] / whole.mass;
    println!("{speed:.3} m/s after the time of relaxation");
    assert!((speed / (5.0 * (1.0 - (-1.0_f64).exp())) - 1.0).abs() < 0.01);
    Ok(())
}
