//! Walls of particles with their motions, planes, periods and outlets.
//! A motion must last as long as the run.

use super::{Builder, Part, in_space, only_in_space, only_one, sound, vector};
use crate::fault::Fault;
use crate::format::{Axis, Mirror, Motion, Outlet, SceneFile, Turn};
use meshfree::boundary::{self, Composed, Pose, Recorded, Translation};
use meshfree::geometry::{Shape, fill, layers};
use meshfree::prelude::{MirrorPlane, Periodic, Scene, Wall};

/// A motion that is chosen at run time.
struct AnyMotion<const D: usize>(Box<dyn boundary::Motion<D>>);

impl<const D: usize> boundary::Motion<D> for AnyMotion<D> {
    fn name(&self) -> String {
        self.0.name()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        self.0.pose(time)
    }
    fn pose_from(&self, origin: &[f64; D], time: f64) -> Pose<D> {
        self.0.pose_from(origin, time)
    }
    fn span(&self) -> [f64; 2] {
        self.0.span()
    }
    fn resolution(&self) -> Option<f64> {
        self.0.resolution()
    }
}

impl Axis {
    /// Its number.
    pub(crate) const fn number(self) -> usize {
        self as usize
    }
}

impl<const D: usize> Builder<'_, D> {
    /// Wall `k`, of so many layers if it does not say.
    pub(super) fn wall(&self, k: usize, reach: usize) -> Part<Wall<D>> {
        let (own, field) = (&self.file.wall[k], format!("wall[{k}]"));
        let given = [
            ("around", own.around.is_some()),
            ("layers_of", own.layers_of.is_some()),
            ("fill", own.fill.is_some()),
        ];
        only_one(&given, &field)?;
        let (name, dx) = (own.name.as_str(), own.spacing);
        if !(dx.is_finite() && dx > 0.0) {
            let text = format!("is {dx}: it must be finite and positive, in metres");
            return Err(Fault::new(format!("{field}.spacing"), text));
        }
        let count = own.layers.unwrap_or(reach);
        let mut wall = if let Some(around) = &own.around {
            let low = vector(&around.low, &format!("{field}.around.low"))?;
            let high = vector(&around.high, &format!("{field}.around.high"))?;
            let at = format!("{field}.around.closed");
            let closed = match &around.closed {
                None => [[true; 2]; D],
                Some(closed) => closed[..].try_into().map_err(|_| {
                    let text = format!(
                        "has {} pairs: it must have {D}, one for each axis",
                        closed.len()
                    );
                    Fault::new(at, text)
                })?,
            };
            Wall::around(name, low, high, dx, count, closed)
        } else if let Some(shape) = &own.layers_of {
            let at = format!("{field}.layers_of");
            let shape = self.shape(shape, &at)?;
            let (origin, thickness) = (shape.bounds().0, count as f64 * dx);
            let points = layers(&shape, dx, thickness, origin).map_err(Fault::of(&at))?;
            Wall::of(name, points, dx).fluid_side(shape)
        } else {
            let at = format!("{field}.fill");
            let shape = own.fill.as_ref().map(|shape| self.shape(shape, &at));
            let shape = shape.unwrap_or_else(|| Err(Fault::new(&at, "is not given")))?;
            let points = fill(&shape, dx, shape.bounds().0).map_err(Fault::of(&at))?;
            Wall::of(name, points, dx).fluid_side(shape.complement())
        };
        let until = self.file.run.until;
        let mut motion: Option<Composed<D>> = None;
        for (n, next) in own.motion.iter().enumerate() {
            let at = format!("{field}.motion[{n}]");
            let next = self.motion(next, &at)?;
            let [first, last] = boundary::Motion::span(&next);
            if first > 0.0 || last < until {
                let text = format!(
                    "goes from {first} s to {last} s, and the run from 0 s to {until} s: give more rows, or `at_rest_beyond`"
                );
                return Err(Fault::new(at, text));
            }
            motion = Some(match motion {
                None if own.motion.len() == 1 => {
                    wall = wall.motion(next);
                    break;
                }
                None => Composed::of(next),
                Some(before) => before.then(next),
            });
        }
        if let Some(motion) = motion {
            wall = wall.motion(motion);
        }
        if let Some(velocity) = &own.sliding {
            wall = wall.sliding(vector(velocity, &format!("{field}.sliding"))?);
        }
        if own.no_slip {
            wall = wall.no_slip();
        }
        Ok(if own.container_frame {
            wall.container_frame()
        } else {
            wall
        })
    }

    fn motion(&self, own: &Motion, field: &str) -> Part<AnyMotion<D>> {
        let motion: Box<dyn boundary::Motion<D>> = match own {
            Motion::Velocity(velocity) => Box::new(Translation::steady(vector(
                velocity,
                &format!("{field}.velocity"),
            )?)),
            Motion::Displacement(record) => {
                let field = format!("{field}.displacement.table");
                let rows = self.rows::<D>(&record.table, &field)?;
                let motion = Recorded::translation(&rows).map_err(Fault::of(&field))?;
                Box::new(resting(motion, record.at_rest_beyond))
            }
            Motion::Acceleration(table) => {
                Box::new(self.accelerated(table, &format!("{field}.acceleration"))?)
            }
            Motion::Rotation(turn) => Box::new(self.turned(turn, &format!("{field}.rotation"))?),
        };
        Ok(AnyMotion(motion))
    }

    fn turned(&self, turn: &Turn, field: &str) -> Part<Recorded<D>> {
        if D < 2 {
            let text = "needs a plane, and the scene has one dimension: leave it out";
            return Err(Fault::new(field, text));
        }
        let centre: [f64; D] = vector(&turn.centre, &format!("{field}.centre"))?;
        let at = format!("{field}.table");
        let rows = self.rows::<1>(&turn.table, &at)?;
        let rows: Vec<_> = rows
            .into_iter()
            .map(|(time, [angle])| (time, angle))
            .collect();
        let motion = match &turn.axis {
            None => Recorded::rotation(centre, &rows).map_err(Fault::of(&at))?,
            Some(axis) => {
                let at_axis = format!("{field}.axis");
                only_in_space::<D>(&at_axis)?;
                let axis = vector(axis, &at_axis)?;
                let centre = in_space::<D, _, _>(centre, &at_axis)?;
                let motion =
                    Recorded::rotation_about(centre, axis, &rows).map_err(Fault::of(field))?;
                in_space::<D, _, _>(motion, &at_axis)?
            }
        };
        Ok(resting(motion, turn.at_rest_beyond))
    }

    /// The scene with planes, periods and outlets.
    pub(super) fn boundaries(&mut self, mut scene: Scene<f64, D>) -> Scene<f64, D> {
        let file: &SceneFile = self.file;
        for (k, own) in file.mirror_plane.iter().enumerate() {
            let field = format!("mirror_plane[{k}]");
            let plane = mirror(own, &field);
            if let Some(plane) = self.keep(plane) {
                scene = scene.boundary(plane);
            }
        }
        for (k, own) in file.periodic.iter().enumerate() {
            let period = Periodic::along(own.axis.number(), own.low, own.high);
            let period = sound::<D, _>(period, &format!("periodic[{k}]"));
            if let Some(period) = self.keep(period) {
                scene = scene.boundary(period);
            }
        }
        for (k, own) in file.outlet.iter().enumerate() {
            let outlet = outlet(own, &format!("outlet[{k}]"));
            if let Some(outlet) = self.keep(outlet) {
                scene = scene.outlet(outlet);
            }
        }
        scene
    }
}

