//! Tests that every artificial viscosity of the list passes in one, two and three dimensions.
//! Laws are asked about single pairs; switches and effective viscosity about small runs.

use super::*;
use crate::for_each_viscosity;
use crate::kernel::{CubicSpline, Kernel};
use crate::material::Material;
use crate::material::eos::Linear;
use crate::scene::{Body, Scene};
use crate::scheme::{DensityForm, EnergyForm, SchemeBuilder};
use crate::simulation::Simulation;
use crate::term::{MOST_READS, MOST_SUMS};
use core::marker::PhantomData;

/// The layout of a viscosity that is alone in its sweep.
struct Alone<V, const D: usize>(PhantomData<V>);

impl<const D: usize, V: ArtificialViscosity<D>> Layout for Alone<V, D> {
    const READS: Fields = <Viscosity<V> as Term<D>>::READS;
    const WRITES: Outputs = <Viscosity<V> as Term<D>>::WRITES;
}

/// Numbers between −1 and 1 that repeat from a seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A particle of a gas with a density and a sound speed near one.
#[derive(Clone)]
struct Particle<const D: usize> {
    x: [f64; D],
    v: [f64; D],
    density: f64,
    sound_speed: f64,
    coefficient: f64,
    divergence: f64,
    gradient: Vec<f64>,
}

impl<const D: usize> Particle<D> {
    fn random(random: &mut Random) -> Self {
        Self {
            x: core::array::from_fn(|_| random.next()),
            v: core::array::from_fn(|_| random.next()),
            density: 1.0 + 0.5 * random.next(),
            sound_speed: 1.0 + 0.5 * random.next(),
            coefficient: 1.0 + random.next(),
            divergence: random.next(),
            gradient: (0..D * D).map(|_| random.next()).collect(),
        }
    }
    fn record(&self, reads: Fields) -> Vec<f64> {
        let mut record = Vec::new();
        for field in reads.iter() {
            match field {
                Field::VELOCITY => record.extend(self.v),
                Field::MASS => record.push(0.7),
                Field::DENSITY => record.push(self.density),
                Field::SOUND_SPEED => record.push(self.sound_speed),
                Field::VISCOSITY_COEFFICIENT => record.push(self.coefficient),
                Field::DIVERGENCE => record.push(self.divergence),
                Field::VELOCITY_GRADIENT => record.extend(&self.gradient),
                other => unreachable!("a viscosity reads {other:?}"),
            }
        }
        record
    }
}

const H: f64 = 0.8;

/// What a law makes of the pair (i, j), the force term included; compiled once for all who ask.
#[inline(never)]
fn ask<V: ArtificialViscosity<D>, const D: usize>(
    law: &V,
    i: &Particle<D>,
    j: &Particle<D>,
) -> (Viscous<f64>, f64) {
    let reads = <Alone<V, D> as Layout>::READS;
    let mut own = [0.0; MOST_READS];
    let record = i.record(reads);
    own[..record.len()].copy_from_slice(&record);
    let other = j.record(reads);
    let r: [f64; D] = core::array::from_fn(|d| i.x[d] - j.x[d]);
    let v: [f64; D] = core::array::from_fn(|d| i.v[d] - j.v[d]);
    let pair = Pair::<f64, D, Alone<V, D>> {
        r,
        r2: r.iter().map(|r| r * r).sum(),
        v,
        v_dot_r: r.iter().zip(&v).map(|(r, v)| r * v).sum(),
        h: H,
        h_i: H,
        w: 1.0,
        w_j: 1.0,
        f: -1.0,
        f_i: -1.0,
        f_j: -1.0,
        mobile: 1.0,
        mobile_i: 1.0,
        body_force: [0.0; D],
        lattice_consistency_factor: 1.0,
        gated: false,
        swapped: false,
        i: &own,
        j: &other,
        layout: PhantomData,
    };
    let mut sums = Sums::new();
    Term::<D>::pair(&Viscosity(law.clone()), &pair, &mut sums);
    sums.settle(pair.f);
    assert!(sums.kept[..MOST_SUMS].iter().all(|sum| sum.is_finite()));
    (law.pair(&pair), sums.radial.value())
}

