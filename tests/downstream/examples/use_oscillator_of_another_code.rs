//! A floor on a spring whose motion another code integrates, under the force of the water on it, from *Loads, and coupling*.

use meshfree::prelude::*;

fn main() -> Result<(), Error> {
    let (dx, g) = (0.02, 9.81);
    // The other code: a mass on a spring that feels the force of the water on the floor of the tank.
    let (mass, stiffness, damping) = (50.0, 2e5, 2e3);
    let (mut place, mut speed) = (0.0_f64, 0.0_f64);

    let water = catalogue::weakly_compressible_water(2.0);
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(
            Body::block("water", water, [0.0; 2], [0.4, 0.2], dx)
                .hydrostatic([0.0, -g], [0.0, 0.2]),
        )
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.4, 0.3],
            dx,
            3,
            [[true, true], [true, false]],
        ))
        .acceleration(move |_| [0.0, -g])
        .build()?;
    let interval = 1e-3;
    for step in 1..=200 {
        tank.run_until(interval * f64::from(step))?;
        let [_, push] = tank.wall_force("tank")?;
        let force = push - stiffness * place - damping * speed;
        speed += interval * force / mass;
        place += interval * speed;
    }
    let weight = 1000.0 * 0.4 * 0.2 * g;
    println!(
        "the spring is pressed by {:.2} mm, by its weight {:.2} mm",
        1e3 * place,
        -1e3 * weight / stiffness
    );
    assert!((place * stiffness / -weight - 1.0).abs() < 0.1);
    Ok(())
}
