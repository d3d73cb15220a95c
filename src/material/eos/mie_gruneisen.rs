//! The Mie–Grüneisen law for shocked solids and liquids, on three forms of its reference curve.
//! p = (1 − Γη/2) p_H(η) + Γ ρ e, with η = ρ/ρ₀ − 1.

use super::guard::{LEAST_RATIO, Problems, compression, speed};
use super::{EosState, EquationOfState, Guards};
use crate::scalar::{Lane, Mask};

/// The form of the reference curve of [`MieGruneisen`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub enum Hugoniot {
    /// The third-order expansion of Lam, Shen & Gong, eqs. 4–6 (eq. 4 prints ρ for p on its left):
    ///
    #[doc = include_str!("../../../docs/equations/hugoniot_cubic.html")]
    ///
    /// Within 10⁻⁴ of the full curve at 5 % compression of copper, 0.7 % at 20 %.
    LamCubic,
    /// The full Hugoniot of u_s = C₀ + S u_p, eq. 12 of Lam, Shen & Gong:
    ///
    #[doc = include_str!("../../../docs/equations/hugoniot_full.html")]
    ///
    /// It has a pole at η = 1/(S−1), which no single shock can pass.
    Full,
    /// `*EOS_GRUNEISEN` of LS-DYNA, with u_s of third order in u_p/u_s and Γ varying with density:
    ///
    #[doc = include_str!("../../../docs/equations/hugoniot_ls_dyna.html")]
    ///
    /// With S₂ = S₃ = 0 and a = γ₀ it equals [`Full`](Self::Full) in compression.
    LsDyna {
        /// Second coefficient S₂ \[1\] of the shock line.
        s2: f64,
        /// Third coefficient S₃ \[1\] of the shock line.
        s3: f64,
        /// First-order volume correction a \[1\] to γ₀.
        a: f64,
    },
}

/// The Mie–Grüneisen law.
///
#[doc = include_str!("../../../docs/equations/mie_gruneisen.html")]
///
/// p_H \[Pa\] is the pressure behind a shock (form: [`Hugoniot`]), Γ \[1\] the Grüneisen parameter,
/// taken as constant, C₀ \[m/s\] and S \[1\] the line u_s = C₀ + S u_p. In expansion (η < 0) the
/// cubic goes on to η = −0.15 and along its tangent from there; the full curve, a fit of shocks, is
/// replaced by its tangent ρ₀C₀²η at once.
///
/// Guards. Beyond 0.8 of the pole, or 0.7 of the η where (1 − Γη/2) p_H vanishes, whichever is less
/// ([`compression_limit`](Self::compression_limit); 0.69 for copper), p goes on along its tangent in
/// η, no flatter than ρ₀C₀²/2 (`compression`). Where c² falls below 10⁻⁴ C₀² (cold compression or
/// wide expansion) c stays at 0.01 C₀ (`compression` or `expansion`). The cubic beyond η = −0.15
/// counts as `expansion`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "Given", into = "Given")
)]
pub struct MieGruneisen {
    reference_density: f64,
    sound_speed: f64,
    slope: f64,
    gruneisen: f64,
    form: Hugoniot,
    limit: f64,
}

/// The law without what follows from its numbers: what a file has of it.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "MieGruneisen", deny_unknown_fields)]
struct Given {
    reference_density: f64,
    sound_speed: f64,
    slope: f64,
    gruneisen: f64,
    form: Hugoniot,
}

#[cfg(feature = "serde")]
impl From<MieGruneisen> for Given {
    fn from(law: MieGruneisen) -> Self {
        Self {
            reference_density: law.reference_density,
            sound_speed: law.sound_speed,
            slope: law.slope,
            gruneisen: law.gruneisen,
            form: law.form,
        }
    }
}

#[cfg(feature = "serde")]
impl From<Given> for MieGruneisen {
    fn from(own: Given) -> Self {
        let law = Self::new(
            own.reference_density,
            own.sound_speed,
            own.slope,
            own.gruneisen,
        );
        law.with_form(own.form)
    }
}

/// Expansion η down to which the cubic is followed; its slope turns over near −0.3 (steel of Lam et al.).
const LEAST_OF_CUBIC: f64 = -0.15;

impl MieGruneisen {
    /// ρ₀ \[kg/m³\], C₀ \[m/s\], S \[1\] and Γ \[1\] on the full Hugoniot, the form that is valid widest.
    #[must_use]
    pub fn new(reference_density: f64, sound_speed: f64, slope: f64, gruneisen: f64) -> Self {
        let full = Self {
            reference_density,
            sound_speed,
            slope,
            gruneisen,
            form: Hugoniot::Full,
            limit: 0.0,
        };
        full.with_form(Hugoniot::Full)
    }

