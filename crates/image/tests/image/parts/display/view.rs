use lightmesh_image::View;

#[test]
fn names_are_read_and_written() {
    View::ALL.iter().for_each(|view| assert_eq!(view.to_string().parse(), Ok(*view)));
    let message = "filmic".parse::<View>().unwrap_err().to_string();
    assert!(View::ALL.iter().all(|view| message.contains(view.name())), "{message}");
}
