//! Names of quantities: what tells them apart, and sets of them that are constants.
//! Where a member of a constant set stands is a constant of the loop that asks for it.

/// What a quantity of an effect is called, and in what it is measured; [`name!`](crate::name) fills in the package.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Name {
    /// The package that the effect belongs to and the name there, as `meshfree::damage`: two packages may use one name.
    pub full: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
}

impl Name {
    /// The name without the package, which files and messages show.
    pub(super) const fn local(&self) -> &'static str {
        let (bytes, mut k) = (self.full.as_bytes(), 0);
        while k + 1 < bytes.len() {
            if bytes[k] == b':' && bytes[k + 1] == b':' {
                return self.full.split_at(k + 2).1;
            }
            k += 1;
        }
        self.full
    }
}

/// The [`Name`](crate::particles::Name) of a field or sum of the package that is being compiled, from its name and SI unit.
///
/// ```
/// use meshfree::name;
/// use meshfree::particles::Field;
/// const STRESS: Field = Field::tensor(name!("stress", "Pa"));
/// assert_eq!((STRESS.name(), STRESS.unit()), ("stress", "Pa"));
/// assert!(STRESS.full_name().ends_with("::stress"));
/// ```
#[macro_export]
macro_rules! name {
    ($name:literal, $unit:literal) => {
        &$crate::particles::Name {
            full: ::core::concat!(::core::env!("CARGO_PKG_NAME"), "::", $name),
            unit: $unit,
        }
    };
}

/// How a quantity changes under rotation and reflection.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Shape {
    /// One number that no rotation changes.
    Scalar,
    /// A point in space.
    Point,
    /// A velocity: also shifted by a moving boundary.
    Velocity,
    /// A vector that only rotates.
    Vector,
    /// A symmetric tensor of six components, xx, yy, zz, yz, xz, xy, whatever the dimension: plane and
    /// uniaxial states need those out of the plane.
    Tensor,
    /// A `D × D` matrix, row by row.
    Matrix,
}

impl Shape {
    const fn word(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Tensor => "tensor",
            Self::Matrix => "matrix",
            _ => "vector",
        }
    }
    #[inline]
    pub(super) const fn components(self, d: usize) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Point | Self::Velocity | Self::Vector => d,
            Self::Tensor => 6,
            Self::Matrix => d * d,
        }
    }
    /// The bits of `places` with this shape at one of them: of scalars, tensors and matrices.
    const fn mark(self, mut marks: [u64; 3], place: usize) -> [u64; 3] {
        match self {
            Self::Scalar => marks[0] |= 1 << place,
            Self::Tensor => marks[1] |= 1 << place,
            Self::Matrix => marks[2] |= 1 << place,
            _ => {}
        }
        marks
    }
}

/// Which places hold scalars, tensors and matrices; all others hold vectors.
pub(super) const fn shapes(all: &[Shape]) -> [u64; 3] {
    let (mut marks, mut place) = ([0; 3], 0);
    while place < all.len() {
        marks = all[place].mark(marks, place);
        place += 1;
    }
    marks
}

/// Numbers of the members at some places, by the places of each shape. Population counts, so that the pair loop sees
/// constants.
#[inline(always)]
const fn width(members: u64, shapes: &[u64; 3], d: usize) -> usize {
    let scalars = (members & shapes[0]).count_ones() as usize;
    let tensors = (members & shapes[1]).count_ones() as usize;
    let matrices = (members & shapes[2]).count_ones() as usize;
    let vectors = members.count_ones() as usize - scalars - tensors - matrices;
    scalars + vectors * d + tensors * 6 + matrices * d * d
}

/// The bits below one.
#[inline(always)]
const fn below(place: usize) -> u64 {
    (1 << place) - 1
}

/// What tells a quantity from all others. The low bits are its shape. Above them stands the place among those of the
/// crate, or the hash of the full name, without the shape, so that a name with two shapes is found.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Key {
    bits: u64,
    name: &'static Name,
}

/// The bits of a shape.
const SHAPE: u32 = 3;
/// What those of effects have.
const OF_EFFECT: u64 = 1 << 63;

