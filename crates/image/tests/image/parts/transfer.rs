use lightmesh_image::Transfer;
use lightmesh_image::internals::transfer::{
    IGNORED, SMALLEST, SRGB_DECODED, SRGB_THRESHOLDS, decode16, encode_between, encode16, exceeded, linear_to_srgb,
};

#[test]
fn known_values_of_srgb() {
    // Middle grey of 18 % is display value 0.4613561; code 128 is 21.586 %; code 10 lies on the straight part.
    assert!((linear_to_srgb(0.18) - 0.461_356_1).abs() < 1e-6);
    assert!((Transfer::Srgb.decode(128) - 0.215_860_5).abs() < 1e-6);
    assert!((Transfer::Srgb.decode(10) - 10.0 / 255.0 / 12.92).abs() < 1e-9);
    assert_eq!((Transfer::Srgb.decode(0), Transfer::Srgb.decode(255)), (0.0, 1.0));
    assert_eq!((Transfer::Srgb.encode(0.18), Transfer::Srgb.encode(0.5)), (118, 188));
}

#[test]
fn names_are_read_and_written() {
    Transfer::ALL.iter().for_each(|transfer| assert_eq!(transfer.to_string().parse(), Ok(*transfer)));
    let message = "gamma".parse::<Transfer>().unwrap_err().to_string();
    assert!(Transfer::ALL.iter().all(|transfer| message.contains(transfer.name())), "{message}");
}

#[test]
fn both_parts_of_srgb_meet() {
    let (below, above) = (linear_to_srgb(0.003_130_8), linear_to_srgb(0.003_130_801));
    assert!((below - above).abs() < 1e-6, "{below} {above}");
}

#[test]
fn every_code_survives_a_round_trip() {
    for transfer in [Transfer::Srgb, Transfer::Linear] {
        for code in 0..=255 {
            assert_eq!(transfer.encode(transfer.decode(code)), code, "{transfer:?}");
            let wide = decode16(transfer, u16::from(code) * 257);
            assert!((wide - transfer.decode(code)).abs() < 1e-7, "{transfer:?} {code}");
            assert!(
                [0.002, 0.5, 0.998]
                    .into_iter()
                    .all(|part| encode_between(transfer, transfer.decode(code), part) == code)
            );
        }
        assert!((0..=u16::MAX).all(|code| encode16(transfer, decode16(transfer, code)) == code), "{transfer:?}");
    }
}

#[test]
fn encoding_rounds_to_the_nearest_code() {
    for step in 0..=100_000 {
        let linear = step as f32 / 100_000.0;
        let srgb = linear_to_srgb(f64::from(linear)) * 255.0;
        let off = (f64::from(Transfer::Srgb.encode(linear)) - srgb).abs();
        assert!(off <= 0.5 + 1e-5, "{linear}: off by {off} codes");
        let off = (f64::from(Transfer::Linear.encode(linear)) - f64::from(linear) * 255.0).abs();
        assert!(off <= 0.5, "{linear}: off by {off} codes");
    }
}

#[test]
fn codes_are_those_of_the_thresholds() {
    let check = |value: f32| assert_eq!(Transfer::Srgb.encode(value), exceeded(value), "{value:e}");
    for value in SRGB_THRESHOLDS.iter().chain(&*SRGB_DECODED).copied() {
        [value.next_down(), value, value.next_up()].into_iter().for_each(check);
    }
    // The first and last value of every range that is looked up.
    for range in SMALLEST.to_bits() >> IGNORED..=1_f32.to_bits() >> IGNORED {
        let start = f32::from_bits(range << IGNORED);
        [start.next_down(), start].into_iter().for_each(check);
    }
    for (below, above) in SRGB_THRESHOLDS.iter().zip(&SRGB_THRESHOLDS[1..]) {
        assert!(below.to_bits() >> IGNORED < above.to_bits() >> IGNORED, "{below} and {above} are in one range");
    }
}

#[test]
fn values_out_of_range_are_clamped() {
    for transfer in [Transfer::Srgb, Transfer::Linear] {
        for low in [-0.0, -1e-9, -3.0, f32::NEG_INFINITY, f32::NAN, -f32::NAN] {
            assert_eq!(transfer.encode(low), 0, "{transfer:?} {low}");
        }
        for high in [1.0, 1.000_1, 1e30, f32::INFINITY] {
            assert_eq!(transfer.encode(high), 255, "{transfer:?} {high}");
        }
    }
}
