//! Spells of sunlight: known answers, and the same as by moments.

use glam::{DMat3, DVec3};
use lightmesh_sunlight::{Blocker, HourTable, MANY, Place, Receiver, SunPath, Taken, Tree, Walker, arcs_of_day};

const ESTONIA: Place = Place { latitude: 59.4, longitude: 24.7, offset: 120, refraction: true };

/// The paths of a day in a scene with y up and north along −z.
fn paths(place: Place, date: [u32; 3]) -> Vec<(SunPath, HourTable)> {
    let arcs = arcs_of_day(&place, date, DMat3::IDENTITY).unwrap();
    arcs.into_iter().map(|path| (HourTable::new(&path), path)).map(|(hours, path)| (path, hours)).collect()
}

fn axes(place: Place) -> DMat3 {
    arcs_of_day(&place, [2026, 3, 20], DMat3::IDENTITY).unwrap()[0].axes()
}

fn spells(blockers: &[Blocker], place: Place, date: [u32; 3], receiver: Receiver) -> Vec<(f64, f64)> {
    let tree = Tree::new(blockers, axes(place));
    let mut walker = Walker::default();
    let of_path = |(path, hours): &(SunPath, HourTable)| {
        tree.walk((path, hours), &receiver, false, &mut walker).spells().to_vec()
    };
    paths(place, date).iter().flat_map(of_path).collect()
}

fn at(x: f64, y: f64, z: f64) -> Receiver {
    Receiver { point: DVec3::new(x, y, z), normal: DVec3::ZERO }
}

/// Numbers that look random, from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 ^ self.0 >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

fn quad(corners: [DVec3; 4], object: u32) -> [Blocker; 2] {
    let [a, b, c, d] = corners;
    [Blocker { corners: [a, b, c], object }, Blocker { corners: [a, c, d], object }]
}

/// A box on the ground, turned by an angle.
fn house(middle: DVec3, size: DVec3, angle: f64, object: u32) -> Vec<Blocker> {
    let turn = DMat3::from_rotation_y(angle);
    let corner = |x: f64, y: f64, z: f64| middle + turn * (DVec3::new(x, y, z) * size);
    let (low, high) = (-0.5, 0.5);
    let ring = [(low, low), (high, low), (high, high), (low, high)];
    let mut all = Vec::new();
    for side in 0..4 {
        let ((ax, az), (bx, bz)) = (ring[side], ring[(side + 1) % 4]);
        all.extend(quad([corner(ax, 0.0, az), corner(bx, 0.0, bz), corner(bx, 1.0, bz), corner(ax, 1.0, az)], object));
    }
    all.extend(quad(ring.map(|(x, z)| corner(x, 1.0, z)), object));
    all
}

/// A quarter with houses and trees, and receivers on the ground, on walls and anywhere.
fn quarter(seed: u64) -> (Vec<Blocker>, Vec<Receiver>) {
    let mut random = Random(seed);
    let mut blockers = Vec::new();
    let mut receivers = Vec::new();
    for object in 0..14 {
        let middle = DVec3::new(random.within(-60.0, 60.0), 0.0, random.within(-60.0, 60.0));
        let size = DVec3::new(random.within(6.0, 18.0), random.within(4.0, 30.0), random.within(6.0, 18.0));
        let angle = if object % 3 == 0 { 0.0 } else { random.within(0.0, 3.0) };
        blockers.extend(house(middle, size, angle, object));
        // On a wall, exactly in its plane.
        let turn = DMat3::from_rotation_y(angle);
        let normal = turn * DVec3::Z;
        let point = middle + turn * (DVec3::new(random.within(-0.4, 0.4), random.next(), 0.5) * size);
        receivers.push(Receiver { point, normal });
    }
    for leaf in 0..160 {
        let middle = DVec3::new(random.within(-40.0, 40.0), random.within(2.0, 9.0), random.within(-40.0, 40.0));
        let corner = |random: &mut Random| middle + DVec3::new(random.next(), random.next(), random.next()) * 1.5;
        let corners = [corner(&mut random), corner(&mut random), corner(&mut random)];
        blockers.push(Blocker { corners, object: 14 + leaf / 40 });
    }
    for number in 0..16 {
        let height = if number % 2 == 0 { 0.0 } else { random.within(0.0, 12.0) };
        receivers.push(at(random.within(-50.0, 50.0), height, random.within(-50.0, 50.0)));
    }
    (blockers, receivers)
}

