//! Plots as SVG: lines, steps, markers and coloured particles, in one panel or a grid of them.
//! Thinned to what can be seen, so that long histories make small files.
//!
//! Particles of a plane coloured by pressure, a metre as long across as up:
//!
//! ```
//! use meshfree::output::svg::{Axis, Cloud, Figure, Panel};
//! let (spacing, surface) = (0.05, 1.0);
//! let places = (0..800).map(|i| [i % 40, i / 40].map(|k| spacing * (f64::from(k) + 0.5)));
//! let water = places.map(|[x, y]| (x, y, 9.81 * (surface - y)));
//!
//! // Ranges are fixed, so that the frames of a film agree in place and colour.
//! let pressure = Axis::linear("pressure", "kPa").range(0.0, 10.0);
//! let tank = Panel::new(
//!     Axis::linear("x", "m").range(0.0, 4.0),
//!     Axis::linear("y", "m").range(0.0, 2.0),
//! );
//! let panel = tank.equal_aspect().cloud(Cloud::new(pressure, water).diameter(spacing));
//! let figure = Figure::new().panel_size(720.0, 400.0).panel(panel.title("t = 0.00 s"));
//! # assert!(figure.to_string().contains("pressure [kPa]"));
//! # let _ = || -> meshfree::error::Result<()> {
//! figure.save("out/frame_00000.svg")?;
//! # Ok(())
//! # };
//! ```
//!
//! In a run `water` is `simulation.all()`, each particle mapped to the components of its `position()`
//! and its `pressure()`. Particles in space are a [`Picture`](super::picture::Picture).

mod axis;
mod bar;
mod cloud;
mod color;
mod draw;
mod figure;
mod fit;
mod ink;
mod legend;
mod panel;
mod path;
mod series;
mod slope;
mod text;

pub use axis::Axis;
pub(super) use bar::{Bar, LEVELS, level_color};
pub use color::{Color, PALETTE, viridis};
pub(super) use draw::power_label;
pub use figure::Figure;
#[cfg(feature = "pictures")]
pub(super) use figure::page;
pub use fit::{PowerLaw, power_law};
pub use legend::Legend;
pub use panel::Panel;
#[cfg(feature = "pictures")]
pub(super) use path::px;
pub use series::{Cloud, Marker, Series};
pub(super) use text::parts;

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of all elements, after checking that they are closed in order.
    fn elements(svg: &str) -> Vec<&str> {
        let mut names = Vec::new();
        let mut open = Vec::new();
        for tag in svg.split('<').skip(1) {
            let (tag, text) = tag.split_once('>').expect("a closed tag");
            assert!(!text.contains('>'), "{text}");
            let name = tag.split([' ', '/']).next().unwrap_or_default();
            assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
            if let Some(closing) = tag.strip_prefix('/') {
                assert_eq!(open.pop(), Some(closing));
            } else {
                names.push(name);
                if !tag.ends_with('/') {
                    open.push(name);
                }
            }
        }
        assert!(open.is_empty(), "{open:?}");
        assert!(
            !svg.contains("NaN") && !svg.contains("inf"),
            "a place that is not finite"
        );
        names
    }

    fn xy() -> Panel {
        Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m"))
    }

    #[test]
    fn any_text_and_any_value_makes_valid_xml() {
        let strange = [
            (0.0, 1.0),
            (1.0, f64::NAN),
            (2.0, f64::INFINITY),
            (3.0, -1e300),
            (4.0, 1e300),
        ];
        let panel = |x, y| {
            Panel::new(x, y)
                .title("a < b & \"c\" ^{2}")
                .series(Series::line("<1>", strange).marker(Marker::Cross).fitted())
                .series(Series::steps("", strange).reference())
                .cloud(Cloud::new(
                    Axis::linear("v", "&"),
                    [(0.0, 1.0, f64::NAN), (1.0, 2.0, 3.0)],
                ))
                .slope(2.0)
                .mark_x(f64::NAN)
                .mark_y(0.0)
        };
        let linear = || Axis::linear("x", "<m>");
        let log = || Axis::log("y", "");
        let figure = Figure::new()
            .title("R&D")
            .panel(panel(linear(), linear()))
            .panel(panel(log(), log()))
            .panel(panel(linear(), log()).equal_aspect())
            .panel(xy());
        elements(&figure.to_string());
        elements(&figure.shared_legend().to_string());
        elements(&Figure::new().columns(0).to_string());
    }

    #[test]
    fn long_histories_make_small_files() {
        let n = 100_000;
        let wave = (0..n)
            .map(|i| 1e-3 * f64::from(i))
            .map(|t| (t, (7.0 * t).sin()));
        let svg = Figure::new()
            .panel(xy().series(Series::line("wave", wave)))
            .to_string();
        elements(&svg);
        assert!(svg.len() < 60_000, "{}", svg.len());
    }

    #[test]
    fn a_shared_legend_has_each_entry_once() {
        let panel = || xy().series(Series::line("same", [(0.0, 0.0), (1.0, 1.0)]));
        let figure = Figure::new().panel(panel()).panel(panel());
        assert_eq!(figure.to_string().matches(">same<").count(), 2);
        assert_eq!(
            figure.shared_legend().to_string().matches(">same<").count(),
            1
        );
    }

    #[test]
    fn slopes_stand_by_the_curve_that_has_them() {
        let spacings = || (0..6).map(|i| 0.1 * 0.5_f64.powi(i));
        let panel = Panel::new(Axis::log("h", ""), Axis::log("error", ""))
            .series(Series::markers("first", spacings().map(|h| (h, h))))
            .series(Series::markers("second", spacings().map(|h| (h, h * h))).fitted());
        let plain = Figure::new().panel(panel.clone()).to_string();
        let marked = Figure::new().panel(panel.slope(1.0).slope(2.0)).to_string();
        assert!(plain.contains("second (slope 2.00)"));
        assert_eq!(elements(&marked).len(), elements(&plain).len() + 6);
    }
}
