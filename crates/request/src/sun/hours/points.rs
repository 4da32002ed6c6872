//! Points on objects that few pixels show, with their hours.

use std::collections::BTreeMap;

use glam::Vec3;

/// A point on an object, the area that it stands for, and its hours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) area: f64,
    pub(super) hours: f64,
}

/// The points of objects that few pixels show, by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Finer(pub(super) BTreeMap<u32, Vec<Point>>);
