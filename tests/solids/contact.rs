//! Contact between bodies by couplings: impact, weight, friction, ties and self-contact, against closed forms.
//! What is kept: momentum, the ledger with the work of couplings, and every bit through a checkpoint.

use meshfree::coupling::{ContactDensity, CoupledParticle, Coupling, Penalty, Tied};
use meshfree::effect::Hypoelastic;
use meshfree::error::Error;
use meshfree::material::Material;
use meshfree::material::eos::Linear;
use meshfree::scene::{Body, Scene};
use meshfree::scheme::Scheme;
use meshfree::schemes;
use meshfree::simulation::{Load, Simulation};
use meshfree::term::viscosity::LimitedMonaghanGingold;

/// How two bodies touch.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// By their kernels.
    Kernels,
    Density,
    Penalty,
}

const FORMS: [Form; 3] = [Form::Kernels, Form::Density, Form::Penalty];

fn touching<const D: usize>(
    scene: Scene<f64, D>,
    form: Form,
    mu: Option<f64>,
    [a, b]: [&str; 2],
) -> Scene<f64, D> {
    match (form, mu) {
        (Form::Kernels, _) => scene,
        (Form::Density, None) => scene.couple(a, b, ContactDensity::new()),
        (Form::Density, Some(mu)) => scene.couple(a, b, ContactDensity::new().friction(mu)),
        (Form::Penalty, None) => scene.couple(a, b, Penalty::new()),
        (Form::Penalty, Some(mu)) => scene.couple(a, b, Penalty::new().friction(mu)),
    }
}

/// Density \[kg/m³\] and sound speed \[m/s\] of a material without a shock of its own.
fn linear(density: f64, sound_speed: f64) -> Material<f64> {
    Material::new("linear", Linear::new(density, sound_speed))
}

fn solid() -> Scheme<f64, 2> {
    schemes::impact_by_continuity().with(Hypoelastic).into()
}

/// Two equal rods of length 1 and sound speed 1, of which the left strikes the right at `v`.
fn rods(form: Form, count: usize, v: f64) -> Scene<f64, 1> {
    let dx = 1.0 / count as f64;
    let scene = Scene::new(schemes::impact())
        .body(Body::block("left", linear(1.0, 1.0), [0.0], [1.0], dx).velocity([v]))
        .body(Body::block("right", linear(1.0, 1.0), [1.0], [2.0], dx));
    touching(scene, form, None, ["left", "right"])
}

/// All places and velocities.
#[cfg(feature = "checkpoint")]
fn state<const D: usize>(now: &Simulation<f64, D>) -> Vec<u64> {
    let numbers = now.all().flat_map(|p| [p.position(), p.velocity()]);
    numbers.flatten().map(f64::to_bits).collect()
}

/// Kinetic and internal energy less the work of couplings.
fn kept<const D: usize>(now: &Simulation<f64, D>) -> f64 {
    let whole = now.ledger().whole;
    whole.total_energy() - whole.total("work of couplings").unwrap_or(0.0)
}

