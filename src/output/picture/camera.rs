//! The camera: from places in metres to pixels, along parallel rays.
//! What it shows is fitted to the picture once all of it is known.

/// A place \[m\], or pixels to the right, down, and towards the viewer.
pub(super) type Point = [f64; 3];

/// The part of the picture's sides that is filled.
const FILLED: f64 = 0.96;

/// The eight corners of a box.
pub(super) fn corners(ends: [Point; 2]) -> impl Iterator<Item = Point> {
    (0..8).map(move |i| core::array::from_fn(|axis| ends[i >> axis & 1][axis]))
}

/// The twelve edges of a box, or the four of a rectangle.
pub(super) fn edges(ends: [Point; 2]) -> Vec<[Point; 2]> {
    let mut edges = Vec::new();
    for axis in 0..3 {
        for mut from in corners([ends[0], ends[1]]) {
            let mut to = from;
            (from[axis], to[axis]) = (ends[0][axis], ends[1][axis]);
            if from != to && !edges.contains(&[from, to]) {
                edges.push([from, to]);
            }
        }
    }
    edges
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Where the viewer's right, down and towards are, and how large a metre is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    axes: [Point; 3],
    /// The extent of what is shown, along the axes \[m\].
    low: Point,
    high: Point,
    /// Pixels a metre.
    pub(super) scale: f64,
    /// What the middle of the extent becomes \[pixels\].
    middle: Point,
}

impl Camera {
    /// A camera at azimuth and elevation \[degrees\].
    pub(super) fn new((azimuth, elevation): (f64, f64)) -> Self {
        let ((sa, ca), (se, ce)) = (
            azimuth.to_radians().sin_cos(),
            elevation.to_radians().sin_cos(),
        );
        Self {
            axes: [
                [-sa, ca, 0.0],
                [se * ca, se * sa, -ce],
                [ce * ca, ce * sa, se],
            ],
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            scale: 1.0,
            middle: [0.0; 3],
        }
    }

    /// Widens what is shown by a sphere.
    pub(super) fn include(&mut self, at: Point, radius: f64) {
        for (axis, direction) in self.axes.iter().enumerate() {
            let along = dot(*direction, at);
            self.low[axis] = self.low[axis].min(along - radius);
            self.high[axis] = self.high[axis].max(along + radius);
        }
    }

    /// Fits what is shown into a picture of this size; says no if that has no extent.
    pub(super) fn fit(&mut self, width: f64, height: f64) -> bool {
        let across = FILLED * width / (self.high[0] - self.low[0]);
        let down = FILLED * height / (self.high[1] - self.low[1]);
        // An extent of zero along one of them leaves the choice to the other.
        self.scale = across.min(down);
        self.middle = [0.5 * width, 0.5 * height, 0.0];
        self.low[0] <= self.high[0] && self.scale.is_normal()
    }

    /// The coordinate along which the picture goes to a side (0 right, 1 down), if that is one of x, y and z.
    pub(super) fn along(&self, side: usize) -> Option<usize> {
        (0..3).find(|axis| self.axes[side][*axis].abs() > 1.0 - 1e-9)
    }

    /// Where a value \[m\] of the coordinate along a side is \[pixels\].
    pub(super) fn pixel(&self, side: usize, value: f64) -> f64 {
        let sign: f64 = self.axes[side].iter().sum();
        let middle = 0.5 * (self.low[side] + self.high[side]);
        self.middle[side] + self.scale * (sign.signum() * value - middle)
    }

    /// The value \[m\] of that coordinate at a pixel.
    pub(super) fn coordinate(&self, side: usize, pixel: f64) -> f64 {
        let sign: f64 = self.axes[side].iter().sum();
        let middle = 0.5 * (self.low[side] + self.high[side]);
        sign.signum() * ((pixel - self.middle[side]) / self.scale + middle)
    }

    /// How far right and down a metre along x, y or z goes.
    pub(super) fn direction(&self, axis: usize) -> [f64; 2] {
        [0, 1].map(|side| self.axes[side][axis])
    }

    /// Where a place is in the picture.
    pub(super) fn place(&self, at: Point) -> Point {
        core::array::from_fn(|axis| {
            let middle = 0.5 * (self.low[axis] + self.high[axis]);
            self.middle[axis] + self.scale * (dot(self.axes[axis], at) - middle)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(view: (f64, f64)) -> Camera {
        let mut camera = Camera::new(view);
        corners([[-1.0; 3], [1.0; 3]]).for_each(|corner| camera.include(corner, 0.0));
        assert!(camera.fit(400.0, 200.0));
        camera
    }

    fn assert_near(a: Point, b: Point) {
        assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-9), "{a:?} {b:?}");
    }

    #[test]
    fn views_along_axes_show_the_other_two() {
        // 0.96 of 200 pixels for 2 metres.
        let above = fitted((-90.0, 90.0));
        assert_near(above.place([0.0; 3]), [200.0, 100.0, 0.0]);
        assert_near(above.place([1.0, 0.5, 0.25]), [296.0, 52.0, 24.0]);
        let front = fitted((-90.0, 0.0));
        assert_near(front.place([1.0, 0.5, 0.25]), [296.0, 76.0, -48.0]);
        let right = fitted((0.0, 0.0));
        assert_near(right.place([1.0, 0.5, 0.25]), [248.0, 76.0, 96.0]);
    }

    #[test]
    fn any_view_keeps_lengths_and_what_is_above_above() {
        let camera = fitted((-60.0, 20.0));
        let [o, up, p] = [[0.0; 3], [0.0, 0.0, 0.7], [0.3, -0.5, 0.4]].map(|at| camera.place(at));
        let length = (0..3).map(|i| (p[i] - o[i]).powi(2)).sum::<f64>().sqrt();
        assert!((length / camera.scale - 0.5_f64.sqrt()).abs() < 1e-12);
        assert!(up[1] < o[1] && (up[0] - o[0]).abs() < 1e-9);
        // Each corner is in the picture, and one at least reaches what is filled.
        let places = corners([[-1.0; 3], [1.0; 3]]).map(|corner| camera.place(corner));
        let top = places.map(|place| place[1]).fold(f64::INFINITY, f64::min);
        assert!((top - 4.0).abs() < 1e-9, "{top}");
    }

    #[test]
    fn boxes_have_twelve_edges_and_rectangles_four() {
        let count = |high| edges([[0.0; 3], high]).len();
        assert_eq!([[1.0, 2.0, 3.0], [1.0, 2.0, 0.0]].map(count), [12, 4]);
        let length = |[a, b]: &[Point; 2]| (0..3).map(|i| b[i] - a[i]).sum::<f64>();
        let all = edges([[0.0; 3], [1.0, 2.0, 3.0]]);
        assert_eq!(all.iter().map(length).sum::<f64>(), 24.0);
    }

    #[test]
    fn what_has_no_extent_is_not_fitted() {
        let mut camera = Camera::new((0.0, 0.0));
        assert!(!camera.fit(10.0, 10.0));
        camera.include([1.0; 3], 0.0);
        assert!(!camera.fit(10.0, 10.0));
        camera.include([1.0, 2.0, 1.0], 0.0);
        assert!(camera.fit(10.0, 10.0));
    }
}
