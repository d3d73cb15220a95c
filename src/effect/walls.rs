//! Wall laws: how walls of particles answer a liquid.
//! Adami, Hu & Adams 2012; the one-sided Riemann problem of Zhang, Hu & Adams 2017.

use super::{Around, CONSTANTS, Effect, Point, PointLaw, Reach, Setting, StepProgram};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::viscosity::Riemann;
use crate::term::{In, Layout, LiquidNearWall, Pair, Stage, Sums, Term, TermDoc, stage};

/// No walls: what a scheme has that meets none.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NoWalls;

impl<const D: usize> Effect<D> for NoWalls {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
}

/// Share of a full neighbourhood below which a wall particle sees no liquid.
pub(super) const DRY: f64 = 1e-6;

/// Walls whose pressure extrapolates that of the liquid before them.
///
#[doc = include_str!("../../docs/equations/extrapolated_pressure.html")]
///
/// (Adami, Hu & Adams 2012, eq. 27), not below a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ExtrapolatedPressure {
    /// The lowest pressure \[Pa\] that a wall can show the liquid: 0 by default, so nothing sticks.
    /// In a closed domain that is always full, minus infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub floor: f64,
}

impl Default for ExtrapolatedPressure {
    fn default() -> Self {
        Self { floor: 0.0 }
    }
}

impl<const D: usize> Effect<D> for ExtrapolatedPressure {
    type Terms = (In<stage::Walls, LiquidNearWall>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(LiquidNearWall),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Walls, *self);
    }
}

const PRESSED: Outputs = Outputs::of(&[
    Output::UNITY,
    Output::LIQUID_PRESSURE,
    Output::LIQUID_MOMENT,
]);

/// The pressure of wall particles, extrapolated along an acceleration, and a push, not below a floor; zero where they are dry.
#[inline(always)]
fn press<L: Lane, const D: usize, P: Reach>(
    at: &mut Point<'_, L, D, P>,
    fall: [L; D],
    push: L,
    floor: f64,
) {
    let (unity, moment) = (at.sum(Output::UNITY), at.sum_vector(Output::LIQUID_MOMENT));
    let mut sum = at.sum(Output::LIQUID_PRESSURE);
    for d in 0..D {
        sum += moment[d] * fall[d];
    }
    let own = (sum / unity + push).max(L::of(floor));
    let dry = unity.le(L::of(DRY));
    at.set(Field::PRESSURE, L::select(dry, L::zero(), own));
}

impl<const D: usize> PointLaw<D> for ExtrapolatedPressure {
    const NAME: &'static str = "pressure of walls";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    const SUMS: Outputs = PRESSED;
    const OF_WALLS: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        press(at, at.wall.fall, L::zero(), self.floor);
    }
}

/// Walls whose pressure extrapolates that of the liquid before them by gravity alone: [`ExtrapolatedPressure`] without the
/// acceleration of the wall, not below a floor.
///
#[doc = include_str!("../../docs/equations/hydrostatic_walls.html")]
///
/// with pressure p \[Pa\] and density ρ \[kg/m³\] of the liquid, gravity g \[m/s²\] and the kernel W.
///
/// For structures that strike each other in a liquid. A contact acts on single particles and accelerates them by 10⁸ m/s²
/// and more. Over a smoothing length of water that is a difference in pressure of tens of MPa, which the liquid before the
/// wall does not have: the wall flings it away, and the liquid gains energy that the structure does not lose
/// ([crushed cells](crate#pages)). Where a wall accelerates as a whole, the liquid feels less of it within a spacing of
/// the wall: take `ExtrapolatedPressure` there.
///
/// ```
/// use meshfree::effect::HydrostaticWalls;
/// use meshfree::prelude::*;
/// let scheme: Scheme<f64, 3> = schemes::weakly_compressible()
///     .walls(HydrostaticWalls::default())
///     .compose();
/// assert!(scheme.to_string().contains("without the acceleration of the wall"));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HydrostaticWalls {
    /// The lowest pressure \[Pa\], as of [`ExtrapolatedPressure`].
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub floor: f64,
}

