//! Liquids at a chosen sound speed: the physical one, or an artificial one that costs fewer steps.
//! Either way the density is ρ₀ to within a hundredth, and the price of each can be printed.

use super::Material;
use super::eos::guard::Problems;
use super::eos::{Linear, Tait};
use crate::scalar::{Lane, Real};

/// The Mach number that keeps the density of a liquid within 1 %: the change is about Ma².
const WEAK: f64 = 0.1;
/// The step factor of the schemes, of which `price` speaks.
const STEP_FACTOR: f64 = 0.55;

/// Which sound speed c₀ \[m/s\] a liquid is computed with.
///
/// The time step is proportional to h/c₀, and in slow flow c₀ decides nothing else than how far the
/// density departs from ρ₀: by about Ma² = (v/c₀)² of it. So a liquid may take an artificial c₀ of ten
/// times the greatest speed (Monaghan 1994), where inertia makes the pressure: Δp compresses by Δp/(ρ c₀²), whatever makes it, and
/// viscosity in a thin film makes more (see [advice](crate::scene::advice)). The pressure of an impact that the sound speed does
/// decide, ρ₀ c v behind a wave of the water-hammer kind, is then that of the artificial one, too low
/// by the same factor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub enum SoundSpeed {
    /// That of the real liquid: right for impact, water hammer and sound.
    #[default]
    Physical,
    /// c₀ = speed/mach. More than Mach 0.1 is a problem, because the density then changes by more
    /// than 1 %; ask for it with [`Chosen`](Self::Chosen).
    Artificial {
        /// Mach number \[1\] of the flow at that speed, at most 0.1.
        mach: f64,
        /// Greatest speed \[m/s\] that is expected, for a column of depth H about 2 √(g H).
        speed: f64,
    },
    /// This c₀ \[m/s\], whatever the speed of the flow.
    Chosen(f64),
}

impl SoundSpeed {
    /// Artificial, for flow up to that speed \[m/s\] at Mach 0.1.
    #[must_use]
    pub const fn artificial(speed: f64) -> Self {
        Self::Artificial { mach: WEAK, speed }
    }

    /// c₀ \[m/s\] of a liquid that really has the `physical` one \[m/s\].
    #[must_use]
    pub fn of(self, physical: f64) -> f64 {
        match self {
            Self::Physical => physical,
            Self::Artificial { mach, speed } => speed / mach,
            Self::Chosen(speed) => speed,
        }
    }

    /// What is wrong with the choice, as `(field, value, what it must be)`; empty if nothing.
    #[must_use]
    pub fn problems(self) -> Vec<(&'static str, f64, &'static str)> {
        match self {
            Self::Physical => Vec::new(),
            Self::Artificial { mach, speed } => Problems::default()
                .must(
                    mach > 0.0 && mach <= WEAK,
                    "mach",
                    mach,
                    "above 0 and at most 0.1, so that the sound speed is ten times the expected \
                     speed and the density keeps within 1 %; lower it, or take \
                     `SoundSpeed::Chosen` if that is not wanted",
                )
                .positive("speed", speed)
                .list(),
            Self::Chosen(speed) => Problems::default().positive("sound_speed", speed).list(),
        }
    }

    /// What the choice is called in a report.
    const fn name(self) -> &'static str {
        match self {
            Self::Physical => "physical",
            Self::Artificial { .. } => "artificial",
            Self::Chosen(_) => "chosen",
        }
    }
}

/// A liquid: density ρ₀ \[kg/m³\], physical sound speed \[m/s\] and dynamic viscosity \[Pa s\], which
/// become a material on Tait's law with γ = 7, or on the [linear](Self::linear) one.
///
/// ```
/// use meshfree::material::{Liquid, Material, SoundSpeed};
/// // Sunflower oil, flowing at up to 0.5 m/s, in cells of 5 mm.
/// let oil = Liquid::new(920.0, 1450.0, 0.05);
/// let choice = SoundSpeed::artificial(0.5);
/// println!("{}", oil.price(choice, 5e-3, 1.5));
/// let material: Material<f64> = oil.material("sunflower oil", choice);
/// assert_eq!(material.state(920.0, 0.0), (0.0, 5.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Liquid {
    density: f64,
    sound_speed: f64,
    dynamic_viscosity: f64,
    linear: bool,
}

impl Liquid {
    /// ρ₀ \[kg/m³\], the physical sound speed \[m/s\] and the dynamic viscosity \[Pa s\].
    #[must_use]
    pub const fn new(density: f64, sound_speed: f64, dynamic_viscosity: f64) -> Self {
        Self {
            density,
            sound_speed,
            dynamic_viscosity,
            linear: false,
        }
    }

    /// Water at 20 °C: 1000 kg/m³, 1480 m/s, 10⁻³ Pa s.
    #[must_use]
    pub const fn water() -> Self {
        Self::new(1000.0, 1480.0, 1.0e-3)
    }

    /// The same on the linear law p = c₀² (ρ − ρ₀): gentler than Tait's where the density strays, and
    /// within 3.1 % of it at 1 % compression.
    #[must_use]
    pub const fn linear(mut self) -> Self {
        self.linear = true;
        self
    }

