//! Whole inputs to damage: the built-in files, and small ones that are written here.

use regrasp::host::Registry;
use regrasp::run::scenario::{HANDS, SCENARIOS};
use regrasp::study::compare::{Hypotheses, Machine, Seeds, StudyWish, VariantWish, prepare};
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

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

/// A hand of four fingers as MJCF, one of them coupled, with classes, actuators and an equality.
pub fn mjcfs() -> Vec<Vec<u8>> {
    let mut fingers = String::new();
    for finger in 0..4 {
        let angle = FRAC_PI_2 * f64::from(finger);
        let _ = write!(
            fingers,
            "<body name=\"base{finger}\" pos=\"{} {} 0\" euler=\"0 0 {angle}\">\
             <joint name=\"a{finger}\" axis=\"1 0 0\"/><geom type=\"capsule\" size=\"0.008\" \
             fromto=\"0 0 0 0 0 0.04\"/>\n\
             <body pos=\"0 0 0.04\" quat=\"1 0 0 0\"><joint name=\"b{finger}\"/><geom size=\"0.008\"/>\
             <body pos=\"0 0 0.04\"><joint name=\"c{finger}\"/>\
             <geom class=\"tip\" pos=\"0 0 0.03\"/></body></body></body>\n",
            0.05 * angle.cos(),
            0.05 * angle.sin()
        );
    }
    let text = format!(
        "<mujoco model=\"four\">\n<compiler angle=\"radian\" eulerseq=\"xyz\" autolimits=\"true\"/>\n\
         <default><joint axis=\"0 1 0\" range=\"-1.2 1.2\" actuatorfrcrange=\"-1 1\"/>\
         <default class=\"tip\"><geom type=\"sphere\" size=\"0.01\"/></default></default>\n\
         <worldbody><body name=\"palm\"><geom type=\"box\" size=\"0.06 0.06 0.01\" pos=\"0 0 \
         -0.02\"/>\n{fingers}</body></worldbody>\n\
         <contact><exclude body1=\"palm\" body2=\"base0\"/></contact>\n\
         <equality><joint joint1=\"c0\" joint2=\"b0\" polycoef=\"0.1 0.9 0 0 0\"/></equality>\n\
         <actuator><position joint=\"a1\" forcerange=\"-2 2\" kp=\"3\"/></actuator>\n\
         <keyframe><key name=\"home\" qpos=\"0 0.3 0.4 0 0.3 0.4 0 0.3 0.4 0 0.3 0.4\"/></keyframe>\n\
         </mujoco>\n"
    );
    vec![text.into_bytes()]
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

/// The tetrahedron as glTF: as text with its numbers in it, and in the binary form.
pub fn gltfs() -> Vec<Vec<u8>> {
    let corners = CORNERS.iter().flatten().flat_map(|x| x.to_le_bytes());
    let facets = FACETS.iter().flatten().flat_map(|&corner| (corner as u16).to_le_bytes());
    let numbers: Vec<u8> = corners.chain(facets).collect();
    let scene = |buffer: serde_json::Value| {
        serde_json::json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0, "translation": [0.0, 0.0, 0.0], "scale": [1.0, 1.0, 1.0] }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
            "accessors": [
                { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                  "min": [0.0, 0.0, 0.0], "max": [0.04, 0.04, 0.04] },
                { "bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR" },
            ],
            "bufferViews": [
                { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
                { "buffer": 0, "byteOffset": 48, "byteLength": 24 },
            ],
            "buffers": [buffer],
        })
        .to_string()
    };
    let uri = format!("data:application/octet-stream;base64,{}", base64(&numbers));
    let text = scene(serde_json::json!({ "byteLength": 72, "uri": uri }));
    let mut head = scene(serde_json::json!({ "byteLength": 72 }));
    head.extend(std::iter::repeat_n(' ', head.len().next_multiple_of(4) - head.len()));
    let parts = [(b"JSON", head.as_bytes()), (b"BIN\0", &numbers[..])];
    let length: usize = 12 + parts.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
    let mut binary = b"glTF\x02\0\0\0".to_vec();
    binary.extend((length as u32).to_le_bytes());
    for (kind, bytes) in parts {
        binary.extend((bytes.len() as u32).to_le_bytes());
        binary.extend(kind.iter().chain(bytes));
    }
    vec![text.into_bytes(), binary]
}

fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let sign = |bits: u32| char::from(SIGNS[bits as usize & 63]);
    // The tetrahedron's bytes are a multiple of three.
    let threes = bytes.chunks_exact(3).map(|three| u32::from_be_bytes([0, three[0], three[1], three[2]]));
    threes.flat_map(|bits| [18, 12, 6, 0].map(|shift| sign(bits >> shift))).collect()
}

/// The tetrahedron as 3MF's model, as text and in its archive.
pub fn threemfs() -> Vec<Vec<u8>> {
    let corners = CORNERS.map(|[x, y, z]| format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>"));
    let facets = FACETS.map(|[a, b, c]| format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>"));
    let model = format!(
        "<model unit=\"meter\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n\
         <resources><object id=\"1\" type=\"model\"><mesh><vertices>{}</vertices>\n\
         <triangles>{}</triangles></mesh></object>\n\
         <object id=\"2\"><components><component objectid=\"1\"/></components></object></resources>\n\
         <build><item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 0 0\"/></build></model>\n",
        corners.concat(),
        facets.concat()
    );
    vec![model.clone().into_bytes(), archive("3D/3dmodel.model", model.as_bytes())]
}

/// A zip archive of one file, which is stored as it is.
pub fn archive(name: &str, bytes: &[u8]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    writer.start_file(name, stored).and_then(|()| Ok(writer.write_all(bytes)?)).expect("memory takes it");
    writer.finish().expect("memory takes it").into_inner()
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
    let study = || {
        let wish = StudyWish {
            command: vec!["regrasp".into(), "compare".into(), "sphere-free".into()],
            versions: [("regrasp".to_owned(), "0.2.0".to_owned())].into(),
            machine: Machine::default(),
            started_s: 1,
            shard: None,
            variants: vec![VariantWish { name: "default".into(), ..VariantWish::default() }],
            seeds: Seeds { first: 1, count: 3 },
            time_limit_s: Some(1.0),
            skip_unsupported: false,
            hypotheses: Hypotheses::default(),
        };
        let scenarios = [regrasp::load("sphere-free").ok()?];
        let registry = Registry::linked().ok()?;
        serde_json::to_vec_pretty(&prepare(wish, &scenarios, &registry).ok()?.study).ok()
    };
    study().into_iter().collect()
}
