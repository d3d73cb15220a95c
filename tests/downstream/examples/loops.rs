//! What an effect of one's own costs beside the crate's: the pair sweeps of two elastic plates, in turns.
//! `cargo run --release --example loops --manifest-path tests/downstream/Cargo.toml`

use downstream::hypoelastic::Hypoelastic;
use meshfree::material::{Material, eos::Linear};
use meshfree::prelude::*;
use std::error::Error as Failure;

const MODULUS: f64 = 5e6;
const TURNS: usize = 41;
const STEPS: usize = 10;

/// A plate of 120² particles that swings.
fn plate<T: Real>(scheme: Scheme<T, 2>) -> Result<Simulation<T, 2>, Error> {
    let soft = Material::new("soft", Linear::new(1000.0, 100.0)).with_shear_modulus(MODULUS);
    let plate = Body::block("plate", soft, [0.0; 2], [1.2, 1.2], 0.01);
    let swing = |[x, y]: [f64; 2], own| meshfree::scene::Start {
        velocity: [0.1 * (3.0 * y).sin(), 0.1 * (3.0 * x).sin()],
        ..own
    };
    Scene::new(scheme).body(plate.start(swing)).build()
}

/// Seconds of pair sweeps in some steps.
fn pairs<T: Real>(simulation: &mut Simulation<T, 2>) -> Result<f64, Error> {
    let before = simulation.phases().pairs;
    for _ in 0..STEPS {
        simulation.step()?;
    }
    Ok((simulation.phases().pairs - before).as_secs_f64())
}

fn compare<T: Real>(name: &str) -> Result<(), Error> {
    let base = schemes::impact_by_continuity;
    let own = base()
        .with(Hypoelastic {
            shear_modulus: MODULUS,
        })
        .compose();
    let built_in = base().with(meshfree::effect::Hypoelastic).compose();
    let [mut own, mut built_in] = [plate::<T>(own)?, plate::<T>(built_in)?];
    let mut ratios = Vec::new();
    for _ in 0..TURNS {
        ratios.push(pairs(&mut own)? / pairs(&mut built_in)?);
    }
    ratios.sort_by(f64::total_cmp);
    let [low, median, high] = [TURNS / 4, TURNS / 2, 3 * TURNS / 4].map(|k| ratios[k]);
    println!(
        "{name}: own over built-in {median:.3} (half of {TURNS} turns between {low:.3} and {high:.3})"
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Failure>> {
    compare::<f64>("f64")?;
    compare::<f32>("f32")?;
    Ok(())
}
