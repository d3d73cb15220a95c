//! Steps of a run on the device: the same bits in any work groups, readings, checkpoints, errors of a run, and what crosses the bus.
//! A dam break in the plane.

use super::{Fill, tank, water};
use crate::common::{device, in_any_groups};
use crate::compare::{build, differences, load, on_device, resumed};
use crate::neighbours;
use meshfree::prelude::*;
use meshfree::scalar::Record;
use meshfree_gpu::{Device, Error as GpuError, PointKernel, Precision};

#[test]
fn bits_are_the_same_twice_and_in_any_work_groups() {
    let Some(device) = device("bits of a scene") else {
        return;
    };
    in_any_groups(device, |device| {
        let double = |steps| {
            let own = on_device(device, water::<f64, 2>(Fill::Dam, false), steps);
            own.bits_hash()
        };
        let single = on_device(device, water::<f32, 2>(Fill::Dam, false), 40);
        let all = vec![double(40), double(41), single.bits_hash()];
        assert_ne!(all[0], all[1]);
        all
    });
}

#[test]
fn a_reading_changes_no_bit_and_is_that_of_the_host() {
    let Some(device) = device("readings") else {
        return;
    };
    let scene = || water::<f64, 2>(Fill::Dam, false);
    let [mut plain, mut read] = [load(&device, scene()), load(&device, scene())];
    let mut host = build(scene());
    let end = 0.02;
    let mut shown = 0;
    for part in [0.3, 0.5] {
        read.run_with(part * end, |now| shown = now.steps())
            .unwrap();
        host.run_until(part * end).unwrap();
        assert_eq!(read.time(), part * end);
        let now = read.simulation().unwrap();
        assert_eq!(now.time(), host.time());
        let own = differences(now, &host);
        assert!(own[0] < 1e-13 && own[1] < 1e-12 && own[2] < 1e-9, "{own:?}");
    }
    assert!(shown > 0);
    for run in [&mut plain, &mut read] {
        run.run_until(end).unwrap();
    }
    let [plain, read] = [plain, read].map(|run| run.into_simulation().unwrap());
    assert_eq!(plain.bits_hash(), read.bits_hash());
    assert_eq!(plain.ledger(), read.ledger());
    // A run goes on from what a reading has left, on the host too.
    host.run_until(end).unwrap();
    let mut back = read;
    for own in [&mut host, &mut back] {
        own.run_until(1.2 * end).unwrap();
    }
    let own = differences(&back, &host);
    assert!(own[0] < 1e-13 && own[1] < 1e-12 && own[2] < 1e-9, "{own:?}");
    assert_eq!(back.steps(), host.steps());
}

#[test]
fn a_checkpoint_of_one_side_resumes_on_the_other() {
    let Some(device) = device("checkpoints") else {
        return;
    };
    let scene = |fused| water::<f64, 2>(Fill::Dam, fused);
    let all = resumed(&device, "water", scene, [30, 30]);
    let impulses = all.map(|own| own.wall_impulse("tank").unwrap()[1]);
    for own in impulses {
        assert!((own / impulses[2] - 1.0).abs() < 1e-11, "{impulses:?}");
    }
}

#[test]
fn what_crosses_the_bus_is_counted() {
    let Some(device) = device("traffic") else {
        return;
    };
    let mut run = load(&device, thrown(0.05));
    run.step().unwrap();
    // Steps between two list builds, and those with a build.
    let (mut quiet, mut built) = (Vec::new(), Vec::new());
    for _ in 0..60 {
        let builds = run.simulation().unwrap().list_builds();
        let before = device.traffic();
        run.step().unwrap();
        let after = device.traffic();
        let own = [
            after.launches - before.launches,
            after.sent - before.sent,
            after.received - before.received,
            after.waits - before.waits,
        ];
        if run.simulation().unwrap().list_builds() == builds {
            quiet.push(own);
        } else {
            built.push(own);
        }
    }
    // By speeds and accelerations the host knows for most steps that lists serve, and asks where the skin may be used up.
    let (told, asked): (Vec<[u64; 4]>, Vec<_>) = quiet.iter().partition(|own| own[3] == 1);
    println!(
        "launches, bytes sent and received, waits: {:?}, {} steps more ask; with a list build {built:?}",
        told[0],
        asked.len()
    );
    assert!(told.iter().all(|own| *own == told[0]), "{told:?}");
    assert!(asked.iter().all(|own| own[3] <= 3), "{asked:?}");
    assert!(2 * asked.len() < told.len(), "{} steps", asked.len());
    let [launches, sent, received, _] = told[0];
    assert!(launches <= 32, "{launches} launches");
    // None of it grows with the number of particles.
    assert!(
        sent <= 1000 && received <= 120,
        "{sent} and {received} bytes"
    );
    // A list build adds a handful of numbers, and after a sort which particle is where.
    let order = 4 * neighbours::on_host(&mut run).mobile(0) as u64;
    let (mut plain, mut sorted) = (0, 0);
    for own in built {
        let [more_sent, more] = [own[1] - sent, own[2] - received];
        let of_sort = more.saturating_sub(order);
        assert!(more_sent <= 800 && more.min(of_sort) <= 100, "{own:?}");
        plain += usize::from(more <= 100);
        sorted += usize::from(more >= order);
    }
    assert!(
        plain > 0 && sorted > 0,
        "{plain} builds, {sorted} with a sort"
    );
}

