//! An equation of state of your own: two rods with a law that stiffens collide, next to the exact shocks. It shows what a law
//! has to state, and how a material takes it.
//! `cargo run --release --example own_material` leaves a picture, a table and files for ParaView in `out/own_material`.

use meshfree::material::eos::{EosState, EquationOfState, Guards};
use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};

/// A law that stiffens, p = c² (ρ − ρ₀) ρ/ρ₀. Its shocks run at c + u into material at rest that they leave at u.
#[derive(Clone, Copy, Debug)]
struct Stiffening {
    /// Density ρ₀ without pressure \[kg/m³\].
    density: f64,
    /// Sound speed c at that density \[m/s\].
    sound_speed: f64,
}

impl EquationOfState for Stiffening {
    fn name(&self) -> &'static str {
        "stiffening"
    }
    fn reference_density(&self) -> f64 {
        self.density
    }
    fn uses_energy(&self) -> bool {
        false
    }
    // A lane is a number or a row of numbers: one text serves single particles and vectors of them.
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, _energy: L) -> EosState<L> {
        let (c, one) = (L::of(self.sound_speed), L::of(1.0));
        let ratio = density * L::of(1.0 / self.density);
        // Far in tension the law would lose its sound speed, dp/dρ = c² (2ρ/ρ₀ − 1).
        let slope = (ratio + ratio - one).max(L::of(0.1));
        EosState {
            pressure: c * c * (density - L::of(self.density)) * ratio,
            sound_speed: c * slope.sqrt(),
            guards: Guards::none(),
        }
    }
}

pub(crate) fn main() -> Result<(), Failure> {
    // Rods of 0.1 m; a rod at 200 m/s leaves both at u = 100 m/s behind their shocks.
    let (length, speed, end) = (0.1, 100.0, 40e-6);
    let law = Stiffening {
        density: 1000.0,
        sound_speed: 1000.0,
    };
    let rod = |name, from: f64| {
        let foam = Material::new("foam", law);
        Body::block(name, foam, [from], [from + length], 5e-4)
    };
    let mut rods = Scene::<f64, 1>::new(schemes::impact())
        .body(rod("striker", 0.0).velocity([2.0 * speed]))
        .body(rod("target", length))
        .build()?;
    let summary = Run::new(&mut rods, end)
        .label("rods")
        .paraview(Schedule::evenly(11), "out/own_material/rods.pvd")
        .go()?;

    let shock = law.sound_speed + speed;
    let pressure = 1e-6 * law.density * speed * shock;
    let front = length + shock * end;
    let rear = length + (2.0 * speed - shock) * end;
    let exact = [
        (0.0, 0.0),
        (rear, 0.0),
        (rear, pressure),
        (front, pressure),
        (front, 0.0),
        (2.0 * length, 0.0),
    ];
    let points = rods.all().map(|p| [p.position()[0], 1e-6 * p.pressure()]);
    let points: Vec<_> = points.collect();
    let columns = ["x_m", "pressure_mpa"];
    CsvWriter::create("out/own_material/rods.csv", &columns)?.rows(&points)?;
    let [x, y] = [Axis::linear("x", "m"), Axis::linear("pressure", "MPa")];
    let panel = Panel::new(x, y)
        .series(Series::line("exact", exact).reference())
        .series(Series::line(
            "particles",
            points.into_iter().map(Into::into),
        ));
    let figure = Figure::new().panel(panel);
    figure.save("out/own_material/rods.svg")?;
    println!("{summary}\nwritten to out/own_material");
    Ok(())
}
