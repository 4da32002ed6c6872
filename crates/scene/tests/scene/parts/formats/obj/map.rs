use glam::Vec2;
use lightmesh_scene::OpacityChannel;
use lightmesh_scene::internals::formats::obj::Map;

#[test]
fn options_stand_before_a_name_that_may_hold_blanks() {
    let map = |file: &str, scale, offset, clamp| {
        let (scale, offset) = (Vec2::from(scale), Vec2::from(offset));
        Some(Map { file: file.to_owned(), scale, offset, clamp, multiplier: 1.0, channel: None })
    };
    let plain = |file| map(file, [1.0; 2], [0.0; 2], false);
    assert_eq!(Map::parse("brick wall.png"), plain("brick wall.png"));
    assert_eq!(Map::parse(r".\maps\oak #2.png"), plain(r".\maps\oak #2.png"));
    let all = "-blendu on -mm 0 1  -s 2 3 1 -o 0.5 -t 9 9 9 -clamp on -bm 1 a b.png";
    assert_eq!(Map::parse(all), map("a b.png", [2.0, 3.0], [0.5, 0.0], true));
    assert_eq!(Map::parse("-s 4 7 7.png"), map("7.png", [4.0, 7.0], [0.0; 2], false));
    assert_eq!(Map::parse("-odd.png"), plain("-odd.png"));
    assert_eq!(Map::parse("-s 1 1 1 \"brick wall.png\""), plain("brick wall.png"));
    assert_eq!(Map::parse("-odd one.png"), plain("-odd one.png"));
    assert_eq!(Map::parse("-bm -0.25 a.png").map(|map| map.multiplier), Some(-0.25));
    assert_eq!(Map::parse("-bm nan a.png"), plain("a.png"));
    let channels =
        ["r", "g", "b", "m", "l", "z"].map(|word| Map::parse(&format!("-imfchan {word} a.png")).unwrap().channel);
    let found: Vec<_> = channels.into_iter().flatten().map(OpacityChannel::name).collect();
    assert_eq!((found, channels[5]), (vec!["red", "green", "blue", "alpha", "luminance"], None));
    assert_eq!(
        [Map::parse(""), Map::parse("-s 1 1 1"), Map::parse("-clamp on")].map(|map| map.map(|m| m.file)),
        [None, Some("1".into()), None]
    );
}
