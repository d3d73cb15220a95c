//! Particle files in pieces: together they are the file of a run on one process, to the bit, and what one rank cannot write is one
//! error on all.

use super::bits::said;
use super::scenes::{dam_break, periodic_gas, rod, tank_in_space};
use super::watched;
use crate::common::folder::Folder;
use meshfree::prelude::*;
use meshfree::ranks::{self, Ranks};
use meshfree::run::{Run, Schedule};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// The text of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let start = tag.split_once(&format!(" {name}=\"")).expect(name).1;
    start.split('"').next().expect(name)
}

/// What a list or a file declares, in its order: name, type and components.
type Declared = Vec<[String; 3]>;

fn declared(xml: &str, tag: &str) -> Declared {
    let begin = format!("<{tag} ");
    let tags = xml.split(&begin).skip(1);
    let of = |tag: &str| {
        ["Name", "type", "NumberOfComponents"]
            .map(|name| attribute(&format!(" {tag}"), name).into())
    };
    tags.map(of).collect()
}

/// A particle file: what it declares of particles, its time, and all bytes of each particle by its number.
struct File {
    declared: Declared,
    time: Vec<u8>,
    particles: BTreeMap<i64, Vec<u8>>,
}

fn read(path: &Path) -> File {
    const DATA: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let head = bytes.windows(DATA.len()).position(|own| own == DATA);
    let head = head.expect("appended data");
    let data = &bytes[head + DATA.len()..];
    let xml = std::str::from_utf8(&bytes[..head]).expect("text");
    let array = |name: &str| -> Vec<u8> {
        let tags = xml.split("<DataArray ").skip(1);
        let tag = tags
            .map(|tag| format!(" {tag}"))
            .find(|tag| attribute(tag, "Name") == name);
        let at: usize = attribute(&tag.expect(name), "offset")
            .parse()
            .expect("an offset");
        let length = u64::from_le_bytes(data[at..at + 8].try_into().expect("a length")) as usize;
        data[at + 8..at + 8 + length].to_vec()
    };
    let of_points = xml.split_once("<PointData>").expect("columns").1;
    let of_points = of_points.split("<Cells>").next().expect("columns");
    let declared = declared(of_points, "DataArray");
    let count: usize = attribute(xml, "NumberOfPoints").parse().expect("a number");
    let columns: Vec<Vec<u8>> = declared.iter().map(|own| array(&own[0])).collect();
    let numbers = array("number");
    let mut particles = BTreeMap::new();
    for n in 0..count {
        let mut own = Vec::new();
        for column in &columns {
            let width = column.len() / count;
            own.extend_from_slice(&column[n * width..(n + 1) * width]);
        }
        let number = numbers[8 * n..8 * n + 8].try_into().expect("a number");
        let before = particles.insert(i64::from_le_bytes(number), own);
        assert!(before.is_none(), "a particle is there twice");
    }
    File {
        declared,
        time: array("TimeValue"),
        particles,
    }
}

/// Compares a list of so many pieces with the file of all particles.
fn same_particles(list: &Path, count: usize, whole: &Path, at: &str) {
    let text = fs::read_to_string(list).expect("a list");
    let whole = read(whole);
    assert_eq!(declared(&text, "PDataArray"), whole.declared, "{at}");
    let sources: Vec<_> = text.split("<Piece").skip(1).collect();
    assert_eq!(sources.len(), count, "{at}");
    let mut together = BTreeMap::new();
    for source in sources {
        let piece = read(&list.with_file_name(attribute(source, "Source")));
        assert_eq!(piece.declared, whole.declared, "{at}");
        assert_eq!(piece.time, whole.time, "{at}");
        // Each rank has its share, and none of them all.
        let (own, all) = (piece.particles.len(), whole.particles.len());
        assert!(own > 0 && (own < all || count == 1), "{at}: {own} of {all}");
        for (number, bytes) in piece.particles {
            assert!(
                together.insert(number, bytes).is_none(),
                "{at}: {number} twice"
            );
        }
    }
    assert!(together == whole.particles, "{at}: other particles");
}

/// Where a series begins, two times between steps, and the end.
fn series<T: Real, const D: usize>(
    scene: Scene<T, D>,
    (end, path): (f64, &Path),
    in_pieces: bool,
) -> Result<(Vec<u64>, u64), Error> {
    let mut simulation = scene.build()?;
    let run = Run::new(&mut simulation, end);
    let schedule = Schedule::every(end / 2.7).and(Schedule::end());
    if in_pieces {
        run.paraview_in_pieces(schedule, path).go()?;
    } else {
        run.paraview(schedule, path).go()?;
    }
    Ok((said(&simulation), simulation.work().pairs))
}

