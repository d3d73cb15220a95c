//! A column of TNT that is lit at one end: speed of its detonation, Chapman–Jouguet pressure, energy.
//! D = 6930 m/s and p_CJ = 21 GPa go with the constants of the products (Dobratz & Crawford 1985, UCRL-52997).

use approx::assert_relative_eq;
use meshfree::boundary::MirrorPlane;
use meshfree::effect::ProgrammedBurn;
use meshfree::material::Material;
use meshfree::material::eos::Jwl;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;
use meshfree::simulation::Simulation;

const SPEED: f64 = 6930.0;
const PRESSURE: f64 = 21e9;
const LENGTH: f64 = 0.2;

fn charge(count: u32) -> Body<f64, 1> {
    let tnt = Material::new("TNT", Jwl::tnt());
    let spacing = LENGTH / f64::from(count);
    Body::block("charge", tnt, [0.0], [LENGTH], spacing).energy(Jwl::tnt().detonation_energy)
}

/// Lit at a wall at its left end.
fn column(count: u32, lit: f64) -> Simulation<f64, 1> {
    let burn = ProgrammedBurn::new("TNT", SPEED).lit_at_plane([0.0], [1.0], lit);
    Scene::new(schemes::gas().with(burn))
        .body(charge(count))
        .boundary(MirrorPlane::wall([0.0], [-1.0]))
        .build()
        .unwrap()
}

/// Where the pressure is half of p_CJ in front of its peak, between particles \[m\], and the largest pressure \[Pa\].
fn front(simulation: &Simulation<f64, 1>) -> (f64, f64) {
    let mut all: Vec<[f64; 2]> = simulation
        .all()
        .map(|own| [own.position()[0], own.pressure()])
        .collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let peak = all.iter().map(|own| own[1]).fold(0.0, f64::max);
    let k = all.iter().rposition(|own| own[1] > 0.5 * PRESSURE).unwrap();
    let [behind, ahead] = [all[k], all[k + 1]];
    let share = (behind[1] - 0.5 * PRESSURE) / (behind[1] - ahead[1]);
    (behind[0] + share * (ahead[0] - behind[0]), peak)
}

#[test]
fn tnt_detonates_at_its_speed_with_the_pressure_of_chapman_and_jouguet() {
    let mut simulation = column(2000, 0.0);
    let energy = simulation.ledger().whole.total_energy();
    simulation.run_until(12e-6).unwrap();
    let (early, _) = front(&simulation);
    simulation.run_until(24e-6).unwrap();
    let (late, peak) = front(&simulation);
    let speed = (late - early) / 12e-6;
    let gain = simulation.ledger().whole.total_energy() / energy - 1.0;
    let ahead = simulation
        .all()
        .map(|own| (own.position()[0], own.velocity()[0].abs()));
    let ahead = ahead.filter(|own| own.0 > SPEED * 24e-6 + 2e-3);
    let (count, fastest) = ahead.fold((0, 0.0_f64), |most, own| (most.0 + 1, most.1.max(own.1)));
    println!(
        "front at {late:.5} m, {speed:.1} m/s, largest pressure {:.2} GPa, energy {gain:+.1e}; ahead {count} particles with {fastest} m/s",
        peak / 1e9
    );
    assert_relative_eq!(speed, SPEED, max_relative = 3e-3);
    assert_relative_eq!(peak, PRESSURE, max_relative = 0.03);
    assert!(gain.abs() < 1e-10, "{gain:e}");
    // Ahead of the front nothing presses; what is left is rounding, against 1500 m/s behind it.
    assert!(count > 200 && fastest < 1e-9, "{count} {fastest}");
}

#[test]
fn what_is_not_lit_does_not_move_and_what_is_lit_at_once_has_another_pressure() {
    let mut cold = column(200, 1.0);
    cold.run_until(5e-6).unwrap();
    assert!(
        cold.all()
            .all(|own| own.velocity()[0] == 0.0 && own.pressure() == 0.0)
    );
    // The same energy without a burn is an explosion at constant volume.
    let hot = Scene::<f64, 1>::new(schemes::gas())
        .body(charge(200))
        .build()
        .unwrap();
    let middle = hot.all().nth(100).unwrap().pressure();
    assert_relative_eq!(middle, 8.38e9, max_relative = 0.01);
}

#[test]
fn the_front_from_a_point_is_round_and_the_first_light_counts() {
    let burn = ProgrammedBurn::new("TNT", SPEED)
        .lit_at_point([0.0; 2], 0.0)
        .lit_at_point([0.02, 0.0], 1e-6);
    let tnt = Material::new("TNT", Jwl::tnt());
    let body = Body::block("charge", tnt, [-0.01; 2], [0.03, 0.01], 1e-3);
    let simulation = Scene::<f64, 2>::new(schemes::gas().with(burn))
        .body(body.energy(Jwl::tnt().detonation_energy))
        .build()
        .unwrap();
    for own in simulation.all() {
        let [x, y] = own.position();
        let exact = (x.hypot(y) / SPEED).min(1e-6 + (x - 0.02).hypot(y) / SPEED);
        let time = own.scalar(ProgrammedBurn::LIGHTING_TIME).unwrap();
        assert_relative_eq!(time, exact, max_relative = 1e-12);
    }
}

