//! Work shared out over threads: what shares it out is compiled once, and not once for each loop.
//! A loop is one indirect call a piece, so pieces are of some thousand numbers. The one file that knows the pool:
//! without the feature `parallel` the same pieces are done one after another, to the same bits.

use std::marker::PhantomData;
use std::ops::Range;

/// Numbers that are worth an indirect call and a look of another thread.
pub(crate) const GRAIN: usize = 4096;

/// What is cut into pieces that threads take by their numbers.
pub(crate) trait Pieces: Sync {
    /// What a thread gets.
    type Piece;
    /// How many there are.
    fn count(&self) -> usize;
    /// The piece with a number below their count.
    ///
    /// # Safety
    /// No piece is taken again while it is in use.
    unsafe fn piece(&self, number: usize) -> Self::Piece;
}

/// A range of numbers in pieces.
pub(crate) struct Runs {
    range: Range<usize>,
    size: usize,
}

/// A range in pieces of `size` numbers, and of fewer at its end.
pub(crate) fn runs(range: Range<usize>, size: usize) -> Runs {
    Runs { range, size }
}

impl Pieces for Runs {
    type Piece = Range<usize>;

    fn count(&self) -> usize {
        self.range.len().div_ceil(self.size)
    }

    unsafe fn piece(&self, number: usize) -> Range<usize> {
        let first = self.range.start + number * self.size;
        first..self.range.end.min(first + self.size)
    }
}

/// A slice in pieces.
pub(crate) struct Cut<'a, V> {
    data: *mut V,
    length: usize,
    size: usize,
    borrowed: PhantomData<&'a mut [V]>,
}

// SAFETY: threads get pieces of the slice that do not overlap, as if it had been split among them.
unsafe impl<V: Send> Sync for Cut<'_, V> {}

/// A slice in pieces of `size` entries (one, if `size` is zero), and of fewer at its end.
pub(crate) fn cut<V>(data: &mut [V], size: usize) -> Cut<'_, V> {
    Cut {
        data: data.as_mut_ptr(),
        length: data.len(),
        size: size.max(1),
        borrowed: PhantomData,
    }
}

impl<'a, V: Send> Pieces for Cut<'a, V> {
    type Piece = &'a mut [V];

    fn count(&self) -> usize {
        self.length.div_ceil(self.size)
    }

    unsafe fn piece(&self, number: usize) -> &'a mut [V] {
        // Behind the end there is nothing.
        let first = self.length.min(number * self.size);
        let count = self.size.min(self.length - first);
        // SAFETY: these entries are of the slice that is borrowed, and of no other piece.
        unsafe { std::slice::from_raw_parts_mut(self.data.add(first), count) }
    }
}

/// Two slices whose pieces belong together: as many as the first has, and the second may end before.
impl<A: Pieces, B: Pieces> Pieces for (A, B) {
    type Piece = (A::Piece, B::Piece);

    fn count(&self) -> usize {
        self.0.count()
    }

    unsafe fn piece(&self, number: usize) -> Self::Piece {
        // SAFETY: taken once, as the two are.
        unsafe { (self.0.piece(number), self.1.piece(number)) }
    }
}

/// Does `work` with the number of each piece and the piece, in any order.
pub(crate) fn for_each<P: Pieces>(pieces: P, work: impl Fn(usize, P::Piece) + Sync) {
    // SAFETY: each number comes once.
    share(0..pieces.count(), &|k| work(k, unsafe { pieces.piece(k) }));
}

/// One value for each number below `count`, in order.
pub(crate) fn collect<V: Send>(count: usize, of: impl Fn(usize) -> V + Sync) -> Vec<V> {
    let mut values: Vec<Option<V>> = Vec::new();
    values.resize_with(count, || None);
    for_each(cut(&mut values, 1), |k, own| own[0] = Some(of(k)));
    values.into_iter().flatten().collect()
}

/// Sorts numbers from `first` on by their keys; those of one key keep their order.
pub(crate) fn sort_by_key(numbers: &mut [u32], first: usize, keys: &[u64]) {
    let key = |&number: &u32| keys[number as usize - first];
    #[cfg(feature = "parallel")]
    rayon::slice::ParallelSliceMut::par_sort_by_key(numbers, key);
    #[cfg(not(feature = "parallel"))]
    numbers.sort_by_key(key);
}

