//! States from files: what is written is read to the same bits, and what is resampled is exact for linear fields.
//! VTK files, tables and a checkpoint of another scene.

use approx::{assert_abs_diff_eq, assert_relative_eq};
#[cfg(feature = "checkpoint")]
use meshfree::boundary::{Inlet, Outlet};
use meshfree::effect::{HeatConduction, NeoHookean};
use meshfree::output::vtu::Vtu;
use meshfree::prelude::*;
#[cfg(feature = "checkpoint")]
use meshfree::ranks::in_threads;
use meshfree::scene::{ParticleState, Start};
use std::path::PathBuf;

fn water() -> Material<f64> {
    catalogue::weakly_compressible_water(2.0)
}

fn scheme() -> Scheme<f64, 2> {
    let conduction = HeatConduction {
        conductivity: 1.0,
        specific_heat: 1.0,
        temperature: 300.0,
    };
    schemes::weakly_compressible().with(conduction).compose()
}

fn file(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("meshfree-{}-{name}", std::process::id()))
}

/// A linear state.
fn velocity([x, y]: [f64; 2]) -> [f64; 2] {
    [1.0 + 3.0 * x - y, 0.5 * y]
}

fn body(dx: f64) -> Body<f64, 2> {
    Body::block("water", water(), [0.0; 2], [0.4, 0.2], dx)
}

fn start(x: [f64; 2], own: Start<2>) -> Start<2> {
    Start {
        velocity: velocity(x),
        density: 1000.0 + x[0],
        ..own
    }
}

fn coarse() -> Simulation<f64, 2> {
    let body = body(0.02)
        .start(start)
        .field(HeatConduction::TEMPERATURE, |[x, y]| [300.0 + 10.0 * x + y]);
    let mut run = Scene::new(scheme()).body(body).build().expect("water");
    run.step_at_most(1e-12).expect("a step");
    run
}

#[test]
fn what_is_written_is_read_to_the_same_bits() {
    let mut run = coarse();
    run.run_until(0.01).expect("a run");
    let state = ParticleState::of(&run);
    let (grid, table) = (file("state.vtu"), file("state.csv"));
    run.vtu().write(&grid).expect("a grid");
    state.write_csv(&table).expect("a table");
    let [a, b] = [
        ParticleState::read_vtu(&grid),
        ParticleState::read_csv(&table),
    ]
    .map(|own| own.expect("a state"));
    for path in [grid, table] {
        let _ = std::fs::remove_file(path);
    }
    assert_eq!(a, state);
    for name in ["velocity", "density", "temperature", "mass"] {
        let values = state.values(name).expect(name);
        assert!(!values.is_empty());
        assert_eq!(a.values(name), Some(values));
        // A table has the components of a vector of VTK.
        assert_eq!(b.values(name), Some(values));
    }
    assert_eq!(b.points(), state.points());
    // A body of the same particles starts with these bits.
    let body = Body::of_state("water", water(), &a, 0.02)
        .and_then(|own| own.field_from(&a, HeatConduction::TEMPERATURE))
        .expect("a body");
    let again = Scene::new(scheme()).body(body).build().expect("water");
    for (x, y) in again.all().zip(run.all()) {
        assert_eq!(x.velocity(), y.velocity());
        assert_eq!(x.density(), y.density());
        assert_eq!(x.mass(), y.mass());
        assert_eq!(
            x.scalar(HeatConduction::TEMPERATURE),
            y.scalar(HeatConduction::TEMPERATURE)
        );
        assert_abs_diff_eq!(x.position()[0], y.position()[0], epsilon = 1e-15);
    }
}

/// Resampled to finer and coarser spacings linear fields are exact, and mass is conserved as the integral of a linear density is.
#[test]
fn resampled_linear_fields_are_exact() {
    let state = ParticleState::of(&coarse());
    let mass: f64 = state.values("mass").expect("masses").iter().sum();
    for dx in [0.01, 0.0137, 0.04] {
        let fine = body(dx)
            .started_from(&state)
            .and_then(|own| own.field_from(&state, HeatConduction::TEMPERATURE))
            .expect("a body");
        let run = Scene::new(scheme()).body(fine).build().expect("water");
        for own in run.all() {
            let x = own.position();
            for d in 0..2 {
                assert_abs_diff_eq!(own.velocity()[d], velocity(x)[d], epsilon = 1e-10);
            }
            assert_abs_diff_eq!(own.density(), 1000.0 + x[0], epsilon = 1e-8);
            let temperature = own
                .scalar(HeatConduction::TEMPERATURE)
                .expect("a temperature");
            assert_abs_diff_eq!(temperature, 300.0 + 10.0 * x[0] + x[1], epsilon = 1e-8);
        }
        assert_relative_eq!(run.ledger().whole.mass, mass, max_relative = 1e-9);
    }
}