/// Whether a ray meets a triangle: the test of Möller and Trumbore, independent of planes through edges.
fn meets(blocker: &Blocker, point: DVec3, direction: DVec3) -> bool {
    let [a, b, c] = blocker.corners;
    let (u, v) = (b - a, c - a);
    let cross = direction.cross(v);
    let determinant = u.dot(cross);
    let from = point - a;
    if determinant == 0.0 || u.cross(v).normalize_or_zero().dot(from).abs() < 1e-8 {
        return false;
    }
    let first = from.dot(cross) / determinant;
    let along = from.cross(u);
    let second = direction.dot(along) / determinant;
    first >= 0.0 && second >= 0.0 && first + second <= 1.0 && v.dot(along) / determinant > 0.0
}

#[test]
fn an_open_field_sees_the_sun_from_rise_to_set() {
    // The half day of the textbook, cos H = (sin e − sin φ sin δ) / (cos φ cos δ), with the refraction of 34 minutes of arc at the horizon.
    for (date, declination) in [([2026, 6, 21], 23.436_f64), ([2026, 12, 21], -23.436)] {
        for latitude in [59.4, 30.0, 0.0, -45.0_f64] {
            let all = spells(&[], Place { latitude, ..ESTONIA }, date, at(0.0, 0.0, 0.0));
            let (sin, cos) = latitude.to_radians().sin_cos();
            let (sin_sun, cos_sun) = declination.to_radians().sin_cos();
            let half = (((-34.0_f64 / 60.0).to_radians().sin() - sin * sin_sun) / (cos * cos_sun)).acos();
            let (length, expected) = ((all[0].1 - all[0].0) / 60.0, 2.0 * half.to_degrees() * 4.0);
            assert!(all.len() == 1 && (length - expected).abs() < 1.0, "{latitude} {date:?}: {length} {expected}");
        }
    }
}

#[test]
fn days_without_night_and_nights_without_day_are_whole() {
    let svalbard = Place { latitude: 78.2, longitude: 15.6, offset: 60, refraction: true };
    let day = spells(&[], svalbard, [2026, 6, 21], at(0.0, 0.0, 0.0));
    assert!((day.iter().map(|spell| spell.1 - spell.0).sum::<f64>() - 86_400.0).abs() < 1e-6, "{day:?}");
    assert!(spells(&[], svalbard, [2026, 12, 21], at(0.0, 0.0, 0.0)).is_empty());
    // Where the clock's midnight is at noon of the sun, a day has the evening of one sun and the morning of the next.
    let other = Place { offset: -600, longitude: 24.7, ..ESTONIA };
    let halves = spells(&[], other, [2026, 3, 20], at(0.0, 0.0, 0.0));
    let total: f64 = halves.iter().map(|spell| spell.1 - spell.0).sum();
    assert!(halves[0].0 == 0.0 && (total / 3600.0 - 12.2).abs() < 0.2, "{halves:?}");
}

#[test]
fn a_wall_to_the_south_takes_the_noon_and_says_so() {
    // An endless wall along x of height h at distance d to the south: the sun is seen while its elevation in the plane of the meridian is above h/d.
    let wall = quad(
        [DVec3::new(-1e5, 0.0, 3.0), DVec3::new(1e5, 0.0, 3.0), DVec3::new(1e5, 3.0, 3.0), DVec3::new(-1e5, 3.0, 3.0)],
        7,
    );
    let tree = Tree::new(&wall, axes(ESTONIA));
    let mut walker = Walker::default();
    for date in [[2026, 3, 20], [2026, 6, 21], [2026, 12, 21]] {
        for (path, hours) in &paths(ESTONIA, date) {
            let open = tree.walk((path, hours), &at(0.0, 0.0, 0.0), true, &mut walker);
            let is_lit = |time: f64| open.spells().iter().any(|spell| spell.0 <= time && time <= spell.1);
            let is_taken = |time: f64| {
                open.alone().iter().any(|taken| taken.object == 7 && taken.begin <= time && time <= taken.end)
            };
            let (begin, end) = path.hull();
            for step in 1..2000 {
                let time = begin + (end - begin) * f64::from(step) / 2000.0;
                let direction = path.at(time).0;
                let (height, wall) = (direction.y, direction.z);
                if (height - wall).abs() > 1e-6 {
                    assert_eq!(is_lit(time), height > wall, "{date:?} {time}");
                    assert_eq!(is_taken(time), height < wall, "{date:?} {time}");
                }
            }
        }
    }
}