#[test]
fn lists_are_looked_at_where_speeds_do_not_tell() {
    let Some(device) = device("what speeds do not tell") else {
        return;
    };
    // Particles that are shifted, and a wall that swings.
    let mut run = load(&device, super::stirred::<f64>(false));
    let mut host = build(super::stirred::<f64>(false));
    run.step().unwrap();
    host.step().unwrap();
    for _ in 0..10 {
        let before = device.traffic().waits;
        run.step().unwrap();
        host.step().unwrap();
        assert!(device.traffic().waits >= before + 3);
    }
    assert_eq!(run.list_builds(), host.list_builds());
}

/// Water that is thrown at a wall, at a share of its speed of sound.
fn thrown(mach: f64) -> Scene<f64, 2> {
    let sound = 10.0 * (2.0 * super::G * 0.3f64).sqrt();
    tank(Fill::Dam, schemes::weakly_compressible(), |body, wall| {
        (body.velocity([mach * sound, 0.0]), wall)
    })
}

#[test]
fn what_is_faster_than_its_sound_ends_a_run_as_on_the_host() {
    let Some(device) = device("pairs that approach") else {
        return;
    };
    let words = |error: &dyn core::fmt::Display| {
        let text = error.to_string();
        text.split(' ')
            .take(7)
            .map(String::from)
            .collect::<Vec<_>>()
    };
    let mut ended = 0;
    for mach in [0.4, 0.6, 0.8] {
        let mut host = build(thrown(mach));
        let mut run = load(&device, thrown(mach));
        for _ in 0..40 {
            let (a, b) = match (run.step(), host.step()) {
                (Ok(a), Ok(b)) => (a, b),
                (Err(a), Err(b)) => {
                    println!("{a}\n{b}");
                    assert!(matches!(
                        a,
                        GpuError::Simulation(Error::SoundSpeedTooLow { .. })
                    ));
                    assert_eq!(words(&a), words(&b));
                    // What has failed goes no further.
                    let after = run.step().expect_err("a run that has failed");
                    assert!(
                        matches!(after, GpuError::Simulation(Error::Failed { .. })),
                        "{after}"
                    );
                    ended += 1;
                    break;
                }
                (a, b) => panic!("{a:?} on the device, {b:?} on the host"),
            };
            assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
            let own = run.simulation().unwrap().last_vote().unwrap();
            let vote = host.last_vote().unwrap();
            assert_eq!(
                (own.criterion, own.particle),
                (vote.criterion, vote.particle)
            );
        }
    }
    assert!(ended > 0);
}

#[test]
fn a_state_that_breaks_is_named_as_on_the_host() {
    let Some(device) = device("a state that breaks") else {
        return;
    };
    // Gravity that is no number from some time on, and one that is too large to be squared.
    let scene = |most: f64| {
        let scene = water::<f64, 2>(Fill::Dam, false);
        scene.acceleration(move |t| [if t > 0.002 { most } else { 0.0 }, 0.0])
    };
    for most in [f64::NAN, 1e100] {
        let host = build(scene(most)).run_until(0.1).expect_err("no number");
        let mut run = load(&device, scene(most));
        let found = run.run_until(0.1).expect_err("no number");
        println!("{host}\n{found}");
        let kind = |text: String| text.split(' ').next().map(String::from);
        assert_eq!(kind(found.to_string()), kind(host.to_string()));
    }
}

/// What is compiled for parts of one size does not serve those of another.
#[test]
fn a_kernel_serves_parts_of_every_size() {
    let Some(device) = device("parts of every size") else {
        return;
    };
    let record = Record::of(1, |x| vec![x[0] + x[0]]).expect("lanes");
    let kernel = PointKernel::new(&device, "twice", &record, Precision::Double);
    let kernel = kernel.unwrap_or_else(|error| panic!("{error}"));
    let column: Vec<f64> = (0..175).map(f64::from).collect();
    let twice: Vec<f64> = column.iter().map(|x| 2.0 * x).collect();
    // 1408 bytes in two parts of 768 or of 1024, in three of 512, and whole.
    for most in [768, 1024, 512, 1024, 1408] {
        let lesser = device.clone().as_lesser(true, most);
        let found = kernel.run(&lesser, &[&column]);
        let found = found.unwrap_or_else(|error| panic!("{most} bytes: {error}"));
        assert_eq!(found, std::slice::from_ref(&twice), "{most} bytes");
    }
}

#[test]
fn arrays_in_parts_give_the_same_bits() {
    let Some(device) = device("arrays in parts") else {
        return;
    };
    if device.adapter().arrays == 1 {
        println!(
            "skipped: arrays in parts: {} needs none",
            device.adapter().name
        );
        return;
    }
    let scene = || build(water::<f64, 2>(Fill::Dam, false));
    let bits = |device: &Device| -> Result<u64, GpuError> {
        let mut run = device.load(scene())?;
        for _ in 0..60 {
            run.step()?;
        }
        assert!(run.list_builds() > 1);
        Ok(run.simulation()?.bits_hash())
    };
    let Err(GpuError::TooLarge { bytes, .. }) = bits(&device.clone().as_lesser(true, 512)) else {
        panic!("arrays are larger than that");
    };
    // The first array of all, in two parts and more.
    let mut found = 0;
    for most in (1..16).map(|k| bytes * k / 16) {
        match bits(&device.clone().as_lesser(true, most)) {
            Ok(own) => {
                assert_eq!(own, bits(&device).unwrap(), "{most} of {bytes} bytes");
                found += 1;
            }
            Err(GpuError::TooLarge { .. }) => {}
            Err(error) => panic!("{error}"),
        }
        if found == 2 {
            println!("up to {most} bytes of {bytes}");
            return;
        }
    }
    panic!("no array is bound in parts");
}