/// Far from the origin of coordinates a front is as fast, in `f32` too.
#[test]
fn where_a_charge_stands_changes_no_lighting_time() {
    let times = |far: f64| {
        let burn = ProgrammedBurn::new("TNT", SPEED).lit_at_point([far + 5e-4, 5e-4], 0.0);
        let tnt = Material::new("TNT", Jwl::tnt());
        let body = Body::block("charge", tnt, [far, 0.0], [far + 0.016, 0.016], 1e-3);
        let simulation = Scene::<f32, 2>::new(schemes::gas().with(burn))
            .body(body.energy(Jwl::tnt().detonation_energy))
            .build()
            .unwrap();
        let all = simulation.all();
        all.map(|own| own.scalar(ProgrammedBurn::LIGHTING_TIME).unwrap())
            .collect::<Vec<f64>>()
    };
    for (here, far) in times(0.0).into_iter().zip(times(1024.0)) {
        assert_relative_eq!(here, far, max_relative = 1e-6);
    }
}

#[test]
fn a_booster_and_a_main_charge_burn_each_at_its_speed() {
    let half = |name: &str, at: f64| {
        let material = Material::new(name, Jwl::tnt());
        let body = Body::block(name, material, [at], [at + 0.05], 5e-4);
        body.energy(Jwl::tnt().detonation_energy)
    };
    let booster = ProgrammedBurn::new("booster", SPEED).lit_at_plane([0.0], [1.0], 0.0);
    let main = ProgrammedBurn::new("main", 0.5 * SPEED).lit_at_plane([0.1], [1.0], 1e-6);
    let simulation = Scene::<f64, 1>::new(schemes::gas().with(booster.and(main)))
        .body(half("booster", 0.0))
        .body(half("main", 0.05))
        .build()
        .unwrap();
    for own in simulation.all() {
        let x = own.position()[0];
        let exact = if x < 0.05 {
            x / SPEED
        } else {
            1e-6 + (0.1 - x) / (0.5 * SPEED)
        };
        let time = own.scalar(ProgrammedBurn::LIGHTING_TIME).unwrap();
        assert_relative_eq!(time, exact, max_relative = 1e-12);
    }
}

#[test]
fn what_cannot_burn_is_named() {
    let refusal = |burn: ProgrammedBurn| {
        let scene = Scene::<f64, 1>::new(schemes::gas().with(burn)).body(charge(20));
        scene.build().unwrap_err().to_string()
    };
    let burn = |name, speed| ProgrammedBurn::new(name, speed).lit_at_point([0.0], 0.0);
    for (burn, part) in [
        (ProgrammedBurn::new("TNT", SPEED), "places that are lit"),
        (burn("RDX", SPEED), "RDX"),
        (burn("TNT", SPEED).and(burn("TNT", SPEED)), "`TNT` twice"),
        (burn("TNT", -1.0), "speed of the detonation"),
        (
            burn("TNT", SPEED).width(f64::NAN),
            "width of the detonation front",
        ),
        (
            burn("TNT", SPEED).lit_at_plane([0.0], [0.0], 0.0),
            "normal of the plane",
        ),
        (
            burn("TNT", SPEED).lit_at_point([0.0; 2], 0.0),
            "number of coordinates",
        ),
        (
            burn("TNT", SPEED).lit_at_point([f64::NAN], 0.0),
            "must be finite",
        ),
    ] {
        let message = refusal(burn);
        assert!(message.contains(part), "{part}: {message}");
    }
}

/// Lighting times and burn fractions are of the state: a run that is resumed has the bits of one that was not stopped.
#[cfg(feature = "checkpoint")]
#[test]
fn a_burn_resumes() {
    let scene = || {
        let burn = ProgrammedBurn::new("TNT", SPEED).lit_at_plane([0.0], [1.0], 0.0);
        Scene::<f64, 1>::new(schemes::gas().with(burn)).body(charge(200))
    };
    let path = std::env::temp_dir().join(format!("detonation_{}", std::process::id()));
    let mut whole = scene().build().unwrap();
    whole.run_until(6e-6).unwrap();
    whole.save(&path).unwrap();
    let mut resumed = scene().resume(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    for now in [&mut whole, &mut resumed] {
        now.run_until(12e-6).unwrap();
    }
    let [one, other] = [&whole, &resumed].map(|now| {
        let bits = now.all().map(|own| {
            let time = own.scalar(ProgrammedBurn::LIGHTING_TIME).unwrap();
            [own.position()[0], own.velocity()[0], own.energy(), time].map(f64::to_bits)
        });
        bits.collect::<Vec<_>>()
    });
    assert_eq!(one, other);
    let burnt = whole
        .all()
        .filter(|own| own.scalar(ProgrammedBurn::BURN_FRACTION) == Some(1.0));
    assert!((60..90).contains(&burnt.count()));
}
