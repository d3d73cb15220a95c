//! Shapes of the library from those of a file.
//! Each part of a combined shape is checked at its own field.

use super::{Builder, Part, in_space, only_in_space, vector};
use crate::fault::Fault;
use crate::format::Shape as Described;
use meshfree::geometry::{Ball, Cuboid, Cylinder, HalfSpace, Mesh, Shape};

/// A shape that is chosen at run time.
pub(crate) type AnyShape<const D: usize> = Box<dyn Shape<D>>;

impl<const D: usize> Builder<'_, D> {
    /// A shape, whose numbers make one.
    pub(crate) fn shape(&self, own: &Described, field: &str) -> Part<AnyShape<D>> {
        let shape: AnyShape<D> = match own {
            Described::Cuboid { low, high } => {
                let low = vector(low, &format!("{field}.cuboid.low"))?;
                Box::new(Cuboid::new(
                    low,
                    vector(high, &format!("{field}.cuboid.high"))?,
                ))
            }
            Described::Ball { centre, radius } => Box::new(Ball::new(
                vector(centre, &format!("{field}.ball.centre"))?,
                *radius,
            )),
            Described::HalfSpace { point, normal } => {
                let point = vector(point, &format!("{field}.half_space.point"))?;
                let normal = vector(normal, &format!("{field}.half_space.normal"))?;
                Box::new(HalfSpace::new(point, normal))
            }
            Described::Cylinder { start, end, radius } => {
                only_in_space::<D>(&format!("{field}.cylinder"))?;
                let start = vector(start, &format!("{field}.cylinder.start"))?;
                let end = vector(end, &format!("{field}.cylinder.end"))?;
                let shape: AnyShape<3> = Box::new(Cylinder::between(start, end, *radius));
                in_space::<D, _, _>(shape, field)?
            }
            Described::Mesh { file, unit } => {
                only_in_space::<D>(&format!("{field}.mesh"))?;
                let at_file = format!("{field}.mesh.file");
                let mesh =
                    Mesh::read(self.folder.join(file), *unit).map_err(Fault::of(&at_file))?;
                let shape: AnyShape<3> = Box::new(mesh);
                in_space::<D, _, _>(shape, field)?
            }
            Described::Union(parts) => {
                let field = format!("{field}.union");
                let joined = |a: AnyShape<D>, b| Box::new(a.union(b)) as AnyShape<D>;
                self.combined(parts, &field, joined)?
            }
            Described::Intersection(parts) => {
                let field = format!("{field}.intersection");
                let common = |a: AnyShape<D>, b| Box::new(a.intersection(b)) as AnyShape<D>;
                self.combined(parts, &field, common)?
            }
            Described::Minus(parts) => {
                let field = format!("{field}.minus");
                let left = |a: AnyShape<D>, b| Box::new(a.minus(b)) as AnyShape<D>;
                self.combined(parts, &field, left)?
            }
        };
        match shape.problems().first() {
            Some(problem) => Err(Fault::of_part(field, *problem)),
            None => Ok(shape),
        }
    }

    fn combined(
        &self,
        parts: &[Described],
        field: &str,
        of: impl Fn(AnyShape<D>, AnyShape<D>) -> AnyShape<D>,
    ) -> Part<AnyShape<D>> {
        let mut all = None;
        for (k, part) in parts.iter().enumerate() {
            let shape = self.shape(part, &format!("{field}[{k}]"))?;
            all = Some(match all {
                None => shape,
                Some(before) => of(before, shape),
            });
        }
        all.ok_or_else(|| Fault::new(field, "is empty: give at least one shape"))
    }
}
