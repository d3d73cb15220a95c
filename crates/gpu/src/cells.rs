//! The texts of kernels that list neighbours: cells of places, order along a curve, and who is within reach of a cluster.
//! Cells are counted modulo a table, so that one particle far away asks for no more of it.

use crate::compile::transformed;
use crate::{Dialect, Precision};
use meshfree::particles::Fields;
use meshfree::scalar::Record;
use meshfree::simulation::device::{CellGrid, Layout, Search};

/// What the texts know of a group.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around<'a> {
    pub dialect: Dialect,
    pub layout: &'a Layout,
    pub blocks: usize,
    pub cluster: usize,
}

/// The numbers of a search, as the texts read them. Cells of the table along each axis stand behind those of the grid.
pub(crate) fn numbers<const D: usize>(
    search: &Search<D>,
    table: [u32; D],
    precision: Precision,
) -> Vec<f64> {
    let rounding = rounding(precision);
    let reach = search.supports[0] + search.skin;
    let grid = |own: &CellGrid<D>| {
        let counts = own.counts.map(f64::from);
        [&own.origin[..], &[own.inverse], &counts].concat()
    };
    let mut all = grid(&search.cells);
    all.extend(table.map(f64::from));
    // As much as rounding may add to a reach.
    all.extend([reach * (1.0 + 1e-6), reach * reach * (1.0 + rounding)]);
    all.extend([search.supports[1], search.skin]);
    all.extend(grid(&search.order));
    all.push(f64::from(search.order.bits));
    all
}

/// Cells of a table along each axis that has at most so many: those of a grid, or fewer, of which each stands for several.
pub(crate) fn folded<const D: usize>(counts: [u32; D], most: usize) -> [u32; D] {
    let mut all = counts;
    while all.iter().map(|own| *own as usize).product::<usize>() > most {
        if let Some(longest) = all.iter_mut().max_by_key(|own| **own) {
            *longest = longest.div_ceil(2);
        }
    }
    all
}

/// What the square of a reach is raised by, so that rounding leaves out none.
fn rounding(precision: Precision) -> f64 {
    match precision {
        Precision::Single => 1e-6,
        Precision::Double => 1e-15,
    }
}

