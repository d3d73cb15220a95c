//! A tank thrown sideways at 30 g in a plane, against the impulsive solution and the laws of balance.
//! The same in space, finer and with all figures, is `cargo validate sloshing_tank -- --bars`.

use meshfree::boundary::Motion;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::PressureProbe;
use meshfree::prelude::*;
use meshfree::study::impulsive_tank::{FarWall, ImpulsiveTank};
use meshfree::term::viscosity::MonaghanGingold;

const LENGTH: f64 = 0.5;
const HEIGHT: f64 = 0.3;
const DEPTH: f64 = 0.18;
const GRAVITY: f64 = 9.81;
/// 30 g \[m/s²\].
const PEAK: f64 = 30.0 * 9.80665;
const WATER: f64 = 1000.0;
const POINT: [f64; 2] = [LENGTH, 0.05];

/// Half sine of 80 ms, in lines.
fn half_sine(t: f64) -> f64 {
    if t < 0.08 {
        PEAK * (core::f64::consts::PI * t / 0.08).sin()
    } else {
        0.0
    }
}

struct Case {
    spacing: f64,
    /// Sound speed of the water \[m/s\].
    sound: SoundSpeed,
    cut_off: f64,
    constant: bool,
    in_frame: bool,
    step: Option<f64>,
}

impl Default for Case {
    fn default() -> Self {
        Self {
            spacing: 0.02,
            sound: SoundSpeed::artificial((2.0 * PEAK * LENGTH).sqrt()),
            cut_off: 0.0,
            constant: false,
            in_frame: false,
            step: None,
        }
    }
}

impl Case {
    fn motion(&self) -> Translation<2> {
        let record: Vec<_> = if self.constant {
            vec![(0.0, [-PEAK, 0.0]), (1.0, [-PEAK, 0.0])]
        } else {
            let times = (0..=800).map(|k| 1e-4 * f64::from(k));
            times.map(|t| (t, [-half_sine(t), 0.0])).collect()
        };
        Translation::from_acceleration(&record).unwrap()
    }

    fn build(&self) -> Simulation<f64, 2> {
        let water = Liquid::water()
            .material("water", self.sound)
            .with_pressure_cut_off(self.cut_off);
        let gravity = [0.0, -GRAVITY];
        let body = Body::block("water", water, [0.0; 2], [LENGTH, DEPTH], self.spacing)
            .hydrostatic(gravity, [0.0, DEPTH]);
        let tank = Wall::around(
            "tank",
            [0.0; 2],
            [LENGTH, HEIGHT],
            self.spacing,
            3,
            [[true; 2]; 2],
        )
        .container_frame();
        let scheme = schemes::weakly_compressible()
            .with_viscosity(MonaghanGingold {
                alpha: 0.002,
                beta: 0.0,
            })
            .walls(ExtrapolatedPressure {
                floor: self.cut_off,
            });
        let (step, motion) = (self.step, self.motion());
        let scene = Scene::new(scheme).body(body).steps(|steps| StepControl {
            fixed: step,
            ..steps
        });
        let scene = if self.in_frame {
            scene.wall(tank).acceleration(move |t| {
                let a = motion.pose(t).shift[2];
                [-a[0], -a[1] - GRAVITY]
            })
        } else {
            let scene = scene.wall(tank.motion(motion));
            scene.acceleration(move |_| gravity)
        };
        scene.build().unwrap()
    }
}

fn sensor(simulation: &Simulation<f64, 2>, place: [f64; 2]) -> PressureProbe<2> {
    let sensor = PressureProbe::disc(simulation, "sensor", place, [-1.0, 0.0], 0.02);
    sensor.unwrap().on_wall(0).unwrap()
}

/// Times and pressures at places on the struck wall, sampled in every step.
fn history(
    simulation: &mut Simulation<f64, 2>,
    places: &[[f64; 2]],
    until: f64,
) -> Vec<(f64, Vec<f64>)> {
    let sensors: Vec<_> = places
        .iter()
        .map(|place| sensor(simulation, *place))
        .collect();
    // One search for all reads what each reads alone.
    let alone: Vec<_> = sensors.iter().map(|own| own.pressure(simulation)).collect();
    assert_eq!(PressureProbe::pressures(&sensors, simulation), alone);
    let mut samples = Vec::new();
    simulation
        .run_with(until, |now| {
            samples.push((now.time(), PressureProbe::pressures(&sensors, now)));
        })
        .unwrap();
    samples
}

/// Integral of a sampled pressure from one time to another.
fn integral(samples: &[(f64, Vec<f64>)], k: usize, [from, to]: [f64; 2]) -> f64 {
    let inside = samples
        .windows(2)
        .filter(|pair| pair[0].0 >= from && pair[1].0 <= to);
    inside
        .map(|pair| 0.5 * (pair[1].0 - pair[0].0) * (pair[0].1[k] + pair[1].1[k]))
        .sum()
}

