//! COLLADA files.

use super::*;

/// A COLLADA file of a cube in centimetres: half of its sides as triangles, half as polygons, below a node
/// that turns and mirrors it.
fn dae() -> String {
    let corners: Vec<String> = (0..8).map(|i| format!("{} {} {}", i & 1, i >> 1 & 1, i >> 2)).collect();
    format!(
        "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>
         <asset><unit name='centimeter' meter='0.01'/><up_axis>Y_UP</up_axis></asset>
         <library_geometries><geometry id='cube'><mesh>
         <source id='places'><float_array id='numbers' count='24'>{}</float_array>
         <technique_common><accessor source='#numbers' count='8' stride='3'/></technique_common></source>
         <vertices id='corners'><input semantic='POSITION' source='#places'/></vertices>
         <triangles count='4'><input semantic='NORMAL' source='#places' offset='1'/><input \
         semantic='VERTEX' source='#corners' offset='0'/>
         <p>0 7 2 7 3 7  0 7 3 7 1 7</p><p>4 0 5 0 7 0  4 0 7 0 6 0</p></triangles>
         <polylist count='2'><input semantic='VERTEX' source='#corners' offset='0'/><vcount>4 \
         4</vcount><p>0 1 5 4 2 6 7 3</p></polylist>
         <polygons count='1'><input semantic='VERTEX' source='#corners' offset='0'/><p>0 4 6 2</p></polygons>
         <tristrips count='1'><input semantic='VERTEX' source='#corners' offset='0'/><p>1 3 5 \
         7</p></tristrips>
         <lines count='1'><input semantic='VERTEX' source='#corners' offset='0'/><p>0 1</p></lines>
         </mesh></geometry></library_geometries>
         <library_nodes><node id='shared'><scale>2 2 2</scale><instance_geometry \
         url='#cube'/></node></library_nodes><library_visual_scenes><visual_scene id='scene'>
         <node><translate>10 0 0</translate><rotate>0 0 1 90</rotate>
         <node><matrix>-1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1</matrix><instance_node \
         url='#shared'/></node></node></visual_scene>
         </library_visual_scenes><scene><instance_visual_scene url='#scene'/></scene></COLLADA>",
        corners.join(" ")
    )
}

#[test]
fn collada_is_read_with_its_unit_nodes_and_all_kinds_of_faces() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.DAE");
    std::fs::write(&path, dae()).unwrap();
    let source = MeshSource { file: Some("cube.DAE".into()), ..Default::default() };
    let mesh = load_mesh(&source, folder.path(), "shape").unwrap();
    assert_eq!((mesh.vertices().len(), mesh.facets().len()), (8, 12));
    // Doubled to 2 cm, mirrored in x, turned by 90° about z, moved by 10 cm: x in 8..=10 cm, y in -2..=0, z
    // in 0..=2.
    let low = mesh.vertices().iter().copied().reduce(|a, b| a.inf(&b)).unwrap();
    let high = mesh.vertices().iter().copied().reduce(|a, b| a.sup(&b)).unwrap();
    assert!((low - Vec3::new(0.08, -0.02, 0.0)).norm() < 1e-12, "{low}");
    assert!((high - Vec3::new(0.10, 0.0, 0.02)).norm() < 1e-12, "{high}");
    assert!((mesh.mass_properties().volume - 8e-6).abs() < 1e-12, "outward although mirrored");
}

/// Nodes that each hold the next one twice, so that the last one stands in the scene 2^40 times.
fn doubling() -> String {
    let node = |i: usize| {
        let next = format!("<instance_node url='#n{}'/>", i + 1);
        format!("<node id='n{i}'>{next}{next}</node>")
    };
    let nodes: String = (0..40).map(node).collect();
    format!("{nodes}<node id='n40'/></library_nodes>")
}

#[test]
fn what_is_wrong_with_collada_is_said() {
    let refusal = |from: &str, to: &str| {
        let text = dae();
        assert!(text.contains(from), "{from}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.dae");
        std::fs::write(&path, text.replace(from, to)).unwrap();
        read_points(&path).unwrap_err().to_string()
    };
    let doubling = doubling()
        + "<library_visual_scenes><visual_scene id='scene'><node><instance_node url='#n0'/></node>";
    for (from, to, part) in [
        ("</COLLADA>", "", "XML"),
        ("COLLADA", "dae", "<dae>"),
        ("meter='0.01'", "meter='0'", "metres"),
        ("0 4 6 2", "0 4 6 9", "corner 9 of only 8"),
        ("0 4 6 2", "0 4 x 2", "`x` is no number"),
        ("<vcount>4 4</vcount>", "<vcount>4 5</vcount>", "more corners"),
        ("<vcount>4 4</vcount>", "", "<vcount>"),
        ("url='#cube'", "url='#ball'", "\"#ball\" names nothing"),
        ("url='#cube'/>", "url='#cube'/><instance_node url='#shared'/>", "deep"),
        (
            "<instance_geometry url='#cube'/>",
            "<instance_node url='#shared'/><instance_node url='#shared'/>",
            "deep",
        ),
        (
            "</library_nodes><library_visual_scenes><visual_scene id='scene'>",
            &doubling,
            "more than 100000 nodes",
        ),
        ("semantic='VERTEX'", "semantic='CORNER'", "VERTEX"),
        ("<scale>2 2 2</scale>", "<scale>2 2</scale>", "3 finite numbers"),
        ("<scale>2 2 2</scale>", "<skew>1 2 3 4 5 6 7</skew>", "STL"),
        ("0 0 0 1 0 0", "0 nan 0 1 0 0", "finite"),
    ] {
        let said = refusal(from, to);
        assert!(said.contains(part), "{part}: {said}");
    }
}