/// Errors of a smooth field fall with the square of the spacing of the state.
#[test]
fn smooth_fields_converge() {
    let error = |n: i32| {
        let x = move |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let points: Vec<[f64; 2]> = (0..n * n).map(|k| [x(k % n), x(k / n)]).collect();
        let wave = |x: &[f64; 2]| (3.0 * x[0]).sin() * (2.0 * x[1]).cos();
        let path = file(&format!("wave{n}.vtu"));
        let own = points.clone();
        Vtu::new(points)
            .vector("velocity", own.iter().map(|x| [wave(x), 0.0]))
            .write(&path)
            .expect("a grid");
        let state = ParticleState::read_vtu(&path).expect("a state");
        let _ = std::fs::remove_file(&path);
        let body = Body::block("water", water(), [0.0; 2], [1.0; 2], 0.031)
            .started_from(&state)
            .expect("a body");
        let run = Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(body)
            .build()
            .expect("water");
        run.all()
            .map(|own| (own.velocity()[0] - wave(&own.position())).abs())
            .fold(0.0, f64::max)
    };
    let [coarse, fine] = [error(20), error(40)];
    assert!(coarse < 0.02 && fine < 0.4 * coarse, "{coarse} {fine}");
}

#[cfg(feature = "checkpoint")]
#[test]
fn a_checkpoint_of_another_scene_starts_a_body() {
    let path = file("other.safetensors");
    let scene = || {
        let wall = Body::block("block", water(), [1.0, 0.0], [1.1, 0.1], 0.02);
        Scene::<f64, 2>::new(scheme())
            .body(wall)
            .body(body(0.02).start(start))
            .wall(Wall::around(
                "tank",
                [0.0, -0.1],
                [1.2, 0.4],
                0.02,
                3,
                [[true; 2]; 2],
            ))
    };
    let other = scene().build().expect("a scene");
    other.save(&path).expect("a file");
    let state = ParticleState::read_checkpoint(&path).expect("a state");
    let resumed = scene().resume(&path).expect("a run");
    let _ = std::fs::remove_file(&path);
    for known in [other, resumed] {
        same_state(&state, &ParticleState::of(&known));
    }
    let state = state.only("body", 1.0);
    assert_eq!(state.len(), 200);
    let fine = body(0.01).started_from(&state).expect("a body");
    let run = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(fine)
        .build()
        .expect("water");
    for own in run.all() {
        let exact = velocity(own.position())[0];
        assert_abs_diff_eq!(own.velocity()[0], exact, epsilon = 1e-10);
    }
}

/// What a file and a simulation both know is the same to the bit.
#[cfg(feature = "checkpoint")]
fn same_state<const D: usize>(file: &ParticleState<D>, of: &ParticleState<D>) {
    assert_eq!(file.points(), of.points());
    let of = file
        .names()
        .filter_map(|name| Some((name, of.values(name)?)));
    let mut known = Vec::new();
    for (name, values) in of {
        let own = file.values(name).expect(name);
        assert_eq!(own.len(), values.len(), "{name}");
        // Bodies without a field have no numbers of it.
        let mut pairs = own.iter().zip(values);
        assert!(
            pairs.all(|(a, b)| a == b || a.is_nan() && (b.is_nan() || *b == 0.0)),
            "{name}"
        );
        known.push(name);
    }
    for name in ["body", "mass", "density", "velocity"] {
        assert!(known.contains(&name), "{name} of {known:?}");
    }
}

#[cfg(feature = "checkpoint")]
fn copper<T: Real>() -> Material<T> {
    catalogue::copper().with_shear_modulus(4.8e10)
}