    /// The same on another form of the reference curve.
    #[must_use]
    pub fn with_form(mut self, form: Hugoniot) -> Self {
        self.form = form;
        let pole = self.first_root(|law, eta| law.factors(eta).1);
        let zero = self.first_root(|law, eta| law.factors(eta).0);
        self.limit = (0.8 * pole).min(0.7 * zero);
        self
    }

    /// The form of the reference curve.
    #[must_use]
    pub const fn form(&self) -> Hugoniot {
        self.form
    }
    /// Sound speed C₀ \[m/s\] at rest.
    #[must_use]
    pub const fn sound_speed(&self) -> f64 {
        self.sound_speed
    }
    /// Slope S \[1\] of the shock line.
    #[must_use]
    pub const fn slope(&self) -> f64 {
        self.slope
    }
    /// Grüneisen parameter Γ \[1\] at ρ₀.
    #[must_use]
    pub const fn gruneisen(&self) -> f64 {
        self.gruneisen
    }
    /// The compression η \[1\] beyond which the law goes on along its tangent.
    #[must_use]
    pub const fn compression_limit(&self) -> f64 {
        self.limit
    }
    /// The pole η* \[1\] of the curve: 1/(S−1), infinite if S ≤ 1 and for the cubic.
    #[must_use]
    pub fn pole(&self) -> f64 {
        match self.form {
            Hugoniot::LamCubic => f64::INFINITY,
            Hugoniot::Full if self.slope > 1.0 => 1.0 / (self.slope - 1.0),
            Hugoniot::Full => f64::INFINITY,
            Hugoniot::LsDyna { .. } => self.first_root(|law, eta| law.factors(eta).1),
        }
    }
    /// The plain Hugoniot pressure p_H \[Pa\] at η ≥ 0, without guards.
    #[must_use]
    pub fn hugoniot_pressure(&self, eta: f64) -> f64 {
        let (numerator, denominator, ..) = self.factors(eta);
        let stiffness = self.reference_density * self.sound_speed * self.sound_speed;
        let factor = match self.form {
            Hugoniot::LsDyna { a, .. } => {
                1.0 + (1.0 - 0.5 * self.gruneisen) * eta - 0.5 * a * eta * eta
            }
            _ => 1.0 - 0.5 * self.gruneisen * eta,
        };
        let without_energy = match self.form {
            Hugoniot::LamCubic => numerator / factor,
            Hugoniot::Full => 1.0 + eta,
            Hugoniot::LsDyna { .. } => numerator * (1.0 + eta) / factor,
        };
        stiffness * eta * without_energy / (denominator * denominator)
    }

