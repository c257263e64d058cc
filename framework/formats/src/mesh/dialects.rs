//! Files as programs really write them.

use super::*;
use regrasp_api::{MeshError, Primitive};
use regrasp_world::primitive_mesh;

fn cube() -> Mesh {
    primitive_mesh(&Primitive::Cuboid { half_size: Vec3::new(0.01, 0.02, 0.03) }, 12).unwrap()
}

fn load(name: &str, bytes: impl AsRef<[u8]>) -> Result<Mesh, FormatError> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    load_mesh(&MeshSource { file: Some(name.into()), ..Default::default() }, folder.path(), "shape")
}

fn refusal(name: &str, bytes: impl AsRef<[u8]>) -> MeshError {
    match load(name, bytes) {
        Err(FormatError::FileMesh { source, .. }) => *source,
        other => panic!("{other:?}"),
    }
}

/// The cube as ASCII STL, with a solid for each half of it.
fn stl() -> String {
    let mesh = cube();
    let mut text = String::new();
    for half in 0..2 {
        text += if half == 0 { "solid\n" } else { "solid facet with a name\n" };
        for facet in 6 * half..6 * half + 6 {
            text += "\tfacet normal 0 0 0\n\t\touter loop\n";
            mesh.corners(facet)
                .iter()
                .for_each(|v| text += &format!("\t\t\tvertex {:E}\t{} {}\n", v.x, v.y, v.z));
            text += "\t\tendloop\n\tendfacet\n";
        }
        text += "endsolid\n";
    }
    text
}

/// Decimal commas in place of points.
fn with_commas(text: &str) -> String {
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    text.split_inclusive([' ', '\t', '\n'])
        .map(|word| if is_number(word.trim()) { word.replace('.', ",") } else { word.to_owned() })
        .collect()
}

/// Commas between the coordinates of vertices.
fn with_lists(text: &str) -> String {
    let line = |line: &str| match line.trim().strip_prefix("vertex") {
        Some(rest) => format!("vertex {}\n", rest.split_whitespace().collect::<Vec<_>>().join(", ")),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

fn obj(vertices: &[[f64; 3]], facets: &[[usize; 3]]) -> String {
    let vertices: String = vertices.iter().map(|v| format!("v {} {} {}\n", v[0], v[1], v[2])).collect();
    facets.iter().fold(vertices, |text, f| text + &format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1))
}

/// A tetrahedron with its corners on the axes.
const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.0, 0.02, 0.0], [0.0, 0.0, 0.02]];
const SIDES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

#[test]
fn ascii_stl_is_read_in_every_dialect() {
    let text = stl();
    let utf16: Vec<u8> =
        "\u{feff}".chars().chain(text.chars()).flat_map(|c| (c as u16).to_le_bytes()).collect();
    let apart = text.replace("endloop", "end loop").replace("endfacet", "end facet");
    let dialects = [
        text.clone().into_bytes(),
        text.to_uppercase().into_bytes(),
        format!("\u{feff}{text}").into_bytes(),
        format!("\r\n\u{20}{text}").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        text.replace('\n', "\r\n").into_bytes(),
        text.replace("E-", "D-").into_bytes(),
        text.replace("outer loop", "outerloop").into_bytes(),
        apart.into_bytes(),
        utf16,
        text.rsplit_once("endsolid").unwrap().0.into(),
        text.replace('\n', " ").into_bytes(),
        format!("# a remark\n; another\n{text}").into_bytes(),
        format!("{text}\u{1a}").into_bytes(),
        format!("{text}\0\0\0").into_bytes(),
        with_commas(&text).into_bytes(),
        with_lists(&text).into_bytes(),
    ];
    for (i, bytes) in dialects.into_iter().enumerate() {
        let mesh = load("part.stl", bytes).unwrap_or_else(|error| panic!("dialect {i}: {error}"));
        assert!((mesh.mass_properties().volume - 4.8e-5).abs() < 1e-12, "dialect {i}");
    }
}

