use lightmesh_render::internals::material_ids::MaterialIds;
use lightmesh_scene::{Geometry, Material};

#[test]
fn materials_of_one_name_have_one_number() {
    let materials = ["a", "", "b", "a", ""].map(|name| Material::default().named(name)).to_vec();
    let ids = MaterialIds::new(&Geometry { materials, ..Geometry::default() });
    assert_eq!((ids.numbers, ids.names.join(",")), (vec![1, 2, 3, 1, 4], "a,material 2,b,material 5".to_owned()));
}
