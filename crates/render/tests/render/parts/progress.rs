use std::sync::Mutex;

use lightmesh_render::internals::progress::Work;
use lightmesh_render::{Observer, Progress, Stage};

/// Keeps the latest progress.
#[derive(Default)]
struct Latest(Mutex<Progress>);

impl Observer for Latest {
    fn progress(&self, progress: Progress) {
        *self.0.lock().unwrap() = progress;
    }
}

#[test]
fn parts_count_by_their_share_of_the_image() {
    let (work, latest) = (Work::new(), Latest::default());
    let mut shares = Vec::new();
    for (part, pieces) in [([0.0, 0.25], 10), ([0.25, 0.5], 1000), ([0.5, 1.0], 10)] {
        work.begin_part(part);
        work.expect(2 * pieces);
        for _ in 0..2 {
            work.begin(&latest, Stage::Shade, pieces, pieces);
            work.end(&latest, Stage::Shade);
            shares.push(latest.0.lock().unwrap().done);
        }
    }
    assert_eq!(shares, [0.125, 0.25, 0.375, 0.5, 0.75, 1.0]);
    assert_eq!(work.done(), work.total());
}
