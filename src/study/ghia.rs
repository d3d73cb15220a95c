//! Velocities on the centre lines of a lid-driven square cavity, as Ghia, Ghia & Shin print them.
//! The accepted reference for incompressible flow with walls, computed on 129 by 129 points.
//!
//! Liquid fills a square of side L \[m\]; its lid at y = L slides along x with U \[m/s\]; the
//! Reynolds number is UL/ν. Places are in units of L, velocities of U. U. Ghia, K. N. Ghia, C. T.
//! Shin, *Journal of Computational Physics* 48 (1982) 387–411, Tables I and II, at Reynolds numbers
//! of 100 and 1000. They are those of a scheme of second order: at 1000 a spectral method finds
//! extremes of −0.38857, 0.37694 and −0.52708, which are 1.5 to 2.3 % larger (O. Botella, R. Peyret,
//! *Computers & Fluids* 27 (1998) 421–433).
//!
//! ```
//! use meshfree::study::ghia::{ALONG_X, ALONG_Y};
//! let slowest = ALONG_Y.iter().map(|point| point.reynolds_100).fold(f64::INFINITY, f64::min);
//! assert_eq!(slowest, -0.21090);
//! assert_eq!(ALONG_X[8].place, 0.5);
//! ```

/// A point on a centre line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CentreLinePoint {
    /// Distance from the left or lower wall, in units of L.
    pub place: f64,
    /// Velocity across the line at a Reynolds number of 100, in units of U.
    pub reynolds_100: f64,
    /// Velocity across the line at a Reynolds number of 1000, in units of U.
    pub reynolds_1000: f64,
}

const fn point(place: f64, reynolds_100: f64, reynolds_1000: f64) -> CentreLinePoint {
    CentreLinePoint {
        place,
        reynolds_100,
        reynolds_1000,
    }
}

/// u/U over y/L on the vertical line x = L/2, from the bottom to the lid (Table I).
pub const ALONG_Y: [CentreLinePoint; 17] = [
    point(0.0, 0.0, 0.0),
    point(0.0547, -0.03717, -0.18109),
    point(0.0625, -0.04192, -0.20196),
    point(0.0703, -0.04775, -0.22220),
    point(0.1016, -0.06434, -0.29730),
    point(0.1719, -0.10150, -0.38289),
    point(0.2813, -0.15662, -0.27805),
    point(0.4531, -0.21090, -0.10648),
    point(0.5000, -0.20581, -0.06080),
    point(0.6172, -0.13641, 0.05702),
    point(0.7344, 0.00332, 0.18719),
    point(0.8516, 0.23151, 0.33304),
    point(0.9531, 0.68717, 0.46604),
    point(0.9609, 0.73722, 0.51117),
    point(0.9688, 0.78871, 0.57492),
    point(0.9766, 0.84123, 0.65928),
    point(1.0, 1.0, 1.0),
];

/// v/U over x/L on the horizontal line y = L/2, from the left to the right wall (Table II).
pub const ALONG_X: [CentreLinePoint; 17] = [
    point(0.0, 0.0, 0.0),
    point(0.0625, 0.09233, 0.27485),
    point(0.0703, 0.10091, 0.29012),
    point(0.0781, 0.10890, 0.30353),
    point(0.0938, 0.12317, 0.32627),
    point(0.1563, 0.16077, 0.37095),
    point(0.2266, 0.17507, 0.33075),
    point(0.2344, 0.17527, 0.32235),
    point(0.5000, 0.05454, 0.02526),
    point(0.8047, -0.24533, -0.31966),
    point(0.8594, -0.22445, -0.42665),
    point(0.9063, -0.16914, -0.51550),
    point(0.9453, -0.10313, -0.39188),
    point(0.9531, -0.08864, -0.33714),
    point(0.9609, -0.07391, -0.27669),
    point(0.9688, -0.05906, -0.21388),
    point(1.0, 0.0, 0.0),
];

#[cfg(test)]
mod tests {
    use super::super::check::reference;
    use super::*;

    #[test]
    fn points_go_from_wall_to_wall() {
        for (line, end) in [(ALONG_Y, 1.0), (ALONG_X, 0.0)] {
            assert!(line.windows(2).all(|pair| pair[0].place < pair[1].place));
            assert_eq!(line[0], point(0.0, 0.0, 0.0));
            assert_eq!(line[16], point(1.0, end, end));
        }
    }

    /// What the lid drags one way must flow back below: no net flow through a centre line. Trapezoids
    /// over the few points of the table leave at most a twenty-fifth of what flows back and forth.
    #[test]
    fn nothing_flows_through_the_cavity() {
        for line in [ALONG_Y, ALONG_X] {
            let flow = |velocity: fn(&CentreLinePoint) -> f64| -> (f64, f64) {
                line.windows(2).fold((0.0, 0.0), |(net, gross), pair| {
                    let width = pair[1].place - pair[0].place;
                    let (a, b) = (velocity(&pair[0]), velocity(&pair[1]));
                    (
                        net + 0.5 * width * (a + b),
                        gross + 0.5 * width * (a.abs() + b.abs()),
                    )
                })
            };
            for velocity in [
                (|point| point.reynolds_100) as fn(&CentreLinePoint) -> f64,
                |point| point.reynolds_1000,
            ] {
                let (net, gross) = flow(velocity);
                assert!(net.abs() < 0.05 * gross, "{net} of {gross}");
            }
        }
    }

    #[test]
    fn values_are_those_of_the_reference_data() {
        for (line, name) in [
            (ALONG_Y, "lid_driven_cavity/ghia_u_along_y.csv"),
            (ALONG_X, "lid_driven_cavity/ghia_v_along_x.csv"),
        ] {
            let Some(table) = reference("values_are_those_of_the_reference_data", name) else {
                return;
            };
            assert_eq!(table.rows.len(), line.len());
            let place = table.columns[0].as_str();
            for known in line {
                let value = |column| table.interpolate(column, place, known.place).unwrap();
                assert_eq!(value("Re100"), known.reynolds_100);
                assert_eq!(value("Re1000"), known.reynolds_1000);
            }
        }
    }
}