/// How far means over 4 h/c₀ of the start-up pressure are outside of the bracket between the solution
/// with the far wall attached and detached.
fn outside_of_bracket(case: &Case) -> f64 {
    let places = [0.01, 0.05, 0.10].map(|z| [LENGTH, z]);
    let samples = history(&mut case.build(), &places, 0.010);
    let window = 4.0 * DEPTH / case.sound.of(1480.0);
    let mut worst = 0.0_f64;
    for (k, [_, z]) in places.into_iter().enumerate() {
        let [low, high] = [FarWall::Attached, FarWall::Detached].map(|far| {
            let tank = ImpulsiveTank::new(LENGTH, DEPTH, far).unwrap();
            tank.coefficient([0.0, z]).unwrap()
        });
        let mut from = 0.002;
        while from + window < 0.010 {
            let inside: Vec<_> = samples
                .iter()
                .filter(|(t, _)| (from..from + window).contains(t))
                .collect();
            let count = inside.len() as f64;
            let pressure = inside.iter().map(|(_, p)| p[k]).sum::<f64>() / count;
            let acceleration = inside.iter().map(|(t, _)| half_sine(*t)).sum::<f64>() / count;
            let c = (pressure - WATER * GRAVITY * (DEPTH - z)) / (WATER * acceleration * DEPTH);
            worst = worst.max(1.0 - c / low).max(c / high - 1.0);
            from += 0.25 * window;
        }
    }
    worst
}

#[test]
fn start_up_pressure_at_the_physical_sound_speed() {
    let worst = outside_of_bracket(&Case {
        spacing: 0.01,
        sound: SoundSpeed::Physical,
        ..Case::default()
    });
    assert!(worst < 0.05, "{worst}");
}

#[test]
fn start_up_pressure_at_an_artificial_sound_speed() {
    let worst = outside_of_bracket(&Case {
        spacing: 0.01,
        ..Case::default()
    });
    assert!(worst < 0.05, "{worst}");
}

#[test]
fn water_against_the_wall_presses_with_its_thickness() {
    let case = Case {
        constant: true,
        ..Case::default()
    };
    let mut simulation = case.build();
    let samples = history(&mut simulation, &[POINT], 0.2);
    let mean = integral(&samples, 0, [0.15, 0.2]) / 0.05;
    let slab = WATER * PEAK * LENGTH * DEPTH / HEIGHT;
    assert!((mean / slab - 1.0).abs() < 0.05, "{mean} {slab}");
}

#[test]
fn reactions_balance_and_nothing_leaks() {
    let case = Case::default();
    let mut simulation = case.build();
    for until in [0.005, 0.08] {
        simulation.run_until(until).unwrap();
        if until == 0.005 {
            let lack = wall_integral(&case, &simulation);

            assert!(lack.abs() < 0.01, "{lack}");
        }
    }
    let (impulse, whole) = (
        simulation.wall_impulse(0).unwrap(),
        simulation.ledger().whole,
    );
    let gravity = [0.0, -GRAVITY * whole.mass * simulation.time()];
    for d in 0..2 {
        let lack = whole.momentum[d] + impulse[d] - gravity[d];
        assert!(lack.abs() < 1e-10 * impulse[0].abs(), "{lack}");
    }
    // The water moves with the tank at the end, but for what sloshes.
    let with_tank = whole.mass * 2.0 * PEAK * 0.08 / core::f64::consts::PI;
    assert!((impulse[0] / with_tank - 1.0).abs() < 0.1, "{impulse:?}");
    let shift = simulation.wall_pose(0).unwrap().shift[0];
    for particle in simulation.all() {
        let x = particle.position();
        let (x, z) = (x[0] - shift[0], x[1] - shift[1]);
        let half = 0.5 * case.spacing;
        assert!((-half..LENGTH + half).contains(&x) && (-half..HEIGHT + half).contains(&z));
    }
}

/// Pressures of sensors all over both ends of the tank, with their lengths, against the force of the
/// water along it.
fn wall_integral(case: &Case, simulation: &Simulation<f64, 2>) -> f64 {
    let count = (HEIGHT / case.spacing).round();
    let length = HEIGHT / count;
    let mut sum = 0.0;
    for k in 0..count as u32 {
        let z = length * (f64::from(k) + 0.5);
        for (x, outwards) in [(0.0, -1.0), (LENGTH, 1.0)] {
            let part = PressureProbe::disc(simulation, "part", [x, z], [-outwards, 0.0], length);
            let part = part.unwrap().on_wall(0).unwrap();
            sum += outwards * length * part.pressure(simulation);
        }
    }
    sum / simulation.wall_force(0).unwrap()[0] - 1.0
}

#[test]
fn the_impulse_at_point_1_does_not_depend_on_the_spacing() {
    let impulses = [0.02, 0.015, 0.01].map(|spacing| {
        let case = Case {
            spacing,
            ..Case::default()
        };
        integral(&history(&mut case.build(), &[POINT], 0.08), 0, [0.0, 0.08])
    });
    let (least, most) = impulses
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(least, most), &i| {
            (least.min(i), most.max(i))
        });
    assert!(most / least < 1.05, "{impulses:?}");
}

