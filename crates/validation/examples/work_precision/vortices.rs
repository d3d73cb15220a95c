//! Taylor–Green vortices at Re 100 in two dimensions, which decay by viscosity alone.
//! Speed by the energy, velocity and pressure by their fields, against the exact flow.

use super::problem::{Problem, Text, method, sweep};
use meshfree::kernel::WendlandC4;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::Shifting;
use meshfree::study::taylor_green::TaylorGreen;
use meshfree::study::work_precision::{Case, Failure, Method, Outcome, Quantity, relative_l2};
use meshfree::term::LaminarViscosity;
use meshfree::term::viscosity::Inviscid;

const TEXT: Text = Text {
    key: "vortices",
    title: "Taylor–Green vortices at Re 100",
    setting: "Four vortices of 1 m/s in a periodic square of 1 m, after 0.5 s, when the speed has fallen to 0.67; root mean \
              square error of velocity over velocity. Two dimensions.",
    words: include_str!("words/vortices.md"),
};
const VELOCITY: &str = "velocity of the vortices";
const SPEED: &str = "speed by the energy";
const PRESSURE: &str = "pressure of the vortices";
const END: f64 = 0.5;
const SOUND: f64 = 10.0;

fn methods() -> Vec<Method> {
    let own = |name: &str, kernel: &str, shifting: &str, ratio: f64, sound: f64| {
        let numbers = [("h/dx", ratio), ("sound", sound)];
        method(
            name,
            &[("kernel", kernel), ("shifting", shifting)],
            &numbers,
        )
    };
    vec![
        own(
            "C2, h/dx 1.5, shifted (default)",
            "C2",
            "closed",
            1.5,
            SOUND,
        ),
        own("C2, h/dx 2.0, shifted", "C2", "closed", 2.0, SOUND),
        own("C2, h/dx 1.5, transport", "C2", "transport", 1.5, SOUND),
        own("C2, h/dx 2.0, shifted, 20 U", "C2", "closed", 2.0, 20.0),
        own("C4, h/dx 2.2, shifted", "C4", "closed", 2.2, SOUND),
    ]
}

fn run(case: &Case<'_>) -> Result<Outcome, Failure> {
    let shifting = match case.text("shifting")? {
        "transport" => Shifting::TRANSPORT,
        _ => Shifting::CLOSED,
    };
    let ratio = case.number("h/dx")?;
    let scheme: Scheme<f64, 2> = if case.text("kernel")? == "C4" {
        SchemeBuilder::liquid(WendlandC4, Inviscid)
            .with(DensityDiffusion(meshfree::term::Fourtakas::default()))
            .with(Laminar(LaminarViscosity))
            .with(shifting)
            .h_over_dx(ratio)
            .compose()
    } else {
        schemes::weakly_compressible()
            .with_viscosity(Inviscid)
            .with(Laminar(LaminarViscosity))
            .with(shifting)
            .h_over_dx(ratio)
            .compose()
    };
    let exact = TaylorGreen::new(100.0)?;
    let sound = case.number("sound")?;
    let liquid = Liquid::new(1.0, 1480.0, exact.kinematic_viscosity()).linear();
    let material = liquid.material("liquid", SoundSpeed::Chosen(sound));
    let body = Body::block("liquid", material, [0.0; 2], [1.0; 2], case.spacing());
    let body = body.start(|x, start| Start {
        velocity: exact.velocity(x, 0.0),
        density: 1.0 + exact.pressure(x, 0.0) / (sound * sound),
        ..start
    });
    let mut vortices = Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .build()?;
    vortices.run_until(END)?;
    let energy = vortices.ledger().whole.kinetic / exact.kinetic_energy(END);
    let velocity = relative_l2(vortices.all().flat_map(|particle| {
        let (found, exact) = (
            particle.velocity(),
            exact.velocity(particle.position(), END),
        );
        [0, 1].map(|d| (found[d], exact[d], 1.0))
    }));
    // Pressure but for a constant.
    let count = vortices.particles() as f64;
    let mean = vortices.all().map(|p| p.pressure()).sum::<f64>() / count;
    let pressure = relative_l2(
        vortices
            .all()
            .map(|p| (p.pressure() - mean, exact.pressure(p.position(), END), 1.0)),
    );
    Ok(Outcome::of(&vortices)
        .value(VELOCITY, velocity)
        .value(SPEED, energy.sqrt())
        .value(PRESSURE, pressure))
}

pub fn problem(quick: bool) -> Problem {
    let counts: &[u32] = if quick {
        &[16, 24, 32]
    } else {
        &[24, 32, 48, 64, 96]
    };
    let study = sweep(TEXT, counts, quick, methods(), run)
        .quantity(Quantity::measured(VELOCITY))
        .quantity(Quantity::exact(SPEED, 1.0))
        .quantity(Quantity::measured(PRESSURE));
    Problem { text: TEXT, study }
}
