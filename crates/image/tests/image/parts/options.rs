use lightmesh_image::{ExrCompression, ExrParts, ExrSamples, Format};

#[test]
fn words_are_read_and_written() {
    Format::ALL.iter().for_each(|word| assert_eq!(word.to_string().parse(), Ok(*word)));
    ExrSamples::ALL.iter().for_each(|word| assert_eq!(word.to_string().parse(), Ok(*word)));
    ExrCompression::ALL.iter().for_each(|word| assert_eq!(word.to_string().parse(), Ok(*word)));
    ExrParts::ALL.iter().for_each(|word| assert_eq!(word.to_string().parse(), Ok(*word)));
    let message = "dwaa".parse::<ExrCompression>().unwrap_err().to_string();
    assert_eq!(message, "unknown compression `dwaa`; available: zip, zips, piz, rle, none");
}
