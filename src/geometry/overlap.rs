//! The volume that a mesh holds more than once, or with its inside out, by lines through it.
//! Along a line winding numbers are exact; what lines are apart is what the volume of an overlap is known to.

/// Lines along each of two axes.
const LINES: usize = 512;

type Point = [f64; 3];

/// Where a triangle meets a line.
struct Crossing {
    line: usize,
    /// How far along the line \[m\].
    at: f64,
    /// By how much the winding number changes there.
    change: i32,
}

/// ∫ ([w > 0] − w) dV \[m³\] over all space, with the winding number w: what the sum of signed volumes of shells has to be
/// corrected by to be the volume in which w is above zero. Exactly zero where no shells overlap and none is inside out.
pub(super) fn correction(triangles: &[[Point; 3]], low: Point, high: Point) -> f64 {
    // Along the longest axis, so that there are fewest lines in thin meshes.
    let size = |d: usize| high[d] - low[d];
    let along = (0..3)
        .max_by(|&a, &b| size(a).total_cmp(&size(b)))
        .unwrap_or(0);
    let [u, v] = [(along + 1) % 3, (along + 2) % 3];
    let step = [u, v].map(|d| size(d) / LINES as f64);
    // Off the middle of their cells, so that lines do not run along edges of what has round coordinates.
    let place = |d: usize, k: usize| {
        let (axis, off) = if d == u { (0, 0.487_3) } else { (1, 0.512_9) };
        low[d] + (k as f64 + off) * step[axis]
    };
    let mut crossings = Vec::new();
    for own in triangles {
        let range = |d: usize, axis: usize| {
            let corners = own.map(|x| (x[d] - low[d]) / step[axis]);
            let from = corners.into_iter().fold(f64::INFINITY, f64::min) - 1.0;
            let to = corners.into_iter().fold(f64::NEG_INFINITY, f64::max) + 1.0;
            from.max(0.0) as usize..(to.max(0.0) as usize).min(LINES - 1) + 1
        };
        for j in range(v, 1) {
            for i in range(u, 0) {
                let x = [place(u, i), place(v, j)];
                if let Some((at, change)) = crossing(own, x, [u, v, along]) {
                    let line = j * LINES + i;
                    crossings.push(Crossing { line, at, change });
                }
            }
        }
    }
    crossings.sort_unstable_by(|a, b| a.line.cmp(&b.line).then(a.at.total_cmp(&b.at)));
    let mut length = 0.0;
    for line in crossings.chunk_by(|a, b| a.line == b.line) {
        // What an edge has hidden says nothing.
        if line.iter().map(|own| own.change).sum::<i32>() != 0 {
            continue;
        }
        let mut winding = 0;
        for pair in line.windows(2) {
            winding += pair[0].change;
            let wanted = i32::from(winding > 0);
            length += f64::from(wanted - winding) * (pair[1].at - pair[0].at);
        }
    }
    length * step[0] * step[1]
}

/// Where the line through `x` meets a triangle, and by how much the winding number changes on the way up.
fn crossing(own: &[Point; 3], x: [f64; 2], [u, v, along]: [usize; 3]) -> Option<(f64, i32)> {
    // Twice the areas of the triangles that the line makes with the edges. The corners of an edge are taken in one order, so that
    // the two triangles at it get the same number with the opposite sign, and one of them has the line.
    let area = |a: &Point, b: &Point| {
        let key = |p: &Point| (p[u], p[v], p[along]);
        let ordered = key(a) <= key(b);
        let (p, q) = if ordered { (a, b) } else { (b, a) };
        let value = (q[u] - p[u]) * (x[1] - p[v]) - (q[v] - p[v]) * (x[0] - p[u]);
        if ordered { value } else { -value }
    };
    let [a, b, c] = own;
    let areas = [area(b, c), area(c, a), area(a, b)];
    let sum: f64 = areas.iter().sum();
    let inside = areas.iter().all(|s| *s > 0.0) || areas.iter().all(|s| *s < 0.0);
    if !inside || sum == 0.0 {
        return None;
    }
    let at = (0..3).map(|k| areas[k] * own[k][along]).sum::<f64>() / sum;
    // Counter-clockwise seen from above is a top, above which one is outside.
    Some((at, if sum > 0.0 { -1 } else { 1 }))
}
