//! A standing sound wave in a weakly compressible liquid, in one, two and three dimensions.
//! After one period it should be what it was.

use super::problem::{Problem, Text, liquid, plain_viscosity, sweep};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::work_precision::{Case, Failure, Method, Outcome, Quantity, relative_l2};
use meshfree::term::{Antuono, Fourtakas};

const LINE: Text = Text {
    key: "sound_1d",
    title: "Sound in a liquid, one dimension",
    setting: "A standing wave of 1 m, amplitude 10⁻⁸ c, in a period of its length, after one period of time: root mean square \
              error of velocity over that of the wave.",
    words: include_str!("words/sound_1d.md"),
};
const PLANE: Text = Text {
    key: "sound_2d",
    title: "Sound in a liquid, two dimensions",
    setting: "The same wave in a periodic strip, 16 spacings high.",
    words: include_str!("words/sound_2d.md"),
};
const SPACE: Text = Text {
    key: "sound_3d",
    title: "Sound in a liquid, three dimensions",
    setting: "The same wave in a periodic bar, 12 spacings wide and high.",
    words: include_str!("words/sound_3d.md"),
};
const SOUND: f64 = 10.0;
const QUANTITY: &str = "velocity of a sound wave";

fn methods() -> Vec<Method> {
    vec![
        liquid(
            "h/dx 1.5, α 0.02, δ 0.1 (default)",
            "Fourtakas",
            1.5,
            0.02,
            0.1,
        ),
        liquid("h/dx 2.0, α 0.02, δ 0.1", "Fourtakas", 2.0, 0.02, 0.1),
        liquid("h/dx 1.2, α 0.02, δ 0.1", "Fourtakas", 1.2, 0.02, 0.1),
        liquid("h/dx 1.5, α 0, δ 0.1", "Fourtakas", 1.5, 0.0, 0.1),
        liquid("h/dx 1.5, α 0.02, δ 0", "Fourtakas", 1.5, 0.02, 0.0),
        liquid("h/dx 1.5, α 0.02, Antuono δ 0.1", "Antuono", 1.5, 0.02, 0.1),
        liquid("h/dx 1.5, α 0, δ 0", "Fourtakas", 1.5, 0.0, 0.0),
        liquid("h/dx 2.0, α 0, δ 0", "Fourtakas", 2.0, 0.0, 0.0),
    ]
}

/// The dimensions in which both schemes can be composed.
trait Composed: Sized {
    fn composed(case: &Case<'_>) -> Result<Self, Failure>;
}

macro_rules! composed {
    ($($D:literal)*) => {$(
        impl Composed for Scheme<f64, $D> {
            fn composed(case: &Case<'_>) -> Result<Self, Failure> {
                let delta = case.number("delta")?;
                let scheme = schemes::weakly_compressible()
                    .with_viscosity(plain_viscosity(case)?)
                    .h_over_dx(case.number("h/dx")?);
                Ok(if case.text("scheme")? == "Antuono" {
                    scheme.density_diffusion(Antuono { delta }).compose()
                } else {
                    scheme.density_diffusion(Fourtakas { delta }).compose()
                })
            }
        }
    )*};
}
composed! { 1 2 3 }

fn ring<const D: usize>(case: &Case<'_>) -> Result<Outcome, Failure>
where
    Scheme<f64, D>: Composed,
{
    let dx = case.spacing();
    let mut size = [if D == 3 { 12.0 } else { 16.0 } * dx; D];
    size[0] = 1.0;
    let wavenumber = core::f64::consts::TAU;
    let liquid = Liquid::new(1000.0, 1480.0, 0.0).linear();
    let liquid = liquid.material("liquid", SoundSpeed::Chosen(SOUND));
    // So small that what theory leaves out, a part of as much of the wave, is below all errors here.
    let amplitude = 1e-8 * SOUND;
    let body = Body::block("liquid", liquid, [0.0; D], size, dx).start(|x, start| {
        let mut velocity = [0.0; D];
        velocity[0] = amplitude * (wavenumber * x[0]).sin();
        Start { velocity, ..start }
    });
    let scene = Scene::new(Scheme::<f64, D>::composed(case)?).body(body);
    let scene = (0..D).fold(scene, |scene, d| {
        scene.boundary(Periodic::along(d, 0.0, size[d]))
    });
    let mut wave = scene.build()?;
    wave.run_until(1.0 / SOUND)?;
    let error = relative_l2(wave.all().map(|particle| {
        let exact = amplitude * (wavenumber * particle.position()[0]).sin();
        (particle.velocity()[0], exact, 1.0)
    }));
    Ok(Outcome::of(&wave).value(QUANTITY, error))
}

pub fn problem(dimensions: usize, quick: bool) -> Problem {
    type Run = fn(&Case<'_>) -> Result<Outcome, Failure>;
    let (text, run, counts): (_, Run, &[u32]) = match dimensions {
        1 => (LINE, ring::<1>, &[16, 32, 64, 128, 256, 512]),
        2 => (PLANE, ring::<2>, &[16, 24, 32, 48, 64, 96]),
        _ if quick => (SPACE, ring::<3>, &[12, 14, 16]),
        _ => (SPACE, ring::<3>, &[12, 16, 24, 32, 48]),
    };
    let study = sweep(text, counts, quick, methods(), run);
    Problem {
        text,
        study: study.quantity(Quantity::measured(QUANTITY)),
    }
}
