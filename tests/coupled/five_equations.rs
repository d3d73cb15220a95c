//! Two fluids on a lattice that stays: interfaces that are carried along, shocks with their exact solution, what is kept, rest.
//! Water at 10⁹ Pa beside air is the tube of Saurel & Abgrall (1999, J. Comput. Phys. 150, 425).

use approx::assert_relative_eq;
use meshfree::boundary::Translation;
use meshfree::effect::FiveEquations;
use meshfree::kernel::WendlandC2;
use meshfree::material::eos::{IdealGas, StiffenedGas};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::simulation::ParticleView;
use std::f64::consts::TAU;

/// Exponents of water and air.
const GAMMA: [f64; 2] = [4.4, 1.4];
/// Pressure of the air \[Pa\].
const REST: f64 = 1e5;

fn fluids(stiffness: f64, air: f64) -> (StiffenedGas, IdealGas) {
    (
        StiffenedGas::new(GAMMA[0], stiffness, 1000.0),
        IdealGas::new(GAMMA[1], air),
    )
}

/// Energy \[J/kg\] of water or air of a density \[kg/m³\], that of rest for water, under a pressure \[Pa\].
fn energy(pressure: f64, gamma: f64, density: f64) -> f64 {
    pressure / ((gamma - 1.0) * density)
}

/// A bubble of air in water, both at 10 m/s.
fn bubble() -> Simulation<f64, 1> {
    let (water, air) = fluids(1e6, 1.2);
    let part = |name, fluid: &Material<f64>, low, high, energy| {
        Body::block(name, fluid.clone(), [low], [high], 0.01)
            .energy(energy)
            .velocity([10.0])
    };
    let (liquid, gas) = (Material::new("water", water), Material::new("air", air));
    let cold = energy(REST, GAMMA[0], 1000.0);
    let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
    Scene::new(scheme)
        .body(part("left", &liquid, 0.0, 0.4, cold))
        .body(part("bubble", &gas, 0.4, 0.6, energy(REST, GAMMA[1], 1.2)))
        .body(part("right", &liquid, 0.6, 1.0, cold))
        .boundary(Periodic::along(0, 0.0, 1.0))
        .build()
        .unwrap()
}

/// Once through a period: velocity and pressure stay, and each side of the bubble is three spacings wide at most.
#[test]
fn an_interface_is_carried_along() {
    let mut tube = bubble();
    tube.run_until(0.1).unwrap();
    let mut between = 0;
    for p in tube.all() {
        assert_relative_eq!(p.velocity()[0], 10.0, max_relative = 1e-8);
        assert_relative_eq!(p.pressure(), REST, max_relative = 1e-6);
        let fraction = p.scalar(FiveEquations::FRACTION).unwrap();
        between += usize::from((0.1..0.9).contains(&fraction));
    }
    assert!((2..=6).contains(&between), "{between}");
    // No fraction was held, and no pressure was without a sound speed.
    assert!(
        tube.limits().iter().all(|own| own.1 == 0),
        "{:?}",
        tube.limits()
    );
    let air: f64 = tube
        .all()
        .map(|p| 1.0 - p.scalar(FiveEquations::FRACTION).unwrap())
        .sum();
    assert_relative_eq!(0.01 * air, 0.2, max_relative = 1e-3);
}

/// A fluid before the tube is opened: density, pressure, exponent, internal pressure.
#[derive(Clone, Copy)]
struct Before {
    density: f64,
    pressure: f64,
    gamma: f64,
    stiffness: f64,
}

