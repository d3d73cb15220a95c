//! The structure as an elastic–plastic solid between two plates, with water in it or without: the scene.
//! x is the way out, z the direction of the crush; half of the depth y of a cell stands between planes of symmetry.

use super::filler::{self, HOLE, LAYERS, RATE, ramp, water_scheme};
use meshfree::boundary::Translation;
use meshfree::effect::FiniteStrainPlasticity;
use meshfree::geometry::{Cuboid, OpenCell, Shape, fill};
use meshfree::material::eos::Linear;
use meshfree::material::strength::{CowperSymonds, TensionCompression};
use meshfree::prelude::*;
use meshfree::term::viscosity::MonaghanGingold;
use std::collections::HashSet;

/// FullCure M730: density \[kg/m³\], Young's modulus \[Pa\], Poisson's ratio, yield stresses \[Pa\] in tension and
/// compression.
const POLYMER: [f64; 5] = [1180.0, 2323e6, 0.3, 49e6, 91e6];
/// Cowper and Symonds: rate \[1/s\] at which the yield stress has doubled, and exponent.
const RATES: [f64; 2] = [3000.0, 5.0];
/// Linear artificial viscosity of the polymer: it damps the ringing of contacts.
const DAMPING: f64 = 0.2;
/// How far particles of the structure were apart as built, in spacings, if they are to touch by folding.
const FOLDS: f64 = 4.0;
/// How far the plates reach beyond the structure at its open end, in its length.
const RIM: f64 = 0.25;

/// What the paper does not state.
pub const CHOICES: &str = "\
Vesenjak & Ren (2007): holes of 3 mm, walls of 1.5, 1.0 and 0.5 mm, FullCure M730 (E 2323 MPa, nu 0.3, yield
49 MPa in tension and 91 MPa in compression, Cowper-Symonds), water, upper face moved at a strain rate of 1000 1/s.
Our choice, which the paper does not state:
- density of the polymer 1180 kg/m3; Cowper-Symonds C = 3000 1/s, P = 5; no hardening, no failure; yield stresses of
  tension and compression by the sign of pressure; pressure linear in density;
- N cells along the outflow and along the crush, one deep, of which half the depth is computed between planes of
  symmetry; a plane of symmetry at the closed end; the other end is open to the water, and the structure free there;
- rigid plates above and below, which touch structure and water; all starts at rest, and the speed of the upper one grows
  as half a cosine while sound runs through the block six times (a strain of 0.9 % for one cell of c = 1.5 mm);
- contact without friction by springs between particles (images in planes of symmetry included);
- artificial viscosity: alpha 0.2 in the polymer, none in the water apart from its density diffusion;
- no outlet: water that has left flies on;
- water sticks to structure and plates;
- Mie-Grueneisen constants of water C0 1480 m/s, S 1.92, Gamma 0.1; it supports no tension;
- one cell (the paper: sixteen), and a spacing of 0.25 mm of structure and water (the paper: elements of 0.1 mm and
  particles 0.112 mm apart).";

/// Total Lagrangian with J2 flow.
fn polymer_scheme() -> Scheme<f64, 3> {
    let damping = MonaghanGingold {
        alpha: DAMPING,
        beta: 2.0,
    };
    schemes::total_lagrangian_impact()
        .with_viscosity(damping)
        .with(FiniteStrainPlasticity)
        .compose()
}

/// A structure, what fills it, and the crush.
#[derive(Clone, Debug)]
pub struct Crushed {
    /// Thickness between the holes \[m\].
    pub wall: f64,
    /// Dynamic viscosity \[Pa s\] of the water; none where there is none.
    pub viscosity: Option<f64>,
    /// Cells along x and z.
    pub cells: usize,
    /// Spacing that is asked for \[m\]; a whole even number fits a cell.
    pub spacing: f64,
    /// Final strain.
    pub strain: f64,
}

impl Crushed {
    pub fn name(&self) -> String {
        let fill = self.viscosity.map_or("empty".to_string(), |viscosity| {
            format!("mu{viscosity:.0e}")
        });
        format!("c{:.1}mm_{fill}", 1e3 * self.wall)
    }
    pub fn cell(&self) -> OpenCell {
        OpenCell::new(HOLE, self.wall).tiled([self.cells, 1, self.cells])
    }
    /// The spacing \[m\] of which a whole even number fits a cell.
    pub fn fitted(&self) -> f64 {
        let side = HOLE + self.wall;
        side / (2.0 * (0.5 * side / self.spacing).round().max(1.0))
    }
    /// Length, half of the depth, and height \[m\].
    pub fn size(&self) -> [f64; 3] {
        let side = HOLE + self.wall;
        [
            self.cells as f64 * side,
            0.5 * side,
            self.cells as f64 * side,
        ]
    }
    /// Engineering strain \[1\] by the upper plate, its rate \[1/s\] and the second derivative \[1/s²\] at a time \[s\].
    pub fn strain_at(&self, time: f64) -> [f64; 3] {
        filler::strain(ramp(self.size()[0]), time)
    }
    /// Time \[s\] of the final strain.
    pub fn end(&self) -> f64 {
        self.strain / RATE + 0.5 * ramp(self.size()[0])
    }
    /// Area \[m²\] that engineering stress is referred to.
    pub fn area(&self) -> f64 {
        let [length, depth, _] = self.size();
        length * depth
    }