    /// The material of that name at that sound speed, whose problems it reports with its own.
    #[must_use]
    pub fn material<T: Real>(self, name: &str, sound_speed: SoundSpeed) -> Material<T> {
        let speed = sound_speed.of(self.sound_speed);
        let material = if self.linear {
            Material::new(name, Linear::new(self.density, speed))
        } else {
            Material::new(name, Tait::new(self.density, speed))
        };
        Material {
            sound_speed,
            ..material.with_dynamic_viscosity(self.dynamic_viscosity)
        }
    }

    /// Acoustic steps dt = C h/c₀ that a second of flow takes with that choice, for a spacing \[m\]
    /// and h/dx, with the step factor C = 0.55 that the schemes have by default.
    #[must_use]
    pub fn steps_per_second(&self, choice: SoundSpeed, spacing: f64, h_over_dx: f64) -> f64 {
        choice.of(self.sound_speed) / (STEP_FACTOR * h_over_dx * spacing)
    }

    /// The price of the choice compared with that of the physical sound speed, in two lines to print: steps
    /// for a second of flow, and what becomes of impact pressures.
    #[must_use]
    pub fn price(&self, choice: SoundSpeed, spacing: f64, h_over_dx: f64) -> String {
        let line = |choice: SoundSpeed| {
            let steps = self.steps_per_second(choice, spacing, h_over_dx);
            let (name, speed) = (choice.name(), choice.of(self.sound_speed));
            // Four digits, however large it is.
            let unit = Lane::powf(10.0, 3.0 - speed.log10().floor());
            let speed = (speed * unit).round() / unit;
            format!("{name} sound speed {speed} m/s: {steps:.0} steps for a second of flow")
        };
        let mut text = format!(
            "{}, impact pressures of the liquid",
            line(SoundSpeed::Physical)
        );
        if choice != SoundSpeed::Physical {
            let factor = choice.of(self.sound_speed) / self.sound_speed;
            text += &format!("\n{}, impact pressures {factor:.3} of those", line(choice));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::catalogue;

    const DX: f64 = 0.01;

    #[test]
    fn the_price_speaks_of_the_step_factor_of_schemes() {
        assert_eq!(STEP_FACTOR, crate::scheme::DEFAULT_STEP_FACTOR);
        let choice = SoundSpeed::artificial(2.0);
        let steps = Liquid::water().steps_per_second(choice, DX, 1.5);
        assert!((steps * STEP_FACTOR * 0.015 / 20.0 - 1.0).abs() < 1e-15);
        let text = Liquid::water().price(choice, DX, 1.5);
        // 1480/(0.55·0.015) and 20/(0.55·0.015); 20/1480.
        for part in ["1480 m/s: 179394 steps", "20 m/s: 2424 steps", "0.014 of"] {
            assert!(text.contains(part), "{text}");
        }
        let slow = Liquid::water().price(SoundSpeed::artificial(0.03), DX, 1.5);
        assert!(slow.contains(" 0.3 m/s: 36 steps"), "{slow}");
        let physical = Liquid::water().price(SoundSpeed::Physical, DX, 1.5);
        assert_eq!(physical.lines().count(), 1);
    }

    /// The dynamic pressure ρ₀v² at the expected speed compresses by at most a hundredth.
    #[test]
    fn the_density_keeps_within_a_hundredth() {
        let (speed, oil) = (3.0, Liquid::new(920.0, 1450.0, 0.05));
        for liquid in [oil, oil.linear()] {
            let material = liquid.material::<f64>("oil", SoundSpeed::artificial(speed));
            let density = material.eos().density_at(920.0 * speed * speed, 0.0);
            let strain = density.expect("within range") / 920.0 - 1.0;
            assert!(strain > 0.009 && strain < 0.01 + 1e-12, "{strain}");
        }
        let law = |liquid: Liquid| {
            let material = liquid.material::<f64>("oil", SoundSpeed::Physical);
            assert!((material.state(920.0, 0.0).1 - 1450.0).abs() < 1e-9);
            (material.eos().name(), material.dynamic_viscosity)
        };
        assert_eq!(law(oil), ("Tait", Some(0.05)));
        assert_eq!(law(oil.linear()), ("linear", Some(0.05)));
    }

    #[test]
    fn a_low_sound_speed_is_a_problem_unless_asked_for() {
        let problems = |choice| catalogue::water_at::<f64>(choice).problems();
        let (mach, speed) = (0.2, 2.0);
        let found = problems(SoundSpeed::Artificial { mach, speed });
        assert!(found.len() == 1 && found[0].0 == "mach" && found[0].1 == 0.2);
        assert!(found[0].2.contains("SoundSpeed::Chosen"));
        assert_eq!(problems(SoundSpeed::Chosen(10.0)), []);
        assert_eq!(problems(SoundSpeed::artificial(2.0)), []);
        assert_eq!(problems(SoundSpeed::Physical), []);
        // A wrong speed is wrong in the choice and in the law that comes of it.
        for choice in [SoundSpeed::artificial(-1.0), SoundSpeed::Chosen(f64::NAN)] {
            assert!(!choice.problems().is_empty() && problems(choice).len() >= 2);
        }
        // Another law has its own sound speed.
        let artificial = SoundSpeed::Artificial { mach, speed };
        let other = catalogue::water_at::<f64>(artificial).with_eos(Linear::new(1000.0, 1480.0));
        assert_eq!(other.problems(), []);
    }
}
