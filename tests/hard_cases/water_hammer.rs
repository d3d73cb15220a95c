//! A column of water that a closed end stops: Joukowsky's pressure there, and as much tension when the wave has come back from
//! the free end. Particles pair in tension; the cures are artificial pressure, and a Riemann viscosity without its limiter.

use super::harness::{Row, Varied, seed};
use meshfree::effect::ArtificialPressure;
use meshfree::material::eos::Tait;
use meshfree::prelude::*;
use meshfree::term::viscosity::Riemann;

/// Mean error of the pressure at the wall while in tension, over Joukowsky's ρ c v, of so many particles.
fn hammer(limiter: f64, share: f64, count: usize) -> f64 {
    const SOUND: f64 = 10.0;
    const SPEED: f64 = 0.1;
    let scheme = schemes::riemann_liquid()
        .with_viscosity(Riemann {
            limiter,
            ..Riemann::STANDARD
        })
        .with(ArtificialPressure {
            share,
            ..ArtificialPressure::default()
        });
    let water = Material::new("water", Tait::new(1000.0, SOUND));
    let body = Body::block("water", water, [0.0], [1.0], 1.0 / count as f64);
    let mut pipe = Scene::<f64, 1>::new(scheme)
        .body(body.jitter(0.01, seed(5)).velocity([SPEED]))
        .boundary(MirrorPlane::symmetry([1.0], [1.0]))
        .varied()
        .build()
        .expect("a pipe");
    let scale = 1000.0 * SOUND * SPEED;
    // The wave comes back from the free end at 2 L/c, and as compression at 4 L/c.
    let (mut sum, mut steps) = (0.0, 0.0);
    let ended = pipe.run_with(3.8 / SOUND, |now| {
        if now.time() > 2.2 / SOUND {
            let last = now.all().last().map_or(f64::NAN, |p| p.pressure());
            sum += (last / scale + 1.0).abs();
            steps += 1.0;
        }
    });
    println!(
        "limiter {limiter}, share {share}, {count}: {ended:?}, {}",
        sum / steps
    );
    if ended.is_ok() {
        sum / steps
    } else {
        f64::INFINITY
    }
}

#[test]
fn water_that_is_stopped_pulls_when_its_wave_returns() {
    Row {
        case: "water hammer in tension, Riemann liquid, 200",
        criterion: "mean error of the pressure over ρcv; artificial pressure of 0.3 and no limiter",
        value: hammer(1e3, 0.3, 200),
        control: hammer(Riemann::STANDARD.limiter, 0.0, 200),
    }
    .at_most(0.1);
}
