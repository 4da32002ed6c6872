use lightmesh_memory::OverBudget;
use lightmesh_render::internals::antialiasing::Antialiasing;
use lightmesh_render::internals::bands::{RESERVE, check_picture, rows_in_parts, rows_on_host};
use lightmesh_render::{Filter, LightGroups, Plan, RenderError};

use super::plain;

fn plan(size: [u32; 2], layers: Option<usize>, left: Option<u64>) -> Plan {
    let lights = LightGroups { lights: 3, at_once: 3 };
    Plan { layers, ..plain(size, lights, left) }
}

#[test]
fn an_image_that_does_not_fit_is_refused_before_it_is_made() {
    let needed = |side, layers| match check_picture(&plan([side; 2], layers, Some(1 << 20))) {
        Err(RenderError::Memory { short: OverBudget { needed, left: 0x10_0000, limit: Some(0x10_0000) }, .. }) => {
            needed
        }
        found => panic!("{found:?}"),
    };
    assert_eq!(needed(60_000, None), 43_200_000_000);
    assert_eq!(needed(256, Some(3)), 65_536 * (12 + 32 + 12));
    assert!(check_picture(&plan([256; 2], None, Some(1 << 20))).is_ok());
    // Colours of three lights and of none; of objects and of materials a number and a rank, or six ranks and eight slots.
    let all = |antialiasing| Plan { antialiasing, compositing: true, ..plan([256; 2], Some(3), None) };
    let several = Antialiasing::new(16, Filter::Box, 0, 1);
    assert_eq!(all(None).film_bytes(), 12 + 32 + 12 + 48 + 2 * (4 + 8));
    assert_eq!(all(Some(several)).film_bytes(), 12 + 32 + 12 + 48 + 2 * (4 + 8 * (6 + 8)));
}

#[test]
fn parts_are_small_but_not_tiny() {
    let parts = |height: u32| height.div_ceil(rows_in_parts(height));
    assert_eq!([1, 8, 9, 64, 256, 1024, 10_000].map(parts), [1, 1, 2, 8, 32, 32, 32]);
}

#[test]
fn a_limit_splits_the_picture_and_none_does_not() {
    let rows = |left| rows_on_host(&plan([1000; 2], None, left));
    assert_eq!(rows(None).unwrap(), 1000);
    assert_eq!(rows(Some(u64::MAX)).unwrap(), 1000);
    let some = rows(Some(RESERVE + (32 << 20))).unwrap();
    assert!((1..1000).contains(&some), "{some}");
    let Err(RenderError::Memory { short, .. }) = rows(Some(RESERVE + 1)) else { panic!("no row fits") };
    assert_eq!(rows(Some(short.needed)).unwrap(), 1);
    assert!(rows(Some(short.needed - 1)).is_err());
}