impl<const D: usize> Effect<D> for HydrostaticWalls {
    type Terms = (In<stage::Walls, LiquidNearWall>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(LiquidNearWall),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Walls, *self);
        program.document(TermDoc {
            name: "pressure of walls without the acceleration of the wall".into(),
            equation: "p_w = (Σ p_f W + g·Σ ρ_f r W)/Σ W",
            source: "after Adami, Hu & Adams 2012, eq. 27",
        });
    }
}

impl<const D: usize> PointLaw<D> for HydrostaticWalls {
    const NAME: &'static str = "hydrostatic pressure of walls";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    const SUMS: Outputs = PRESSED;
    const OF_WALLS: bool = true;
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        constants[..D].copy_from_slice(&around.gravity);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let mut gravity = [L::zero(); D];
        for d in 0..D {
            gravity[d] = at.constant(d);
        }
        press(at, gravity, L::zero(), self.floor);
    }
}

/// Walls that meet liquid as in a one-sided Riemann problem: liquid that moves into a wall at the speed u \[m/s\]
/// feels ρβu \[Pa\] more than the [extrapolated pressure](ExtrapolatedPressure).
///
#[doc = include_str!("../../docs/equations/riemann_walls.html")]
///
/// It is the pressure p* between the liquid and its mirror image by Zhang, Hu & Adams 2017 (eqs. 13, 14), whose
/// limiter 3 sees twice the speed u. Theirs acts on approach alone; here liquid that leaves feels as much less,
/// down to the floor.
///
/// A particle that strikes an elastic wall alone bounces, and hits it with up to twice its momentum; water
/// spreads: a row thrown at a floor leaves it with 0.39 of its speed without this, 0.12 with it
/// (`tests/liquids/riemann_walls.rs`). u is the mean over the kernel along the wall's normal, so a wall must know the
/// container that it faces: one [around](crate::boundary::Wall::around) a box does, others are
/// [set](crate::boundary::Wall::fluid_side), and a scene with one that is not is refused. It costs D sums a wall
/// particle.
///
/// ```
/// use meshfree::effect::RiemannWalls;
/// use meshfree::prelude::*;
/// let scheme: Scheme<f64, 2> = schemes::weakly_compressible()
///     .walls(RiemannWalls::default())
///     .compose();
/// assert!(scheme.to_string().contains("Riemann"));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct RiemannWalls {
    /// The lowest pressure \[Pa\], as of [`ExtrapolatedPressure`].
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub floor: f64,
}

impl<const D: usize> Effect<D> for RiemannWalls {
    type Terms = (
        In<stage::Walls, LiquidNearWall>,
        In<stage::Walls, VelocityBeforeWall>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(LiquidNearWall), In::new(VelocityBeforeWall))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.ask_for_wall_normals();
        program.law(Stage::Walls, *self);
        program.document(TermDoc {
            name: "walls as one-sided Riemann problems".into(),
            equation: "p_w ← p_w + 2 ρ β u, u = (Σ v_f W / Σ W − v_wall)·n, β = min(6 |u|, c)",
            source: "after Zhang, Hu & Adams 2017, eqs. 13, 14",
        });
    }
}

/// Σ V v W over the liquid before a wall particle.
const BEFORE: Output = Output::vector(name!("liquid_velocity_before_wall", "m/s"));

/// The sum from which the velocity of the liquid before a wall is taken.
#[derive(Clone, Copy, Debug)]
pub struct VelocityBeforeWall;

impl<const D: usize> Term<D> for VelocityBeforeWall {
    const NAME: &'static str = "meshfree::velocity_before_wall";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY, Field::VELOCITY]);
    const WRITES: Outputs = Outputs::of(&[BEFORE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY) * (pair.w * pair.mobile);
        for d in 0..D {
            sums.add_product_at(BEFORE, d, volume, pair.j_at(Field::VELOCITY, d));
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "velocity of the liquid before walls".into(),
            equation: "Σ v_f W / Σ W",
            source: "Adami, Hu & Adams 2012, eq. 22",
        }
    }
}