/// Does both, at once if a thread is free.
pub(crate) fn join<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "parallel")]
    return rayon::join(a, b);
    #[cfg(not(feature = "parallel"))]
    (a(), b())
}

/// Does `work` inside the pool, so that its many short loops start without waking a thread for each.
pub(crate) fn inside<V: Send>(work: impl FnOnce() -> V + Send) -> V {
    #[cfg(feature = "parallel")]
    return rayon::scope(|_| work());
    #[cfg(not(feature = "parallel"))]
    work()
}

/// How many threads there are.
pub(crate) fn threads() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    1
}

/// Threads of their own, where there are any.
pub(crate) struct Pool(#[cfg(feature = "parallel")] rayon::ThreadPool);

impl Pool {
    /// A pool of so many threads, or why there is none.
    pub(crate) fn new(threads: usize) -> Result<Self, String> {
        #[cfg(feature = "parallel")]
        return match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => Ok(Self(pool)),
            Err(why) => Err(why.to_string()),
        };
        #[cfg(not(feature = "parallel"))]
        match threads {
            1 => Ok(Self()),
            _ => Err("more than one thread needs the feature `parallel`".into()),
        }
    }

    /// Does `work` in this pool.
    pub(crate) fn install<V: Send>(&self, work: impl FnOnce() -> V + Send) -> V {
        #[cfg(feature = "parallel")]
        return self.0.install(work);
        #[cfg(not(feature = "parallel"))]
        work()
    }
}

/// Does `work` by threads of its own while this one waits and does nothing else, as one that keeps others waiting must.
pub(crate) fn apart(work: impl FnOnce() + Send) {
    #[cfg(feature = "parallel")]
    match Pool::new(threads()) {
        Ok(pool) => {
            let done = std::thread::scope(|scope| scope.spawn(|| pool.install(work)).join());
            done.unwrap_or_else(|panicked| std::panic::resume_unwind(panicked));
        }
        // A system without threads has none that could wait.
        Err(_) => work(),
    }
    #[cfg(not(feature = "parallel"))]
    work();
}

/// Halves of a range of numbers by two threads, until each has one.
fn share(numbers: Range<usize>, work: &(dyn Fn(usize) + Sync)) {
    match numbers.len() {
        0 => {}
        1 => work(numbers.start),
        count => {
            let middle = numbers.start + count.div_ceil(2);
            join(
                || share(numbers.start..middle, work),
                || share(middle..numbers.end, work),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_met_once() {
        for (count, size) in [(0, 3), (1, 3), (3, 3), (10, 3), (1000, 7)] {
            let met = |piece: usize, own: Range<usize>| {
                assert_eq!(own.start, 5 + piece * size);
                [own.len(), own.sum()].map(|n| n as u64)
            };
            let sums = crate::collective::over_pieces(runs(5..5 + count, size), met);
            assert_eq!(sums, [count, (5..5 + count).sum()].map(|n| n as u64));
        }
    }

    #[test]
    fn a_second_slice_may_be_empty_or_of_another_width() {
        let (mut wide, mut narrow, mut none) = ([0; 20], [0; 10], [0; 0]);
        for_each((cut(&mut wide, 6), cut(&mut narrow, 3)), |k, own| {
            own.0.fill(k);
            own.1.fill(k);
        });
        assert_eq!(wide[..6], [0; 6]);
        assert_eq!(wide[18..], [3; 2]);
        assert_eq!(narrow[9], 3);
        for_each((cut(&mut wide, 6), cut(&mut none, 6)), |_, own| {
            own.0.fill(9);
            assert!(own.1.is_empty());
        });
        assert_eq!(wide, [9; 20]);
    }

    #[test]
    fn collected_and_sorted_values_keep_their_order() {
        assert_eq!(collect(4, |k| k * k), [0, 1, 4, 9]);
        let mut numbers = [2, 3, 4, 5];
        sort_by_key(&mut numbers, 2, &[7, 1, 7, 0]);
        assert_eq!(numbers, [5, 3, 2, 4]);
    }
}