#[test]
fn an_accelerated_frame_is_a_moving_tank() {
    let spacing = 0.02;
    let case = |in_frame, step: Option<f64>| Case {
        in_frame,
        step,
        // Leapfrog steps are exact in a steady field, and the places can be the same to rounding.
        constant: step.is_some(),
        ..Case::default()
    };
    let [mut moving, mut resting] = [false, true].map(|f| case(f, Some(5e-5)).build());
    for _ in 0..200 {
        moving.step().unwrap();
        resting.step().unwrap();
    }
    let shift = moving.wall_pose(0).unwrap().shift[0];
    for (a, b) in moving.all().zip(resting.all()) {
        for d in 0..2 {
            let apart = a.position()[d] - shift[d] - b.position()[d];
            assert!(apart.abs() < 1e-9 * spacing, "{apart}");
        }
    }
    let [moving, resting] = [false, true].map(|in_frame| {
        let mut simulation = case(in_frame, None).build();
        simulation.run_until(0.08).unwrap();
        simulation.wall_impulse(0).unwrap()[0]
    });
    assert!((resting / moving - 1.0).abs() < 0.005, "{resting} {moving}");
}

#[test]
fn the_far_wall_holds_nothing_by_suction_below_the_cut_off() {
    for (cut_off, dry) in [(0.0, true), (-101e3, false)] {
        let case = Case {
            cut_off,
            ..Case::default()
        };
        let mut simulation = case.build();
        simulation.run_until(0.038).unwrap();
        let shift = simulation.wall_pose(0).unwrap().shift[0][0];
        let far = |x: f64| x - shift < simulation.smoothing_length();
        let walls = simulation.wall(0).unwrap().chain(simulation.all());
        for particle in walls.filter(|particle| far(particle.position()[0])) {
            assert!(particle.pressure() >= cut_off);
        }
        let wet = simulation
            .all()
            .filter(|particle| far(particle.position()[0]))
            .count();
        // Air pressure lets go of the wall where nothing can pull; water that bears suction does not.
        assert_eq!(wet == 0, dry, "{wet} particles at cut-off {cut_off}");
    }
}

#[test]
fn slips_in_the_scene_are_named() {
    let message = |case: &Case| {
        let water = Liquid::water().material::<f64>("water", case.sound);
        let water = water.with_pressure_cut_off(case.cut_off);
        let body = Body::block("water", water, [0.0; 2], [0.5, 0.18], case.spacing);
        let tank = Wall::around(
            "tank",
            [0.0; 2],
            [0.5, 0.15],
            case.spacing,
            3,
            [[true; 2]; 2],
        );
        let scene = Scene::new(schemes::weakly_compressible())
            .body(body)
            .wall(tank);
        let problems = scene.problems();
        problems
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join("; ")
    };
    // More water than the tank holds overlaps its lid.
    let text = message(&Case::default());
    assert!(text.contains("overlap"), "{text}");
    let slow = Case {
        sound: SoundSpeed::Artificial {
            mach: 0.2,
            speed: 17.0,
        },
        ..Case::default()
    };
    let text = message(&slow);
    assert!(
        text.contains("mach") && text.contains("ten times"),
        "{text}"
    );
}

/// Between two halves of a tank at rest stands a plate; the water on its other side would cancel what its
/// sensor feels.
#[test]
fn a_sensor_on_a_plate_feels_its_own_side() {
    let (dx, gravity) = (0.05, [0.0, -GRAVITY]);
    let half = |name, from: f64| {
        let water = catalogue::water_at::<f64>(SoundSpeed::Chosen(60.0));
        Body::block(name, water, [from, 0.0], [from + 0.7, 1.0], dx)
            .hydrostatic(gravity, [0.0, 1.0])
    };
    let sides = [[true; 2], [true, false]];
    let plate = (0..6 * 30).map(|k| {
        [
            0.7 + dx * (0.5 + f64::from(k % 6)),
            dx * (0.5 + f64::from(k / 6)),
        ]
    });
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(half("left", 0.0))
        .body(half("right", 1.0))
        .wall(Wall::around("tank", [0.0; 2], [1.7, 1.5], dx, 3, sides))
        .wall(Wall::of("plate", plate.collect(), dx))
        .acceleration(move |_| gravity)
        .build()
        .expect("a tank");
    tank.run_until(0.05).expect("a run");
    let at = |face: f64, normal: f64| {
        let sensor = PressureProbe::disc(&tank, "plate", [face, 0.5], [normal, 0.0], 2.0 * dx);
        sensor.expect("a sensor")
    };
    let sensors = [at(0.7, -1.0), at(1.0, 1.0)];
    let felt = PressureProbe::contact_pressures(&sensors, &tank);
    for (sensor, felt) in sensors.iter().zip(&felt) {
        let pressure = WATER * GRAVITY * 0.5;
        let text = format!(
            "feels {felt:.0} Pa, shows {:.0} Pa, of {pressure:.0} Pa",
            sensor.pressure(&tank)
        );
        println!("{text}");
        assert!((felt / pressure - 1.0).abs() < 0.05, "{text}");
        assert_eq!(*felt, sensor.contact_pressure(&tank));
    }
}