#[test]
fn rods_strike_as_acoustics_has_it() {
    let v = 2e-4;
    // The pressure is ρ c v/2 until the waves are back at 2 L/c; then the left rod rests, and the right one flies at v.
    let exact = 0.5 * v;
    for form in FORMS {
        let mut simulation = rods(form, 100, v).build().unwrap();
        let before = kept(&simulation);
        let (mut felt, mut worst) = (Vec::new(), 0.0_f64);
        simulation
            .run_with(3.5, |now| {
                let force = now.force_between("right", "left").unwrap()[0];
                felt.push((now.time(), force));
                if now.time() > 0.4 && now.time() < 1.6 {
                    worst = worst.max((force / exact - 1.0).abs());
                }
            })
            .unwrap();
        let ledger = simulation.ledger();
        let half: Vec<f64> = felt
            .iter()
            .filter(|own| own.1 > 0.5 * exact)
            .map(|own| own.0)
            .collect();
        let duration = (half[half.len() - 1] - half[0]) / 2.0;
        let last = felt[felt.len() - 1].1;
        let speeds = [0, 1].map(|k| ledger.bodies[k].1.momentum[0]);
        let restitution = (speeds[1] - speeds[0]) / v;
        let momentum = ledger.whole.momentum[0] / v - 1.0;
        let closes = kept(&simulation) / before - 1.0;
        let stored = ledger.whole.total("energy of couplings").unwrap_or(0.0);
        let drift = (ledger.whole.total_energy() + stored) / before - 1.0;
        let depth = simulation
            .contacts()
            .first()
            .map(|own| own.largest_penetration);
        println!(
            "{form:?}: pressure within {worst:.4}, duration {duration:.4}, restitution {restitution:.4}, momentum \
             {momentum:.1e}, closes {closes:.1e}, energy {drift:.1e}, penetration {depth:?}"
        );
        assert!(worst < 0.01, "{form:?}: {worst}");
        assert!((duration - 0.98).abs() < 0.015, "{form:?}: {duration}");
        assert!(
            restitution > 0.96 && restitution < 1.0,
            "{form:?}: {restitution}"
        );
        assert!(last == 0.0, "{form:?}: they part, {last}");
        assert!(momentum.abs() < 1e-12 && closes.abs() < 1e-12, "{form:?}");
        assert!(drift.abs() < 1e-4, "{form:?}: {drift}");
        // As deep as the strain of the rods, and once that where they meet.
        assert!(
            depth.is_none_or(|depth| depth < v && depth > 0.4 * v),
            "{depth:?}"
        );
    }
}

/// Two blocks of 20 by 40 spacings of sound speed 1 for pressure waves, one out of step with the other by a share of the
/// spacing, strike at `v`: stress in the middle over ρ c v/2 when waves have run 14 spacings.
fn blocks(form: Form, shift: f64) -> f64 {
    let (dx, v) = (0.05, 5e-3);
    // K + 4/3 G = 1.
    let steel = || linear(1.0, 0.75_f64.sqrt()).with_shear_modulus(0.1875);
    let scene = Scene::new(solid())
        .body(Body::block("left", steel(), [-1.0, -1.0], [0.0, 1.0], dx).velocity([v, 0.0]))
        .body(Body::block(
            "right",
            steel(),
            [0.0, -1.0 + shift * dx],
            [1.0, 1.0 + shift * dx],
            dx,
        ));
    let mut simulation = touching(scene, form, None, ["left", "right"])
        .build()
        .unwrap();
    simulation.run_until(14.0 * dx).unwrap();
    let (mut sum, mut count) = (0.0, 0.0);
    for particle in simulation.body("right").unwrap() {
        let [x, y] = particle.position();
        if y.abs() < 3.0 * dx && x > 4.0 * dx && x < 6.0 * dx {
            let stress = particle
                .tensor(Hypoelastic::STRESS)
                .map_or(0.0, |stress| stress.at(0, 0));
            sum += particle.pressure() - stress;
            count += 1.0;
        }
    }
    sum / count / (0.5 * v)
}

#[test]
fn blocks_out_of_step_strike_as_blocks_in_step() {
    for form in FORMS {
        let found = [0.0, 0.5].map(|shift| blocks(form, shift));
        println!("{form:?}: {found:?}");
        let [in_step, out_of_step] = found;
        assert!((in_step - 1.0).abs() < 0.03, "{form:?}: {in_step}");
        if form == Form::Penalty {
            // Its lattices have a gap of 0.13 spacings to close first.
            assert!(out_of_step == 0.0);
        } else {
            assert!(
                (out_of_step / in_step - 1.0).abs() < 0.02,
                "{form:?}: {found:?}"
            );
        }
    }
}

/// A block on a slope of tangent 0.4 whose gravity comes on within a tenth of a second, across the slope first: mean
/// velocity along the slope and its gain in the last tenth \[m/s\], way \[m\], and mean force on it over its weight then.
struct Slope {
    speed: f64,
    gain: f64,
    way: f64,
    force: [f64; 2],
}

