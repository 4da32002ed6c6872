use glam::IVec3;
use lightmesh_render::internals::light_mesh::{Span, Windows};
use lightmesh_render::light_mesh::{Template, brick_of, point_bit};

#[test]
fn a_window_finds_every_template_point_of_every_cell() {
    for radius in [0.5, 1.0, 2.1, 3.1, 4.1, 5.1, 16.0] {
        let template = Template::new(radius).unwrap();
        let windows = Windows::new(&template);
        for place in 0..64 {
            let cell = IVec3::new(40, 44, 48) + IVec3::new(place & 3, place >> 2 & 3, place >> 4);
            let window = windows.around(cell);
            let mut offsets = template.offsets().iter().enumerate();
            for span in window.spans {
                assert!(usize::from(span.slot) < windows.len());
                for (point, (index, &offset)) in (0..span.count).zip(&mut offsets) {
                    let brick = window.key(usize::from(span.slot));
                    assert_eq!(brick, brick_of(cell + offset), "R = {radius}, {cell}, {offset}");
                    assert_eq!(u32::from(span.bit + point), point_bit(cell + offset));
                    assert_eq!(usize::from(span.word) * 32 + usize::from(span.shift + point), index);
                }
            }
            assert_eq!(offsets.next(), None, "R = {radius}, {cell}");
        }
    }
}

#[test]
fn a_span_takes_its_bits_and_no_others() {
    let span = Span { slot: 3, bit: 60, count: 3, word: 1, shift: 29 };
    assert_eq!((span.to_mask(u64::MAX), span.to_brick(u32::MAX)), (0b111 << 29, 0b111 << 60));
    assert_eq!((span.to_mask(1 << 61 | 1 << 63), span.to_brick(1 << 30 | 1 << 28)), (1 << 30, 1 << 61));
}
