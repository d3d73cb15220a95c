//! What compatible energy costs, and what it buys: the same runs with compatible and with symmetric energy.
//! Time is that of steps, least of three runs in turns; the change of total energy is relative to the largest kinetic energy.

use super::rods;
use meshfree::effect::NeoHookean;
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::output::table::{Table, significant};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::EnergyForm;
use meshfree::study::work_precision::Failure;

/// What one run took: seconds of steps, seconds of the work in kicks, pairs, and the change of total energy.
struct Run {
    seconds: f64,
    work: f64,
    pairs: f64,
    change: f64,
}

fn run<const D: usize>(scene: Scene<f64, D>, end: f64) -> Result<Run, Failure> {
    let mut simulation = scene.build()?;
    let start = simulation.ledger().whole.total_energy();
    let mut kinetic = 0.0_f64;
    simulation.run_with(end, |now| {
        let own = |p: meshfree::simulation::ParticleView<'_, f64, D>| {
            0.5 * p.mass() * p.velocity().map(|v| v * v).iter().sum::<f64>()
        };
        kinetic = kinetic.max(now.all().map(own).sum());
    })?;
    let phases = simulation.phases();
    Ok(Run {
        seconds: phases.total().as_secs_f64(),
        work: phases.work.as_secs_f64(),
        pairs: simulation.work().pairs as f64,
        change: (simulation.ledger().whole.total_energy() - start) / kinetic,
    })
}

fn compare<const D: usize>(
    table: &mut Table,
    name: &str,
    end: f64,
    scene: impl Fn(EnergyForm) -> Result<Scene<f64, D>, Failure>,
) -> Result<(), Failure> {
    let mut forms = [Vec::new(), Vec::new()];
    for _ in 0..3 {
        for (form, runs) in [EnergyForm::Compatible, EnergyForm::Symmetric]
            .into_iter()
            .zip(&mut forms)
        {
            runs.push(run(scene(form)?, end)?);
        }
    }
    let [compatible, symmetric] = forms.map(|runs| {
        runs.into_iter()
            .min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    });
    let (Some(compatible), Some(symmetric)) = (compatible, symmetric) else {
        return Ok(());
    };
    table.row([
        name.to_string(),
        significant(100.0 * compatible.work / compatible.seconds, 2),
        significant(compatible.seconds / symmetric.seconds, 3),
        significant(compatible.pairs / symmetric.pairs, 3),
        format!("{:.1e}", 100.0 * compatible.change),
        format!("{:.1e}", 100.0 * symmetric.change),
    ]);
    Ok(())
}

/// Two states of gas side by side, of which the left expands into the right, periodic across.
fn tube(form: EnergyForm, dx: f64) -> Scene<f64, 2> {
    let gas = IdealGas::new(1.4, 1.0);
    let width = 16.0 * dx;
    let tube = Body::block(
        "tube",
        Material::new("gas", gas),
        [-0.5, 0.0],
        [0.5, width],
        dx,
    );
    let tube = tube.start(|[x, _], start| Start {
        energy: gas.energy(if x < 0.0 { 1.0 } else { 0.1 }, 1.0),
        ..start
    });
    Scene::new(schemes::gas().energy(form).compose())
        .body(tube)
        .boundary(MirrorPlane::symmetry([-0.5, 0.0], [-1.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.5, 0.0], [1.0, 0.0]))
        .boundary(Periodic::along(1, 0.0, width))
}

/// A free plate of rubber that starts to bend.
fn plate(form: EnergyForm, dx: f64) -> Scene<f64, 2> {
    let rubber = Material::new("rubber", Linear::from_elastic_constants(1000.0, 2e6, 0.4))
        .with_shear_modulus(2e6 / 2.8);
    let plate = Body::block("plate", rubber, [0.0; 2], [0.2, 0.02], dx);
    let scheme = schemes::total_lagrangian().with(NeoHookean).energy(form);
    Scene::new(scheme.compose()).body(plate.start(|[x, _], start| Start {
        velocity: [0.0, (x / 0.1 - 1.0).powi(2) - 1.0 / 3.0],
        ..start
    }))
}

/// The table of all scenes.
pub fn table(quick: bool) -> Result<Table, Failure> {
    let mut table = Table::new([
        "scene",
        "share of the work in kicks [%]",
        "time over symmetric",
        "pairs over symmetric",
        "change of total energy [%]",
        "with symmetric energy [%]",
    ]);
    let fine = if quick { 4.0 } else { 1.0 };
    compare(&mut table, "copper rods (1D)", rods::END, |form| {
        let scheme = schemes::impact().energy(form).compose();
        rods::scene(scheme, 2.5e-5 * fine, "copper")
    })?;
    compare(&mut table, "shock in gas (2D)", 0.1, |form| {
        Ok(tube(form, 0.005 * fine))
    })?;
    compare(
        &mut table,
        "elastic plate (2D, total Lagrangian)",
        0.05,
        |form| Ok(plate(form, 0.00125 * fine)),
    )?;
    Ok(table)
}
