//! Inlets and outlets that a motion carries: mass closes, and a flow that is carried as a whole is the flow at rest.
//! The pipe goes with its ends at a steady velocity, in which no force is different (Galilei).

use approx::assert_abs_diff_eq;
use meshfree::boundary::{GivenPressure, Inlet, Outlet, Rotation, Translation, VelocityProfile};
use meshfree::prelude::*;

const DX: f64 = 0.01;

fn water() -> Material<f64> {
    catalogue::weakly_compressible_water(1.0)
}

/// A pipe in one dimension with inflow at 1 m/s and an outlet at a pressure, carried at a velocity.
fn pipe(carried: f64, profile: bool) -> Scene<f64, 1> {
    let inlet = if profile {
        let speed = |_: [f64; 1], t: f64| [1.0 + 0.2 * (20.0 * t).sin()];
        Inlet::through(
            "water",
            vec![[0.0]],
            [1.0],
            DX,
            200,
            VelocityProfile::new(speed),
        )
    } else {
        Inlet::new("water", vec![[0.0]], [1.0], DX, 200)
    };
    let outlet = Outlet::plane([0.5], [1.0]).buffer(0.05, GivenPressure::of(100.0));
    let motion = || Translation::steady([carried]);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water(), [0.0], [0.5], DX).velocity([1.0 + carried]))
        .inlet(inlet.motion(motion()))
        .outlet(outlet.motion(motion()))
}

#[test]
fn a_pipe_that_is_carried_is_the_pipe_at_rest() {
    for profile in [false, true] {
        let [rest, carried] = [0.0, 3.0].map(|velocity| {
            let mut run = pipe(velocity, profile).build().expect("a pipe");
            let before = run.ledger().whole.mass;
            run.run_until(0.2).expect("a run");
            let (entered, removed) = (run.entered(), run.removed());
            // Mass closes.
            let after = run.ledger().whole.mass;
            assert_abs_diff_eq!(after, before + entered.mass - removed.mass, epsilon = 1e-9);
            assert!(entered.particles >= 19 && removed.particles >= 17);
            let mut state: Vec<[f64; 2]> = run
                .all()
                .map(|own| {
                    [
                        own.position()[0] - velocity * 0.2,
                        own.velocity()[0] - velocity,
                    ]
                })
                .collect();
            state.sort_by(|a, b| a[0].total_cmp(&b[0]));
            (state, entered.particles)
        });
        assert_eq!(rest.1, carried.1);
        // Outlets take particles where lists are made, which is at other times when all moves.
        for (a, b) in rest.0.iter().zip(&carried.0) {
            assert_abs_diff_eq!(a[0], b[0], epsilon = 1e-3);
            assert_abs_diff_eq!(a[1], b[1], epsilon = 1e-2);
        }
        // A control: an outlet that stays takes other particles.
        let mut stays = Scene::new(schemes::weakly_compressible())
            .body(Body::block("water", water(), [0.0], [0.5], DX).velocity([4.0]))
            .inlet(
                Inlet::new("water", vec![[0.0]], [1.0], DX, 200).motion(Translation::steady([3.0])),
            )
            .outlet(Outlet::plane([0.5], [1.0]))
            .build()
            .expect("a pipe");
        stays.run_until(0.1).expect("a run");
        assert!(stays.removed().particles > 30);
    }
}

/// A nozzle that turns about the origin sprays: particles start with the velocity of the jet and that of the nozzle.
#[test]
fn a_nozzle_that_turns_sprays() {
    let omega: f64 = 5.0;
    let points = (0..4)
        .map(|k| [0.2 + DX * (f64::from(k) + 0.5), 0.0])
        .collect();
    let mut run = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water(), [5.0; 2], [5.1; 2], DX))
        .inlet(
            Inlet::new("water", points, [0.0, 1.0], DX, 100)
                .motion(Rotation::about([0.0; 2], move |t| [omega * t, omega, 0.0])),
        )
        .build()
        .expect("a nozzle");
    run.run_until(0.0112).expect("a run");
    let entered = run.entered();
    assert_eq!(entered.particles, 4);
    // Within a step of t = 0.0105 s: the jet is along (−sin, cos), and the nozzle goes by ω × x.
    let time = 0.0105;
    let (sin, cos) = (omega * time).sin_cos();
    let [along, out] = [time - 0.5 * DX, 0.22];
    let x = [out * cos - along * sin, out * sin + along * cos];
    let expected = [-sin - omega * x[1], cos + omega * x[0]];
    for d in 0..2 {
        assert_abs_diff_eq!(
            entered.momentum[d] / entered.mass,
            expected[d],
            epsilon = 0.02
        );
    }
}

#[cfg(feature = "checkpoint")]
#[test]
fn carried_openings_resume_to_the_same_bits() {
    for profile in [false, true] {
        let file = std::env::temp_dir().join(format!("meshfree-{}-pipe", std::process::id()));
        let mut whole = pipe(2.0, profile).build().expect("a pipe");
        whole.run_until(0.05).expect("a run");
        whole.save(&file).expect("a file");
        whole.run_until(0.1).expect("a run");
        let mut resumed = pipe(2.0, profile).resume(&file).expect("a file");
        resumed.run_until(0.1).expect("a run");
        let _ = std::fs::remove_file(&file);
        let places = |run: &Simulation<f64, 1>| -> Vec<[f64; 1]> {
            run.all().map(|own| own.position()).collect()
        };
        assert_eq!(places(&whole), places(&resumed));
        assert_eq!(whole.entered(), resumed.entered());
    }
}

#[test]
fn a_motion_carries_planes_alone() {
    let outlet = Outlet::faster_than(10.0).motion(Translation::steady([1.0]));
    let body = Body::block("water", water(), [0.0], [0.5], DX);
    let scene = Scene::<f64, 1>::new(schemes::weakly_compressible())
        .body(body)
        .outlet(outlet);
    let error = scene.build().map(drop).expect_err("no plane").to_string();
    assert!(error.contains("Outlet::plane"), "{error}");
}