#[test]
fn spells_are_those_of_moments_and_none_is_missing() {
    let places = [1.3, 48.2, 69.6, -33.9, 89.9].map(|latitude| Place { latitude, ..ESTONIA });
    let (mut spells, mut moments) = (0, 0);
    for (number, &place) in places.iter().enumerate() {
        for date in [[2026, 6, 21], [2026, 3, 20], [2026, 11, 5]] {
            let paths = paths(place, date);
            let (blockers, receivers) = quarter(17 * number as u64 + u64::from(date[1]));
            let tree = Tree::new(&blockers, axes(place));
            let mut walker = Walker::default();
            for (path, hours) in &paths {
                for receiver in &receivers {
                    let open = tree.walk((path, hours), receiver, false, &mut walker);
                    spells += open.spells().len();
                    let (begin, end) = path.hull();
                    for step in 0..(end - begin) as u32 / 97 {
                        let time = begin + 13.7 + 97.0 * f64::from(step);
                        let direction = path.at(time).0;
                        let is_up = path.up().list().iter().any(|up| up.0 <= time && time <= up.1);
                        let sees = receiver.normal == DVec3::ZERO || direction.dot(receiver.normal) >= 0.0;
                        let is_hidden = || blockers.iter().any(|blocker| meets(blocker, receiver.point, direction));
                        let expected = is_up && sees && !is_hidden();
                        let is_lit = open.spells().iter().any(|spell| spell.0 <= time && time <= spell.1);
                        let ends = open.spells().iter().flat_map(|spell| [spell.0, spell.1]);
                        let nearest = ends.map(|end| (end - time).abs()).fold(f64::INFINITY, f64::min);
                        assert!(
                            is_lit == expected || nearest < 2e-3,
                            "{place:?} {date:?} {receiver:?} {time}: {is_lit}"
                        );
                        moments += 1;
                    }
                }
            }
        }
    }
    assert!(spells > 600 && moments > 100_000, "{spells} {moments}");
}

#[test]
fn what_an_object_alone_takes_comes_back_without_it() {
    let (blockers, receivers) = quarter(5);
    let date = [2026, 3, 20];
    let [(path, hours)] = &paths(ESTONIA, date)[..] else { panic!("one arc") };
    let tree = Tree::new(&blockers, axes(ESTONIA));
    let mut walker = Walker::default();
    let length = |spells: &[(f64, f64)]| spells.iter().map(|spell| spell.1 - spell.0).sum::<f64>();
    let mut compared = 0;
    for receiver in &receivers {
        let open = tree.walk((path, hours), receiver, true, &mut walker).clone();
        let plain = tree.walk((path, hours), receiver, false, &mut walker).spells().to_vec();
        // Pieces below a millisecond vanish in different orders.
        assert!((length(open.spells()) - length(&plain)).abs() < 0.01);
        let mut objects: Vec<u32> = open.alone().iter().map(|taken| taken.object).collect();
        objects.sort_unstable();
        objects.dedup();
        for object in objects {
            assert!(object < MANY);
            let others: Vec<Blocker> = blockers.iter().copied().filter(|blocker| blocker.object != object).collect();
            let without = Tree::new(&others, axes(ESTONIA));
            let gained = length(without.walk((path, hours), receiver, false, &mut walker).spells()) - length(&plain);
            let own = open.alone().iter().filter(|taken| taken.object == object);
            let predicted: f64 = own.map(|&Taken { begin, end, .. }| end - begin).sum();
            assert!((gained - predicted).abs() < 0.05, "{receiver:?} {object}: {gained} {predicted}");
            compared += 1;
        }
    }
    assert!(compared > 60, "{compared}");
}

#[test]
fn threads_and_far_coordinates_do_not_matter() {
    let (blockers, receivers) = quarter(9);
    let [(path, hours)] = &paths(ESTONIA, [2026, 3, 20])[..] else { panic!("one arc") };
    let all = |offset: DVec3| -> Vec<Vec<(f64, f64)>> {
        let moved = |blocker: &Blocker| Blocker { corners: blocker.corners.map(|corner| corner + offset), ..*blocker };
        let tree = Tree::new(&blockers.iter().map(moved).collect::<Vec<_>>(), axes(ESTONIA));
        let mut walker = Walker::default();
        let walk = |receiver: &Receiver| {
            let receiver = Receiver { point: receiver.point + offset, ..*receiver };
            tree.walk((path, hours), &receiver, false, &mut walker).spells().to_vec()
        };
        receivers.iter().map(walk).collect()
    };
    let here = all(DVec3::ZERO);
    let there = all(DVec3::new(5e5, 0.0, -6e6));
    for (here, there) in here.iter().zip(&there) {
        let long = |spells: &[(f64, f64)]| spells.iter().map(|spell| spell.1 - spell.0).sum::<f64>();
        assert!((long(here) - long(there)).abs() < 0.1, "{here:?} {there:?}");
    }
    assert!(all(DVec3::ZERO) == here);
}
