//! Steps allocate nothing: counted by an allocator of the test's own, on the threads that step.

use meshfree::boundary::{MirrorPlane, Periodic, Wall};
use meshfree::kernel::CubicSpline;
use meshfree::material::catalogue;
use meshfree::neighbors::CHUNK;
use meshfree::particles::{Field, Fields};
use meshfree::scalar::{Lane, Real};
use meshfree::scene::{Body, Scene, Start};
use meshfree::scheme::SchemeBuilder;
use meshfree::schemes;
use meshfree::simulation::{Simulation, Thresholds};
use meshfree::term::viscosity::{ArtificialViscosity, Viscous};
use meshfree::term::{Layout as TermLayout, Pair, TermDoc};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

thread_local! {
    /// Whether this thread's allocations are counted: other tests allocate meanwhile.
    static COUNTED: Cell<bool> = const { Cell::new(false) };
}

fn count() {
    if COUNTED.get() {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
    }
}

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations in steps between list builds, after a warm-up.
fn counted<const D: usize>(simulation: &mut Simulation<f64, D>) -> (u64, u64) {
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let (mut counted, mut steps) = (0, 0);
    for _ in 0..60 {
        let (builds, before) = (
            simulation.list_builds(),
            ALLOCATIONS.load(Ordering::Relaxed),
        );
        simulation.step().unwrap();
        if simulation.list_builds() == builds {
            counted += ALLOCATIONS.load(Ordering::Relaxed) - before;
            steps += 1;
        }
    }
    (counted, steps)
}

/// A viscosity with a table on the heap: Π = Σₖ aₖ μᵏ/ρ̄ for approaching pairs, μ = h |v·r|/(r² + 0.01 h²).
#[derive(Clone, Debug)]
struct Polynomial {
    coefficients: Vec<f64>,
}

impl<const D: usize> ArtificialViscosity<D> for Polynomial {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: TermLayout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        let approach = (-pair.v_dot_r).positive_part();
        let mu = pair.h * approach / pair.h.mul_add(pair.h * L::of(0.01), pair.r2);
        let mut sum = L::zero();
        for &coefficient in self.coefficients.iter().rev() {
            sum = sum.mul_add(mu, L::of(coefficient));
        }
        let density = (pair.i(Field::DENSITY) + pair.j(Field::DENSITY)) * L::of(0.5);
        Viscous {
            pi: sum / density,
            signal: mu,
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("polynomial viscosity {:?}", self.coefficients),
            equation: "Π = Σₖ aₖ μᵏ/ρ̄",
            source: "",
        }
    }
}

#[test]
fn a_step_between_list_builds_allocates_nothing() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .start_handler(|_| COUNTED.set(true))
        .build()
        .unwrap();
    // Inside of the pool: handing work to it from outside allocates now and then.
    pool.install(|| {
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        drop(std::hint::black_box(Box::new(0)));
        assert!(
            ALLOCATIONS.load(Ordering::Relaxed) > before,
            "nothing is counted"
        );
        // A thread makes its room for the other sides of pairs once, when it first gets a chunk that has them: four sums of
        // eight by eight.
        rayon::broadcast(|_| f64::with_room(CHUNK * 8 * 8 * 4, &mut |_| ()));
        for scheme in [schemes::impact, schemes::impact_by_continuity] {
            let mut rods = Scene::<f64, 1>::new(scheme())
                .body(
                    Body::block("striker", catalogue::copper(), [0.0], [0.05], 1e-5)
                        .velocity([20.0]),
                )
                .body(Body::block(
                    "target",
                    catalogue::pmma(),
                    [0.05],
                    [0.1],
                    1e-5,
                ))
                .boundary(MirrorPlane::wall([0.1], [1.0]))
                .build()
                .unwrap();
            // Watching allocates as little.
            rods.keep_stability(Thresholds {
                every: 1,
                ..Thresholds::default()
            });
            let (allocations, steps) = counted(&mut rods);
            println!(
                "{}: {allocations} allocations in {steps} steps",
                rods.scheme().name()
            );
            assert!(steps > 40, "lists are built too often to tell: {steps}");
            assert_eq!(allocations, 0, "{}", rods.scheme().name());
        }
        let polynomial = Polynomial {
            coefficients: vec![0.0, 4e3, 2.0],
        };
        for (name, scheme) in [
            ("sheet", schemes::impact().compose()),
            (
                "sheet with a table in its viscosity",
                SchemeBuilder::new(CubicSpline, polynomial).compose(),
            ),
        ] {
            let mut sheet = Scene::<f64, 2>::new(scheme)
                .body(
                    Body::block("sheet", catalogue::copper(), [0.0; 2], [1.0; 2], 0.02).start(
                        |x, start| Start {
                            velocity: [(core::f64::consts::TAU * x[1]).sin(), 0.0],
                            ..start
                        },
                    ),
                )
                .boundary(Periodic::along(0, 0.0, 1.0))
                .boundary(Periodic::along(1, 0.0, 1.0))
                .build()
                .unwrap();
            let (allocations, steps) = counted(&mut sheet);
            println!("{name}: {allocations} allocations in {steps} steps");
            assert!(steps > 40);
            assert_eq!(allocations, 0, "{name}");
        }
        let mut pool = Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(Body::block(
                "pool",
                catalogue::weakly_compressible_water(1.0),
                [0.0; 2],
                [1.0; 2],
                0.02,
            ))
            .wall(Wall::around(
                "tank",
                [0.0; 2],
                [1.0; 2],
                0.02,
                4,
                [[true; 2]; 2],
            ))
            .build()
            .unwrap();
        let (allocations, steps) = counted(&mut pool);
        println!("pool: {allocations} allocations in {steps} steps");
        assert!(steps > 40);
        assert_eq!(allocations, 0);
    });
}
