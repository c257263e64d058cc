//! glTF and 3MF: files that are written here, and what becomes of faults in them.

use super::*;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;

/// A tetrahedron with its corners on the axes.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.0, 0.02, 0.0], [0.0, 0.0, 0.02]];
const SIDES: [[u16; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
const VOLUME: f64 = 8e-6 / 6.0;

fn load(name: &str, bytes: &[u8]) -> Result<Mesh, FormatError> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    std::fs::write(folder.path().join("a buffer.bin"), buffer()).unwrap();
    load_mesh(&MeshSource { file: Some(name.into()), ..Default::default() }, folder.path(), "shape")
}

fn buffer() -> Vec<u8> {
    let mut bytes: Vec<u8> = CORNERS.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(SIDES.iter().flatten().flat_map(|index| index.to_le_bytes()));
    bytes
}

/// The tetrahedron as glTF; `node` stands in its one node, `buffer` in its one buffer.
fn gltf(node: &str, buffer: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0 {node}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 24}}],
        "buffers": [{{"byteLength": 72 {buffer}}}]}}"#
    )
}

fn glb(json: &str) -> Vec<u8> {
    let padded = |mut bytes: Vec<u8>, with: u8| {
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json.as_bytes().to_vec(), b' '), padded(buffer(), 0));
    let mut bytes = b"glTF".to_vec();
    let total = 12 + 8 + json.len() + 8 + binary.len();
    bytes.extend([2_u32, total as u32].iter().flat_map(|n| n.to_le_bytes()));
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

#[test]
fn gltf_has_its_buffer_beside_within_or_behind() {
    let base64 =
        "AAAAAAAAAAAAAAAACtejPAAAAAAAAAAAAAAAAArXozwAAAAAAAAAAAAAAAAK16M8AAACAAEAAAABAAMAAAADAAIAAQACAAMA";
    let beside = gltf("", r#", "uri": "a%20buffer.bin""#).into_bytes();
    let within =
        gltf("", &format!(r#", "uri": "data:application/octet-stream;base64,{base64}""#)).into_bytes();
    for (name, bytes) in [("a.gltf", beside), ("a.gltf", within), ("a.glb", glb(&gltf("", "")))] {
        let mesh = load(name, &bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!((mesh.mass_properties().volume - VOLUME).abs() < 1e-12);
    }
}

#[test]
fn gltf_nodes_move_turn_scale_and_mirror() {
    let half = r#", "translation": [1, 0, 0], "rotation": [0, 0, 1, 0], "scale": [0.5, 0.5, 0.5]"#;
    let mesh = load("a.glb", &glb(&gltf(half, ""))).unwrap();
    assert!((mesh.mass_properties().volume - VOLUME / 8.0).abs() < 1e-12);
    assert!(mesh.vertices().iter().any(|v| (v - Vec3::new(0.99, 0.0, 0.0)).norm() < 1e-6));
    let mirror = r#", "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"#;
    assert!(load("a.glb", &glb(&gltf(mirror, ""))).is_ok());
}

#[test]
fn faults_of_gltf_are_told() {
    let good = gltf("", "");
    for (from, to, reason) in [
        ("\"count\": 4", "\"count\": 40", "reaches beyond its buffer"),
        ("\"count\": 4", "\"count\": 4000000000000", "at most"),
        ("\"byteOffset\": 48", "\"byteOffset\": 18446744073709551615", "reaches beyond its buffer"),
        ("\"mesh\": 0", "\"mesh\": 7", "there is no mesh 7"),
        ("\"mesh\": 0", "\"mesh\": 0, \"children\": [0]", "deep in each other"),
        ("\"nodes\": [0]", "\"nodes\": [9]", "there is no node 9"),
        ("\"2.0\"", "\"1.0\"", "glTF 1.0"),
        (
            "\"asset\"",
            "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"], \"asset\"",
            "without compression",
        ),
        ("\"byteLength\": 72", "\"byteLength\": 72, \"uri\": \"http://x.org/y.bin\"", "nothing is fetched"),
        ("\"byteLength\": 72", "\"byteLength\": 72, \"uri\": \"none.bin\"", "none.bin"),
        ("\"byteLength\": 72", "\"byteLength\": 72, \"uri\": \"data:;base64,*\"", "no base64"),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good);
        let message = load("a.glb", &glb(&text)).unwrap_err().to_string();
        assert!(message.contains(reason), "{to}: {message}");
    }
    for cut in [4, 11, 19, 100] {
        assert!(load("a.glb", &glb(&good)[..cut]).is_err());
    }
}

/// The tetrahedron as 3MF in a unit, built by `items`, with further objects.
fn threemf(unit: &str, others: &str, items: &str) -> Vec<u8> {
    let vertices =
        CORNERS.map(|[x, y, z]| format!("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", 1e3 * x, 1e3 * y, 1e3 * z));
    let triangles = SIDES.map(|[a, b, c]| format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>"));
    let model = format!(
        "<?xml version=\"1.0\"?><model {unit} \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\
         <resources><object id=\"1\" \
         type=\"model\"><mesh><vertices>{}</vertices><triangles>{}</triangles></mesh>\
         </object>{others}</resources><build>{items}</build></model>",
        vertices.concat(),
        triangles.concat()
    );
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let packed = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Deflated);
    archive.start_file("3D/3dmodel.model", packed).unwrap();
    archive.write_all(model.as_bytes()).unwrap();
    archive.finish().unwrap().into_inner()
}

#[test]
fn threemf_is_read_in_its_unit_with_components_and_transforms() {
    let one = "<item objectid=\"1\"/>";
    for (unit, times) in [("", 1.0), ("unit=\"centimeter\"", 10.0), ("unit=\"inch\"", 25.4)] {
        let mesh = load("a.3mf", &threemf(unit, "", one)).unwrap();
        assert!((mesh.mass_properties().volume / (VOLUME * f64::powi(times, 3)) - 1.0).abs() < 1e-5);
    }
    let other = "<object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 6 \
        7\"/>\
                 </components></object>";
    let item = "<item objectid=\"2\" transform=\"0 1 0 -1 0 0 0 0 1 100 0 0\"/>";
    let mesh = load("a.3mf", &threemf("", other, item)).unwrap();
    // The corner at the origin is moved by (5, 6, 7), turned by 90° about z and moved by 100 along x.
    assert!(mesh.vertices().iter().any(|v| (v - Vec3::new(0.094, 0.005, 0.007)).norm() < 1e-9));
}

#[test]
fn faults_of_threemf_are_told() {
    let circle = "<object id=\"2\"><components><component objectid=\"2\"/></components></object>";
    for (bytes, reason) in [
        (threemf("unit=\"ell\"", "", ""), "its unit \"ell\""),
        (threemf("", "", "<item objectid=\"9\"/>"), "there is no object \"9\""),
        (threemf("", circle, "<item objectid=\"2\"/>"), "deep in each other"),
        (threemf("", "", "<item objectid=\"1\" transform=\"1 2\"/>"), "12 finite numbers"),
        (threemf("", "", ""), "the mesh has no facets"),
        (b"PK\x03\x04 and no more".to_vec(), "no zip archive"),
    ] {
        let message = load("a.3mf", &bytes).unwrap_err().to_string();
        assert!(message.contains(reason), "{message}");
    }
}
