//! Bodies of the library, and what holds parts of them.
//! A body that is wrong leaves the others to be looked at.

use super::{Builder, Part, only_one, vector};
use crate::fault::Fault;
use crate::format::SceneFile;
use meshfree::prelude::{Body, Scene, Shape};

impl<const D: usize> Builder<'_, D> {
    /// Body `k`, with all that is wrong with it.
    pub(super) fn body(&mut self, k: usize, gravity: Option<[f64; D]>) -> Option<Body<f64, D>> {
        let placed = self.placed(k);
        let body = self.keep(placed);
        let file: &SceneFile = self.file;
        let (own, field) = (&file.body[k], format!("body[{k}]"));
        let velocity = own.velocity.as_ref();
        let velocity = velocity.map(|v| vector(v, &format!("{field}.velocity")));
        let velocity = velocity.and_then(|part| self.keep(part));
        let at = format!("{field}.hydrostatic");
        let surface = own.hydrostatic.as_ref().map(|x| vector(x, &at));
        let surface = surface.and_then(|part| self.keep(part));
        let mut body = body?;
        if let Some(velocity) = velocity {
            body = body.velocity(velocity);
        }
        if let Some(density) = own.density {
            body = body.density(density);
        }
        if let Some(energy) = own.energy {
            body = body.energy(energy);
        }
        if let Some(jitter) = &own.jitter {
            body = body.jitter(jitter.share, jitter.seed.unwrap_or(1));
        }
        if let Some(surface) = surface {
            let Some(gravity) = gravity else {
                let text =
                    "needs `gravity`, along which pressure grows: give that, or leave this out";
                self.faults.push(Fault::new(at, text));
                return None;
            };
            body = body.hydrostatic(gravity, surface);
        }
        Some(if own.no_slip { body.no_slip() } else { body })
    }

    /// Body `k` where it is, at rest.
    fn placed(&self, k: usize) -> Part<Body<f64, D>> {
        let (own, field) = (&self.file.body[k], format!("body[{k}]"));
        let given = [
            ("block", own.block.is_some()),
            ("fill", own.fill.is_some()),
            ("packed", own.packed.is_some()),
            ("points", own.points.is_some()),
        ];
        only_one(&given, &field)?;
        let material = self.material(&own.material, &format!("{field}.material"))?;
        let (name, dx) = (own.name.as_str(), own.spacing);
        // Before a shape is filled: the library says it of the body then, and not of the shape.
        if !(dx.is_finite() && dx > 0.0) {
            let text = format!("is {dx}: it must be finite and positive, in metres");
            return Err(Fault::new(format!("{field}.spacing"), text));
        }
        if let Some(block) = &own.block {
            let low = vector(&block.low, &format!("{field}.block.low"))?;
            let high = vector(&block.high, &format!("{field}.block.high"))?;
            return Ok(Body::block(name, material, low, high, dx));
        }
        if let Some(shape) = &own.fill {
            let shape = self.shape(shape, &format!("{field}.fill"))?;
            return Ok(Body::fill(name, material, &shape, dx));
        }
        if let Some(shape) = &own.packed {
            let shape = self.shape(shape, &format!("{field}.packed"))?;
            return Ok(Body::packed(name, material, &shape, dx));
        }
        let file = own.points.as_deref().unwrap_or("".as_ref());
        let points = self.places(file, &format!("{field}.points"))?;
        Ok(Body::points_of(name, material, points, dx))
    }

    /// The scene with the parts of body `k` that do not move, and with that body rigid.
    pub(super) fn held(&mut self, k: usize, mut scene: Scene<f64, D>) -> Scene<f64, D> {
        let file: &SceneFile = self.file;
        let own = &file.body[k];
        for (n, region) in own.fix.iter().enumerate() {
            let region = self.shape(region, &format!("body[{k}].fix[{n}]"));
            if let Some(region) = self.keep(region) {
                scene = scene.fix(&own.name, move |x| region.signed_distance(x) <= 0.0);
            }
        }
        if own.rigid {
            scene.rigid(&own.name)
        } else {
            scene
        }
    }
}
