//! Whole inputs to damage: the built-in files, and small ones that are written here.

use regrasp::run::scenario::{HANDS, SCENARIOS};
use std::fmt::Write;

/// The built-in scenario files.
pub fn scenarios() -> Vec<Vec<u8>> {
    SCENARIOS.iter().map(|file| file.text.as_bytes().to_vec()).collect()
}

/// The built-in hand files.
pub fn hands() -> Vec<Vec<u8>> {
    HANDS.iter().map(|file| file.text.as_bytes().to_vec()).collect()
}

/// A plan file.
pub fn plans() -> Vec<Vec<u8>> {
    let plan = || {
        let scenario = regrasp::load("sphere-free").ok()?;
        let plan = regrasp::solve(&scenario, 1).ok()?.plan?;
        let mut bytes = Vec::new();
        regrasp::plan::write_json(&plan, &mut bytes).ok()?;
        Some(bytes)
    };
    plan().into_iter().collect()
}

/// A hand of three fingers as URDF.
pub fn urdfs() -> Vec<Vec<u8>> {
    let mut text = String::from("<robot name=\"three\">\n<link name=\"palm\"/>\n");
    for finger in 0..3 {
        let mut parent = "palm".to_owned();
        for joint in 0..4 {
            let (name, angle) = (format!("f{finger}j{joint}"), 2.0944 * f64::from(finger));
            let origin = match joint {
                0 => format!("xyz=\"{} {} 0\" rpy=\"0 0 {angle}\"", 0.05 * angle.cos(), 0.05 * angle.sin()),
                _ => "xyz=\"0 0 0.04\"".to_owned(),
            };
            let (kind, axis) = match joint {
                0 => ("revolute", "1 0 0"),
                3 => ("fixed", "0 0 1"),
                _ => ("revolute", "0 1 0"),
            };
            let _ = write!(
                text,
                "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child \
                 link=\"{name}-link\"/><origin {origin}/>\
                 <axis xyz=\"{axis}\"/><limit lower=\"-1.2\" upper=\"1.2\" velocity=\"3\" \
                 effort=\"1\"/></joint>\n\
                 <link name=\"{name}-link\"><collision><geometry><sphere \
                 radius=\"0.01\"/></geometry></collision></link>\n"
            );
            parent = format!("{name}-link");
        }
    }
    vec![(text + "</robot>\n").into_bytes()]
}

const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.04, 0.0, 0.0], [0.0, 0.04, 0.0], [0.0, 0.0, 0.04]];
const FACETS: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

/// A tetrahedron as text and as binary STL.
pub fn stls() -> Vec<Vec<u8>> {
    let mut text = String::from("solid t\n");
    let mut binary = vec![b' '; 80];
    binary.extend(4_u32.to_le_bytes());
    for facet in FACETS {
        text += "facet normal 0 0 0\nouter loop\n";
        binary.extend([0; 12]);
        for [x, y, z] in facet.map(|corner| CORNERS[corner]) {
            let _ = writeln!(text, "vertex {x} {y} {z}");
            binary.extend([x, y, z].iter().flat_map(|number| number.to_le_bytes()));
        }
        text += "endloop\nendfacet\n";
        binary.extend([0; 2]);
    }
    vec![(text + "endsolid t\n").into_bytes(), binary]
}

/// The tetrahedron as OBJ.
pub fn objs() -> Vec<Vec<u8>> {
    let corners = CORNERS.map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let facets = FACETS.map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    vec![(corners.concat() + &facets.concat()).into_bytes()]
}

/// The tetrahedron as PLY.
pub fn plys() -> Vec<Vec<u8>> {
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float \
        z\n\
                element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    let corners = CORNERS.map(|[x, y, z]| format!("{x} {y} {z}\n"));
    let facets = FACETS.map(|[a, b, c]| format!("3 {a} {b} {c}\n"));
    vec![(head.to_owned() + &corners.concat() + &facets.concat()).into_bytes()]
}

/// The tetrahedron as COLLADA.
pub fn daes() -> Vec<Vec<u8>> {
    let corners: String = CORNERS.iter().flatten().map(|x| format!("{x} ")).collect();
    let facets: String = FACETS.iter().flatten().map(|corner| format!("{corner} ")).collect();
    vec![
        format!(
            "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset><unit \
             meter=\"1\"/></asset>\n\
             <library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" \
             count=\"12\">{corners}</float_array>\n\
             <technique_common><accessor source=\"#a\" count=\"4\" \
             stride=\"3\"/></technique_common></source>\n\
             <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\n\
             <triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" \
             offset=\"0\"/><p>{facets}</p></triangles></mesh></geometry>\n\
             </library_geometries><library_visual_scenes><visual_scene id=\"s\"><node><instance_geometry \
             url=\"#g\"/></node>\n\
             </visual_scene></library_visual_scenes><scene><instance_visual_scene \
             url=\"#s\"/></scene></COLLADA>\n"
        )
        .into_bytes(),
    ]
}

/// The head of an ELF library, and what no library is.
pub fn libraries() -> Vec<Vec<u8>> {
    let system = ["/lib/x86_64-linux-gnu/libm.so.6", "/lib64/libm.so.6", "/usr/lib/libm.so.6"];
    let whole = system.iter().find_map(|path| std::fs::read(path).ok());
    let mut head = b"\x7fELF\x02\x01\x01".to_vec();
    head.resize(64, 0);
    head[16..20].copy_from_slice(&[3, 0, 62, 0]);
    [head].into_iter().chain(whole).collect()
}

/// A study's description.
pub fn studies() -> Vec<Vec<u8>> {
    let scenario = serde_json::json!({ "name": "sphere", "file": "sphere" });
    let study = serde_json::json!({
        "format": "regrasp-study", "version": 1, "scenarios": [scenario], "variants": [], "seeds": { "first": 0, "count": 1 },
    });
    vec![study.to_string().into_bytes()]
}