fn pieces_are_the_whole<T: Real, const D: usize>(
    name: &'static str,
    end: f64,
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    watched(move || {
        let folder = Folder::new(&format!("pieces-{}", name.replace(' ', "-")));
        let plain = folder.0.join("plain.pvd");
        let expected = series(scene(), (end, &plain), false).expect("a run");
        let mut silent = scene().build().expect("the scene");
        silent.run_until(end).expect("a run");
        assert!(said(&silent) == expected.0, "{name}: files change the run");
        for count in [1, 2, 3] {
            let path = folder.0.join(format!("on_{count}.pvd"));
            let program =
                |ranks: Arc<dyn Ranks>| series(scene().on_ranks(ranks), (end, &path), true);
            for own in ranks::in_threads(count, 1, program).expect("threads") {
                assert!(
                    own.expect("a run") == expected,
                    "{name}: other bits on {count}"
                );
            }
            let [list, of_plain] =
                [&path, &plain].map(|path| fs::read_to_string(path).expect("a list"));
            let named = of_plain.replace("plain", &format!("on_{count}"));
            assert_eq!(list, named.replace(".vtu", ".pvtu"), "{name}");
            for frame in 0..4 {
                let own = folder.0.join(format!("on_{count}_{frame:05}.pvtu"));
                let whole = folder.0.join(format!("plain_{frame:05}.vtu"));
                let at = format!("{name} on {count}, frame {frame}");
                same_particles(&own, count, &whole, &at);
            }
            assert!(!folder.0.join(format!("on_{count}_00004.pvtu")).exists());
        }
    });
}

#[test]
fn pieces_of_a_dam_break_are_the_whole() {
    pieces_are_the_whole("dam break", 0.02, dam_break);
}

#[test]
fn pieces_of_a_tank_in_space_are_the_whole() {
    pieces_are_the_whole("tank in space", 0.002, tank_in_space);
}

#[test]
fn pieces_of_a_gas_are_the_whole() {
    pieces_are_the_whole("periodic gas", 0.02, periodic_gas);
}

#[test]
fn a_piece_that_cannot_be_written_is_one_error_on_all_ranks() {
    watched(|| {
        let folder = Folder::new("pieces-errors");
        let path = folder.0.join("now.pvtu");
        let mut plain = rod(400.0).build().expect("the scene");
        plain.run_until(2e-8).expect("a run");
        let expected = said(&plain);
        // A folder stands where a file must be: of rank 1, of ranks 1 and 2, and the list.
        for (blocked, failed) in [
            (&["now_1.vtu"][..], 1),
            (&["now_2.vtu", "now_1.vtu"], 1),
            (&["now_2.vtu"], 2),
            (&["now.pvtu"], 0),
        ] {
            for name in blocked {
                let _ = fs::remove_file(folder.0.join(name));
                fs::create_dir_all(folder.0.join(name).join("full")).expect("a folder");
            }
            let all = ranks::in_threads(3, 1, |ranks| {
                let is_first = ranks.rank() == 0;
                let mut simulation = rod(400.0).on_ranks(ranks).build().expect("the scene");
                simulation.run_until(1e-8).expect("a run");
                let error = simulation.write_pieces(&path).expect_err("blocked");
                assert!(
                    matches!(error, Error::Rank { rank, .. } if rank == failed),
                    "{error}"
                );
                let listed = path.is_file();
                // A run goes on after it, and writes where nothing is in the way.
                simulation
                    .write_pieces(folder.0.join("other.pvtu"))
                    .expect("files");
                simulation.run_until(2e-8).expect("a run");
                assert!(said(&simulation) == expected);
                (error.to_string(), listed && is_first)
            });
            let all = all.expect("threads");
            assert!(all.iter().all(|own| *own == all[0]), "{all:#?}");
            let text = format!("rank {failed} has failed");
            let named = if failed == 0 {
                "now.pvtu".into()
            } else {
                format!("now_{failed}.vtu")
            };
            assert!(
                all[0].0.starts_with(&text) && all[0].0.contains(&named),
                "{all:#?}"
            );
            assert!(!all[0].1, "a list of pieces that are not there");
            for name in blocked {
                fs::remove_dir_all(folder.0.join(name)).expect("a folder");
            }
        }
        // In a run, at its second frame.
        fs::create_dir_all(folder.0.join("rod_00001_2.vtu/full")).expect("a folder");
        let all = ranks::in_threads(3, 1, |ranks| {
            let file = folder.0.join("rod.pvd");
            let failed = series(rod(400.0).on_ranks(ranks), (2e-8, &file), true);
            failed.expect_err("blocked").to_string()
        });
        let all = all.expect("threads");
        assert!(all.iter().all(|own| *own == all[0]), "{all:#?}");
        assert!(
            all[0].contains("rank 2 has failed") && all[0].contains("rod_00001_2.vtu"),
            "{all:#?}"
        );
        assert!(folder.0.join("rod_00000.pvtu").exists());
        // Another ending is refused on all, before anything is written.
        let all = ranks::in_threads(2, 1, |ranks| {
            let simulation = rod(400.0).on_ranks(ranks).build().expect("the scene");
            let refused = simulation.write_pieces(folder.0.join("end.vtu"));
            refused.expect_err("another ending").to_string()
        });
        assert!(
            all.expect("threads")
                .iter()
                .all(|own| own.contains(".pvtu"))
        );
        assert!(!folder.0.join("end_0.vtu").exists());
    });
}
