//! Water at rest for 40 √(H/g), against the pressure of a column that its own weight compresses.
//! dp = ρ g dz with p = c²(ρ − ρ₀) gives p = ρ₀c² (exp(g d/c²) − 1) at the depth d (Batchelor 1967, §1.4); Tait's law 1e-4 of ρgH less.

use crate::tank::GRAVITY;
use meshfree::boundary::Wall;
use meshfree::material::{Material, SoundSpeed, catalogue};
use meshfree::prelude::*;
use meshfree::scene::Start;

/// The largest RMS error of the pressure over ρgH on the way, of water of 1 m depth and 0.5 m width with h/dx 2.
fn largest_error(spacing: f64, balanced: bool) -> f64 {
    let speed_of_sound = 10.0 * GRAVITY.sqrt();
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(speed_of_sound));
    let law = water.clone();
    let mut body = Body::block("water", water, [0.0; 2], [0.5, 1.0], spacing);
    body = if balanced {
        body.hydrostatic([0.0, -GRAVITY], [0.0, 1.0])
    } else {
        // The pressure of a column that nothing compresses.
        body.start(|[_, z], start| Start {
            density: law
                .eos()
                .density_at(1000.0 * GRAVITY * (1.0 - z), 0.0)
                .expect("a density"),
            ..start
        })
    };
    let sides = [[true; 2], [true, false]];
    let mut now = Scene::new(schemes::weakly_compressible().h_over_dx(2.0))
        .body(body)
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.5, 1.2],
            spacing,
            5,
            sides,
        ))
        .acceleration(|_| [0.0, -GRAVITY])
        .build()
        .expect("a tank");
    let mut largest = 0.0_f64;
    for reading in 1..=160 {
        // Not at a multiple of the period 4H/c of sound, which would hide a wave.
        let time = (0.25 * f64::from(reading) + 0.013 * f64::from(reading % 7)) / GRAVITY.sqrt();
        now.run_until(time).expect("rest");
        let squares = now.all().map(|particle| {
            let head = GRAVITY * (1.0 - particle.position()[1]);
            let square = speed_of_sound * speed_of_sound;
            let exact = 1000.0 * square * (head / square).exp_m1();
            (particle.pressure() - exact).powi(2)
        });
        let rms = (squares.sum::<f64>() / now.particles() as f64).sqrt();
        largest = largest.max(rms / (1000.0 * GRAVITY));
    }
    largest
}

/// Over 50 rows. The control starts out of balance by half the compression, and sound of that pressure goes up and down in it.
#[test]
fn still_water_keeps_the_pressure_of_its_weight() {
    let [still, control] = [true, false].map(|balanced| largest_error(0.02, balanced));
    assert!(still < 2e-3, "{still}");
    assert!(control > 3.5e-3, "{control}");
}

/// Over 100 rows.
#[test]
#[ignore = "takes two minutes"]
fn still_water_keeps_its_pressure_within_a_thousandth() {
    let largest = largest_error(0.01, true);
    assert!(largest < 1e-3, "{largest}");
}