    pub fn polymer() -> Material<f64> {
        let [density, youngs, poisson, tension, compression] = POLYMER;
        let slow = TensionCompression::new(tension, compression);
        let [doubling, exponent] = RATES;
        Material::new(
            "FullCure M730",
            Linear::from_elastic_constants(density, youngs, poisson),
        )
        .with_shear_modulus(youngs / (2.0 * (1.0 + poisson)))
        .with_strength(CowperSymonds::new(slow, doubling, exponent))
    }

    pub fn water(&self) -> Option<Material<f64>> {
        self.viscosity.map(filler::water)
    }

    /// Places of the structure and of the water. What the lattice leaves of the structure without a neighbour along an axis
    /// has no strain there, and is left to the water.
    pub fn parts(&self) -> Result<[Vec<[f64; 3]>; 2], Error> {
        let (dx, [_, depth, _]) = (self.fitted(), self.size());
        let half = |shape: &dyn Shape<3>| -> Result<Vec<[f64; 3]>, Error> {
            let places = fill(shape, dx, [0.0; 3])?;
            Ok(places.into_iter().filter(|x| x[1] < depth).collect())
        };
        let (solid, mut void) = (half(&self.cell().solid())?, half(&self.cell().void())?);
        let rows = (depth / dx).round() as i64;
        let number = |x: &[f64; 3]| x.map(|x| (x / dx).floor() as i64);
        let mut there: HashSet<[i64; 3]> = solid.iter().map(number).collect();
        loop {
            let has = |[x, y, z]: [i64; 3]| {
                // Beyond a plane of symmetry it is the particle itself.
                let image = x < 0 || y < 0 || y >= rows;
                image || there.contains(&[x, y, z])
            };
            let alone = |at: &&[i64; 3]| {
                (0..3).any(|d| {
                    let beside = |by: i64| {
                        let mut other = **at;
                        other[d] += by;
                        has(other)
                    };
                    !beside(1) && !beside(-1)
                })
            };
            let loose: Vec<[i64; 3]> = there.iter().filter(alone).copied().collect();
            if loose.is_empty() {
                break;
            }
            for at in loose {
                there.remove(&at);
            }
        }
        let (solid, loose): (Vec<_>, Vec<_>) =
            solid.into_iter().partition(|x| there.contains(&number(x)));
        void.extend(loose);
        Ok([solid, void])
    }

    pub fn build(&self) -> Result<Simulation<f64, 3>, Error> {
        let dx = self.fitted();
        let [length, depth, height] = self.size();
        let [structure, void] = self.parts()?;
        let structure = Body::points_of("structure", Self::polymer(), structure, dx).no_slip();
        let thick = LAYERS as f64 * dx;
        let plate = |name: &str, low: f64| -> Result<Body<f64, 3>, Error> {
            let shape = Cuboid::new([0.0, 0.0, low], [(1.0 + RIM) * length, depth, low + thick]);
            let places = fill(&shape, dx, shape.bounds().0)?;
            Ok(Body::points_of(name, Self::polymer(), places, dx).no_slip())
        };
        // The plates are groups of their own: within one, a body sees the images of others in planes of symmetry even where
        // the two do not meet.
        let [bottom, top] = [plate("bottom", -thick)?, plate("top", height)?];
        let ramp = ramp(length);
        let travel =
            move |order: usize| move |t: f64| [0.0, 0.0, -height * filler::strain(ramp, t)[order]];
        let scene = match self.water() {
            None => Scene::<f64, 3>::new(polymer_scheme()).body(structure),
            Some(water) => {
                let water = Body::points_of("water", water, void, dx);
                Scene::<f64, 3>::new(water_scheme::<f64>(0.0))
                    .body(water)
                    .group(polymer_scheme(), [structure])
            }
        };
        scene
            .group(polymer_scheme(), [bottom])
            .group(polymer_scheme(), [top])
            .fix("bottom", |_| true)
            .clamp(
                "top",
                |_| true,
                Translation::new(travel(0), travel(1), travel(2)),
            )
            .between("bottom", "top", Interaction::None)
            .couple("structure", "bottom", Penalty::new())
            .couple("structure", "top", Penalty::new())
            .couple_self("structure", FOLDS * dx, Penalty::new())
            .boundary(MirrorPlane::symmetry([0.0; 3], [-1.0, 0.0, 0.0]))
            .boundary(MirrorPlane::symmetry([0.0; 3], [0.0, -1.0, 0.0]))
            .boundary(MirrorPlane::symmetry([0.0, depth, 0.0], [0.0, 1.0, 0.0]))
            .build()
    }
}
