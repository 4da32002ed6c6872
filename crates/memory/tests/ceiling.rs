//! A program with the counting allocator and a ceiling. One test: the ceiling is the process's.
#![allow(clippy::print_stdout, reason = "the test reads what its children say")]

use std::process::Command;

use lightmesh_memory::{Counting, Refused, held, set_ceiling};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The variable that tells the child what to allocate.
const ROLE: &str = "LIGHTMESH_TEST_ALLOCATES";
const CEILING: u64 = 64 << 20;

fn end(refused: Refused) -> ! {
    println!("refused {} of {:?}, held {}", refused.needed, refused.ceiling, refused.held);
    std::process::exit(3)
}

#[test]
fn the_program_ends_in_its_own_way_before_it_holds_too_much() {
    match std::env::var(ROLE).as_deref() {
        Ok(role) => allocate(role),
        Err(_) => {
            for (role, code, says) in [
                ("little", 0, "counted"),
                ("at once", 3, "refused 100000000 of Some(67108864)"),
                ("grown", 3, "of Some(67108864), held"),
                ("from threads", 3, "of Some(67108864), held"),
                ("more than there is", 3, "of None"),
            ] {
                let this = std::env::current_exe().unwrap();
                let child =
                    Command::new(this).args(["--nocapture", "--test-threads=1"]).env(ROLE, role).output().unwrap();
                let said = String::from_utf8_lossy(&child.stdout);
                assert_eq!(
                    child.status.code(),
                    Some(code),
                    "{role}: {said} {}",
                    String::from_utf8_lossy(&child.stderr)
                );
                assert!(said.contains(says), "{role}: {said}");
            }
        }
    }
}

fn allocate(role: &str) {
    // A thread reports what it holds from time to time only.
    let reported = vec![1_u8; 1 << 20];
    let before = held();
    set_ceiling(CEILING, end);
    match role {
        "little" => {
            let much = vec![1_u8; 50_000_000];
            let during = held();
            assert!((50_000_000..51_000_000).contains(&(during - before)), "{before} {during}");
            drop(much);
            assert!(held() < before + 1_000_000);
            drop(reported);
            println!("counted");
        }
        "at once" => drop(vec![1_u8; 100_000_000]),
        "grown" => {
            let mut grown = Vec::new();
            (0..u64::MAX).for_each(|number| grown.push(number));
        }
        "from threads" => std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let blocks: Vec<Vec<u8>> = (0..1000).map(|_| vec![1; 100_000]).collect();
                    assert_eq!(blocks.len(), 1000);
                });
            }
        }),
        "more than there is" => {
            set_ceiling(u64::MAX, end);
            drop(Vec::<u8>::with_capacity(isize::MAX as usize));
        }
        other => panic!("{other}"),
    }
}