#[test]
fn an_stl_that_ends_too_early_or_late_is_told() {
    let text = stl();
    let cut = load("part.stl", &text[..text.len() / 3]).unwrap_err().to_string();
    assert!(cut.contains("truncated") || cut.contains("damaged"), "{cut}");
    let mut binary = vec![b' '; 80];
    binary.extend(11_u32.to_le_bytes());
    binary.extend(vec![0; 12 * 50]);
    let message = load("part.stl", binary).unwrap_err().to_string();
    assert!(message.contains("announces 11 facets, the file holds 12"), "{message}");
}

#[test]
fn a_file_with_the_wrong_ending_is_told_by_its_content() {
    for (name, content, what) in [
        ("part.obj", stl(), "an STL file: give it the ending `.stl`"),
        ("part.stl", obj(&CORNERS, &SIDES), "an OBJ file"),
        ("part.ply", obj(&CORNERS, &SIDES), "an OBJ file"),
        ("part.3mf", stl(), "an STL file"),
    ] {
        let message = load(name, content).unwrap_err().to_string();
        assert!(message.contains(what), "{name}: {message}");
    }
    let message = load("part", stl()).unwrap_err().to_string();
    assert!(message.contains("no ending"), "{message}");
}

#[test]
fn obj_has_its_faces_anywhere_and_its_words_in_any_case() {
    let text = obj(&CORNERS, &SIDES);
    let (vertices, faces) = text.split_at(text.find('f').unwrap());
    let negative =
        SIDES.iter().map(|f| format!("f {} {} {}\n", f[0] as i64 - 4, f[1] as i64 - 4, f[2] as i64 - 4));
    let negative: String = negative.collect();
    for file in [
        format!("{faces}{vertices}"),
        text.to_uppercase(),
        text.replace("f ", "fo "),
        format!("{vertices}{negative}"),
        format!("{text}f 1 2\nf 3\nl 1 2\n"),
        text.replace("0.02", "0,02"),
    ] {
        let mesh = load("part.obj", &file).unwrap_or_else(|error| panic!("{file}: {error}"));
        assert!((mesh.mass_properties().volume - 8e-6 / 6.0).abs() < 1e-15, "{file}");
    }
    let message = load("part.obj", vertices).unwrap_err().to_string();
    assert!(message.contains("no facets"), "{message}");
}

#[test]
fn a_ply_header_may_end_its_lines_with_cr() {
    let vertices: String = CORNERS.iter().map(|v| format!("{} {} {}\n", v[0], v[1], v[2])).collect();
    let faces: String = SIDES.iter().map(|f| format!("3 {} {} {}\n", f[0], f[1], f[2])).collect();
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
                  property float z\nelement face 5\nproperty list uchar int vertex_index\nend_header\n";
    let text = format!("{header}{vertices}{faces}2 0 1\n");
    assert!(load("part.ply", text.replace('\n', "\r")).is_ok());
    let cloud = text.replace("face 5", "face 0");
    let message = load("part.ply", cloud).unwrap_err().to_string();
    assert!(message.contains("points and no faces"), "{message}");
}

