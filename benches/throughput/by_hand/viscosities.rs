//! Artificial viscosities beside the pressure force, written out by hand for each law, and the rows of their table.
//! Every law divides a pair once; what a particle's own velocity gradient says of it is found once a row, or once for all lanes.

use super::by_hand::{Apart, MOST, Record, Written, norm, parting, places, row};
use super::lattice::H;
use meshfree::particles::{Field, Output};
use meshfree::scalar::Lane;
use meshfree::term::viscosity::{
    Balsara, CullenDehnen, LimitedMonaghanGingold, MonaghanGingold, MorrisMonaghan, Riemann,
    SignalVelocity,
};
use meshfree::term::{ArtificialViscosity, PressureForce, Viscosity};

/// The laws.
const PLAIN: u8 = 0;
const LIMITED: u8 = 1;
const SIGNAL: u8 = 2;
const BALSARA: u8 = 3;
const MORRIS_MONAGHAN: u8 = 4;
const CULLEN_DEHNEN: u8 = 5;
const RIEMANN: u8 = 6;

/// Where the sums are, behind the force.
const SPEED: usize = 3;
const LARGEST: usize = 4;
const SIGN: usize = 5;
const UNITY: usize = 6;

#[derive(Clone, Copy)]
struct Viscous<const LAW: u8>;

/// Coefficients α and β, the latter over α where particles have their own.
const fn coefficients(law: u8) -> [f64; 2] {
    match law {
        LIMITED => {
            let own = LimitedMonaghanGingold::STANDARD;
            [own.alpha, own.beta]
        }
        SIGNAL => {
            let own = SignalVelocity::STANDARD;
            [own.alpha, own.beta]
        }
        BALSARA => [Balsara::STANDARD.alpha, Balsara::STANDARD.beta],
        MORRIS_MONAGHAN => [0.5, MorrisMonaghan::STANDARD.beta_over_alpha],
        CULLEN_DEHNEN => [0.5, CullenDehnen::STANDARD.beta_over_alpha],
        RIEMANN => [Riemann::STANDARD.alpha, 0.0],
        _ => [
            MonaghanGingold::STANDARD.alpha,
            MonaghanGingold::STANDARD.beta,
        ],
    }
}

/// |∇·v|/(|∇·v| + |∇×v| + noise) of a velocity gradient, row by row, and a sound speed.
#[inline(always)]
fn share_of_compression<L: Lane>(gradient: &[L], sound_speed: L) -> L {
    let divergence = (gradient[0] + gradient[4] + gradient[8]).abs();
    let (x, y, z) = (
        gradient[7] - gradient[5],
        gradient[2] - gradient[6],
        gradient[3] - gradient[1],
    );
    let curl = z.mul_add(z, y.mul_add(y, x * x)).sqrt();
    divergence / sound_speed.mul_add(L::of(1e-4 / H), divergence + curl)
}

