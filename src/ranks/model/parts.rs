//! Ghosts of a rank by the surface of its part: a box of the scene, cut along its longest sides.
//! The crate cuts a space-filling curve, whose parts have other ghosts than boxes, by a factor that is counted.

/// Particles that are cut among ranks: those that move by forces, or all others, of bodies that share a scheme.
///
/// A rank has a box of them. The box of all has sides L; the longest are cut until there are P boxes, so that cut sides l = L/f are
/// equal. Ghosts are the b particles within reach r of such a box, and those that lists of the other kind name, which may be the same:
///
/// ```text
/// b = n/ΠL (Π min(L, l + m r) − Π l),   m = 2 (1 − 1/f),  and 2 min(1, f − 1) along a period
/// g = s (b + a/P − b a/(n (P − 1)))
/// ```
///
/// with n particles, the mean number m of neighbouring boxes along an axis, a particles in all lists of the other kind, none of which are
/// taken to be of the same rank, for each kind is cut by itself, and how many more ghosts s parts of the curve have than that on about P
/// ranks. One rank has no ghosts.
///
/// ```
/// use meshfree::ranks::RankParts;
/// // A channel of 20 by 1600 particles on two ranks: a face of 20 particles, four deep.
/// let channel = RankParts {
///     particles: 32_000.0,
///     sides: vec![16.0, 0.2],
///     periodic: vec![false; 2],
///     reach: 0.04,
///     across: 0.0,
///     over_boxes: [1.0; 3],
/// };
/// assert!((channel.ghosts(2) - 80.0).abs() < 1e-9);
/// assert!(channel.ghosts(1).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RankParts {
    /// How many there are.
    pub particles: f64,
    /// Sides L of the box around them \[m\].
    pub sides: Vec<f64>,
    /// Whether there is a period along each side.
    pub periodic: Vec<bool>,
    /// How far lists reach beyond a particle \[m\]: support and skin; zero if lists name none of their own kind.
    pub reach: f64,
    /// Particles a of these that the lists of the other kind name.
    pub across: f64,
    /// How many more ghosts s parts of the curve have than boxes, on two, four, and eight ranks or more.
    pub over_boxes: [f64; 3],
}

impl RankParts {
    /// Ghosts of a rank, on so many ranks.
    #[must_use]
    pub fn ghosts(&self, ranks: usize) -> f64 {
        let count = ranks.max(1) as f64;
        let (mut whole, mut own, mut outer) = (1.0, 1.0, 1.0);
        for (axis, side) in self.sides.iter().enumerate() {
            let cuts = self.cuts(count)[axis];
            let is_periodic = self.periodic.get(axis).copied().unwrap_or(false);
            let near = if is_periodic {
                2.0 * (cuts - 1.0).min(1.0)
            } else {
                2.0 * (1.0 - 1.0 / cuts)
            };
            whole *= side;
            own *= side / cuts;
            outer *= (side / cuts + near * self.reach).min(*side);
        }
        let beside = if whole > 0.0 {
            self.particles / whole * (outer - own)
        } else {
            0.0
        };
        let (others, named) = (self.particles * (1.0 - 1.0 / count), self.across / count);
        if others > 0.0 {
            let doublings = (count.log2().round() as usize).clamp(1, 3);
            let ghosts = beside + named - beside * named / others;
            // There are no more than others have.
            (self.over_boxes[doublings - 1] * ghosts).min(others)
        } else {
            0.0
        }
    }

    /// Into how many boxes each side is cut.
    fn cuts(&self, ranks: f64) -> Vec<f64> {
        let mut order: Vec<usize> = (0..self.sides.len()).collect();
        order.sort_by(|a, b| self.sides[*b].total_cmp(&self.sides[*a]));
        let mut cuts = vec![1.0; self.sides.len()];
        for cut in (1..=order.len()).rev() {
            let longest = &order[..cut];
            let product: f64 = longest.iter().map(|&axis| self.sides[axis]).product();
            let side = (product / ranks).powf(1.0 / cut as f64);
            if cut == 1 || self.sides[longest[cut - 1]] >= side {
                for &axis in longest {
                    cuts[axis] = (self.sides[axis] / side).max(1.0);
                }
                break;
            }
        }
        cuts
    }

    pub(super) fn of_more(self, times: f64) -> Self {
        let dimensions = self.sides.len().max(1) as f64;
        let longer = times.powf(1.0 / dimensions);
        Self {
            particles: self.particles * times,
            sides: self.sides.iter().map(|side| side * longer).collect(),
            across: self.across * times / longer,
            ..self
        }
    }
}