impl Key {
    pub const fn of_crate(index: u8, shape: Shape, name: &'static Name) -> Self {
        assert!(index < 64, "those of the crate are 64 at most");
        Self {
            bits: (index as u64) << SHAPE | shape as u64,
            name,
        }
    }
    pub const fn of_effect(shape: Shape, name: &'static Name) -> Self {
        Self {
            bits: OF_EFFECT | fnv(name.full) << SHAPE | shape as u64,
            name,
        }
    }
    #[inline(always)]
    pub const fn index(self) -> Option<usize> {
        if self.bits < OF_EFFECT {
            Some((self.bits >> SHAPE) as usize)
        } else {
            None
        }
    }
    #[inline(always)]
    pub const fn is(self, other: Self) -> bool {
        self.bits == other.bits
    }
    #[inline]
    pub const fn shape(self) -> Shape {
        const ALL: [Shape; 6] = [
            Shape::Scalar,
            Shape::Point,
            Shape::Velocity,
            Shape::Vector,
            Shape::Tensor,
            Shape::Matrix,
        ];
        ALL[(self.bits & ((1 << SHAPE) - 1)) as usize]
    }
    pub const fn name(self) -> &'static Name {
        self.name
    }
    const fn has_hash_of(self, other: Self) -> bool {
        self.bits >> SHAPE == other.bits >> SHAPE
    }
    const fn equals(self, other: Self) -> bool {
        self.is(other)
            && same(self.name.full, other.name.full)
            && same(self.name.unit, other.name.unit)
    }
    /// Why both cannot be members of one set, in words.
    pub fn against(self, other: Self) -> String {
        let says = |own: Self| {
            let Name { full, unit } = own.name;
            format!("`{full}` is a {} [{unit}]", own.shape().word())
        };
        if self.has_hash_of(other) {
            return format!("{}, and {}", says(self), says(other));
        }
        let full = other.name.full;
        format!(
            "there is no room for `{full}` beside {} others of effects",
            Set::MOST
        )
    }
}

/// The hash of a text (Fowler, Noll & Vo 1991).
const fn fnv(text: &str) -> u64 {
    let (bytes, mut hash, mut k) = (text.as_bytes(), 0xcbf2_9ce4_8422_2325, 0);
    while k < bytes.len() {
        hash = (hash ^ bytes[k] as u64).wrapping_mul(0x0100_0000_01b3);
        k += 1;
    }
    hash
}

const fn same(a: &str, b: &str) -> bool {
    let (a, b, mut k) = (a.as_bytes(), b.as_bytes(), 0);
    if a.len() != b.len() {
        return false;
    }
    while k < a.len() {
        if a[k] != b[k] {
            return false;
        }
        k += 1;
    }
    true
}

/// A set of quantities: a bit for each of the crate, and the sorted keys of those of effects.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Set {
    of_crate: u64,
    of_effects: [Key; Set::MOST],
    count: usize,
    /// Which of the keys are scalars, tensors and matrices.
    shapes: [u64; 3],
    /// A member, and the first that could not join it.
    fault: Option<[Key; 2]>,
}

impl Set {
    /// Most members of effects.
    pub const MOST: usize = 32;
    /// The first place of those of effects in tables.
    const FIRST: usize = 64;
    pub const PLACES: usize = Self::FIRST + Self::MOST;
    pub const NONE: Self = Self {
        of_crate: 0,
        // Behind every key that there is.
        of_effects: [Key {
            bits: u64::MAX,
            name: &Name { full: "", unit: "" },
        }; Self::MOST],
        count: 0,
        shapes: [0; 3],
        fault: None,
    };

