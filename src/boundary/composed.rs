//! Motions that follow each other: sums of translations, products of rotations.
//! A later motion moves what the earlier ones have moved.

use super::{Motion, Pose};

/// Motions one after the other, each in axes and about centres that stay in space: x = A₂ (A₁ X + b₁) + b₂.
///
/// Translations add up in any order. Rotations multiply, and the order counts: a hull that rolls about its own axis
/// while it heaves rolls first.
///
/// ```
/// use meshfree::boundary::{Composed, Motion, Rotation, Translation};
/// let roll = Rotation::about([1.0, 0.0], |t| [0.2 * t, 0.2, 0.0]);
/// let hull = Composed::of(roll).then(Translation::steady([0.0, 0.5]));
/// // Its centre heaves, and does not know that the hull rolls.
/// assert_eq!(hull.pose(2.0).of(0, &[1.0, 0.0]), [1.0, 1.0]);
/// assert_eq!(hull.pose(2.0).of(1, &[1.0, 0.0]), [0.0, 0.5]);
/// ```
pub struct Composed<const D: usize> {
    motions: Vec<Box<dyn Motion<D>>>,
}

impl<const D: usize> Composed<D> {
    /// The motion that comes first.
    #[must_use]
    pub fn of(first: impl Motion<D> + 'static) -> Self {
        Self {
            motions: vec![Box::new(first)],
        }
    }

    /// A motion of what the ones before have moved.
    #[must_use]
    pub fn then(mut self, next: impl Motion<D> + 'static) -> Self {
        self.motions.push(Box::new(next));
        self
    }
}

impl<const D: usize> Motion<D> for Composed<D> {
    fn name(&self) -> String {
        let names: Vec<String> = self.motions.iter().map(|own| own.name()).collect();
        names.join(", then ")
    }
    fn pose(&self, time: f64) -> Pose<D> {
        self.pose_from(&[0.0; D], time)
    }
    fn pose_from(&self, origin: &[f64; D], time: f64) -> Pose<D> {
        let poses = self.motions.iter().map(|own| own.pose_from(origin, time));
        poses
            .reduce(|before, next| before.then(&next))
            .unwrap_or_else(Pose::rest)
    }
    fn span(&self) -> [f64; 2] {
        let spans = self.motions.iter().map(|own| own.span());
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        spans.fold(all, |[from, to], own| [from.max(own[0]), to.min(own[1])])
    }
    fn resolution(&self) -> Option<f64> {
        let all = self.motions.iter().filter_map(|own| own.resolution());
        all.reduce(f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::super::motion::tests::derivatives_agree;
    use super::super::{Crush, Recorded, Rotation, Translation};
    use super::*;
    use approx::assert_relative_eq;

    fn wave(t: f64) -> [f64; 3] {
        [t.sin(), t.cos(), -t.sin()]
    }

    #[test]
    fn a_product_of_motions_has_its_own_derivatives() {
        let swing = Translation::new(
            |t| [t.sin(), 0.0, t],
            |t| [t.cos(), 0.0, 1.0],
            |t| [-t.sin(), 0.0, 0.0],
        );
        let turn = Rotation::about_axis([0.2, -0.1, 3.0], [1.0, 2.0, -2.0], wave).unwrap();
        let all = Composed::of(Crush::along(1, 0.4, wave))
            .then(turn)
            .then(swing)
            .then(Rotation::about([1.0, 0.0, 0.0], wave));
        derivatives_agree(&all, [1.0, 0.5, 2.0]);
    }

    #[test]
    fn translations_add_up_and_rotations_multiply_in_order() {
        let x = Rotation::about_axis([0.0; 3], [1.0, 0.0, 0.0], |_| [1.2, 0.0, 0.0]);
        let z = || Rotation::about([0.0; 3], |_| [0.4, 0.0, 0.0]);
        let a = Composed::of(z()).then(x.unwrap());
        let first = z().pose(0.0).of(0, &[1.0, 0.0, 0.0]);
        let (sin, cos) = 1.2_f64.sin_cos();
        let turned = [
            first[0],
            cos * first[1] - sin * first[2],
            sin * first[1] + cos * first[2],
        ];
        let own = a.pose(0.0).of(0, &[1.0, 0.0, 0.0]);
        assert_relative_eq!(own.as_slice(), turned.as_slice(), max_relative = 1e-14);
        let steady = |v: f64| Translation::steady([v]);
        let sum = Composed::of(steady(1.0)).then(steady(2.0));
        assert_eq!(sum.pose(3.0).of(0, &[0.5]), [9.5]);
    }

    /// A scene that is moved by a power of two has the bits of the one that is not.
    #[test]
    fn the_place_of_a_scene_changes_no_bit() {
        let rows: Vec<_> = (0..9)
            .map(|k| (f64::from(k), [f64::from(k * k) * 0.01, 0.3]))
            .collect();
        let angles: Vec<_> = rows.iter().map(|&(t, [x, _])| (t, x)).collect();
        let motion = |far: f64| {
            let turn = Recorded::rotation([far + 0.25, 0.5], &angles).unwrap();
            Composed::of(turn).then(Recorded::translation(&rows).unwrap())
        };
        let far = 2.0_f64.powi(20);
        let here = motion(0.0).pose_from(&[0.0, 0.0], 3.3);
        assert_eq!(motion(far).pose_from(&[far, 0.0], 3.3), here);
    }
}