#[test]
fn numbers_that_no_object_has_are_refused_as_such() {
    for (number, reason) in [("1e160", "1e160 m is outside -1e6..=1e6"), ("1e-160", "1e-160 m large")] {
        let message =
            load("part.obj", obj(&CORNERS, &SIDES).replace("0.02", number)).unwrap_err().to_string();
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn one_body_inside_out_is_named_though_it_is_the_largest() {
    let mut corners = CORNERS.to_vec();
    corners.extend(CORNERS.map(|v| v.map(|x| 0.5 * x + 0.05)));
    let outer = SIDES.map(|[a, b, c]| [a, c, b]);
    let sides: Vec<[usize; 3]> = outer.into_iter().chain(SIDES.map(|f| f.map(|v| v + 4))).collect();
    let message = load("part.obj", obj(&corners, &sides)).unwrap_err().to_string();
    assert!(message.contains("body 1 of 2 (4 facets, near [0.0000"), "{message}");
}

#[test]
fn what_was_done_to_close_a_mesh_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let source = MeshSource { file: Some("part.obj".into()), ..Default::default() };
    let read = |text: String| {
        std::fs::write(folder.path().join("part.obj"), text).unwrap();
        read_mesh(&source, folder.path(), "shape").unwrap()
    };
    assert!(read(obj(&CORNERS, &SIDES)).remarks().is_empty());
    let flat = read(obj(&CORNERS, &SIDES) + "f 1 1 2\nf 3 3 3\n");
    assert!(flat.dropped == 2 && flat.remarks()[0].contains("2 facets without area"), "{flat:?}");
    let mut corners = CORNERS.to_vec();
    corners.push([0.02, 1e-7, 0.0]);
    let seam = read(obj(&corners, &[[0, 2, 4], [0, 1, 3], [0, 3, 2], [1, 2, 3]]));
    assert!(seam.welded > 1e-7 && seam.remarks()[0].contains("a vertex became one with another"), "{seam:?}");
}

#[test]
fn the_line_of_a_fault_is_counted_in_every_dialect() {
    for end in ["\n", "\r\n", "\r"] {
        let text = stl().replacen("endloop", "endlop", 1).replace('\n', end);
        let message = load("part.stl", text).unwrap_err().to_string();
        assert!(message.contains("line 7: `endlop`"), "{end:?}: {message}");
    }
}

#[test]
fn ply_has_its_elements_in_any_order_and_faces_as_strips() {
    let vertices: String = CORNERS.iter().map(|v| format!("{} {} {}\n", v[0], v[1], v[2])).collect();
    let vertex = "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n";
    let faces: String = SIDES.iter().map(|f| format!("3 {} {} {} 7\n", f[0], f[1], f[2])).collect();
    let face = "element face 4\nproperty list uchar int vertex_index\nproperty uchar flags\n";
    let first = format!("ply\nformat ascii 1.0\n{face}{vertex}end_header\n{faces}{vertices}");
    let strip = "element tristrips 1\nproperty list int int vertex_indices\n";
    let strips = format!("ply\nformat ascii 1.0\n{vertex}{strip}end_header\n{vertices}8 0 2 1 3 -1 3 2 0\n");
    let closed = format!("ply\nformat ascii 1.0\n{vertex}{strip}end_header\n{vertices}6 0 2 1 3 0 2\n");
    for (text, volume) in [(first, Some(8e-6 / 6.0)), (closed, Some(8e-6 / 6.0)), (strips, None)] {
        match (load("part.ply", &text), volume) {
            (Ok(mesh), Some(volume)) => assert!((mesh.mass_properties().volume - volume).abs() < 1e-15),
            (Err(FormatError::FileMesh { .. }), None) => {}
            (other, _) => panic!("{text}: {other:?}"),
        }
    }
    let bad = format!("ply\nformat ascii 1.0\n{vertex}{strip}end_header\n{vertices}3 0 1 4\n");
    assert!(load("part.ply", bad).unwrap_err().to_string().contains("vertex 4 of 4"));
}

#[test]
fn vertices_that_differ_by_rounding_are_one() {
    let mut corners = CORNERS.to_vec();
    corners.extend([[0.0, -2.7e-16, 0.0], [0.02, 1e-9, 0.0]]);
    let mesh = load("part.obj", obj(&corners, &[[0, 2, 5], [4, 1, 3], [0, 3, 2], [1, 2, 3]])).unwrap();
    assert_eq!((mesh.vertices().len(), mesh.facets().len()), (4, 4));
}

#[test]
fn the_true_reason_is_named_with_its_place() {
    let mut corners = CORNERS.to_vec();
    corners.push([0.02, 1e-6, 0.0]);
    let seam = refusal("part.obj", obj(&corners, &[[0, 2, 4], [0, 1, 3], [0, 3, 2], [1, 2, 3]]));
    assert!(matches!(seam, MeshError::Seam { apart, .. } if (apart - 1e-6).abs() < 1e-12), "{seam}");
    corners[4] = [0.01, 0.0, 0.0];
    let split = refusal("part.obj", obj(&corners, &[[0, 2, 1], [0, 4, 3], [4, 1, 3], [0, 3, 2], [1, 2, 3]]));
    assert!(matches!(split, MeshError::TJunction { vertex: [0.01, 0.0, 0.0], .. }), "{split}");
    let twice = refusal("part.obj", obj(&CORNERS, &[SIDES[0], SIDES[1], SIDES[2], SIDES[3], SIDES[1]]));
    assert!(matches!(twice, MeshError::Duplicated { first: 1, second: 4, .. }), "{twice}");
    let hole = refusal("part.obj", obj(&CORNERS, &SIDES[1..]));
    assert!(matches!(hole, MeshError::Open { count: 3, .. }), "{hole}");
}

/// A tetrahedron in COLLADA, its sides given as `polygons`, shown by `nodes`.
fn dae(polygons: &str, nodes: &str) -> String {
    format!(
        r##"<COLLADA><library_geometries><geometry id="g"><mesh><source id="s"><float_array id="a">
        0 0 0 0.02 0 0 0 0.02 0 0 0 0.02</float_array></source><vertices id="v"><input semantic="POSITION" source="#s"/>
        </vertices><polygons><input semantic="VERTEX" source="#v" offset="0"/>{polygons}</polygons></mesh></geometry>
        </library_geometries><library_nodes>{nodes}</library_nodes><library_visual_scenes><visual_scene>
        <node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes></COLLADA>"##
    )
}

#[test]
fn collada_outlines_count_and_holes_are_refused() {
    let sides = "<p>0 2 1</p><p>0 1 3</p><p>0 3 2</p>";
    assert!(load("part.dae", dae(&format!("{sides}<ph><p>1 2 3</p></ph>"), "")).is_ok());
    let message =
        load("part.dae", dae(&format!("{sides}<ph><p>1 2 3</p><h>0 1 2</h></ph>"), "")).unwrap_err();
    assert!(message.to_string().contains("<ph>: a polygon with holes"), "{message}");
}

#[test]
fn collada_has_its_encodings_and_named_axes() {
    let sides = "<p>0 2 1</p><p>0 1 3</p><p>0 3 2</p><p>1 2 3</p>";
    let declared =
        format!("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><!DOCTYPE COLLADA>{}", dae(sides, ""));
    let mut latin = declared.into_bytes();
    latin.extend(b"<!-- f\xfcnf -->");
    assert!(load("part.dae", latin).is_ok());
    let accessor = "<technique_common><accessor source=\"#a\" stride=\"3\"><param name=\"Y\"/><param \
        name=\"X\"/>\
                    <param name=\"Z\"/></accessor></technique_common></source><vertices";
    let turned = dae(sides, "").replace("</source><vertices", accessor);
    let fault = refusal("part.dae", turned);
    assert!(matches!(fault, MeshError::InsideOut { .. }), "{fault}");
    for (transform, reason) in [
        ("<rotate>0 0 1 1e160</rotate>", "is outside ±36000°"),
        ("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1</matrix>", "last row"),
    ] {
        let text = dae(sides, "").replace("<node><instance", &format!("<node>{transform}<instance"));
        let message = load("part.dae", text).unwrap_err().to_string();
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn a_collada_scene_of_many_vertices_is_refused_before_they_are_gathered() {
    let points: String = (0..1000).map(|i| format!("{i} 0 0 ")).collect();
    let mut nodes = String::from(r##"<node id="n0"><instance_geometry url="#g"/></node>"##);
    for level in 1..=17 {
        let inner = format!(r##"<instance_node url="#n{}"/>"##, level - 1).repeat(2);
        nodes += &format!(r##"<node id="n{level}">{inner}</node>"##);
    }
    let text = dae("<p>0 2 1</p>", &nodes).replace("0 0 0 0.02", &format!("{points} 0 0 0 0.02"));
    let text =
        text.replace(r##"<node><instance_geometry url="#g"/>"##, r##"<node><instance_node url="#n17"/>"##);
    let message = load("part.dae", text).unwrap_err().to_string();
    assert!(message.contains("more than"), "{message}");
}