fn obeys_the_contract<V: ArtificialViscosity<D>, const D: usize>(law: &V) {
    let mut random = Random(7 + D as u64);
    for _ in 0..500 {
        let (i, j) = (Particle::random(&mut random), Particle::random(&mut random));
        let (viscous, radial) = ask(law, &i, &j);
        let (mirrored, _) = ask(law, &j, &i);
        assert!((viscous.pi - mirrored.pi).abs() <= 1e-14 * viscous.pi.abs());
        assert!((viscous.signal - mirrored.signal).abs() <= 1e-14 * viscous.signal.abs());
        let closing: f64 = (0..D).map(|d| (i.v[d] - j.v[d]) * (i.x[d] - j.x[d])).sum();
        assert!(viscous.pi >= 0.0 && viscous.signal >= 0.0);
        if closing >= 0.0 {
            assert_eq!(viscous.pi, 0.0, "receding pairs feel nothing");
        }
        // The pair loses −F·v of kinetic energy.
        assert!(-radial * closing >= 0.0);
        // Velocities count by their differences only.
        let boosted = |p: &Particle<D>| Particle {
            v: p.v.map(|v| v + 1.0),
            ..p.clone()
        };
        let (moved, _) = ask(law, &boosted(&i), &boosted(&j));
        assert!((moved.pi - viscous.pi).abs() <= 1e-12 * (1.0 + viscous.pi));
        let (own, _) = ask(law, &i, &i);
        assert!(own.pi == 0.0 && own.signal.is_finite());
        let mut same_place = j.clone();
        same_place.x = i.x;
        assert_eq!(ask(law, &i, &same_place).0.pi, 0.0);
        // Silence: neither sound nor motion.
        let still = |p: &Particle<D>| Particle {
            v: [0.0; D],
            sound_speed: 0.0,
            divergence: 0.0,
            gradient: vec![0.0; D * D],
            ..p.clone()
        };
        assert_eq!(ask(law, &still(&i), &still(&j)).0.pi, 0.0);
    }
    assert!(law.problems().is_empty());
    let doc = law.document();
    assert!(!doc.name.is_empty() && !doc.equation.is_empty());
}

fn obeys_the_contract_everywhere<V>(law: &V)
where
    V: ArtificialViscosity<1> + ArtificialViscosity<2> + ArtificialViscosity<3>,
{
    obeys_the_contract::<V, 1>(law);
    obeys_the_contract::<V, 2>(law);
    obeys_the_contract::<V, 3>(law);
}

#[test]
fn every_law_obeys_the_contract() {
    macro_rules! check {
        ($($Law:ident $name:literal),*) => {
            $(obeys_the_contract_everywhere(&$Law::STANDARD);)*
        };
    }
    for_each_viscosity!(check);
}

#[test]
fn every_kind_is_its_law() {
    fn same<V: ArtificialViscosity<D>, const D: usize>(law: V, kind: ViscosityKind) {
        let mut random = Random(3);
        for _ in 0..100 {
            let (i, j) = (
                Particle::<D>::random(&mut random),
                Particle::random(&mut random),
            );
            let (ours, theirs) = (ask(&kind, &i, &j), ask(&law, &i, &j));
            assert_eq!(ours.0.pi, theirs.0.pi);
            assert_eq!(ours.0.signal, theirs.0.signal);
        }
        let kind_needs = ArtificialViscosity::<D>::needs_velocity_gradient(&kind);
        assert_eq!(kind_needs, law.needs_velocity_gradient());
        let [chosen, own] = [ArtificialViscosity::<D>::switch(&kind), law.switch()];
        assert_eq!(format!("{chosen:?}"), format!("{own:?}"));
    }
    macro_rules! check {
        ($($Law:ident $name:literal),*) => {$(
            same::<_, 1>($Law::STANDARD, $Law::STANDARD.into());
            same::<_, 2>($Law::STANDARD, $Law::STANDARD.into());
            same::<_, 3>($Law::STANDARD, $Law::STANDARD.into());
        )*};
    }
    for_each_viscosity!(check);
}

