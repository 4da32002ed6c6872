use lightmesh_image::internals::deflate::{HEADER, Piece, WINDOW, checksum, end, zlib};
use zlib_rs::Status;

/// Text-like bytes, noise, and runs.
fn data(length: usize) -> Vec<u8> {
    let noise = |index: usize| (index as u32).wrapping_mul(2_654_435_761).rotate_left(9) as u8;
    (0..length)
        .map(|index| match index / 1000 % 3 {
            0 => b"light mesh"[index % 10],
            1 => noise(index),
            _ => 7,
        })
        .collect()
}

fn inflated(stream: &[u8]) -> Vec<u8> {
    let mut inflate = zlib_rs::Inflate::new(true, WINDOW);
    let mut output = vec![0; 1 << 20];
    let status = inflate.decompress(stream, &mut output, zlib_rs::InflateFlush::Finish).unwrap();
    assert_eq!((status, inflate.total_in() as usize), (Status::StreamEnd, stream.len()));
    output.truncate(inflate.total_out() as usize);
    output
}

fn joined(pieces: &[&[u8]], level: i32) -> Vec<u8> {
    let (mut stream, mut sum) = (HEADER.to_vec(), 1);
    for data in pieces {
        let piece = Piece::new(data, level);
        sum = checksum(sum, &piece);
        stream.extend(piece.bytes);
    }
    stream.extend(end(sum));
    stream
}

#[test]
fn pieces_join_to_one_stream() {
    let data = data(70_001);
    for level in [1, 2, 6, 9] {
        for size in [1, 7, 4096, 70_001] {
            let pieces: Vec<&[u8]> = data.chunks(size).take(300).collect();
            assert_eq!(inflated(&joined(&pieces, level)), pieces.concat(), "level {level}, pieces of {size}");
        }
        assert_eq!(inflated(&zlib(&data, level)), data, "level {level}");
    }
    assert!(inflated(&joined(&[], 2)).is_empty() && inflated(&joined(&[&[], &[]], 2)).is_empty());
}

#[test]
fn a_wrong_checksum_is_noticed() {
    let mut stream = joined(&[b"one", b"two"], 2);
    *stream.last_mut().unwrap() ^= 1;
    let mut inflate = zlib_rs::Inflate::new(true, WINDOW);
    assert!(inflate.decompress(&stream, &mut [0; 100], zlib_rs::InflateFlush::Finish).is_err());
}