/// Stresses in space, walls, two schemes, and the ends of a pipe through which particles come and go.
#[cfg(feature = "checkpoint")]
#[test]
fn checkpoints_are_read_without_their_scenes() {
    fn read<T: Real, const D: usize>(
        scene: Scene<T, D>,
        steps: u32,
        name: &str,
    ) -> ParticleState<D> {
        let path = file(name);
        let mut run = scene.build().expect("a scene");
        for _ in 0..steps {
            run.step_at_most(1.0).expect("a step");
        }
        run.save(&path).expect("a file");
        let state = ParticleState::read_checkpoint(&path).expect("a state");
        let _ = std::fs::remove_file(&path);
        same_state(&state, &ParticleState::of(&run));
        state
    }
    let dx = 0.02;
    let bar = Body::<f64, 3>::block("bar", copper(), [0.0; 3], [0.1, 0.06, 0.06], dx);
    let bar = bar.start(|[x, y, _], own| Start {
        velocity: [-90.0 * x, 20.0 * y, 5.0],
        ..own
    });
    let state = read(
        Scene::new(schemes::updated_lagrangian()).body(bar),
        12,
        "bar",
    );
    assert_eq!(
        state.values("deviatoric_stress").map(<[f64]>::len),
        Some(6 * 45)
    );
    assert_eq!(state.values("velocity").map(<[f64]>::len), Some(3 * 45));

    let plate = Body::<f32, 2>::block("plate", copper(), [0.1, -0.1], [0.3, -0.04], dx);
    let pool = Body::block(
        "pool",
        catalogue::weakly_compressible_water(2.0),
        [0.0; 2],
        [0.4, 0.2],
        dx,
    );
    let scene = Scene::new(schemes::weakly_compressible())
        .body(pool)
        .acceleration(|_| [0.0, -9.81]);
    let scene = scene.group(
        schemes::total_lagrangian().with(NeoHookean),
        [plate.velocity([0.0, 3.0])],
    );
    let state = read(scene, 12, "pool");
    assert_eq!(state.only("body", 0.0).len(), 200);
    assert_eq!(state.only("body", 1.0).len(), 30);

    let pipe = Body::block("pipe", water(), [0.0], [0.4], dx).velocity([1.0]);
    let inlet = Inlet::new("pipe", vec![[0.0]], [1.0], dx, 40);
    let pipe = Scene::<f64, 1>::new(schemes::weakly_compressible())
        .body(pipe)
        .inlet(inlet);
    let pipe = pipe.outlet(Outlet::plane([0.4], [1.0]));
    let after = Body::block("after", water(), [-2.4], [-2.0], dx);
    let state = read(pipe.body(after), 150, "pipe");
    assert_eq!(state.only("body", 1.0).len(), 20);

    // Written in parts by ranks, and with tensors of a plane.
    let plate = || {
        let body = Body::<f64, 2>::block("plate", copper(), [0.0; 2], [0.2, 0.1], dx);
        let body = body.start(|[x, y], own| Start {
            velocity: [-90.0 * x + y, 20.0 * y],
            ..own
        });
        Scene::new(schemes::updated_lagrangian()).body(body)
    };
    let alone = read(plate(), 12, "plate");
    let path = file("parts");
    let written = path.clone();
    in_threads(3, 1, move |ranks| {
        let mut run = plate().on_ranks(ranks).build().expect("a scene");
        for _ in 0..12 {
            run.step_at_most(1.0).expect("a step");
        }
        run.save(&written).expect("a part");
    })
    .expect("ranks");
    let parts = ParticleState::read_checkpoint(&path).expect("a state");
    let line = ParticleState::<1>::read_checkpoint(&path);
    let error = line.map(drop).expect_err("a plane").to_string();
    assert!(error.contains("dimension"), "{error}");
    same_state(&parts, &alone);
    let part = path.with_extension("a0");
    let read = ParticleState::<2>::read_checkpoint(&part);
    let error = read.map(drop).expect_err("a part alone").to_string();
    assert!(error.contains("no checkpoint by itself"), "{error}");
    for end in ["", "a0", "a1", "a2"] {
        let _ = std::fs::remove_file(path.with_extension(end));
    }

    let path = file("no_checkpoint");
    std::fs::write(&path, b"none").expect("a file");
    let read = ParticleState::<2>::read_checkpoint(&path);
    let _ = std::fs::remove_file(&path);
    let error = read.map(drop).expect_err("none").to_string();
    assert!(error.contains("no_checkpoint"), "{error}");
}

#[test]
fn what_is_no_state_is_refused() {
    let state = ParticleState::of(&coarse());
    let far = Body::block("water", water(), [3.0; 2], [3.1; 2], 0.02).started_from(&state);
    assert!(
        far.map(drop)
            .expect_err("far")
            .to_string()
            .contains("beyond the particles")
    );
    let none = body(0.02).field_from(&state, HeatConduction::CONDUCTED);
    assert!(none.is_ok());
    let none = body(0.02).field_from(&state, Field::PRESSURE_COEFFICIENT);
    assert!(
        none.map(drop)
            .expect_err("no field")
            .to_string()
            .contains("has no field")
    );
    let none = Body::<f64, 2>::of_state("water", water(), &state.only("body", 7.0), 0.02);
    assert!(
        none.map(drop)
            .expect_err("none")
            .to_string()
            .contains("number of particles")
    );
    for (name, text) in [
        ("wrong.vtu", "<VTKFile type=\"PolyData\"/>"),
        (
            "short.vtu",
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\">\n<Piece NumberOfPoints=\"1\">\n<PointData>\n</PointData>\n<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" offset=\"0\"/>\n</Points>\n<AppendedData encoding=\"raw\">\n_\x01",
        ),
    ] {
        let path = file(name);
        std::fs::write(&path, text).expect("a file");
        let error = ParticleState::<2>::read_vtu(&path)
            .map(drop)
            .expect_err(name);
        let _ = std::fs::remove_file(&path);
        assert!(error.to_string().contains(name), "{error}");
    }
    let path = file("table.csv");
    std::fs::write(&path, "x,density\n1,2\n").expect("a file");
    let error = ParticleState::<2>::read_csv(&path)
        .map(drop)
        .expect_err("no y")
        .to_string();
    let _ = std::fs::remove_file(&path);
    assert!(error.contains("`y`"), "{error}");
}