impl Before {
    fn sound(self) -> f64 {
        (self.gamma * (self.pressure + self.stiffness) / self.density).sqrt()
    }
    /// Velocity that it gains towards the other as its pressure becomes p (Toro 2009, eqs. 4.6 and 4.7 with p + p∞ for p).
    fn gain(self, p: f64) -> f64 {
        let (g, rest) = (self.gamma, self.pressure + self.stiffness);
        if p > self.pressure {
            let (a, b) = (
                2.0 / ((g + 1.0) * self.density),
                (g - 1.0) / (g + 1.0) * rest,
            );
            (p - self.pressure) * (a / (p + self.stiffness + b)).sqrt()
        } else {
            let ratio = (p + self.stiffness) / rest;
            2.0 * self.sound() / (g - 1.0) * (ratio.powf((g - 1.0) / (2.0 * g)) - 1.0)
        }
    }
    /// Velocity \[m/s\] and pressure \[Pa\] at the speed ξ away from the other fluid, where both meet at u and p.
    fn at(self, away: f64, u: f64, p: f64) -> [f64; 2] {
        let (g, c, rest) = (self.gamma, self.sound(), self.pressure + self.stiffness);
        let ratio = (p + self.stiffness) / rest;
        if p > self.pressure {
            let shock = c * ((g + 1.0) / (2.0 * g) * ratio + (g - 1.0) / (2.0 * g)).sqrt();
            return if away > shock {
                [0.0, self.pressure]
            } else {
                [u, p]
            };
        }
        let tail = u + c * ratio.powf((g - 1.0) / (2.0 * g));
        if away > c {
            [0.0, self.pressure]
        } else if away < tail {
            [u, p]
        } else {
            let own = 2.0 / (g + 1.0) * (away - c);
            let slower: f64 = (away - own) / c;
            [
                own,
                rest * slower.powf(2.0 * g / (g - 1.0)) - self.stiffness,
            ]
        }
    }
}

/// Mean errors of velocity and pressure over the means, with n particles a metre.
fn errors_of_tube(n: f64) -> [f64; 2] {
    let (water, air) = fluids(6e8, 50.0);
    let (high, time) = (1e9, 2e-4);
    let [left, right] =
        [(1000.0, high, 0, 6e8), (50.0, REST, 1, 0.0)].map(|(density, pressure, k, stiffness)| {
            Before {
                density,
                pressure,
                gamma: GAMMA[k],
                stiffness,
            }
        });
    let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
    let part = |name, fluid: Material<f64>, low, high, own: Before| {
        Body::block(name, fluid, [low], [high], 1.0 / n)
            .density(own.density)
            .energy(energy(own.pressure, own.gamma, own.density))
    };
    let mut tube = Scene::<f64, 1>::new(scheme)
        .body(part("water", Material::new("water", water), 0.0, 0.7, left))
        .body(part("air", Material::new("air", air), 0.7, 1.0, right))
        .boundary(MirrorPlane::symmetry([0.0], [-1.0]))
        .boundary(MirrorPlane::symmetry([1.0], [1.0]))
        .build()
        .unwrap();
    tube.run_until(time).unwrap();
    let [mut low, mut top] = [REST, high];
    for _ in 0..200 {
        let p = 0.5 * (low + top);
        if left.gain(p) + right.gain(p) > 0.0 {
            top = p;
        } else {
            low = p;
        }
    }
    let (p, u) = (low, right.gain(low));
    let (mut error, mut size) = ([0.0; 2], [0.0; 2]);
    for own in tube.all() {
        let speed = (own.position()[0] - 0.7) / time;
        let exact = if speed < u {
            let [own, p] = left.at(-speed, -u, p);
            [-own, p]
        } else {
            right.at(speed, u, p)
        };
        for (k, found) in [own.velocity()[0], own.pressure()].into_iter().enumerate() {
            error[k] += (found - exact[k]).abs();
            size[k] += exact[k].abs();
        }
    }
    [error[0] / size[0], error[1] / size[1]]
}

/// Pressures of ten thousand to one: the exact solution is approached.
#[test]
fn water_shocks_air() {
    let [coarse, fine] = [100.0, 400.0].map(errors_of_tube);
    assert!(fine[0] < 0.03 && fine[1] < 0.02, "{fine:?}");
    assert!(
        fine[0] < 0.5 * coarse[0] && fine[1] < 0.8 * coarse[1],
        "{coarse:?} {fine:?}"
    );
}