impl Around<'_> {
    fn d(&self) -> usize {
        self.layout.dimensions
    }
    fn grid(&self, at: usize) -> String {
        format!("grid[{at}u]")
    }
    /// Where the numbers of a search stand: tables, reaches, and the grid of the order.
    fn tables(&self) -> usize {
        2 * self.d() + 1
    }
    fn reaches(&self) -> usize {
        self.tables() + self.d()
    }
    fn order(&self) -> usize {
        self.reaches() + 4
    }
    pub fn numbers(&self) -> usize {
        self.order() + 2 * self.d() + 2
    }
    fn listed(&self, d: usize, slot: &str) -> String {
        format!("state[{}u + {slot}]", self.layout.listed(d))
    }
    /// Numbers of a place, with a smoothing length where it varies.
    pub fn width(&self) -> usize {
        self.d() + usize::from(self.layout.varies())
    }
    fn place(&self, d: usize, slot: &str) -> String {
        format!("places[({slot}) * {}u + {d}u]", self.width())
    }
    /// The block of a slot, behind the table of who lists whom.
    fn member(&self, slot: &str) -> String {
        format!("members[{}u + {slot}]", self.blocks * self.blocks)
    }
    fn count(&self, name: &str, at: usize) -> String {
        self.dialect
            .index(name, &self.dialect.whole(&self.grid(at)))
    }

    /// The coordinate along an axis of a cell of the grid whose numbers start at a place, for a coordinate of a place.
    fn cell(&self, first: usize, d: usize, x: &str) -> String {
        let (origin, inverse) = (self.grid(first + d), self.grid(first + self.d()));
        let own = format!("({x} - {origin}) * {inverse}");
        let own = self.dialect.whole(&format!("({own})"));
        let last = self.dialect.whole(&self.grid(first + self.d() + 1 + d));
        format!("min({own}, {last} - 1u)")
    }

    /// The row of the table of cells for a block and the axes behind the first, and its length `table0`.
    fn row(&self, block: &str) -> String {
        let axes = (1..self.d()).rev();
        axes.fold(block.to_string(), |row, d| {
            format!("({row} * table{d} + cell{d})")
        })
    }

    /// Places are those that lists are built for.
    pub fn remember(&self) -> String {
        let field = meshfree::particles::Field::POSITION;
        let places = (0..self.d()).map(|d| (self.layout.field(field, d), self.layout.listed(d)));
        let length = self.layout.varies().then(|| {
            let field = meshfree::particles::Field::SMOOTHING_LENGTH;
            (self.layout.field(field, 0), self.layout.listed(self.d()))
        });
        let copies = places.chain(length);
        copies.fold(String::new(), |body, (at, to)| {
            body + &format!("state[{to}u + i] = state[{at}u + i];\n")
        })
    }

    /// What lets particles re-enter, by the record of some fields; their places are then those that lists are built for.
    pub fn re_entry(&self, fields: Fields, record: &Record) -> String {
        let columns = fields
            .iter()
            .flat_map(|field| (0..self.d()).map(move |d| self.layout.field(field, d)));
        let columns = columns.map(|at| (at, format!("state[{at}u + source]")));
        let columns: Vec<_> = columns.collect();
        let body = transformed(&columns, record, (self.d(), self.dialect));
        // Places are the first of what changes.
        let places = columns.iter().take(self.d()).enumerate();
        places.fold(body, |body, (d, (_, place))| {
            body + &format!("{} = {place};\n", self.listed(d, "source"))
        })
    }

    /// The places of particles beside each other, before those of images.
    pub fn places(&self) -> String {
        (0..self.width()).fold(String::new(), |body, d| {
            body + &format!("{} = {};\n", self.place(d, "i"), self.listed(d, "i"))
        })
    }

    /// The cell of each particle and image, behind all for what repeats one.
    pub fn keys(&self) -> String {
        let mut body = self.dialect.index("own", &self.member("i"));
        let mut all = format!("{}u", self.blocks);
        for d in 0..self.d() {
            let x = self.place(d, "i");
            body += &self.count(&format!("table{d}"), self.tables() + d);
            let cell = format!("{} % table{d}", self.cell(0, d, &x));
            body += &self.dialect.index(&format!("cell{d}"), &cell);
            all += &format!(" * table{d}");
        }
        let key = format!("{} * table0 + cell0", self.row("own"));
        let is_there = format!("own < {}u", self.blocks);
        let key = self.dialect.select(&is_there, &key, &all);
        body + &format!("keys[i] = {key};\norder[i] = i;\n")
    }

    /// Where each cell of the table starts among sorted particles.
    pub fn starts(&self) -> String {
        let dialect = self.dialect;
        let mut body = dialect.counter("low", "0u") + &dialect.counter("high", "scene.length");
        body += "while (low < high) {\n";
        body += &dialect.index("middle", "(low + high) / 2u");
        body += "if (keys[sorted[middle]] < n) { low = middle + 1u; } else { high = middle; }\n";
        body + "}\ncells[n] = low;\n"
    }

    /// The place of each particle along the curve, in two words, and its block; as `hilbert_index` has it.
    pub fn curve(&self) -> String {
        let (dialect, first, axes) = (self.dialect, self.order(), 0..self.d());
        let (slots, blocks) = (self.layout.slots, self.blocks);
        let mut body = self.count("bits", first + 2 * self.d() + 1);
        for d in axes.clone() {
            let cell = self.cell(first, d, &self.listed(d, "i"));
            body += &dialect.counter(&format!("x{d}"), &cell);
        }
        body += &dialect.counter("q", "1u << (bits - 1u)");
        body += "while (q > 1u) {\n";
        for d in axes.clone() {
            body += &format!("if ((x{d} & q) != 0u) {{ x0 = x0 ^ (q - 1u); }} else {{\n");
            body += &dialect.index("turn", &format!("(x0 ^ x{d}) & (q - 1u)"));
            body += &format!("x0 = x0 ^ turn;\nx{d} = x{d} ^ turn;\n}}\n");
        }
        body += "q = q >> 1u;\n}\n";
        for d in 1..self.d() {
            body += &format!("x{d} = x{d} ^ x{};\n", d - 1);
        }
        body += &dialect.counter("t", "0u");
        body += "q = 1u << (bits - 1u);\nwhile (q > 1u) {\n";
        body += &format!(
            "if ((x{} & q) != 0u) {{ t = t ^ (q - 1u); }}\nq = q >> 1u;\n}}\n",
            self.d() - 1
        );
        body += &(dialect.counter("low", "0u") + &dialect.counter("high", "0u"));
        body += &dialect.each("bit", "0u", "bits");
        for d in axes {
            body += "high = (high << 1u) | (low >> 31u);\n";
            body += &format!("low = (low << 1u) | (((x{d} ^ t) >> (bits - 1u - bit)) & 1u);\n");
        }
        body += "}\n";
        // What repeats a particle stays behind all of its body.
        let own = self.member("i");
        body += &format!("if ({own} >= {blocks}u) {{ low = 0xffffffffu; high = low; }}\n");
        body += &format!("keys[i] = low;\nkeys[{slots}u + i] = high;\n");
        let width = self.cluster;
        let first = self.member(&format!("i - i % {width}u"));
        body += &format!("keys[{}u + i] = {first};\n", 2 * slots);
        body + "order[i] = i;\nother[i] = i;\n"
    }

    /// What repeats the last particle of a body, after a sort.
    pub fn repeats(&self) -> String {
        let blocks = self.blocks;
        let own = self.dialect.index("own", &self.member("i"));
        format!("{own}if (own >= {blocks}u) {{ order[i] = order[own - {blocks}u]; }}\n")
    }

    /// The neighbours of a cluster in a block: how many, or themselves from a place in the list on. They are looked for around the box of
    /// the cluster, or where its members are far apart around each: what others before it have found is left out then.
    pub fn neighbours(&self, fills: bool) -> String {
        let (dialect, blocks, width) = (self.dialect, self.blocks, self.cluster);
        let (axes, reach) = (0..self.d(), self.reaches());
        let number = |name: &str, value: &str| dialect.declare(false, name, value) + "\n";
        let mut body = dialect.index("first", &format!("n / {blocks}u * {width}u"));
        body += &dialect.index("other", &format!("n % {blocks}u"));
        body += &dialect.index("own", &self.member("first"));
        body += &dialect.counter("found", if fills { "counts[n]" } else { "0u" });
        let listed = format!("members[own * {blocks}u + other]");
        // Beside each other, for the second is no place in the array where the first does not hold.
        body += &format!("if (own < {blocks}u) {{\nif ({listed} != 0u) {{\n");
        let members = 0..width;
        let smaller = |a: String, b: String| dialect.select(&format!("{a} < {b}"), &a, &b);
        let larger = |a: String, b: String| dialect.select(&format!("{a} > {b}"), &a, &b);
        let varies = self.layout.varies();
        for m in members.clone() {
            let slot = format!("first + {m}u");
            for d in axes.clone() {
                body += &number(&format!("m{m}_{d}"), &self.place(d, &slot));
            }
            if varies {
                body += &number(&format!("h{m}"), &self.place(self.d(), &slot));
            }
        }
        if varies {
            body += &dialect.variable("widest", "h0");
            for m in members.clone().skip(1) {
                body += &format!("widest = {};\n", larger("widest".into(), format!("h{m}")));
            }
        }
        let mut wide = String::from("false");
        for d in axes.clone() {
            let (low, high) = (format!("low{d}"), format!("high{d}"));
            body += &dialect.variable(&low, &format!("m0_{d}"));
            body += &dialect.variable(&high, &format!("m0_{d}"));
            for m in members.clone().skip(1) {
                let own = format!("m{m}_{d}");
                body += &format!("{low} = {};\n", smaller(low.clone(), own.clone()));
                body += &format!("{high} = {};\n", larger(high.clone(), own));
            }
            wide += &format!(" || {high} - {low} - {r} > {r}", r = self.grid(reach));
            body += &self.count(&format!("table{d}"), self.tables() + d);
        }
        let boxes = dialect.select(&format!("({wide})"), &format!("{width}u"), "1u");
        body += &(dialect.index("boxes", &boxes) + &dialect.each("member", "0u", "boxes"));
        for d in axes.clone() {
            for end in ["low", "high"] {
                let own = self.place(d, "first + member");
                let own = dialect.select("boxes > 1u", &own, &format!("{end}{d}"));
                body += &number(&format!("{end}est{d}"), &own);
            }
            let begin = larger(format!("(lowest{d} - {})", self.grid(reach)), self.grid(d));
            let begin = self.cell(0, d, &begin);
            body += &dialect.index(&format!("begin{d}"), &begin);
            let last = self.cell(0, d, &format!("(highest{d} + {})", self.grid(reach)));
            let span = format!("min({last} - begin{d} + 1u, table{d})");
            body += &dialect.index(&format!("span{d}"), &span);
        }
        for d in (1..self.d()).rev() {
            body += &dialect.each(&format!("c{d}"), "0u", &format!("span{d}"));
            let cell = format!("(begin{d} + c{d}) % table{d}");
            body += &dialect.index(&format!("cell{d}"), &cell);
        }
        body += &dialect.index("row", &format!("{} * table0", self.row("other")));
        body += &dialect.index("start", "begin0 % table0");
        body += &dialect.index("middle", "min(start + span0, table0)");
        // A row of cells, and what of it starts anew in the table.
        body += &dialect.each("part", "0u", "2u");
        let part = |first: &str, second: &str| dialect.select("part == 0u", first, second);
        body += &dialect.index("k_first", &format!("cells[row + {}]", part("start", "0u")));
        let rest = part("middle", "start + span0 - middle");
        body += &dialect.index("k_last", &format!("cells[row + {rest}]"));
        body += &dialect.each("k", "k_first", "k_last");
        body += &dialect.index("j", "sorted[k]");
        for d in axes.clone() {
            body += &number(&format!("y{d}"), &self.place(d, "j"));
        }
        for m in members.clone() {
            let squares = axes
                .clone()
                .map(|d| format!("(y{d} - m{m}_{d}) * (y{d} - m{m}_{d})"));
            let square = squares.collect::<Vec<_>>().join(" + ");
            body += &number(&format!("r{m}"), &square);
        }
        let mut within = self.grid(reach + 1);
        if varies {
            let h = larger(self.place(self.d(), "j"), "widest".into());
            let own = format!("{h} * {} + {}", self.grid(reach + 2), self.grid(reach + 3));
            body += &number("far", &own);
            let raised = dialect.constant(1.0 + rounding(dialect.precision));
            within = format!("far * far * {raised}");
        }
        // The first member that is near.
        body += &dialect.counter("near", &format!("{width}u"));
        for m in members.rev() {
            body += &format!("if (r{m} <= {within}) {{ near = {m}u; }}\n");
        }
        body += &format!("if (near < {width}u && (boxes == 1u || near == member)) {{\n");
        if fills {
            body += "list[found] = j;\n";
        }
        body += "found = found + 1u;\n}\n";
        body += &"}\n".repeat(4 + self.d());
        if fills {
            body + "segments[n * 3u] = counts[n];\nsegments[n * 3u + 1u] = found;\n"
        } else {
            // Behind all counts stands what they come to.
            body + "counts[n] = found;\nif (n == 0u) { counts[scene.count] = 0u; }\n"
        }
    }

    /// Numbers of particles in a new order, `scene.length` of them a slot.
    pub fn gather(&self) -> String {
        let dialect = self.dialect;
        dialect.index("row", "i / scene.length")
            + &dialect.index("slot", "row % scene.stride")
            + "room[n] = given[(row - slot + order[slot]) * scene.length + i % scene.length];\n"
    }
}
