//! Restart with changes: what is named may be another, and the run is then the one in which it changes at that step, to the
//! bit; what is not named is refused with both values.

use approx::assert_relative_eq;
use meshfree::boundary::Wall;
use meshfree::error::Result;
use meshfree::integrator::{Integrator, System};
use meshfree::prelude::*;
use meshfree::simulation::{Change, Simulation};
use meshfree::term::CentralViscosity;
use meshfree::term::viscosity::MonaghanGingold;
use std::path::PathBuf;

const DX: f64 = 0.1;
const WHEN: f64 = 0.1;
const END: f64 = 0.25;

/// A tank whose left wall is pushed in.
fn tank(alpha: f64, dynamic_viscosity: f64, way: f64) -> Scene<f64, 2> {
    let viscosity = MonaghanGingold { alpha, beta: 0.0 };
    let water =
        catalogue::weakly_compressible_water(10.0).with_dynamic_viscosity(dynamic_viscosity);
    let sides = [[false, true], [true, false]];
    let place = |i: u32, j: u32| [DX * (f64::from(i) - 4.5), DX * (f64::from(j) + 0.5)];
    let piston = (0..5).flat_map(|i| (0..8).map(move |j| place(i, j)));
    let piston = Wall::of("piston", piston.collect(), DX);
    // At rest until after what is saved.
    let gone = |t: f64| (t - WHEN - 0.01).max(0.0);
    let motion = Translation::new(
        move |t| [way * gone(t).powi(2), 0.0],
        move |t| [2.0 * way * gone(t), 0.0],
        move |t| [if gone(t) > 0.0 { 2.0 * way } else { 0.0 }, 0.0],
    );
    let scene = Scene::new(schemes::weakly_compressible().with_viscosity(viscosity))
        .body(Body::block("water", water, [0.0; 2], [1.0, 0.5], DX).velocity([0.1, 0.0]))
        .wall(Wall::around("tank", [-0.5, 0.0], [1.0, 0.8], DX, 5, sides))
        .acceleration(|_| [0.0, -9.81]);
    if way == 0.0 {
        scene.wall(piston)
    } else {
        scene.wall(piston.motion(motion))
    }
}

fn bits(simulation: &Simulation<f64, 2>) -> Vec<u64> {
    let all = simulation.all().flat_map(|p| {
        let [x, v] = [p.position(), p.velocity()];
        [x[0], x[1], v[0], v[1], p.density()]
    });
    all.map(f64::to_bits).collect()
}

/// A file of a scene of the first step from [`WHEN`] on.
fn saved(name: &str, scene: Scene<f64, 2>) -> Result<PathBuf> {
    let file = std::env::temp_dir().join(format!("meshfree-{name}-{}", std::process::id()));
    let mut run = scene.build()?;
    while run.time() < WHEN {
        run.step()?;
    }
    run.save(&file)?;
    Ok(file)
}

/// The run in which a scheme takes over after the first step from [`WHEN`] on.
fn exchanged(scene: Scene<f64, 2>, alpha: f64) -> Result<Simulation<f64, 2>> {
    let viscosity = MonaghanGingold { alpha, beta: 0.0 };
    let scheme = schemes::weakly_compressible().with_viscosity(viscosity);
    let mut run = scene
        .event("now", |now| now.time() >= WHEN)
        .exchange_scheme("water", "now", scheme)
        .build()?;
    run.run_until(END)?;
    Ok(run)
}

#[test]
fn another_viscosity_is_that_of_a_scheme_which_takes_over() -> Result<()> {
    let file = saved("viscosity", tank(0.02, 1e-3, 0.0))?;
    let run = exchanged(tank(0.02, 1e-3, 0.0), 0.2)?;
    let mut resumed = tank(0.2, 1e-3, 0.0).resume_with(&file, &[Change::Viscosity])?;
    resumed.run_until(END)?;
    assert!(bits(&run) == bits(&resumed));
    // It does something.
    let mut same = tank(0.02, 1e-3, 0.0).resume(&file)?;
    same.run_until(END)?;
    assert!(bits(&run) != bits(&same));
    // Of the material too.
    let thick = tank(0.02, 5.0, 0.0).resume_with(&file, &[Change::Viscosity]);
    let _ = std::fs::remove_file(file);
    thick.map(|_| ())
}

