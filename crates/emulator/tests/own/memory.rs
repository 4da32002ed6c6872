//! Memory is poisoned, limited and private to a device.

use std::sync::Arc;

use lightmesh_emulator::Emulator;
use lightmesh_render::cuda::{DeviceError, Fault, Kernel, Pool, Runtime};

use crate::Bench;

const POISON: u32 = 0xfffa_5a5a;

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn what_nobody_has_set_is_poison() {
    assert!(f32::from_bits(POISON).is_nan() && f64::from_bits(u64::from(POISON) << 32).is_nan());
    let pool = Pool::new(Arc::new(Emulator::new()));
    assert_eq!(pool.room::<u32>("values", 5).unwrap().read().unwrap(), [POISON; 5]);
    // Each block finds its shared memory unset, also after one that has set it; a comparison with NaN is false.
    assert_eq!(Bench::new(128).run("read_unset", 4, 32), [POISON; 128]);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn devices_have_constants_of_their_own() {
    let (one, other) = (Bench::new(4), Bench::new(4));
    one.pool.runtime().constant("own", "table", bytemuck::cast_slice(&[1u32, 2, 3, 4])).unwrap();
    other.pool.runtime().constant("own", "table", bytemuck::cast_slice(&[5u32, 6])).unwrap();
    assert_eq!(one.run("read_constant", 1, 4), [1, 2, 3, 4]);
    assert_eq!(other.run("read_constant", 1, 4), [5, 6, POISON, POISON]);
    assert_eq!(Bench::new(4).run("read_constant", 1, 4), [POISON; 4]);
    for (name, bytes) in [("table", 17), ("no_such", 4)] {
        assert!(matches!(one.pool.runtime().constant("own", name, &vec![0; bytes]), Err(Fault::Failed(_))), "{name}");
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn memory_can_be_used_up_and_is_given_back() {
    let pool = Pool::new(Arc::new(Emulator::with_memory(1000)));
    assert_eq!(pool.runtime().free_memory(), Some(1000));
    let first = pool.room::<u8>("first", 600).unwrap();
    let Err(DeviceError::Memory { buffer, needed, free, .. }) = pool.room::<u8>("second", 401) else {
        panic!("401 bytes do not fit")
    };
    assert_eq!((buffer, needed, free), ("second", 401, Some(400)));
    pool.room::<u8>("second", 400).expect("400 bytes fit");
    drop(first);
    assert_eq!((pool.runtime().free_memory(), pool.runtime().taken()), (Some(1000), 0));
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn one_allocation_fails_where_a_test_wants_it() {
    let device = Emulator::new();
    device.fail_allocation(2);
    let failures = [(); 4].map(|()| matches!(device.allocate(8), Err(Fault::OutOfMemory { free: None })));
    assert_eq!(failures, [false, true, false, false]);
    assert!(matches!(device.allocate(0), Err(Fault::Failed(_))));
    assert!(matches!(device.allocate(u64::MAX), Err(Fault::OutOfMemory { .. })));
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn addresses_are_aligned_and_bounds_are_kept() {
    let device = Emulator::new();
    for bytes in [1, 3, 255, 256, 257] {
        let memory = device.allocate(bytes).unwrap();
        assert_eq!(device.address(&memory) % 256, 0);
        let mut byte = [0];
        device.write(&memory, bytes - 1, &[7]).expect("the last byte");
        device.read(&memory, bytes - 1, &mut byte).expect("the last byte");
        assert_eq!(byte, [7]);
        assert!(device.write(&memory, bytes, &[7]).is_err());
        assert!(device.read(&memory, u64::MAX, &mut byte).is_err());
        assert!(device.clear(&memory, 0, bytes + 1).is_err());
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn traffic_is_counted() {
    let bench = Bench::new(8);
    bench.pool.runtime().take_traffic();
    bench.out.write(&[1, 2, 3]).unwrap();
    bench.run("write_numbers", 1, 8);
    let traffic = bench.pool.runtime().take_traffic();
    assert_eq!((traffic.written, traffic.read), (12, 32));
    assert_eq!(traffic.launches.into_iter().collect::<Vec<_>>(), [("own::write_numbers".to_owned(), 1)]);
    assert!(Emulator::has(Kernel { module: "own", name: "trap" }));
    assert!(!Emulator::has(Kernel { module: "own", name: "own" }));
}