const TANGENT: f64 = 0.4;
/// Gravity along the slope and into it \[m/s²\].
fn gravity() -> [f64; 2] {
    let angle = TANGENT.atan();
    [9.81 * angle.sin(), 9.81 * angle.cos()]
}

fn slope(form: Form, mu: f64) -> Scene<f64, 2> {
    let dx = 0.01;
    let [along, into] = gravity();
    let rise = |x: f64| {
        let x = x.clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    };
    let heavy = linear(1e6, 0.7).with_shear_modulus(1e5);
    let block = linear(1000.0, 20.0).with_shear_modulus(1e5);
    let scene = Scene::new(solid())
        .body(Body::block("block", block, [0.003, 0.0], [0.083, 0.04], dx))
        .body(Body::block("ground", heavy, [-0.04, -0.03], [0.2, 0.0], dx))
        .load(
            Load::acceleration(move |at| {
                let (x, y) = (rise(at.time / 0.1 - 0.5), rise(at.time / 0.1));
                [x * along, -y * into]
            })
            .on("block"),
        )
        // So heavy and so damped that it stays where it is.
        .load(Load::acceleration(|at| at.velocity.map(|v| -500.0 * v)).on("ground"));
    touching(scene, form, Some(mu), ["block", "ground"])
}

/// Mean of a quantity over the block.
fn mean(now: &Simulation<f64, 2>, of: impl Fn([f64; 2], [f64; 2]) -> f64) -> f64 {
    let block = now.body("block").unwrap();
    let values: Vec<f64> = block.map(|p| of(p.position(), p.velocity())).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

fn slide(form: Form, mu: f64) -> Slope {
    let mut simulation = slope(form, mu).build().unwrap();
    let x = mean(&simulation, |x, _| x[0]);
    simulation.run_until(0.25).unwrap();
    let before = mean(&simulation, |_, v| v[0]);
    let weight = 9.81 * simulation.ledger().bodies[0].1.mass;
    let given = |now: &Simulation<f64, 2>| -> [f64; 2] {
        core::array::from_fn(|d| now.contacts()[0].force[d])
    };
    let (mut impulse, mut last) = ([0.0; 2], simulation.time());
    simulation
        .run_with(0.35, |now| {
            let dt = now.time() - last;
            last = now.time();
            for d in 0..2 {
                impulse[d] += dt * given(now)[d];
            }
        })
        .unwrap();
    let speed = mean(&simulation, |_, v| v[0]);
    let contact = &simulation.contacts()[0];
    println!("{form:?} {mu}: {contact:?}");
    Slope {
        speed,
        gain: speed - before,
        way: mean(&simulation, |x, _| x[0]) - x,
        force: impulse.map(|own| own / 0.1 / weight),
    }
}

#[test]
fn blocks_on_a_slope_stick_and_slide_as_coulomb_has_it() {
    let [along, into] = gravity();
    let (sine, cosine) = (along / 9.81, into / 9.81);
    // Above the tangent it sticks, and the contact bears its weight.
    let rests = slide(Form::Density, 0.45);
    println!("{:?}", (rests.speed, rests.way, rests.force));
    assert!(rests.way.abs() < 2e-4 && rests.speed.abs() < 1e-3);
    assert!((rests.force[0] + sine).abs() < 0.005 && (rests.force[1] - cosine).abs() < 0.005);
    // Below it slides with g (sin − μ cos).
    for mu in [0.0, 0.2] {
        let slides = slide(Form::Density, mu);
        let exact = 0.1 * (along - mu * into);
        println!(
            "{mu}: {:?}",
            (slides.speed, slides.gain / exact, slides.force)
        );
        assert!((slides.gain / exact - 1.0).abs() < 0.03);
        assert!((slides.force[0] + mu * cosine).abs() < 0.01);
    }
    // Springs between particles lock in each other instead, whatever μ is.
    let locked = slide(Form::Penalty, 0.0);
    println!("{:?}", (locked.speed, locked.way, locked.force));
    assert!(locked.way < 5e-3 && locked.speed < 1e-3);
}

#[test]
fn tied_rods_bear_tension_as_one() {
    let v = 1e-4;
    let dx = 0.01;
    let rod = |name: &str, from: f64, v: f64| {
        Body::block(name, linear(1.0, 1.0), [from], [from + 1.0], dx).velocity([v])
    };
    let mut simulation = Scene::<f64, 1>::new(schemes::impact())
        .body(rod("left", 0.0, -v))
        .group(schemes::impact(), [rod("right", 1.0, v)])
        .couple("left", "right", Tied::new())
        .build()
        .unwrap();
    let before = kept(&simulation);
    simulation.run_until(0.5).unwrap();
    // The joint stands, and −ρ c v has gone half of the way on both sides. The density of the last particles of a body,
    // which their own side alone makes, says less of their strain: three of them are left out.
    let mut worst = 0.0_f64;
    for (name, at) in [("left", 1.0), ("right", 1.0)] {
        for particle in simulation.body(name).unwrap() {
            let far = (particle.position()[0] - at).abs();
            if far > 0.04 && far < 0.3 {
                let pressure = particle.pressure() / v;
                worst = worst.max((pressure + 1.0).abs());
                assert!(particle.velocity()[0].abs() < 0.02 * v);
            }
        }
    }
    let force = simulation.force_between("left", "right").unwrap()[0];
    println!("tied: {worst} {force:e}");
    assert!(worst < 0.03, "{worst}");
    assert!((force / v - 1.0).abs() < 0.01, "{force:e}");
    // It stays tied while the waves run to and fro.
    simulation.run_until(6.0).unwrap();
    let whole = simulation.ledger().whole;
    let stored = whole.total("energy of couplings").unwrap_or(0.0);
    assert!((kept(&simulation) / before - 1.0).abs() < 1e-12);
    assert!(((whole.total_energy() + stored) / before - 1.0).abs() < 1e-4);
    assert!(whole.momentum[0].abs() < 1e-12 * v);
    let ends = ["left", "right"].map(|name| {
        let x = simulation.body(name).unwrap().map(|p| p.position()[0]);
        let x: Vec<f64> = x.collect();
        [x[0], x[x.len() - 1]]
    });
    assert!((ends[1][0] - ends[0][1] - dx).abs() < 1e-3 * dx);
}

/// A rope of particles in the form of a U on its side, whose upper arm comes down on the lower one: how far the arms
/// are apart at last and at least \[spacings\], over particles of one arm.
fn rope(itself: bool) -> [f64; 2] {
    let (s, count, stiffness) = (0.01, 40, 5e4);
    let radius = 4.0 * s;
    let turn = 12;
    let mut points = Vec::new();
    for k in 0..count {
        points.push([-s * f64::from(count - k), radius]);
    }
    for k in 0..=turn {
        let angle = std::f64::consts::PI * (0.5 - f64::from(k) / f64::from(turn));
        points.push([radius * angle.cos(), radius * angle.sin()]);
    }
    for k in 1..=count {
        points.push([-s * (f64::from(k) + 0.3), -radius]);
    }
    let falls = |[_, y]: [f64; 2], start| meshfree::scheme::Start {
        velocity: [0.0, if y > 0.9 * radius { -1.0 } else { 0.0 }],
        ..start
    };
    // Of no stiffness and viscosity of its own: what holds it is springs.
    let viscosity = LimitedMonaghanGingold {
        alpha: 0.0,
        beta: 0.0,
    };
    let scheme = schemes::impact_by_continuity().with_viscosity(viscosity);
    let soft = linear(1000.0, 0.02).with_shear_modulus(0.1);
    let scene = Scene::<f64, 2>::new(scheme.with(Hypoelastic))
        .body(Body::points_of("rope", soft, points, s).start(falls))
        .couple_self("rope", 0.0, Tied::new().stiffness(stiffness));
    let scene = if itself {
        scene.couple_self("rope", 3.0 * s, Penalty::new().stiffness(stiffness))
    } else {
        scene
    };
    let mut simulation = scene.build().unwrap();
    let before = kept(&simulation);
    let gap = |now: &Simulation<f64, 2>| {
        let x: Vec<[f64; 2]> = now.body("rope").unwrap().map(|p| p.position()).collect();
        let arms = [
            &x[..count as usize - 10],
            &x[x.len() - count as usize + 10..],
        ];
        let nearest = |own: &[f64; 2]| {
            let under = arms[1]
                .iter()
                .min_by(|a, b| (a[0] - own[0]).abs().total_cmp(&(b[0] - own[0]).abs()));
            (own[1] - under.unwrap()[1]) / s
        };
        arms[0].iter().map(nearest).fold(f64::INFINITY, f64::min)
    };
    let mut least = f64::INFINITY;
    simulation
        .run_with(0.2, |now| least = least.min(gap(now)))
        .unwrap();
    let whole = simulation.ledger().whole;
    let stored = whole.total("energy of couplings").unwrap_or(0.0);
    let drift = (whole.total_energy() + stored) / before - 1.0;
    println!(
        "{itself}: {:?}, energy {drift:e}, {:?}",
        [gap(&simulation), least],
        simulation.contacts()
    );
    assert!((kept(&simulation) / before - 1.0).abs() < 1e-12);
    assert!(drift.abs() < 0.02, "{drift}");
    let momentum = whole.momentum[1] / (before * 2.0) + 1.0;
    assert!(momentum.abs() < 1e-12, "{momentum:e}");
    [gap(&simulation), least]
}

#[test]
fn a_rope_that_folds_meets_itself() {
    let [_, through] = rope(false);
    assert!(through < -2.0, "without contact it goes through: {through}");
    let [_, least] = rope(true);
    assert!(least > 0.4, "{least}");
}

#[test]
fn contacts_that_cannot_be_are_refused() {
    let rod = |name: &str, from: f64| {
        Body::<f64, 1>::block(name, linear(1.0, 1.0), [from], [from + 1.0], 0.1)
    };
    let scene = |from: f64| {
        Scene::<f64, 1>::new(schemes::impact())
            .body(rod("left", 0.0))
            .group(schemes::impact(), [rod("right", from)])
    };
    for (scene, part) in [
        (
            scene(0.93).couple("left", "right", Penalty::new()),
            "bodies `left` and `right` overlap",
        ),
        (
            scene(1.0).couple("left", "right", Penalty::new().damping(-1.0)),
            "damping of the coupling penalty is -1",
        ),
        (
            scene(1.0).couple("left", "right", ContactDensity::new().friction(f64::NAN)),
            "coefficient of friction",
        ),
        (
            scene(1.0).couple("left", "right", Tied::new().stiffness(0.0)),
            "stiffness of the coupling tied is 0",
        ),
        (
            scene(1.0).couple("left", "left", Penalty::new()),
            "names one body twice",
        ),
        (
            scene(1.0).couple_self("left", 0.2, ContactDensity::new()),
            "presses on itself from the start",
        ),
        (
            scene(1.0).couple_self("middle", 0.3, ContactDensity::new()),
            "there is no body called `middle`",
        ),
    ] {
        let all: Vec<String> = scene.problems().iter().map(ToString::to_string).collect();
        assert!(
            all.iter().any(|text| text.contains(part)),
            "{part}: {all:?}"
        );
    }
    let simulation = scene(1.0)
        .couple("left", "right", Penalty::new())
        .build()
        .unwrap();
    assert_eq!(simulation.largest_penetration("penalty").unwrap(), 0.0);
    let unknown = simulation.largest_penetration("tied").unwrap_err();
    assert!(matches!(unknown, Error::Argument(_)) && unknown.to_string().contains("penalty"));
}

#[cfg(feature = "checkpoint")]
#[test]
fn friction_goes_on_from_a_checkpoint_to_the_same_bits() {
    let file = std::env::temp_dir().join(format!("meshfree-contact-{}", std::process::id()));
    let mut through = slope(Form::Density, 0.2).build().unwrap();
    through.run_until(0.12).unwrap();
    // What is evaluated between steps changes nothing.
    through.evaluate().unwrap();
    through.save(&file).unwrap();
    let mut resumed = slope(Form::Density, 0.2).resume(&file).unwrap();
    let _ = std::fs::remove_file(&file);
    for simulation in [&mut through, &mut resumed] {
        simulation.run_until(0.16).unwrap();
    }
    assert!(through.contacts()[0].heat > 0.0);
    assert_eq!(state(&through), state(&resumed));
    assert_eq!(through.contacts(), resumed.contacts());
    let mut plain = slope(Form::Density, 0.2).build().unwrap();
    plain.run_until(0.12).unwrap();
    plain.run_until(0.16).unwrap();
    assert_eq!(state(&plain), state(&through));
}

/// Particles of two bodies at random places and of unlike spacings: the force on each is what the energy loses as it
/// moves.
fn derives_from_energy<const D: usize>(coupling: &impl Coupling<f64, D>) {
    let mut random = crate::common::Random(7);
    let spacings = [1.0, 0.8];
    let particle = |k: usize, x: [f64; D]| CoupledParticle {
        position: x,
        velocity: [0.0; D],
        mass: 1.0,
        density: 1.0,
        spacing: spacings[k % 2],
        stiffness: 3.0,
        sum: 0.0,
        gradient: [0.0; D],
        pressure: 0.0,
    };
    let mut all: Vec<_> = (0..12).map(|k| particle(k, random.vector(0.7))).collect();
    let reach = coupling.reach(spacings);
    let evaluate = |all: &mut Vec<CoupledParticle<f64, D>>| {
        let near = |a: &CoupledParticle<f64, D>, b: &CoupledParticle<f64, D>| {
            (0..D)
                .map(|d| (a.position[d] - b.position[d]).powi(2))
                .sum::<f64>()
                < reach * reach
        };
        let before = all.clone();
        let mut energy = 0.0;
        for (k, own) in all.iter_mut().enumerate() {
            own.sum = 0.0;
            let others = before
                .iter()
                .enumerate()
                .filter(|(j, other)| j % 2 != k % 2 && near(own, other));
            let sum = others
                .map(|(_, other)| coupling.gather(&before[k], other).0)
                .sum();
            own.sum = sum;
            let (pressure, stored) = coupling.pressure(own, 0.9);
            own.pressure = pressure;
            energy += stored;
        }
        let mut forces = vec![[0.0; D]; all.len()];
        for a in (0..all.len()).step_by(2) {
            for b in (1..all.len())
                .step_by(2)
                .filter(|&b| near(&all[a], &all[b]))
            {
                let own = coupling.act(&meshfree::coupling::CoupledPair {
                    on: all[a],
                    from: all[b],
                    rest: 0.0,
                    anchor: None,
                });
                energy += own.stored;
                for d in 0..D {
                    forces[a][d] += own.force[d];
                    forces[b][d] -= own.force[d];
                }
            }
        }
        (energy, forces)
    };
    let (_, forces) = evaluate(&mut all);
    let largest = forces
        .iter()
        .flatten()
        .fold(0.0_f64, |most, f| most.max(f.abs()));
    assert!(largest > 0.0);
    for k in 0..all.len() {
        for d in 0..D {
            let x = all[k].position[d];
            let [more, less] = [1e-5, -1e-5].map(|by| {
                all[k].position[d] = x + by;
                evaluate(&mut all).0
            });
            all[k].position[d] = x;
            let force = -(more - less) / 2e-5;
            assert!(
                (force - forces[k][d]).abs() < 1e-6 * largest,
                "{force} {}",
                forces[k][d]
            );
        }
    }
}

#[test]
fn forces_derive_from_the_energy_that_is_stored() {
    derives_from_energy::<1>(&ContactDensity::new());
    derives_from_energy::<2>(&ContactDensity::new());
    derives_from_energy::<3>(&ContactDensity::new());
    derives_from_energy::<2>(&Penalty::new());
    derives_from_energy::<3>(&Penalty::new());
}