    pub const fn with(mut self, key: Key) -> Self {
        if let Some(index) = key.index() {
            self.of_crate |= 1 << index;
            return self;
        }
        let at = self.rank(key);
        // A key with the same hash is next to it.
        let mut k = at.saturating_sub(1);
        while k <= at && k < self.count {
            let other = self.of_effects[k];
            if other.equals(key) {
                return self;
            }
            if other.has_hash_of(key) {
                return self.but(other, key);
            }
            k += 1;
        }
        if self.count == Self::MOST {
            return self.but(self.of_effects[0], key);
        }
        let mut k = self.count;
        while k > at {
            self.of_effects[k] = self.of_effects[k - 1];
            k -= 1;
        }
        self.of_effects[at] = key;
        self.count += 1;
        let mut k = 0;
        while k < self.shapes.len() {
            let marks = self.shapes[k];
            self.shapes[k] = marks & below(at) | (marks & !below(at)) << 1;
            k += 1;
        }
        self.shapes = key.shape().mark(self.shapes, at);
        self
    }
    const fn but(mut self, member: Key, key: Key) -> Self {
        if self.fault.is_none() {
            self.fault = Some([member, key]);
        }
        self
    }
    pub const fn fault(&self) -> Option<[Key; 2]> {
        self.fault
    }
    pub const fn union(mut self, other: &Self) -> Self {
        self.of_crate |= other.of_crate;
        let mut k = 0;
        while k < other.count {
            self = self.with(other.of_effects[k]);
            k += 1;
        }
        match other.fault {
            Some([member, key]) => self.but(member, key),
            None => self,
        }
    }
    pub const fn minus(&self, other: &Self) -> Self {
        let (mut rest, mut k) = (Self::NONE, 0);
        rest.of_crate = self.of_crate & !other.of_crate;
        while k < self.count {
            if !other.contains(self.of_effects[k]) {
                rest = rest.with(self.of_effects[k]);
            }
            k += 1;
        }
        rest.fault = self.fault;
        rest
    }
    pub const fn is_empty(&self) -> bool {
        self.of_crate == 0 && self.count == 0
    }
    /// How many keys are less than one: a binary search without a loop, so that it is a constant where the set is one.
    #[inline(always)]
    const fn rank(&self, key: Key) -> usize {
        let (all, bits, mut at) = (&self.of_effects, key.bits, 0);
        at += 16 * (all[at + 15].bits < bits) as usize;
        at += 8 * (all[at + 7].bits < bits) as usize;
        at += 4 * (all[at + 3].bits < bits) as usize;
        at += 2 * (all[at + 1].bits < bits) as usize;
        at += (all[at].bits < bits) as usize;
        at + (all[at].bits < bits) as usize
    }
    #[inline(always)]
    pub const fn contains(&self, key: Key) -> bool {
        if let Some(index) = key.index() {
            return self.of_crate >> index & 1 == 1;
        }
        let at = self.rank(key);
        at < Self::MOST && self.of_effects[at].is(key)
    }
    #[inline(always)]
    pub const fn offset(&self, key: Key, shapes: &[u64; 3], d: usize) -> usize {
        if let Some(index) = key.index() {
            return width(self.of_crate & below(index), shapes, d);
        }
        width(self.of_crate, shapes, d) + width(below(self.rank(key)), &self.shapes, d)
    }
    #[inline(always)]
    pub const fn width(&self, shapes: &[u64; 3], d: usize) -> usize {
        width(self.of_crate, shapes, d) + width(below(self.count), &self.shapes, d)
    }
    #[inline(always)]
    pub const fn place(&self, key: Key) -> Option<usize> {
        match key.index() {
            Some(index) => Some(index),
            None if self.contains(key) => Some(Self::FIRST + self.rank(key)),
            None => None,
        }
    }
    /// The first place from one on that a member has.
    pub const fn place_from(&self, place: usize) -> Option<usize> {
        if place < Self::FIRST {
            let rest = self.of_crate & !below(place);
            if rest != 0 {
                return Some(rest.trailing_zeros() as usize);
            }
        }
        let at = if place < Self::FIRST {
            Self::FIRST
        } else {
            place
        };
        if at < Self::FIRST + self.count {
            Some(at)
        } else {
            None
        }
    }
    /// The member of an effect at a place.
    pub const fn of_effect(&self, place: usize) -> Option<Key> {
        match place.checked_sub(Self::FIRST) {
            Some(at) => Some(self.of_effects[at]),
            None => None,
        }
    }
}