#[test]
fn kinds_have_names_and_coefficients() {
    for &kind in ViscosityKind::ALL {
        assert_eq!(kind.to_string(), kind.key());
        assert_eq!(kind.key().parse(), Ok(kind));
        let other = kind.with_coefficients(0.25, 0.5);
        assert_eq!(other.to_string().parse(), Ok(other));
        if kind.alpha().is_some() {
            assert_eq!((other.alpha(), other.beta()), (Some(0.25), Some(0.5)));
            let bad = kind.with_alpha(f64::NAN);
            assert!(!ArtificialViscosity::<2>::problems(&bad).is_empty());
            let bad = kind.with_beta(-1.0);
            assert!(!ArtificialViscosity::<2>::problems(&bad).is_empty());
        }
    }
    assert_eq!(
        "Morris_Monaghan".parse::<ViscosityKind>(),
        Ok(MorrisMonaghan::STANDARD.into())
    );
    for bad in ["thick", "mg:", "mg:x", "mg:1,", "mg:1,2,3", "none:1"] {
        let message = bad.parse::<ViscosityKind>().map_err(|e| e.to_string());
        assert!(message.is_err_and(|m| m.contains(bad) && m.contains("cullen-dehnen")));
    }
}

#[test]
fn laws_read_no_field_that_they_do_not_use() {
    // Composing a scheme would compile every loop for every law: ask the force term instead.
    fn reads<V: ArtificialViscosity<D>, const D: usize>(_: V) -> Fields {
        <Viscosity<V> as Term<D>>::READS
    }
    let none = reads::<_, 2>(Inviscid);
    assert_eq!(none, reads::<_, 2>(MonaghanGingold::STANDARD));
    assert_eq!(none, reads::<_, 2>(SignalVelocity::STANDARD));
    assert_eq!(none, reads::<_, 2>(Riemann::STANDARD));
    assert_eq!(none, reads::<_, 1>(Balsara::STANDARD));
    let gradient = none.union(Fields::of(&[Field::VELOCITY_GRADIENT]));
    assert_eq!(gradient, reads::<_, 2>(Balsara::STANDARD));
    assert_eq!(gradient, reads::<_, 1>(LimitedMonaghanGingold::STANDARD));
    let own = none.union(Fields::of(&[Field::VISCOSITY_COEFFICIENT]));
    assert_eq!(own, reads::<_, 2>(MorrisMonaghan::STANDARD));
    assert_eq!(own, reads::<_, 1>(CullenDehnen::STANDARD));
    let both = own.union(Fields::of(&[Field::DIVERGENCE]));
    assert_eq!(both, reads::<_, 3>(CullenDehnen::STANDARD));
}

/// A still medium with density and sound speed one, on a lattice of spacing one.
fn medium() -> Material<f64> {
    Material::new("medium", Linear::new(1.0, 1.0))
}

fn coefficient<const D: usize>(simulation: &Simulation<f64, D>, k: usize) -> f64 {
    let particle = simulation.all().nth(k);
    particle
        .and_then(|p| p.scalar(Field::VISCOSITY_COEFFICIENT))
        .unwrap_or(f64::NAN)
}

#[test]
fn coefficients_start_at_rest_and_decay_at_their_rate() {
    // Compression at 0.05 c/h for a while, then rest: both by the law alone.
    let h = 1.2;
    let at = |divergence: f64, before: f64| Surroundings {
        divergence,
        divergence_before: before,
        divergence_sign: -1.0,
        shear2: 0.0,
        sound_speed: 1.0,
        signal_speed: 1.0,
        h,
        support: 2.0 * h,
    };
    let morris = MorrisMonaghan::STANDARD;
    let mut alpha = Switch::start(&morris);
    assert_eq!(alpha, 0.1);
    for _ in 0..1000 {
        alpha = morris.next(alpha, &at(-0.5, -0.5), 0.1);
    }
    let equilibrium = (0.2 / h * 0.1 + 0.5 * 1.5) / (0.2 / h + 0.5);
    assert!((alpha - equilibrium).abs() < 1e-12);
    // One e-folding in h/(ℓ c), whatever the step, and expansion does not feed it.
    for steps in [1, 7, 100] {
        let (mut alpha, time) = (1.1, h / 0.2);
        for _ in 0..steps {
            alpha = morris.next(alpha, &at(0.3, 0.0), time / f64::from(steps));
        }
        assert!((alpha - 0.1 - (-1f64).exp()).abs() < 1e-12);
    }
    let cullen = CullenDehnen::STANDARD;
    assert_eq!(Switch::start(&cullen), 0.0);
    // Steepening raises it at once: A = 0.5/0.1 and H²A = 28.8.
    let up = cullen.next(0.0, &at(-0.5, 0.0), 0.1);
    assert!((up - 2.0 * 28.8 / 29.8).abs() < 1e-12);
    // Expansion does not, and neither does compression that only lasts.
    assert_eq!(cullen.next(0.0, &at(0.5, 1.0), 0.1), 0.0);
    assert_eq!(cullen.next(0.0, &at(-0.5, -0.5), 0.1), 0.0);
    // One e-folding in H/(2 ℓ v).
    let down = cullen.next(1.0, &at(0.0, 0.0), 2.0 * h / 0.1);
    assert!((down - (-1f64).exp()).abs() < 1e-12);
    // Shear takes it away, opening surroundings too.
    let sheared = Surroundings {
        shear2: 1e6,
        ..at(-0.5, 0.0)
    };
    assert!(cullen.next(0.0, &sheared, 0.1) < 0.02);
    let opening = Surroundings {
        divergence_sign: 1.0,
        shear2: 1e-6,
        ..at(-0.5, 0.0)
    };
    assert_eq!(cullen.next(0.0, &opening, 0.1), 0.0);
}