impl<const LAW: u8> Written for Viscous<LAW> {
    fn outputs() -> Vec<(Output, usize)> {
        let count = usize::from(LAW == CULLEN_DEHNEN);
        vec![
            (Output::FORCE, 3),
            (Output::SIGNAL, 1),
            (Output::SIGNAL_SPEED, count),
            (Output::DIVERGENCE_SIGN, count),
            (Output::UNITY, count),
        ]
    }
    #[inline(always)]
    fn prepare<Row: Lane<Scalar = f64>, R: Record>(&self, own: &mut [Row; MOST]) {
        let [c, g] = const { places::<R, 2>([Field::SOUND_SPEED, Field::VELOCITY_GRADIENT]) };
        if LAW == LIMITED {
            for (one, other) in [(1, 3), (2, 6), (5, 7)] {
                own[g + one] = own[g + one] + own[g + other];
            }
        }
        if LAW == BALSARA {
            own[g] = share_of_compression(&own[g..g + 9], own[c]);
        }
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [m, rho, c, weight, coefficient] = const {
            places::<R, 5>([
                Field::MASS,
                Field::DENSITY,
                Field::SOUND_SPEED,
                Field::WEIGHT,
                Field::PRESSURE_COEFFICIENT,
            ])
        };
        let [g, own_alpha, divergence] = const {
            places::<R, 3>([
                Field::VELOCITY_GRADIENT,
                Field::VISCOSITY_COEFFICIENT,
                Field::DIVERGENCE,
            ])
        };
        let [alpha, beta] = const { coefficients(LAW) };
        let Apart { r, d2, shape, f } = *apart;
        let (_, vr) = parting::<Row, R>(&r, own, other);
        let sounds = own[c] + Row::splat(other[c]);
        let densities = own[rho] + Row::splat(other[rho]);
        let inside = f.lt(Row::zero());
        let over_h = d2.mul_add(Row::splat(1.0 / H), Row::splat(0.01 * H));
        let root = (d2 + Row::splat(1e-6 * H * H)).sqrt();
        // Of Π and the speed by which a pair slows the step.
        let (pi, speed);
        if LAW == SIGNAL {
            let closing = (-vr).positive_part();
            let over = closing / (root * densities);
            let signal = (over * densities).mul_add(Row::splat(beta), sounds) * Row::splat(alpha);
            pi = signal * over;
            speed = signal * Row::splat(0.3);
        } else if LAW == RIEMANN {
            let closing = (-vr).positive_part();
            let impedances = own[rho].mul_add(own[c], Row::splat(other[rho] * other[c]));
            let over = closing / (root * sounds * impedances);
            let limited = over * impedances * Row::splat(2.0 * Riemann::STANDARD.limiter);
            let share = limited.min(Row::one()) * Row::splat(alpha);
            let sides = own[c] * Row::splat(2.0 * other[c]) * sounds;
            pi = share * over * sides;
            speed = share * sounds * Row::splat(0.3);
        } else {
            let (mut approach, mut below) = (vr.min(Row::zero()), over_h * densities);
            let mut over_root = Row::zero();
            if LAW == LIMITED {
                let mut products = [Row::zero(); 6];
                let mut k = 0;
                for a in 0..3 {
                    for b in a..3 {
                        products[k] = r[a] * r[b];
                        k += 1;
                    }
                }
                let (mut mine, mut its) = (Row::zero(), Row::zero());
                for (k, at) in [0, 1, 2, 4, 5, 8].into_iter().enumerate() {
                    let across = [0, 3, 6, 0, 7, 0][k];
                    let mut both = other[g + at];
                    if across != 0 {
                        both += other[g + across];
                    }
                    mine = own[g + at].mul_add(products[k], mine);
                    its = Row::splat(both).mul_add(products[k], its);
                }
                // The limiter is min(1, 2 small/large), and its quotient one with that of Π.
                let same = (mine * its).gt(Row::zero());
                let large = Row::select(same, mine.abs().max(its.abs()), Row::one());
                let small = Row::select(same, mine.abs().min(its.abs()), Row::zero());
                let share = small.min(large * Row::splat(0.5));
                let left = vr.mul_add(large, -(share * (mine + its)));
                let kept = (left * vr).gt(Row::zero());
                approach = Row::select(kept, left, Row::zero()).min(Row::zero());
                below = below * large;
            }
            let mut over = approach / below;
            if LAW == CULLEN_DEHNEN {
                let both = approach / (below * root);
                over = both * root;
                over_root = both * below;
            }
            let mu = over * densities;
            let own_coefficients = LAW == MORRIS_MONAGHAN || LAW == CULLEN_DEHNEN;
            let alphas = if own_coefficients {
                (own[own_alpha] + Row::splat(other[own_alpha])) * Row::splat(alpha)
            } else {
                Row::splat(alpha)
            };
            let quadratic = if own_coefficients {
                alphas * Row::splat(2.0 * beta)
            } else {
                Row::splat(2.0 * beta)
            };
            let linear = alphas * sounds;
            let pressed = quadratic * mu;
            let mut signal = linear.mul_add(Row::splat(0.3), -pressed);
            let mut dissipated = over * (pressed - linear);
            if LAW == BALSARA {
                let its = share_of_compression(&other[g..g + 9], other[c]);
                let share = (own[g] + Row::splat(its)) * Row::splat(0.5);
                dissipated = dissipated * share;
                signal = signal * share;
            }
            if LAW == CULLEN_DEHNEN {
                let meeting = sounds.mul_add(Row::splat(0.5), -over_root);
                let meeting = Row::select(inside, meeting, Row::zero());
                sums[LARGEST] = sums[LARGEST].max(meeting);
                let volume = other[m] / other[rho];
                let turn = other[divergence];
                let sign = f64::from(i8::from(turn > 0.0) - i8::from(turn < 0.0));
                sums[SIGN] = shape.mul_add(Row::splat(volume * sign), sums[SIGN]);
                sums[UNITY] = shape.mul_add(Row::splat(volume), sums[UNITY]);
            }
            pi = dissipated;
            speed = signal;
        }
        sums[SPEED] = sums[SPEED].max(Row::select(inside, speed, Row::zero()));
        let pressures = own[coefficient] + Row::splat(other[coefficient]);
        let weights = own[weight] * Row::splat(other[weight]);
        let masses = own[m] * Row::splat(other[m]);
        let radial = -(masses.mul_add(pi, weights * pressures) * f);
        for d in 0..3 {
            sums[d] = radial.mul_add(r[d], sums[d]);
        }
    }
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        let mut finished = *sums;
        for sum in &mut finished[SIGN..=UNITY] {
            *sum = *sum * Row::splat(norm() / H.powi(3));
        }
        finished
    }
}

fn law<V: ArtificialViscosity<3>, const LAW: u8>(name: &str, law: V, side: usize, turns: usize) {
    let terms = (PressureForce, Viscosity(law));
    row(name, terms, Viscous::<LAW>, side, turns);
}

/// The laws, each with the pressure force.
pub fn table(side: usize, turns: usize) {
    law::<_, PLAIN>(
        "viscosity, quadratic too",
        MonaghanGingold::STANDARD,
        side,
        turns,
    );
    law::<_, LIMITED>(
        "limited viscosity",
        LimitedMonaghanGingold::STANDARD,
        side,
        turns,
    );
    law::<_, SIGNAL>("signal velocity", SignalVelocity::STANDARD, side, turns);
    law::<_, BALSARA>("Balsara", Balsara::STANDARD, side, turns);
    let own = MorrisMonaghan::STANDARD;
    law::<_, MORRIS_MONAGHAN>("Morris and Monaghan", own, side, turns);
    law::<_, CULLEN_DEHNEN>("Cullen and Dehnen", CullenDehnen::STANDARD, side, turns);
    law::<_, RIEMANN>("Riemann viscosity", Riemann::STANDARD, side, turns);
}
