use glam::{DMat3, DVec3};
use lightmesh_scene::internals::formats::polygon::{Cutter, PATIENCE};

fn cut(corners: &[DVec3]) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    Cutter::default().cut(corners, |triangle| triangles.push(triangle));
    triangles
}

fn area(corners: &[DVec3], normal: DVec3) -> f64 {
    let triangles = cut(corners).into_iter();
    triangles.map(|t| t.map(|i| corners[i])).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(normal)).sum()
}

/// The total area of the triangles if none is reversed: each counts by its size.
fn covered(corners: &[DVec3]) -> f64 {
    cut(corners).iter().map(|t| t.map(|i| corners[i])).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

fn flat(corners: &[[f64; 2]]) -> Vec<DVec3> {
    corners.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
}

const NOTCHED: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];

#[test]
fn a_convex_polygon_is_a_fan() {
    assert_eq!(
        cut(&flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]])),
        [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
    );
    assert_eq!(cut(&flat(&[[0.0, 0.0], [1.0, 0.0]])), [[0; 3]; 0]);
}

#[test]
fn a_notch_is_left_open_wherever_the_polygon_begins_and_lies() {
    for turn in 0..4 {
        for (x, y) in [(0.0, 0.0), (0.7, 0.0), (1.6, 1.6), (2.5, 0.3), (3.1, 1.0), (0.2, 4.5)] {
            let placed = DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y);
            let mut corners: Vec<DVec3> = flat(&NOTCHED).iter().map(|&p| placed * p + DVec3::splat(1e3)).collect();
            corners.rotate_left(turn);
            let normal = placed * DVec3::Z;
            assert!(
                (covered(&corners) - 4.0).abs() < 1e-9 && (area(&corners, normal) - 4.0).abs() < 1e-9,
                "{turn}, {x}"
            );
            corners.reverse();
            assert!(
                (covered(&corners) - 4.0).abs() < 1e-9 && (area(&corners, normal) + 4.0).abs() < 1e-9,
                "{turn}, {x}"
            );
        }
    }
}

#[test]
fn a_comb_a_spiral_and_a_frame_keep_their_area() {
    let comb: Vec<[f64; 2]> = (0..40)
        .flat_map(|x| [[f64::from(x), 0.0], [f64::from(x) + 0.5, 9.0]])
        .chain([[40.0, 10.0], [-1.0, 10.0]])
        .collect();
    let teeth = flat(&comb);
    // The area enclosed by the outline, by the shoelace formula.
    let gauss = |points: &[DVec3]| {
        0.5 * (0..points.len()).map(|i| points[i].cross(points[(i + 1) % points.len()]).z).sum::<f64>()
    };
    assert_eq!(cut(&teeth).len(), teeth.len() - 2);
    assert!((covered(&teeth) - gauss(&teeth).abs()).abs() < 1e-9);
    // A square with a square hole, joined by a seam.
    let frame = flat(&[
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 3.0],
        [0.0, 3.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [2.0, 2.0],
        [2.0, 1.0],
        [1.0, 1.0],
    ]);
    assert_eq!(cut(&frame).len(), 8);
    assert!((covered(&frame) - 8.0).abs() < 1e-9, "{}", covered(&frame));
    let arm = |r: f64, i: usize| {
        [(r + 0.05 * i as f64) * (0.3 * i as f64).cos(), (r + 0.05 * i as f64) * (0.3 * i as f64).sin()]
    };
    let spiral = flat(&(0..80).map(|i| arm(1.0, i)).chain((0..80).rev().map(|i| arm(1.3, i))).collect::<Vec<_>>());
    assert!((covered(&spiral) - gauss(&spiral).abs()).abs() < 1e-9);
}

#[test]
fn corners_in_a_row_are_kept() {
    let row = flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0], [0.0, 1.0]]);
    assert_eq!(cut(&row).len(), 5);
    assert!((covered(&row) - 2.5).abs() < 1e-12, "{}", covered(&row));
}

#[test]
fn whatever_comes_becomes_n_minus_2_triangles() {
    let nan = DVec3::NAN;
    for corners in
        [vec![DVec3::ZERO; 9], vec![nan; 9], flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0], [1.0, 9.0]])]
    {
        assert_eq!(cut(&corners).len(), corners.len() - 2);
    }
}

/// Each corner used to be compared with all that are not convex, until patience ended.
#[test]
fn polygons_of_very_many_corners_are_cut_in_little_work() {
    const CORNERS: usize = 90_000;
    let around = |index: usize, radius: f64| {
        let angle = std::f64::consts::TAU * index as f64 / CORNERS as f64;
        DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    };
    let flower = |index: usize| around(index, 2.0 + (0.01 * index as f64).cos());
    let gear = |index: usize| around(index, 1.0 + 0.001 * (index % 2) as f64);
    // Single precision makes some corners of a circle reflex.
    let circle = |index: usize| around(index, 1.0).as_vec3().as_dvec3();
    for (name, corner) in [("flower", &flower as &dyn Fn(usize) -> DVec3), ("gear", &gear), ("circle", &circle)] {
        let corners: Vec<DVec3> = (0..CORNERS).map(corner).collect();
        let enclosed = 0.5 * (0..CORNERS).map(|i| corners[i].cross(corners[(i + 1) % CORNERS]).z).sum::<f64>();
        let (mut cutter, mut covered) = (Cutter::default(), 0.0);
        cutter.cut(&corners, |triangle| {
            let [a, b, c] = triangle.map(|corner| corners[corner]);
            covered += 0.5 * (b - a).cross(c - a).length();
        });
        assert!((covered / enclosed - 1.0).abs() < 1e-6, "{name}: {covered} instead of {enclosed}");
        assert_eq!((cutter.patience, cutter.warning()), (PATIENCE, None), "{name}");
    }
}

#[test]
fn patience_ends() {
    // A zigzag that offers an ear only after a long search, again and again.
    let zigzag: Vec<DVec3> =
        (0..60_000).map(|i| DVec3::new(f64::from(i).sin(), (1.7 * f64::from(i)).cos(), 0.0)).collect();
    let mut cutter = Cutter::default();
    let mut count = 0;
    cutter.cut(&zigzag, |_| count += 1);
    assert_eq!(count, zigzag.len() - 2);
    assert!(cutter.warning().is_some_and(|warning| warning.starts_with("1 polygons")));
    cutter.cut(&flat(&NOTCHED), |triangle| assert!(triangle.contains(&2), "the notch is cut at its corner"));
}