/// Two halves of a block that run into each other: the coefficient at the middle and far from it.
fn collision<V: ArtificialViscosity<D>, const D: usize>(law: V) -> (f64, f64)
where
    CubicSpline: Kernel<D>,
{
    let size: [f64; D] = core::array::from_fn(|d| if d == 0 { 40.0 } else { 8.0 });
    let scheme = SchemeBuilder::new(CubicSpline, law)
        .density(DensityForm::NumberDensity)
        .energy(EnergyForm::Symmetric);
    let speed = 0.2;
    let body = Body::block("block", medium(), [0.0; D], size, 1.0).start(|x, start| {
        let mut velocity = [0.0; D];
        velocity[0] = if x[0] < 20.0 { speed } else { -speed };
        crate::scene::Start { velocity, ..start }
    });
    let scene = (1..D).fold(Scene::<f64, D>::new(scheme).body(body), |scene, axis| {
        scene.boundary(crate::boundary::Periodic::along(axis, 0.0, 8.0))
    });
    let mut simulation = scene.build().expect("a scene without problems");
    simulation.run_until(3.0).expect("a run that holds");
    let middle = 20 + if D > 1 { 40 * 4 } else { 0 };
    (
        coefficient(&simulation, middle),
        coefficient(&simulation, middle - 12),
    )
}

#[test]
fn compression_raises_coefficients_and_still_flow_does_not() {
    let (shock, calm) = collision::<_, 1>(MorrisMonaghan::STANDARD);
    assert!(shock > 0.2 && (calm - 0.1).abs() < 1e-3, "{shock} {calm}");
    let (shock, calm) = collision::<_, 1>(CullenDehnen::STANDARD);
    assert!(shock > 0.2 && calm < 1e-3, "{shock} {calm}");
    // Chosen at run time it is the same run.
    let kind: ViscosityKind = CullenDehnen::STANDARD.into();
    assert_eq!(collision::<_, 1>(kind), (shock, calm));
    let (shock, calm) = collision::<_, 2>(CullenDehnen::STANDARD);
    assert!(shock > 0.2 && calm < 1e-2, "{shock} {calm}");
}