fn resting<const D: usize>(motion: Recorded<D>, is_at_rest_beyond: bool) -> Recorded<D> {
    if is_at_rest_beyond {
        motion.at_rest_beyond()
    } else {
        motion
    }
}

fn outlet<const D: usize>(own: &Outlet, field: &str) -> Part<boundary::Outlet<D>> {
    Ok(match own {
        Outlet::Plane { point, normal } => {
            let point = vector(point, &format!("{field}.plane.point"))?;
            boundary::Outlet::plane(point, vector(normal, &format!("{field}.plane.normal"))?)
        }
        Outlet::OutsideBox { low, high } => {
            let low = vector(low, &format!("{field}.outside_box.low"))?;
            boundary::Outlet::outside_box(low, vector(high, &format!("{field}.outside_box.high"))?)
        }
    })
}

fn mirror<const D: usize>(own: &Mirror, field: &str) -> Part<MirrorPlane<D>> {
    let point = vector(&own.point, &format!("{field}.point"))?;
    let at_normal = format!("{field}.normal");
    let normal: [f64; D] = vector(&own.normal, &at_normal)?;
    let size = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(size.is_finite() && size > 0.0) {
        let text = format!("has the length {size}: it must be finite and not zero");
        return Err(Fault::new(at_normal, text));
    }
    let plane = if own.symmetry {
        MirrorPlane::symmetry(point, normal)
    } else {
        MirrorPlane::wall(point, normal)
    };
    sound::<D, _>(plane.moving(own.velocity.unwrap_or(0.0)), field)
}
