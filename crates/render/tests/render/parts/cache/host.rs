use glam::Vec3;
use lightmesh_render::internals::cache::{Allowance, ColumnKey, bytes_of_rows};
use lightmesh_render::internals::light_mesh::bits;
use lightmesh_render::light_mesh::BrickKey;
use lightmesh_render::{HostTable, Table, VisibilityOfLight};
use lightmesh_scene::LightKind;

const BRICKS: usize = 100;

fn lights() -> Vec<ColumnKey> {
    let kind = |x: f32| LightKind::Sphere { position: Vec3::new(x, 4.0, 0.0), radius: 0.5 };
    vec![
        ColumnKey { kind: kind(0.0), glows: false, sampling: None },
        ColumnKey { kind: kind(1.0), glows: false, sampling: Some((9, 0)) },
    ]
}

fn bits_of(brick: BrickKey) -> u64 {
    brick.wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

fn share_of(brick: BrickKey, bit: u32) -> u16 {
    ((bits_of(brick) >> (bit % 32)) % 10) as u16
}

/// Uses bricks in an image. Returns how many light points of the first light were unknown; `None` if there is no room for them.
fn image(table: &mut HostTable, number: u32, most: u64, bricks: &[BrickKey]) -> Option<u64> {
    table.allow(Allowance { image: number, most: Some(most) });
    let rows = table.admit(bricks, lights())?;
    let used = vec![u64::MAX; bricks.len()];
    let asked = [0, 1].map(|light| table.unknown(light, &rows, &used));
    let found = bricks.iter().zip(&asked[0]).map(|(&brick, asked)| bits_of(brick) & asked).collect();
    table.learn(0, &rows, &asked[0], &VisibilityOfLight::Bits(found));
    let points = bricks.iter().zip(&asked[1]).flat_map(|(&brick, &asked)| bits(asked).map(move |bit| (brick, bit)));
    let seen = points.map(|(brick, bit)| share_of(brick, bit)).collect();
    table.learn(1, &rows, &asked[1], &VisibilityOfLight::Share { seen, samples: 9 });
    let VisibilityOfLight::Bits(words) = table.lookup(0, &rows, &used) else { panic!("bits") };
    assert!(words.iter().zip(bricks).all(|(&word, &brick)| word == bits_of(brick)));
    let VisibilityOfLight::Share { seen, .. } = table.lookup(1, &rows, &used) else { panic!("shares") };
    let expected = bricks.iter().flat_map(|&brick| (0..64).map(move |bit| share_of(brick, bit)));
    assert!(seen.into_iter().eq(expected));
    Some(asked[0].iter().map(|asked| u64::from(asked.count_ones())).sum())
}

#[test]
fn bricks_that_were_not_used_for_the_longest_give_way() {
    let most = bytes_of_rows(BRICKS, lights().iter());
    let mut table = HostTable::default();
    let always: Vec<BrickKey> = (1_000_000..1_000_020).collect();
    for number in 1..50 {
        let first = 30 * u64::from(number);
        let bricks: Vec<BrickKey> = (first..first + 40).chain(always.iter().copied()).collect();
        let unknown = image(&mut table, number, most, &bricks).unwrap();
        // Of the image before, ten are used again, and those that always are.
        assert_eq!(unknown, 64 * if number == 1 { 60 } else { 30 }, "image {number}");
        assert!(table.memory() <= most && table.rows.len() <= BRICKS, "image {number}: {}", table.memory());
        assert_eq!(image(&mut table, number, most, &bricks), Some(0));
    }
    assert!(table.rows.len() >= 60);
    assert_eq!(image(&mut table, 50, most, &[30, 31]), Some(128), "the first ones are gone");
    // What is stored is what is known.
    let Ok(stored) = table.stored();
    let mut again = HostTable::restored(stored.clone());
    assert_eq!((again.len(), again.stored()), (table.len(), Ok(stored)));
    assert_eq!(image(&mut again, 51, most, &always), Some(0));
}

#[test]
fn bricks_for_which_there_is_no_room_are_not_kept() {
    let most = bytes_of_rows(BRICKS, lights().iter());
    let mut table = HostTable::default();
    let bricks: Vec<BrickKey> = (0..BRICKS as u64 + 1).collect();
    assert_eq!(image(&mut table, 1, most, &bricks[1..]), Some(64 * BRICKS as u64));
    assert_eq!(image(&mut table, 2, most, &bricks), None);
    assert_eq!((table.len(), table.memory()), (0, 0));
    assert!(image(&mut table, 3, most, &bricks[..50]).is_some());
    let Ok(mut stored) = table.stored();
    stored.limit(Some(bytes_of_rows(20, lights().iter())));
    let mut again = HostTable::restored(stored);
    assert_eq!(again.len(), 2 * 64 * 20);
    assert_eq!(image(&mut again, 4, most, &bricks[..20]), Some(0));
}
