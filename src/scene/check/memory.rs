//! Whether the particles of a scene fit into memory, predicted before any of it is allocated.
//! A number of bytes a particle from what its scheme names, and what the machine has to give.

use crate::effect::When;
use crate::error::Problem;
use crate::neighbors::listed_around;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::scene::numerics::SKINS;
use crate::scene::{Part, Scene};
use crate::scheme::EnergyForm;
use crate::term::MOST_READS;

/// Bytes of the scene's own copies of a place while it is built: cells of the search for overlap, and identities.
const WHILE_BUILT: f64 = 24.0;

/// Bytes a particle that lists, records and sums may differ by from what is predicted.
const MARGIN: f64 = 1.1;

impl<T: Real, const D: usize> Scene<T, D> {
    /// Refuses a scene that memory does not hold.
    pub(super) fn check_memory(&self, problems: &mut Vec<Problem>) {
        let walls: usize = self.walls.iter().map(|wall| wall.points.len()).sum();
        let (mut particles, mut needed) = (0, 0.0);
        for part in &self.parts {
            let entering = self.inlets.iter().map(|inlet| inlet.reserve as f64);
            let entering = entering.chain(self.sources.iter().map(|own| own.reserve as f64));
            let own: usize = part.bodies.iter().map(|body| body.points.len()).sum();
            particles += own;
            let walls = if part.scheme.meets_walls() { walls } else { 0 };
            let count = own as f64 + walls as f64 + entering.sum::<f64>();
            let columns = self.fields_of(&part.scheme, &part.bodies);
            let skin = self.skin.unwrap_or(SKINS[1]);
            needed += count * bytes_a_particle(part, columns, skin, &*self.integrator);
        }
        particles += walls;
        let needed = needed.ceil();
        if particles == 0 || needed.is_nan() {
            return;
        }
        // A rank that begins with its own particles has of others what the scene says of them.
        let ranks = self.ranks.as_ref().map_or(1, |ranks| ranks.count());
        let of_scene = (WHILE_BUILT * particles as f64).min(needed);
        let needed = if ranks > 1 && self.begins_apart(ranks) {
            (of_scene + (needed - of_scene) / ranks as f64).ceil()
        } else {
            needed
        };
        let shared = || Some(available()? / self.ranks_here);
        let known = self.memory.or_else(shared);
        let available = known.unwrap_or(u64::MAX);
        // Where nothing says what there is, the allocator is asked: what it refuses at once need not be tried by pieces.
        let granted = needed < isize::MAX as f64
            && (known.is_some() || Vec::<u8>::new().try_reserve_exact(needed as usize).is_ok());
        if needed > available as f64 || !granted {
            problems.push(Problem::Memory {
                particles,
                each: (needed / particles as f64) as usize,
                needed: needed as u64,
                available,
            });
        }
    }
}

/// Bytes a particle: columns, records of the sweeps, sums, lists, and the states of the integrator.
fn bytes_a_particle<T: Real, const D: usize>(
    part: &Part<T, D>,
    columns: Fields,
    skin: f64,
    integrator: &dyn crate::integrator::Integrator,
) -> f64 {
    let scheme = &part.scheme;
    let number = size_of::<T>() as f64;
    let columns = columns.width(D) as f64;
    // Records of the widest sweep and, where the work of kicks is summed by one, those of that.
    let (records, sums) = scheme.widths();
    // The latter has sums of its own, of power and of what it gains; without it the sums of the rates are kept.
    let (packed, worked) = if scheme.sweeps_work() {
        (2, 2)
    } else if scheme.energy == EnergyForm::Compatible {
        (1, sums)
    } else {
        (1, 0)
    };
    // States that the integrator keeps, and what a prediction takes back.
    let width = |fields: &mut dyn Iterator<Item = Field>| -> usize {
        fields.map(|field| field.components(D)).sum()
    };
    let evolved = || scheme.program.evolved.iter();
    let all = 3 * D + width(&mut evolved().map(|own| own.field));
    let kicked = evolved().filter(|own| own.when == When::Kick);
    let states = integrator.slots() * all + D + width(&mut kicked.map(|own| own.field));
    // A row of W particles lists what any of them reaches.
    let lanes = <T::Wide<false> as Lane>::WIDTH;
    let reach = scheme.kernel.support * scheme.h_over_dx * (1.0 + skin);
    let ball = listed_around(D, reach, lanes);
    let lists = 4.0 * ball / lanes as f64;
    let numbers = columns + (packed * records.min(MOST_READS) + 2 * sums + worked) as f64;
    let places = (2 * D + states) as f64;
    MARGIN * (number * (numbers + places) + lists + WHILE_BUILT)
}

/// Bytes that the machine has to give: the smaller of what is free and what the control group leaves.
fn available() -> Option<u64> {
    let memory = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = memory
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let free = line.split_whitespace().next()?.parse::<u64>().ok()? * 1024;
    let number = |path: &str| {
        std::fs::read_to_string(path)
            .ok()?
            .trim()
            .parse::<u64>()
            .ok()
    };
    let limit = number("/sys/fs/cgroup/memory.max");
    let used = number("/sys/fs/cgroup/memory.current").unwrap_or(0);
    Some(limit.map_or(free, |limit| free.min(limit.saturating_sub(used))))
}