/// A square of both fluids that is stirred: mass of each, momentum and energy are kept to rounding, and much has passed.
#[test]
fn what_two_fluids_exchange_is_kept() {
    let (water, air) = fluids(1e6, 10.0);
    let stirred = |[x, y]: [f64; 2], start| Start {
        velocity: [20.0 * (TAU * y).sin(), 20.0 * (TAU * x).sin()],
        ..start
    };
    let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
    let dx = 1.0 / 24.0;
    let mut square = Scene::<f64, 2>::new(scheme)
        .body(
            Body::block(
                "water",
                Material::new("water", water),
                [0.0; 2],
                [1.0, 0.5],
                dx,
            )
            .energy(energy(REST, GAMMA[0], 1000.0))
            .start(stirred),
        )
        .body(
            Body::block("air", Material::new("air", air), [0.0, 0.5], [1.0, 1.0], dx)
                .energy(energy(REST, GAMMA[1], 10.0))
                .start(stirred),
        )
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .build()
        .unwrap();
    let totals = |now: &Simulation<f64, 2>| {
        let mut all = [0.0; 5];
        for p in now.all() {
            let ([u, v], m) = (p.velocity(), p.mass());
            let energy = m * (0.5 * (u * u + v * v) + p.energy());
            let liquid = p.scalar(FiveEquations::LIQUID).unwrap();
            for (all, own) in all.iter_mut().zip([m, liquid, m * u, m * v, energy]) {
                *all += own;
            }
        }
        all
    };
    let before = totals(&square);
    for _ in 0..200 {
        square.step().unwrap();
    }
    let after = totals(&square);
    for k in [0, 1, 4] {
        assert_relative_eq!(after[k], before[k], max_relative = 1e-12);
    }
    for k in [2, 3] {
        assert!(
            (after[k] - before[k]).abs() < 1e-11 * 20.0 * before[0],
            "{after:?}"
        );
    }
    let mixed = square.all().filter(|p| {
        let fraction = p.scalar(FiveEquations::FRACTION).unwrap();
        (0.05..0.95).contains(&fraction)
    });
    assert!(mixed.count() > 24);
    let ledger = square.ledger();
    assert_relative_eq!(
        ledger.whole.total("liquid mass").unwrap(),
        before[1],
        max_relative = 1e-12
    );
}

/// Water under air between walls stays at rest, with the pressure of its depth.
#[test]
fn water_under_air_stays_at_rest() {
    let (depth, size, dx) = (0.1, [0.1, 0.2], 0.01);
    let (water, air) = fluids(1e6, 1.2);
    let sound = (GAMMA[0] * (REST + 1e6) / 1000.0).sqrt();
    let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
    let deep = move |[_, y]: [f64; 2], start| Start {
        energy: energy(REST + 9810.0 * (depth - y), GAMMA[0], 1000.0),
        ..start
    };
    let mut tank = Scene::<f64, 2>::new(scheme)
        .body(
            Body::block(
                "water",
                Material::new("water", water),
                [0.0; 2],
                [size[0], depth],
                dx,
            )
            .start(deep),
        )
        .body(
            Body::block("air", Material::new("air", air), [0.0, depth], size, dx)
                .energy(energy(REST, GAMMA[1], 1.2)),
        )
        .wall(Wall::around("tank", [0.0; 2], size, dx, 3, [[true; 2]; 2]))
        .acceleration(|_| [0.0, -9.81])
        .build()
        .unwrap();
    tank.run_until(10.0 * depth / sound).unwrap();
    for p in tank.body("water").unwrap() {
        let [_, y] = p.position();
        let exact = REST + 9810.0 * (depth - y);
        assert!(
            (p.pressure() - exact).abs() < 0.03 * 981.0,
            "{y} {}",
            p.pressure()
        );
        let speed = p.velocity()[0].hypot(p.velocity()[1]);
        assert!(speed < 0.02 * (9.81 * depth).sqrt(), "{y} {speed}");
    }
}

/// Sound of fifty particles a wave length keeps its height over four periods, and never gains.
#[test]
fn sound_does_not_grow() {
    let (water, air) = fluids(1e6, 1.2);
    let sound = (GAMMA[0] * (REST + 1e6) / 1000.0).sqrt();
    let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
    let wave = Body::block("water", Material::new("water", water), [0.0], [1.0], 0.02);
    let mut tube = Scene::<f64, 1>::new(scheme)
        .body(wave.start(move |[x], start| Start {
            velocity: [1e-3 * sound * (TAU * x).sin()],
            energy: energy(REST, GAMMA[0], 1000.0),
            ..start
        }))
        .boundary(Periodic::along(0, 0.0, 1.0))
        .build()
        .unwrap();
    let mut before = 1.0;
    for period in 1..=4 {
        tube.run_until(f64::from(period) / sound).unwrap();
        let along = |p: ParticleView<'_, f64, 1>| p.velocity()[0] * (TAU * p.position()[0]).sin();
        let height = tube.all().map(along).sum::<f64>() / (0.5 * 50.0 * 1e-3 * sound);
        assert!(
            height < before && height > before - 0.006,
            "{period} {height}"
        );
        before = height;
    }
}

