//! Files that are cut, altered or nonsense: checkpoints, tables, states, records of motion and meshes are read, or refused.
//! An altered checkpoint is never resumed from.

use super::guard;
use super::numbers::Numbers;
use meshfree::boundary::{Motion, Translation};
use meshfree::output::csv::Csv;
use meshfree::study::records::Record;

/// Bytes that are altered in some places, cut, doubled or replaced.
fn alter(n: &mut Numbers, bytes: &[u8]) -> Vec<u8> {
    let mut own = bytes.to_vec();
    match n.below(5) {
        0 => own.truncate(n.below(bytes.len() + 1)),
        1 => {
            for _ in 0..=n.below(4) {
                let at = n.below(own.len());
                own[at] ^= 1 << n.below(8);
            }
        }
        2 => {
            let at = n.below(own.len());
            let extra: Vec<u8> = (0..n.below(40)).map(|_| n.random.bits() as u8).collect();
            own.splice(at..at, extra);
        }
        3 => {
            let (a, b) = (n.below(own.len()), n.below(own.len()));
            let part = own[a.min(b)..a.max(b)].to_vec();
            own.splice(a..a, part);
        }
        _ => {
            let at = n.below(own.len());
            let end = (at + 1 + n.below(16)).min(own.len());
            own[at..end].fill([0, 0xff, b'9', b'-'][n.below(4)]);
        }
    }
    own
}

const TEXT: &str = "# a comment\nt [s],p [Pa],\"a, b\"\n0,1.5,\"x\"\n1e-3,-2.5e300,y\n2e-3,NaN,z\n";

pub fn table(seed: u64) -> &'static str {
    let mut n = Numbers::of(seed);
    let bytes = alter(&mut n, TEXT.as_bytes());
    let text = String::from_utf8_lossy(&bytes);
    let records = Record::parse(&text);
    if let Ok(records) = &records {
        let at = n.between(-1.0, 1.0);
        let _ = records
            .column("p [Pa]")
            .is_ok_and(|column| column.is_empty());
        let _ = records.interpolate("p [Pa]", "t [s]", at);
    }
    match Csv::parse(&text) {
        Ok(table) => {
            let _ = (table.column("t [s]"), table.text_column("p [Pa]"));
            "read"
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            "refused"
        }
    }
}

#[test]
fn tables_are_read_or_refused() {
    let words = guard::all("tables", 0, 20_000, table);
    assert!(guard::share(&words, "read") > 100 && guard::share(&words, "refused") > 100);
}

pub fn record(seed: u64) -> &'static str {
    let mut n = Numbers::of(seed);
    let mut time = 0.0;
    let count = n.below(8);
    let rows: Vec<_> = (0..count)
        .map(|_| {
            time += n.between(1e-4, 1e-2);
            (time, n.pair(300.0))
        })
        .collect();
    match Translation::<2>::from_acceleration(&rows) {
        Ok(motion) => {
            for k in 0..20 {
                let pose = motion.pose(0.01 * f64::from(k) - 0.05);
                let all = (0..3).flat_map(|order| pose.of(order, &[0.1, 0.2]));
                for value in all {
                    assert!(value.is_finite(), "{rows:?}: {value}");
                }
            }
            "moves"
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            "refused"
        }
    }
}

#[test]
fn records_of_motion_move_or_are_refused() {
    let words = guard::all("records of motion", 0, 20_000, record);
    assert!(guard::share(&words, "moves") > 1000 && guard::share(&words, "refused") > 1000);
}

/// A body that starts from an altered file of another run.
pub fn state(seed: u64) -> &'static str {
    use meshfree::prelude::*;
    use meshfree::scene::ParticleState;
    let mut n = Numbers::of(seed);
    let water = || catalogue::weakly_compressible_water(2.0);
    let block = || Body::<f64, 2>::block("water", water(), [0.0; 2], [0.06, 0.04], 0.01);
    let scene = Scene::<f64, 2>::new(schemes::weakly_compressible()).body(block());
    let run = scene.build().expect("water");
    let path = std::env::temp_dir().join(format!("meshfree-{}-state", std::process::id()));
    let table = n.below(2) == 0;
    if table {
        let whole = ParticleState::of(&run);
        whole.write_csv(&path).expect("a table");
    } else {
        run.vtu().write(&path).expect("a file");
    }
    let bytes = alter(&mut n, &std::fs::read(&path).expect("bytes"));
    std::fs::write(&path, bytes).expect("a file");
    let state = if table {
        ParticleState::<2>::read_csv(&path)
    } else {
        ParticleState::read_vtu(&path)
    };
    let started = state.and_then(|state| {
        let body = Body::<f64, 2>::of_state("water", water(), &state, 0.01)?;
        block().started_from(&state)?;
        Scene::new(schemes::weakly_compressible())
            .body(body)
            .build()
            .map(drop)
    });
    match started {
        Ok(()) => "starts",
        Err(error) => {
            assert!(!error.to_string().is_empty());
            "refused"
        }
    }
}