/// Decay rate of the velocity V sin(k x) along `axis` in a periodic box, as a viscosity in units of
/// α h c.
fn decay<const D: usize>(axis: usize, time: f64) -> f64
where
    CubicSpline: Kernel<D>,
{
    let (length, width) = (32.0, 8.0);
    let (alpha, h) = (0.5, 1.2);
    let k = core::f64::consts::TAU / length;
    let law = MonaghanGingold { alpha, beta: 0.0 };
    let scheme = SchemeBuilder::new(CubicSpline, law)
        .density(DensityForm::NumberDensity)
        .energy(EnergyForm::Symmetric)
        .h_over_dx(h);
    let size: [f64; D] = core::array::from_fn(|d| if d == 0 { length } else { width });
    let body = Body::block("medium", medium(), [0.0; D], size, 1.0).start(|x, start| {
        let mut velocity = [0.0; D];
        velocity[axis] = 1e-5 * (k * x[0]).sin();
        crate::scene::Start { velocity, ..start }
    });
    let scene = (0..D).fold(Scene::<f64, D>::new(scheme).body(body), |scene, d| {
        scene.boundary(crate::boundary::Periodic::along(d, 0.0, size[d]))
    });
    let mut simulation = scene.build().expect("a scene without problems");
    let energy = |simulation: &Simulation<f64, D>| {
        let squares = simulation.all().map(|p| p.velocity()[axis].powi(2));
        squares.sum::<f64>()
    };
    let before = energy(&simulation);
    simulation.run_until(time).expect("a run that holds");
    let rate = (before / energy(&simulation)).ln() / (2.0 * time);
    rate / (k * k * alpha * h)
}

/// Viscosity in units of α h c that a lattice at h/dx 1.2 shows to the linear flow v = −t (n·x):
/// what the pairs of a particle dissipate.
fn on_a_lattice<const D: usize>(n: [f64; D], t: [f64; D]) -> f64
where
    CubicSpline: Kernel<D>,
{
    let law = MonaghanGingold {
        alpha: 1.0,
        beta: 0.0,
    };
    let dx = H / 1.2;
    let dot = |a: [f64; D], b: [f64; D]| (0..D).map(|d| a[d] * b[d]).sum::<f64>();
    let particle = |x: [f64; D]| Particle {
        x,
        v: t.map(|t| -t * dot(n, x)),
        density: 1.0,
        sound_speed: 1.0,
        coefficient: 0.0,
        divergence: 0.0,
        gradient: vec![0.0; D * D],
    };
    let center = particle([0.0; D]);
    let norm = Kernel::<D>::normalisation(&CubicSpline) * H.powi(-(D as i32) - 2);
    let mut dissipated = 0.0;
    for k in 0..7usize.pow(D as u32) {
        let x = core::array::from_fn(|d| dx * ((k / 7usize.pow(d as u32) % 7) as f64 - 3.0));
        let other = particle(x);
        let (viscous, _) = ask::<_, D>(&law, &center, &other);
        let f = norm * Kernel::<D>::slope_over_q(&CubicSpline, dot(x, x).sqrt() / H);
        dissipated += 0.5 * dx.powi(D as i32) * viscous.pi * dot(other.v, x) * f;
    }
    dissipated / H
}

#[test]
fn effective_viscosity_is_that_of_the_literature() {
    // All pairs act in compression: 3 α h c/(2 (D + 2)), three times the α h c/6, /8, /10 of
    // Monaghan 2005. In shear half of the pairs recede: half of his.
    let close = |value: f64, one_over: f64| {
        assert!((value * one_over - 1.0).abs() < 0.05, "1/{}", 1.0 / value);
    };
    close(on_a_lattice([1.0], [1.0]), 2.0);
    // A square lattice resists shear along its diagonals more than along its rows; the mean over all
    // directions (Voigt 1910) is what an irregular arrangement shows.
    let s = 0.5f64.sqrt();
    let rows = on_a_lattice([1.0, 0.0], [0.0, 1.0]);
    let diagonals = on_a_lattice([s, s], [-s, s]);
    close(0.5 * (rows + diagonals), 16.0);
    let rows = on_a_lattice([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let diagonals = on_a_lattice([s, s, 0.0], [-s, s, 0.0]);
    close(0.6 * rows + 0.4 * diagonals, 20.0);
}

#[test]
fn shear_decays_with_the_viscosity_of_the_lattice() {
    let (run, lattice) = (decay::<2>(1, 40.0), on_a_lattice([1.0, 0.0], [0.0, 1.0]));
    assert!((run / lattice - 1.0).abs() < 0.03, "{run} {lattice}");
}

#[test]
fn compression_meets_half_alpha_h_c() {
    // Viscosity ν = ½ α h c acts on half of the energy of a standing wave, and closes in only half of
    // the time: the amplitude decays as ν k²/4.
    let one = decay::<1>(0, 32.0);
    assert!((one * 8.0 - 1.0).abs() < 0.08, "1/{}", 1.0 / one);
}