/// A third fluid, and fluids that cannot be, are refused by name.
#[test]
fn other_fluids_are_refused() {
    let (water, air) = fluids(1e6, 1.2);
    let oil = StiffenedGas::new(3.0, 2e6, 900.0);
    let scheme = |own| SchemeBuilder::five_equations(WendlandC2, own);
    let of = |law: StiffenedGas| Body::block("own", Material::new("own", law), [0.0], [1.0], 0.1);
    let refused = |own: FiveEquations, law: StiffenedGas| {
        let built = Scene::<f64, 1>::new(scheme(own)).body(of(law)).build();
        built.err().map(|error| error.to_string())
    };
    let two = FiveEquations::new(water, air);
    assert!(refused(two, water).is_none());
    let third = refused(two, oil).unwrap();
    assert!(
        third.contains("`own`") && third.contains("neither fluid"),
        "{third}"
    );
    let with_cut_off = Material::new("own", water).with_pressure_cut_off(0.0);
    let built = Scene::<f64, 1>::new(scheme(two))
        .body(Body::block("own", with_cut_off, [0.0], [1.0], 0.1))
        .build();
    let cut = built.err().unwrap().to_string();
    assert!(cut.contains("without a cut-off"), "{cut}");
    let same = refused(FiveEquations::new(water, water), water).unwrap();
    assert!(same.contains("are the same"), "{same}");
    let tank = || {
        let water = Material::new("own", water);
        Scene::<f64, 2>::new(scheme(two)).body(Body::block("own", water, [0.0; 2], [0.1; 2], 0.01))
    };
    let driven = tank().wall(
        Wall::around("tank", [0.0; 2], [0.1; 2], 0.01, 3, [[true; 2]; 2])
            .motion(Translation::steady([1.0, 0.0])),
    );
    let driven = driven.build().err().unwrap().to_string();
    assert!(driven.contains("wall `tank` moves"), "{driven}");
    let pushed = tank().boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]).moving(0.1));
    let pushed = pushed.build().err().unwrap().to_string();
    assert!(pushed.contains("moves through particles"), "{pushed}");
    let late = tank().integrator(DriftKickDrift).build().err().unwrap();
    assert!(late.to_string().contains("half a step behind"), "{late}");
    let thin = FiveEquations::new(StiffenedGas::new(1.0, 1e6, 1000.0), air);
    let thin = refused(thin, water).unwrap();
    assert!(thin.contains("gamma"), "{thin}");
}

/// Reading after every step, another number of threads and a copy that goes on change no bit.
#[test]
fn readings_threads_and_copies_change_no_bit() {
    let numbers = |now: &Simulation<f64, 1>| -> Vec<u64> {
        let of = |p: ParticleView<'_, f64, 1>| {
            let fraction = p.scalar(FiveEquations::FRACTION).unwrap();
            [p.mass(), p.velocity()[0], p.energy(), fraction].map(f64::to_bits)
        };
        now.all().flat_map(of).collect()
    };
    let mut plain = bubble();
    plain.run_until(2e-3).unwrap();
    let mut read = bubble();
    read.run_with(2e-3, |now| {
        let probe = now.sample(FiveEquations::FRACTION, &[[0.43]]).unwrap();
        assert!(now.ledger().whole.mass > 0.0 && probe.filling()[0] > 0.9);
    })
    .unwrap();
    assert_eq!(numbers(&plain), numbers(&read));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let alone = pool.install(|| {
        let mut own = bubble();
        own.run_until(2e-3).unwrap();
        numbers(&own)
    });
    assert_eq!(numbers(&plain), alone);
    let mut clone = plain.clone();
    for own in [&mut plain, &mut clone] {
        own.run_until(4e-3).unwrap();
    }
    assert_eq!(numbers(&plain), numbers(&clone));
}
