use std::sync::Mutex;
use std::thread;
use std::time::Duration;

use lightmesh_render::internals::progress::{Pieces, Work};
use lightmesh_render::{Observer, Progress, Stage};

/// Keeps all progress.
#[derive(Default)]
struct Log(Mutex<Vec<Progress>>);

impl Observer for Log {
    fn progress(&self, progress: Progress) {
        self.0.lock().unwrap().push(progress);
    }
}

impl Log {
    fn last(&self) -> Progress {
        *self.0.lock().unwrap().last().unwrap()
    }
}

const TIME: Duration = Duration::from_millis(40);

/// Does a stage that takes so many times [`TIME`].
fn run(work: &Work, log: &Log, stage: Stage, pieces: f64, times: u32) {
    work.begin(log, stage, 1, pieces);
    thread::sleep(times * TIME);
    work.end(log, stage);
}

/// Bounds are wide: a busy machine sleeps longer than it is asked to.
fn assert_about(share: f64, wanted: f64) {
    assert!((share - wanted).abs() < 0.15, "{share} instead of {wanted}");
}

#[test]
fn stages_count_by_their_time() {
    let (work, log) = (Work::new(), Log::default());
    work.expect(Pieces::of(Stage::Shade, 10.0).and(Stage::Gather, 1.0));
    run(&work, &log, Stage::Gather, 1.0, 8);
    run(&work, &log, Stage::Shade, 5.0, 1);
    assert_about(log.last().done, 0.9);
    run(&work, &log, Stage::Shade, 5.0, 1);
    assert!(work.is_done());
    assert_eq!((log.last().done, log.last().left), (1.0, Some(0.0)));
}

#[test]
fn parts_count_by_their_share_of_the_image() {
    let (work, log) = (Work::new(), Log::default());
    for (part, pieces, wanted) in [([0.0, 0.25], 10.0, 0.25), ([0.25, 0.5], 1000.0, 0.5), ([0.5, 1.0], 10.0, 1.0)] {
        work.begin_part(part);
        work.expect(Pieces::of(Stage::Shade, pieces));
        run(&work, &log, Stage::Shade, pieces, 2);
        assert_about(log.last().done, wanted);
    }
    assert!(work.is_done());
}

#[test]
fn a_share_that_was_told_stays_when_more_is_found_to_do() {
    let (work, log) = (Work::new(), Log::default());
    let mut guess = Pieces::of(Stage::Shade, 1.0);
    work.expect(Pieces::of(Stage::Shade, 1.0));
    work.expect(guess);
    run(&work, &log, Stage::Shade, 1.0, 2);
    let before = log.last();
    work.replace(&mut guess, Pieces::of(Stage::Shade, 20.0));
    run(&work, &log, Stage::Shade, 1.0, 2);
    let after = log.last();
    assert!(after.done >= before.done && after.left.unwrap() > 10.0 * before.left.unwrap(), "{before:?}, {after:?}");
    run(&work, &log, Stage::Shade, 19.0, 1);
    assert_eq!(log.last().done, 1.0);
}

#[test]
fn little_is_told_to_be_done_while_most_of_the_rest_is_a_guess() {
    let (work, log) = (Work::new(), Log::default());
    work.expect(Pieces::of(Stage::Shade, 1.0).and(Stage::Gather, 1.0));
    // By what it costs elsewhere, gathering is soon done: so much that nearly all seems to be.
    run(&work, &log, Stage::Shade, 1.0, 30);
    assert!(log.last().done < 0.3, "{:?}", log.last());
    run(&work, &log, Stage::Gather, 1.0, 30);
    assert_eq!(log.last().done, 1.0);
}

#[test]
fn a_part_is_told_as_a_part_of_the_whole() {
    // The third of four frames that take ten seconds each; its own estimate is wrong.
    let third = |done, left| {
        Progress { done, seconds: 10.0 * done, left: Some(left) }.of_whole([0.5, 0.75], Some(40.0), 20.0 + 10.0 * done)
    };
    let begun = third(0.0, 300.0);
    assert!(begun.done == 0.5 && (begun.left.unwrap() - 20.0).abs() < 1.0, "{begun:?}");
    let half = third(0.5, 5.0);
    assert_eq!((half.done, half.left), (0.625, Some(15.0)));
    let last = Progress { done: 1.0, seconds: 9.0, left: Some(0.0) }.of_whole([0.75, 1.0], Some(40.0), 39.0);
    assert_eq!((last.done, last.left), (1.0, Some(0.0)));
}