    /// The first zero between 0 and 10, found by stepping and bisection; 10 if there is none.
    fn first_root(&self, f: impl Fn(&Self, f64) -> f64) -> f64 {
        let step = 1e-2;
        let inside = |eta: f64| f(self, eta) > 0.0;
        let end = (1..=1000)
            .map(|k| step * f64::from(k))
            .find(|&eta| !inside(eta));
        let Some(mut high) = end else { return 10.0 };
        let mut low = high - step;
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if inside(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// N, D, N′, D′ of the part without energy, ρ₀C₀² η N(η)/D(η)², for η ≥ 0.
    #[inline(always)]
    fn factors<L: Lane>(&self, eta: L) -> (L, L, L, L) {
        let k = self.slope - 1.0;
        let half = 0.5 * self.gruneisen;
        let (one, two) = (L::one(), L::of(2.0));
        match self.form {
            Hugoniot::LamCubic => {
                let (b, c) = (L::of(1.0 + 2.0 * k), L::of(2.0 * k + 3.0 * k * k));
                let curve = c.mul_add(eta, b).mul_add(eta, one);
                let curve_slope = (c * two).mul_add(eta, b);
                let factor = eta.mul_add(L::of(-half), one);
                let slope = curve_slope.mul_add(factor, curve * L::of(-half));
                (curve * factor, one, slope, L::zero())
            }
            Hugoniot::Full => {
                let (b, c) = (L::of(1.0 - half), L::of(-half));
                let numerator = c.mul_add(eta, b).mul_add(eta, one);
                let denominator = eta.mul_add(L::of(-k), one);
                (numerator, denominator, (c * two).mul_add(eta, b), L::of(-k))
            }
            Hugoniot::LsDyna { s2, s3, a } => {
                let (b, c) = (L::of(1.0 - half), L::of(-0.5 * a));
                let numerator = c.mul_add(eta, b).mul_add(eta, one);
                // With x = η/(1+η): η²/(1+η) = ηx, η³/(1+η)² = ηx², dx/dη = 1/(1+η)².
                let share = one / (eta + one);
                let x = eta * share;
                let (s2, s3) = (L::of(s2), L::of(s3));
                let line = s3.mul_add(x, s2).mul_add(x, L::of(k));
                let line_slope = (s3 * two).mul_add(x, s2) * share * share;
                let denominator = one - eta * line;
                let denominator_slope = -(eta.mul_add(line_slope, line));
                (
                    numerator,
                    denominator,
                    (c * two).mul_add(eta, b),
                    denominator_slope,
                )
            }
        }
    }

    /// The part of p/(ρ₀C₀²) without energy, and its derivative with η.
    #[inline(always)]
    fn cold<L: Lane>(&self, eta: L) -> (L, L) {
        // The cubic is a polynomial and goes on into tension; the full curves are fits of shocks.
        let least = match self.form {
            Hugoniot::LamCubic => LEAST_OF_CUBIC,
            _ => 0.0,
        };
        let inside = eta.max(L::of(least));
        let (n, d, n_slope, d_slope) = self.factors(inside);
        let inverse = d.recip();
        let square = inverse * inverse;
        let value = inside * n * square;
        let slope =
            (inside.mul_add(n_slope, n) - L::of(2.0) * inside * n * d_slope * inverse) * square;
        let bend = match self.form {
            Hugoniot::Full => -0.5 * self.gruneisen,
            _ => 0.0,
        };
        let tension = eta - inside;
        let stretched = tension * tension.mul_add(L::of(bend), slope);
        let stretched_slope = tension.mul_add(L::of(2.0 * bend), slope);
        let in_tension = tension.lt(L::zero());
        (
            value + stretched,
            L::select(in_tension, stretched_slope, slope),
        )
    }
}

impl EquationOfState for MieGruneisen {
    fn name(&self) -> &'static str {
        match self.form {
            Hugoniot::LamCubic => "Mie-Grüneisen, cubic",
            Hugoniot::Full => "Mie-Grüneisen, full Hugoniot",
            Hugoniot::LsDyna { .. } => "Mie-Grüneisen, LS-DYNA",
        }
    }
    fn reference_density(&self) -> f64 {
        self.reference_density
    }
    fn uses_energy(&self) -> bool {
        self.gruneisen != 0.0 || matches!(self.form, Hugoniot::LsDyna { a, .. } if a != 0.0)
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let limit = L::of(self.limit);
        let plain = compression(density, self.reference_density);
        let eta = plain.max(-L::one());
        let held = eta.min(limit);
        let beyond = eta - held;
        let over = eta.gt(limit);

        let stiffness = L::of(self.reference_density * self.sound_speed * self.sound_speed);
        let (cold, cold_slope) = self.cold(held);
        let thermal_slope = match self.form {
            Hugoniot::LsDyna { a, .. } => L::of(a),
            _ => L::of(self.gruneisen),
        };
        let thermal = held.mul_add(thermal_slope, L::of(self.gruneisen));
        let volume_energy = energy * L::of(self.reference_density);

        let tangent = stiffness.mul_add(cold_slope, thermal_slope * volume_energy);
        let slope = L::select(over, tangent.max(stiffness * L::of(0.5)), tangent);
        let pressure = slope.mul_add(beyond, stiffness.mul_add(cold, thermal * volume_energy));

        let by_energy = beyond.mul_add(thermal_slope, thermal);
        let ratio = (eta + L::one()).max(L::of(LEAST_RATIO));
        let squared =
            (pressure * by_energy / (ratio * ratio) + slope) * L::of(1.0 / self.reference_density);
        let (sound_speed, slow) = speed(squared, self.sound_speed);
        let stretched = plain.lt(L::zero());
        let least = match self.form {
            Hugoniot::LamCubic => LEAST_OF_CUBIC,
            _ => -1.0,
        };
        EosState {
            pressure,
            sound_speed,
            guards: Guards {
                compression: over | (slow & !stretched),
                expansion: plain.lt(L::of(least)) | (slow & stretched),
                cut_off: L::Mask::all_of(false),
            },
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Problems::default()
            .positive("reference_density", self.reference_density)
            .positive("sound_speed", self.sound_speed)
            .must(
                (0.0..10.0).contains(&self.slope),
                "slope",
                self.slope,
                "between 0 and 10",
            )
            .must(
                (0.0..10.0).contains(&self.gruneisen),
                "gruneisen",
                self.gruneisen,
                "between 0 and 10",
            );
        if let Hugoniot::LsDyna { s2, s3, a } = self.form {
            problems = problems.finite("s2", s2).finite("s3", s3).finite("a", a);
        }
        problems.list()
    }
}