/// A block of viscous liquid that moves as a whole, so that its viscosity does nothing, until a load shears it after what is saved.
fn sheared_later(dynamic_viscosity: f64) -> Scene<f64, 2> {
    let water =
        catalogue::weakly_compressible_water(10.0).with_dynamic_viscosity(dynamic_viscosity);
    let later = |time: f64| if time > WHEN + 0.01 { 40.0 } else { 0.0 };
    Scene::new(schemes::weakly_compressible().with(Laminar(CentralViscosity)))
        .body(Body::block("water", water, [0.0; 2], [1.0, 0.5], DX).velocity([0.5, 0.0]))
        .load(Load::acceleration(move |at| {
            [later(at.time) * at.position[1], 0.0]
        }))
}

#[test]
fn another_viscosity_of_the_material_is_that_of_a_run_built_with_it() -> Result<()> {
    let (thin, thick) = (1e-3, 5.0);
    let file = saved("material", sheared_later(thin))?;
    let refused = sheared_later(thick).resume(&file).err();
    assert!(refused.is_some_and(|error| error.to_string().contains("viscosity")));
    let mut resumed = sheared_later(thick).resume_with(&file, &[Change::Viscosity])?;
    let mut same = sheared_later(thin).resume(&file)?;
    let _ = std::fs::remove_file(file);
    let mut built = sheared_later(thick).build()?;
    for run in [&mut resumed, &mut same, &mut built] {
        run.run_until(END)?;
    }
    assert!(bits(&resumed) == bits(&built));
    // What shear there is fades as the viscosity says.
    let apart = |run: &Simulation<f64, 2>| {
        let speeds = run.all().map(|p| p.velocity()[0]);
        let [low, high] = speeds.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(v), high.max(v)]
        });
        high - low
    };
    println!("{} and {} m/s", apart(&resumed), apart(&same));
    assert!(apart(&resumed) < 0.99 * apart(&same));
    Ok(())
}

/// Kick, drift, kick by another name.
#[derive(Clone, Debug)]
struct Own;

impl Integrator for Own {
    fn name(&self) -> String {
        "mine".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        KickDriftKick.step(system, dt)
    }
}

#[test]
fn another_integrator_goes_on_from_the_state() -> Result<()> {
    let file = saved("integrator", tank(0.02, 1e-3, 0.0))?;
    let run = exchanged(tank(0.02, 1e-3, 0.0), 0.02)?;
    let with = |integrator: &dyn Fn(Scene<f64, 2>) -> Scene<f64, 2>| {
        let scene = integrator(tank(0.02, 1e-3, 0.0));
        let mut run = scene.resume_with(&file, &[Change::Integrator])?;
        run.run_until(END)?;
        Ok::<_, Error>(run)
    };
    let same = with(&|scene| scene.integrator(Own))?;
    assert!(bits(&run) == bits(&same));
    // Another of the same order is near.
    let other = with(&|scene| scene.integrator(DriftKickDrift))?;
    let _ = std::fs::remove_file(&file);
    assert!(bits(&run) != bits(&other));
    for (a, b) in run.all().zip(other.all()) {
        assert_relative_eq!(a.position()[0], b.position()[0], epsilon = 1e-2 * DX);
    }
    Ok(())
}

#[test]
fn another_wall_is_the_one_that_would_have_moved_from_then_on() -> Result<()> {
    let file = saved("wall", tank(0.02, 1e-3, 0.0))?;
    let mut run = tank(0.02, 1e-3, 2.0).resume_with(&file, &[Change::Walls])?;
    run.run_until(END)?;
    let whole = exchanged(tank(0.02, 1e-3, 2.0), 0.02)?;
    let _ = std::fs::remove_file(&file);
    assert!(bits(&run) == bits(&whole));
    let moved = |run: &Simulation<f64, 2>| run.all().next().map_or(0.0, |p| p.position()[0]);
    let mut rests = tank(0.02, 1e-3, 0.0).build()?;
    rests.run_until(END)?;
    assert!(moved(&run) > moved(&rests) + 1e-3);
    Ok(())
}

#[test]
fn other_steps_are_those_of_a_run_that_takes_them_from_then_on() -> Result<()> {
    let still = || tank(0.02, 1e-3, 0.0);
    let file = saved("steps", still())?;
    // Times at which steps end, of which a run built with them feels nothing before.
    let ends = || still().step_ends_at([0.5 * (WHEN + END)]);
    let mut whole = ends().build()?;
    whole.run_until(END)?;
    let mut resumed = ends().resume_with(&file, &[Change::Steps])?;
    resumed.run_until(END)?;
    assert!(bits(&whole) == bits(&resumed));
    let mut same = still().resume(&file)?;
    same.run_until(END)?;
    let _ = std::fs::remove_file(&file);
    assert!(bits(&same) != bits(&whole));
    Ok(())
}