impl<const D: usize> PointLaw<D> for RiemannWalls {
    const NAME: &'static str = "pressure of Riemann walls";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::DENSITY, Field::SOUND_SPEED]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    const SUMS: Outputs = PRESSED.union(Outputs::of(&[BEFORE]));
    const BEFORE: Fields = Fields::of(&[Field::VELOCITY]);
    const OF_WALLS: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (unity, before) = (at.sum(Output::UNITY), at.sum_vector(BEFORE));
        let (own, normal) = (at.vector(Field::VELOCITY), at.wall.normal);
        let mut inwards = L::zero();
        for d in 0..D {
            inwards += (before[d] / unity - own[d]) * normal[d];
        }
        let (density, sound_speed) = (at.get(Field::DENSITY), at.get(Field::SOUND_SPEED));
        press(
            at,
            at.wall.fall,
            riemann_push(inwards, density, sound_speed),
            self.floor,
        );
    }
}

/// What liquid that moves into a wall at the speed u adds to the pressure of its particles \[Pa\]: 2ρβu.
///
/// Pairs take the mean of both sides, so liquid feels p* = p + ρβu: the pressure between it and its mirror image of
/// speed −u, p + ½ρβ(u − (−u)), with the limiter β = min(3 (u − (−u)), c) of Zhang, Hu & Adams 2017, eqs. 13, 14.
/// Theirs is zero where liquid leaves; here it acts down to the floor of walls, or what has struck still bounces.
#[inline(always)]
fn riemann_push<L: Lane>(inwards: L, density: L, sound_speed: L) -> L {
    let closing = inwards + inwards;
    let limited = (L::of(Riemann::STANDARD.limiter) * closing.abs()).min(sound_speed);
    density * limited * closing
}

#[cfg(test)]
mod tests {
    use super::{HydrostaticWalls, riemann_push};
    use crate::prelude::*;

    /// A floor that is about to fly upwards under water of one pressure shows the water that pressure. The control is the wall
    /// law of the scheme, by which it shows ρ a times a good part of the smoothing length more.
    #[test]
    fn the_acceleration_of_a_wall_counts_where_it_is_asked_for() {
        let (spacing, acceleration, pressure) = (0.01, 1e6, 2e4);
        let scheme = schemes::weakly_compressible();
        let schemes: [Scheme<f64, 2>; 2] = [
            scheme.clone().walls(HydrostaticWalls::default()).compose(),
            scheme.compose(),
        ];
        let excess = schemes.map(|scheme| {
            let water = catalogue::weakly_compressible_water::<f64>(1.0);
            let density = water.eos().density_at(pressure, 0.0).unwrap();
            let water = Body::block("water", water, [0.0; 2], [0.2, 0.1], spacing).density(density);
            let floor = Body::<f64, 2>::block(
                "floor",
                catalogue::water(),
                [0.0, -0.04],
                [0.2, 0.0],
                spacing,
            );
            let up = move |order: i32| {
                move |t: f64| [0.0, acceleration * [0.5 * t * t, t, 1.0][order as usize]]
            };
            let floor = Wall::of("floor", floor.points().to_vec(), spacing)
                .motion(Translation::new(up(0), up(1), up(2)));
            let mut simulation = Scene::new(scheme).body(water).wall(floor).build().unwrap();
            simulation.evaluate().unwrap();
            let wall = simulation.wall("floor").unwrap();
            let below = wall.filter(|p| p.position()[1] > -spacing);
            below
                .map(|p| (p.pressure() - pressure).abs())
                .fold(0.0, f64::max)
        });
        let of_acceleration = 1000.0 * acceleration * spacing;
        assert!(excess[0] < 1e-6 * pressure, "{excess:?}");
        assert!(excess[1] > 0.5 * of_acceleration, "{excess:?}");
    }

    #[test]
    fn a_fast_impact_is_a_water_hammer_and_a_gentle_one_is_quadratic() {
        // Joukowsky 1898: what is stopped at once feels ρ c u; pairs take half of what a wall particle gets.
        let (density, sound_speed, fast) = (1000.0, 20.0, 4.0);
        let hammer = density * sound_speed * fast;
        assert_eq!(0.5 * riemann_push(fast, density, sound_speed), hammer);
        assert_eq!(0.5 * riemann_push(-fast, density, sound_speed), -hammer);
        // By hand from the paper's p* with states of 0.1 and −0.1 m/s: ½ · 1000 · (3 · 0.2) · 0.2 = 60 Pa.
        let gentle: f64 = 0.5 * riemann_push(0.1, density, sound_speed);
        assert!((gentle - 60.0).abs() < 1e-12, "{gentle}");
    }
}