#[test]
fn states_of_files_start_a_body_or_are_refused() {
    let words = guard::all("states", 0, 2_000, state);
    assert!(guard::share(&words, "starts") > 100 && guard::share(&words, "refused") > 100);
}

#[cfg(feature = "meshes")]
mod meshes {
    use super::super::numbers::Numbers;
    use super::{alter, guard};
    use meshfree::geometry::{Mesh, Shape, fill};

    /// A tetrahedron as text and in bytes.
    fn solids() -> [Vec<u8>; 2] {
        let corners = [
            [0.0, 0.0, 0.0_f32],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mut text = String::from("solid it\n");
        let mut bytes = vec![0_u8; 80];
        bytes.extend(4_u32.to_le_bytes());
        for face in faces {
            text += "facet normal 0 0 0\nouter loop\n";
            bytes.extend([0_u8; 12]);
            for corner in face.map(|k: usize| corners[k]) {
                text += &format!("vertex {} {} {}\n", corner[0], corner[1], corner[2]);
                for x in corner {
                    bytes.extend(x.to_le_bytes());
                }
            }
            text += "endloop\nendfacet\n";
            bytes.extend([0_u8; 2]);
        }
        text += "endsolid it\n";
        [text.into_bytes(), bytes]
    }

    fn case(path: &std::path::Path, seed: u64) -> &'static str {
        let mut n = Numbers::of(seed);
        let whole = &solids()[n.below(2)];
        let bytes = if n.once_in(50) {
            whole.clone()
        } else {
            alter(&mut n, whole)
        };
        std::fs::write(path, bytes).expect("a file");
        match Mesh::read(path, n.scale(1e-3, 10.0)) {
            Ok(mesh) => {
                assert!(mesh.volume().is_finite());
                let x = core::array::from_fn(|_| n.random.unit());
                assert!(!mesh.signed_distance(&x).is_nan());
                // A lattice of millions takes its time, and is no fault.
                let (low, high) = mesh.bounds();
                let size = (0..3).map(|d| high[d] - low[d]).fold(0.0, f64::max);
                let _ = fill(&mesh, size * n.scale(0.1, 1.0), [0.0; 3]);
                "read"
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                "refused"
            }
        }
    }

    #[test]
    fn meshes_are_read_or_refused() {
        let path = std::env::temp_dir().join(format!("meshfree-robust-{}.stl", std::process::id()));
        let words = guard::all("meshes", 0, 2000, |seed| case(&path, seed));
        let _ = std::fs::remove_file(&path);
        assert!(guard::share(&words, "read") > 50 && guard::share(&words, "refused") > 500);
    }
}

#[cfg(feature = "checkpoint")]
pub mod checkpoints {
    use super::super::numbers::Numbers;
    use super::{alter, guard};
    use meshfree::effect::NeoHookean;
    use meshfree::prelude::*;

    pub fn scene() -> Scene<f64, 2> {
        let water = catalogue::weakly_compressible_water(10.0);
        let plate = Body::block(
            "plate",
            catalogue::tank_pmma(),
            [-0.03, 0.0],
            [0.0, 0.1],
            0.01,
        );
        Scene::new(schemes::weakly_compressible())
            .body(Body::block("water", water, [0.0; 2], [0.1; 2], 0.01).velocity([-1.0, 0.0]))
            .group(schemes::total_lagrangian().with(NeoHookean), [plate])
            .at_rest_until_contact("plate")
    }

    #[test]
    fn an_altered_checkpoint_is_refused() {
        let folder = std::env::temp_dir();
        let path = folder.join(format!(
            "meshfree-robust-{}.safetensors",
            std::process::id()
        ));
        let mut simulation = scene().build().expect("a scene");
        for _ in 0..3 {
            simulation.step().expect("a step");
        }
        simulation.save(&path).expect("a file");
        let whole = std::fs::read(&path).expect("a file");
        let words = guard::all("checkpoints", 0, 1500, |seed| {
            let mut n = Numbers::of(seed);
            let bytes = if n.once_in(100) {
                whole.clone()
            } else {
                alter(&mut n, &whole)
            };
            std::fs::write(&path, &bytes).expect("a file");
            match scene().resume(&path) {
                Ok(mut simulation) => {
                    assert_eq!(bytes, whole, "an altered file was taken for a good one");
                    simulation.step().expect("a step");
                    "resumed"
                }
                Err(error) => {
                    assert!(bytes != whole, "a good file was refused: {error}");
                    "refused"
                }
            }
        });
        let _ = std::fs::remove_file(&path);
        assert!(guard::share(&words, "refused") > 1000, "{words:?}");
        assert!(guard::share(&words, "resumed") > 3, "{words:?}");
    }
}
