//! What mesh files hold, in the form that is the same for all backends: light points and gathered light.

use glam::{UVec3, Vec3};

use super::stored::Stored;
use crate::prepared::PreparedScene;
use crate::stages::irradiance_cache::saved::SavedLight;

/// What a file holds of one geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Hash of the geometry.
    pub geometry: u64,
    /// Where its light points lie.
    pub places: Places,
    /// What they see.
    pub stored: Stored,
}

/// What surfaces of a geometry gathered, as files hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedGathered {
    /// Hash of the geometry.
    pub geometry: u64,
    /// Hash of all that it depends on.
    pub sources: u64,
    /// What was gathered.
    pub light: SavedLight,
}

/// What files hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Content {
    /// Light points, by geometry.
    pub points: Vec<Section>,
    /// Gathered light, by geometry.
    pub gathered: Vec<SavedGathered>,
}

impl Content {
    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty() && self.gathered.is_empty()
    }

    /// Number of values of light points.
    pub(super) fn len(&self) -> u64 {
        self.points.iter().map(Section::len).sum()
    }

    /// Number of records that gathered light.
    pub(super) fn records(&self) -> u64 {
        self.gathered.iter().map(|gathered| gathered.light.len()).sum()
    }

    /// Bytes that light points take.
    pub(super) fn memory_of_points(&self) -> u64 {
        self.points.iter().map(|section| section.stored.memory()).sum()
    }

    /// Bytes that gathered light takes.
    pub(super) fn memory_of_gathered(&self) -> u64 {
        self.gathered.iter().map(|gathered| gathered.light.memory()).sum()
    }

    pub(super) fn append(&mut self, other: &mut Content) {
        self.points.append(&mut other.points);
        self.gathered.append(&mut other.gathered);
    }

    /// The largest section of each geometry of a scene, and most of what its surfaces gathered.
    pub(super) fn only_of(self, scene: &PreparedScene) -> Content {
        let Content { mut points, mut gathered } = self;
        let order: Vec<u64> = scene.geometry.all_parts().iter().map(|geometry| geometry.hash()).collect();
        let place = |section: &Section| order.iter().position(|&hash| hash == section.geometry);
        points.retain(|section| section.len() > 0 && place(section).is_some());
        points.sort_by_key(|section| (place(section), u64::MAX - section.len()));
        points.dedup_by_key(|section| section.geometry);
        gathered.retain(|gathered| gathered.light.len() > 0 && gathered.geometry == scene.geometry.hash());
        gathered.sort_by_key(|gathered| u64::MAX - gathered.light.len());
        gathered.truncate(1);
        Content { points, gathered }
    }
}

impl Section {
    /// Number of values.
    pub(super) fn len(&self) -> u64 {
        self.stored.len()
    }
}

/// What determines the positions of light points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Places {
    /// See [`Lattice`](crate::light_mesh::Lattice).
    pub anchor: Vec3,
    /// See [`Lattice`](crate::light_mesh::Lattice).
    pub step: f32,
    /// See [`Lattice`](crate::light_mesh::Lattice).
    pub number: UVec3,
}