#[test]
fn another_load_is_the_one_that_would_have_begun_then() -> Result<()> {
    let still = || tank(0.02, 1e-3, 0.0);
    let file = saved("load", still())?;
    let later = |time: f64, value: f64| if time > WHEN + 0.01 { value } else { 0.0 };
    // One of all particles, and one by place.
    let shaken = || still().acceleration(move |t| [later(t, 3.0), 0.0]);
    let pushed = || {
        still().load(Load::acceleration(move |at| {
            [0.0, later(at.time, 2.0 * at.position[0])]
        }))
    };
    let mut ends = Vec::new();
    for scene in [&shaken as &dyn Fn() -> Scene<f64, 2>, &pushed] {
        let refused = scene().resume(&file).err();
        assert!(refused.is_some_and(|error| error.to_string().contains("the loads")));
        let mut run = scene().resume_with(&file, &[Change::Loads])?;
        run.run_until(END)?;
        assert!(bits(&run) == bits(&exchanged(scene(), 0.02)?));
        ends.push(bits(&run));
    }
    let same = exchanged(still(), 0.02)?;
    let _ = std::fs::remove_file(&file);
    assert!(ends[0] != ends[1] && !ends.contains(&bits(&same)));
    Ok(())
}

/// Water that runs out over the floor of a tank, to where an outlet is.
fn runs_out(place: f64) -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(20.0);
    let sides = [[true, true], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.4, 0.4], 0.05))
        .wall(Wall::around("tank", [0.0; 2], [1.5, 0.6], 0.05, 5, sides))
        .outlet(Outlet::plane([place, 0.0], [1.0, 0.0]))
        .acceleration(|_| [0.0, -9.81])
}

#[test]
fn another_outlet_is_the_one_that_nothing_had_reached() -> Result<()> {
    let (far, near) = (1.2, 0.7);
    let file = saved("outlet", runs_out(far))?;
    let mut whole = runs_out(near).build()?;
    while whole.time() < WHEN {
        whole.step()?;
    }
    assert_eq!(whole.removed().particles, 0);
    let end = 0.4;
    whole.run_until(end)?;
    let refused = runs_out(near).resume(&file).err();
    let mut run = runs_out(near).resume_with(&file, &[Change::Outlets])?;
    let mut same = runs_out(far).resume(&file)?;
    let _ = std::fs::remove_file(&file);
    assert!(refused.is_some_and(|error| error.to_string().contains("outlets")));
    run.run_until(end)?;
    same.run_until(end)?;
    assert!(bits(&run) == bits(&whole));
    assert_eq!(run.removed(), whole.removed());
    assert!(run.removed().particles > 0 && same.removed().particles == 0);
    Ok(())
}

#[test]
fn what_is_not_named_is_refused_with_both_values() -> Result<()> {
    let file = saved("refused", tank(0.02, 1e-3, 0.0))?;
    let refusal = |scene: Scene<f64, 2>, changes: &[Change]| {
        let made = scene.resume_with(&file, changes);
        made.err().map_or(String::new(), |error| error.to_string())
    };
    let other = || tank(0.02, 2e-3, 0.0).integrator(DriftKickDrift);
    let all = other().differences(&file)?;
    assert!(all.iter().any(|own| own.part == "the integrator"
        && own.file.as_deref() == Some("KickDriftKick")
        && own.scene.as_deref() == Some("DriftKickDrift")));
    let both = refusal(other(), &[]);
    assert!(
        both.contains("integrator is KickDriftKick in the file and DriftKickDrift in the scene"),
        "{both}"
    );
    assert!(
        both.contains("is 0.001 in the file and 0.002 in the scene"),
        "{both}"
    );
    let one = refusal(other(), &[Change::Integrator]);
    assert!(
        !one.contains("KickDriftKick") && one.contains("0.002"),
        "{one}"
    );
    assert_eq!(
        refusal(other(), &[Change::Integrator, Change::Viscosity]),
        ""
    );
    // Names do not cover more than they say.
    let every = [
        Change::Steps,
        Change::Integrator,
        Change::Loads,
        Change::Viscosity,
        Change::Motions,
        Change::Walls,
        Change::Outlets,
        Change::Events,
    ];
    let heavy = Body::block(
        "water",
        catalogue::weakly_compressible_water(11.0),
        [0.0; 2],
        [1.0, 0.5],
        DX,
    );
    let heavy = Scene::new(schemes::weakly_compressible()).body(heavy);
    assert!(refusal(heavy, &every).contains("differs in"));
    let _ = std::fs::remove_file(&file);
    Ok(())
}
