//! A rod of a material of its own, Birch's second-order law, strikes a wall, from *Materials and effects of your own*.

use meshfree::prelude::*;

/// p = 3/2 K (η^(7/3) − η^(5/3)), η = ρ/ρ₀ (Birch 1947, second order), by cubes of a cube root.
#[derive(Clone, Copy, Debug)]
struct Birch {
    density: f64,
    bulk_modulus: f64,
}

impl EquationOfState for Birch {
    fn name(&self) -> &'static str {
        "Birch, second order"
    }
    fn reference_density(&self) -> f64 {
        self.density
    }
    fn uses_energy(&self) -> bool {
        false
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, _energy: L) -> EosState<L> {
        let eta = density / L::of(self.density);
        let (five, seven) = (eta.powf(5.0 / 3.0), eta.powf(7.0 / 3.0));
        let k = L::of(self.bulk_modulus);
        let slope = k * (L::of(3.5) * seven - L::of(2.5) * five) / density;
        EosState {
            pressure: L::of(1.5) * k * (seven - five),
            sound_speed: slope.sqrt(),
            guards: Guards::none(),
        }
    }
}

fn main() -> Result<(), Error> {
    let iron = Material::new(
        "iron",
        Birch {
            density: 7870.0,
            bulk_modulus: 170e9,
        },
    );
    let mut rod = Scene::<f64, 1>::new(schemes::impact())
        .body(Body::block("rod", iron, [0.0], [0.02], 1e-4).velocity([30.0]))
        .boundary(MirrorPlane::wall([0.02], [1.0]))
        .build()?;
    rod.run_until(2e-6)?;
    let at_wall = rod.all().nth(180).map_or(0.0, |own| own.pressure());
    // ρ c v with c = √(K/ρ), a little more for the shock.
    let acoustic = 7870.0 * (170e9_f64 / 7870.0).sqrt() * 30.0;
    println!(
        "{:.0} MPa, in linear acoustics {:.0} MPa",
        1e-6 * at_wall,
        1e-6 * acoustic
    );
    assert!((at_wall / acoustic - 1.0).abs() < 0.05);
    Ok(())
}
