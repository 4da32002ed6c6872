//! Collective operations have the results that CUDA documents.

use crate::Bench;

/// One of the words that each lane of `warp_words` writes.
fn word(all: &[u32], which: usize) -> Vec<u32> {
    all.chunks(12).map(|words| words[which]).collect()
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn lanes_of_a_warp_exchange() {
    // Two blocks of two warps: the second block runs backwards.
    let all = Bench::new(128 * 12).run("warp_words", 2, 64);
    let expect = |which: usize, of: fn(u32) -> u32| {
        let expected: Vec<u32> = (0..128).map(|thread| of(thread % 32)).collect();
        assert_eq!(word(&all, which), expected, "word {which}");
    };
    expect(0, |_| (0..32).filter(|lane| lane % 3 == 0).map(|lane| 1 << lane).sum());
    expect(1, |_| 25);
    expect(2, |lane| lane / 8 * 8 + 3);
    expect(3, |lane| if lane < 2 { lane } else { lane - 2 });
    expect(4, |lane| if lane < 30 { lane + 2 } else { lane });
    expect(5, |lane| lane ^ 1);
    expect(6, |lane| (0..32).filter(|other| other / 5 == lane / 5).map(|other| 1 << other).sum());
    expect(7, |_| 1);
    expect(8, |_| 14);
    expect(9, |_| 4.5f32.to_bits());
    expect(10, |lane| if lane < 16 { 0x0000_aaaa } else { 0xaaaa_0000 + 20 });
    expect(11, |_| 32);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_block_waits_at_its_barriers() {
    let bench = Bench::new(5);
    let sums = bench.run("block_sum", 5, 256);
    let sum = |block: u32| (256 * block..256 * (block + 1)).sum::<u32>();
    assert_eq!(sums, (0..5).map(|block| sum(block) + 128).collect::<Vec<_>>());
    assert_eq!(bench.total.read().unwrap(), [(0..5).map(sum).sum::<u32>()]);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_block_has_the_shared_memory_that_it_asks_for() {
    let out = Bench::new(96).run("dynamic_shared", 2, 48);
    assert_eq!(out, (0..96).map(|thread| 47 - thread % 48).collect::<Vec<_>>());
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn atomic_operations_of_many_blocks_lose_nothing() {
    let bench = Bench::new(7);
    bench.out.write(&[0, 0, 0, u32::MAX]).unwrap();
    let threads = 300 * 256u32;
    let out = bench.run("atomics", 300, 256);
    let xor = (0..threads).fold(0, |xor, thread| xor ^ thread);
    assert_eq!(out, [threads, u32::MAX, threads - 1, 0, xor, 7, 1]);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn threads_that_meet_nobody_run_in_any_number() {
    let out = Bench::new(100_000).run("write_numbers", 391, 256);
    assert_eq!(out, (0..100_000).collect::<Vec<_>>());
}
