use super::*;
use regrasp_api::{MeshError, Primitive};
use regrasp_world::primitive_mesh;
use std::fmt::Write;
use std::path::PathBuf;

mod collada_files;

fn cube() -> Mesh {
    primitive_mesh(&Primitive::Cuboid { half_size: Vec3::new(0.01, 0.02, 0.03) }, 12).unwrap()
}

fn ring() -> Mesh {
    primitive_mesh(&Primitive::Torus { ring_radius: 0.04, tube_radius: 0.015 }, 200).unwrap()
}

fn stl_binary(mesh: &Mesh, unit: f64) -> Vec<u8> {
    let mut bytes = b"solid, but binary".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((mesh.facets().len() as u32).to_le_bytes());
    for facet in 0..mesh.facets().len() as u32 {
        bytes.extend([0; 12]);
        mesh.corners(facet)
            .iter()
            .flat_map(|v| v.iter())
            .for_each(|x| bytes.extend(((x / unit) as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn stl_ascii(mesh: &Mesh) -> String {
    let mut text = String::from("solid vertex 1 2 3\r\n");
    for facet in 0..mesh.facets().len() as u32 {
        text.push_str("  facet normal 0 0 0\r\n    outer loop\r\n");
        mesh.corners(facet)
            .iter()
            .for_each(|v| write!(text, "      vertex {:e} {} {}\r\n", v.x, v.y, v.z).unwrap());
        text.push_str("    endloop\r\n  endfacet\r\n");
    }
    text + "endsolid\r\n"
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::from("# a comment\r\nmtllib none.mtl\nvn 0 0 1\nvt 0 0\n");
    mesh.vertices().iter().for_each(|v| writeln!(text, "v {} {} {} 1.0", v.x, v.y, v.z).unwrap());
    let count = mesh.vertices().len() as i64;
    for (i, [a, b, c]) in mesh.facets().iter().map(|facet| facet.map(|v| i64::from(v) + 1)).enumerate() {
        match i % 3 {
            0 => writeln!(text, "f {a} {b}/1 {c}/1/1").unwrap(),
            1 => writeln!(text, "f {a}//1 \\\n {b}//1 {c}//1 # end").unwrap(),
            _ => writeln!(text, "f {} {} {}", a - count - 1, b - count - 1, c - count - 1).unwrap(),
        }
    }
    text
}

fn ply(mesh: &Mesh, format: &str) -> Vec<u8> {
    let (vertices, facets) = (mesh.vertices().len(), mesh.facets().len());
    let mut bytes = format!(
        "ply\r\nformat {format} 1.0\ncomment made up\nelement vertex {vertices}\nproperty uchar \
            red\nproperty double x\n\
         property double y\nproperty double z\nelement face {facets}\nproperty list uchar int \
         vertex_indices\nelement \
         extra 1\nproperty float nothing\nend_header\n"
    )
    .into_bytes();
    for v in mesh.vertices() {
        match format {
            "ascii" => bytes.extend(format!("255 {} {} {}\n", v.x, v.y, v.z).bytes()),
            "binary_big_endian" => {
                bytes.push(255);
                v.iter().for_each(|x| bytes.extend(x.to_be_bytes()));
            }
            _ => {
                bytes.push(255);
                v.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            }
        }
    }
    for [a, b, c] in mesh.facets() {
        match format {
            "ascii" => bytes.extend(format!("3 {a} {b} {c}\n").bytes()),
            "binary_big_endian" => {
                bytes.push(3);
                [a, b, c].iter().for_each(|v| bytes.extend(v.to_be_bytes()));
            }
            _ => {
                bytes.push(3);
                [a, b, c].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
            }
        }
    }
    bytes.extend(if format == "ascii" { b"0.0 ".to_vec() } else { vec![0; 4] });
    bytes
}

/// A folder with one file.
struct Folder(tempfile::TempDir);

impl Folder {
    fn with(name: &str, bytes: impl AsRef<[u8]>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(name), bytes).unwrap();
        Self(folder)
    }

    fn load(&self, source: MeshSource) -> Result<Mesh, FormatError> {
        load_mesh(&source, self.0.path(), "object.shape")
    }
}

fn file(name: &str) -> MeshSource {
    MeshSource { file: Some(name.into()), ..Default::default() }
}

/// The message of a file that must be refused.
fn refusal(name: &str, bytes: impl AsRef<[u8]>) -> String {
    Folder::with(name, bytes).load(file(name)).unwrap_err().to_string()
}

#[test]
fn every_format_gives_the_same_solid() {
    for mesh in [cube(), ring()] {
        let files = [
            ("a.stl", stl_binary(&mesh, 1.0)),
            ("b.STL", stl_ascii(&mesh).into_bytes()),
            ("c.obj", obj(&mesh).into_bytes()),
            ("d.ply", ply(&mesh, "ascii")),
            ("e.ply", ply(&mesh, "binary_little_endian")),
            ("f.Ply", ply(&mesh, "binary_big_endian")),
        ];
        let expected = mesh.mass_properties();
        for (name, bytes) in files {
            let read = Folder::with(name, bytes).load(file(name)).unwrap();
            assert_eq!(read.facets().len(), mesh.facets().len(), "{name}");
            assert_eq!(read.vertices().len(), mesh.vertices().len(), "{name}");
            let mass = read.mass_properties();
            assert!((mass.volume / expected.volume - 1.0).abs() < 1e-6, "{name}");
            assert!(
                (mass.inertia_OCm - expected.inertia_OCm).norm() < 1e-6 * expected.inertia_OCm.norm(),
                "{name}"
            );
        }
    }
}

#[test]
fn scale_and_flip_are_applied_and_embedding_keeps_the_mesh() {
    let mesh = ring();
    let folder = Folder::with("ring.stl", stl_binary(&mesh, 1e-3));
    let source = MeshSource { scale: Some(0.001), ..file("ring.stl") };
    let read = folder.load(source.clone()).unwrap();
    assert!((read.radius() - mesh.radius()).abs() < 1e-8);
    let load = |source: &MeshSource, base| load_mesh(source, base, "object.shape").unwrap();
    let alone = MeshSource::of(&load(&source, folder.0.path()));
    assert_eq!(load_mesh(&alone, Path::new("/nowhere"), "object.shape").unwrap(), read);
    assert_eq!(MeshSource::of(&load(&alone, Path::new("/nowhere"))), alone);
    let inside_out = folder.load(MeshSource { flip: Some(true), ..source }).unwrap_err();
    assert!(inside_out.to_string().contains("`flip = true`"), "{inside_out}");
    let scale = folder.load(MeshSource { scale: Some(-1.0), ..file("ring.stl") }).unwrap_err().to_string();
    assert!(scale.contains("`object.shape.scale` = -1"), "{scale}");
}

#[test]
fn polygons_are_cut_into_triangles_even_where_they_are_not_convex() {
    // An L-shaped prism: two hexagons and six quads.
    let corners = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]];
    let mut text = String::new();
    for z in [0, 1] {
        corners.iter().for_each(|[x, y]| writeln!(text, "v {x} {y} {z}").unwrap());
    }
    text.push_str("f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n");
    for i in 0..6 {
        let next = (i + 1) % 6;
        writeln!(text, "f {} {} {} {}", i + 1, next + 1, next + 7, i + 7).unwrap();
    }
    let mesh = Folder::with("l.obj", text).load(file("l.obj")).unwrap();
    assert_eq!(mesh.facets().len(), 2 * 4 + 6 * 2);
    assert!((mesh.mass_properties().volume - 5.0).abs() < 1e-12);
    // No facet reaches over the notch.
    let area: f64 = (0..mesh.facets().len() as u32).map(|facet| mesh.area(facet)).sum();
    assert!((area - 2.0 * 5.0 - 12.0).abs() < 1e-12);
}

#[test]
fn missing_and_unknown_files_are_refused_by_name() {
    let folder = Folder::with("a.step", "");
    let message = folder.load(file("none.stl")).unwrap_err().to_string();
    assert!(message.contains("none.stl") && message.contains("object.shape.file"), "{message}");
    assert!(refusal("a.step", "").contains(".stl, .obj, .ply, .dae"));
    let nothing = folder.load(MeshSource::default()).unwrap_err().to_string();
    assert!(nothing.contains("either `file`"), "{nothing}");
    std::fs::create_dir(folder.0.path().join("folder.stl")).unwrap();
    assert!(matches!(folder.load(file("folder.stl")), Err(FormatError::File { .. })));
}

#[test]
fn damaged_files_are_refused_with_the_reason() {
    let (stl, text, ply) =
        (stl_binary(&cube(), 1.0), stl_ascii(&cube()), ply(&cube(), "binary_little_endian"));
    let mut not_finite = stl.clone();
    not_finite[84 + 12..84 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut many = stl.clone();
    many[80..84].copy_from_slice(&3_000_000_u32.to_le_bytes());
    let mut negative = obj(&cube());
    negative.push_str("f 1 2 -99\n");
    for (name, bytes, part) in [
        ("a.stl", stl[..500].to_vec(), "announces 12 facets, the file holds 8; is it truncated?"),
        ("b.stl", b"abc".to_vec(), "too short"),
        ("c.stl", text.as_bytes()[..text.len() - 22].to_vec(), "ends within a facet"),
        ("d.stl", text.replace("facet normal", "fatec normal").into_bytes(), "line 2: `fatec`"),
        ("e.stl", text.replace("0.02", "2e999").into_bytes(), "2e999` is not a finite number"),
        ("f.stl", not_finite, "facet 0 has a coordinate that is not finite"),
        ("g.stl", many, "announces 3000000 facets, the file holds 12"),
        ("h.stl", b"solid empty\nendsolid empty\n".to_vec(), "no facets"),
        ("i.obj", b"".to_vec(), "no facets and no vertices"),
        ("j.obj", b"v 0 0 0\nv 1 0 nan\n".to_vec(), "line 2: `nan`"),
        ("k.obj", b"v 0 0 0\nv 1 0 0\nf 1 2\n".to_vec(), "the mesh has no facets"),
        ("l.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 3\n".to_vec(), "`3` names no vertex of the 2"),
        ("m.obj", b"v 0 0 0\nf 0 1 1\n".to_vec(), "`0` names no vertex"),
        ("n.obj", negative.into_bytes(), "`-99` names no vertex"),
        ("o.ply", ply[..ply.len() - 60].to_vec(), "is it truncated?"),
        ("p.ply", b"ply\nformat ascii 1.0\nelement vertex 1\n".to_vec(), "no `end_header`"),
        ("q.ply", b"ply\nformat ascii 2.0\nend_header\n".to_vec(), "line 2: `format ascii 2.0`"),
        ("r.ply", b"plywood\n".to_vec(), "does not begin with `ply`"),
        (
            "s.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n".to_vec(),
            "x, y, z",
        ),
    ] {
        let message = refusal(name, bytes);
        assert!(message.contains(part) && message.contains(name), "{message}");
    }
}

#[test]
fn damaged_meshes_are_refused_with_file_and_fix() {
    let obj = |facets: &[[u32; 3]], vertices: &[Vec3]| {
        let mut text = String::new();
        vertices.iter().for_each(|v| writeln!(text, "v {} {} {}", v.x, v.y, v.z).unwrap());
        facets.iter().for_each(|[a, b, c]| writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap());
        text
    };
    let (facets, vertices) = (cube().facets().to_vec(), cube().vertices().to_vec());
    let load = |text: String| Folder::with("x.obj", text).load(file("x.obj")).unwrap_err();
    let fault = |text| match load(text) {
        FormatError::FileMesh { source, path, .. } if path.ends_with("x.obj") => *source,
        other => panic!("{other}"),
    };
    assert!(matches!(fault(obj(&facets[1..], &vertices)), MeshError::Open { count: 3, .. }));
    let flipped: Vec<_> = facets.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(load(obj(&flipped, &vertices)).to_string().contains("inside out"));
    let flat: Vec<Vec3> = vertices.iter().map(|v| Vec3::new(v.x, v.y, 0.0)).collect();
    assert!(matches!(
        fault(obj(&facets, &flat)),
        MeshError::NotManifold { .. } | MeshError::Duplicated { .. }
    ));
    let doubled: Vec<_> = facets.iter().chain(&facets).copied().collect();
    assert!(matches!(fault(obj(&doubled, &vertices)), MeshError::Duplicated { .. }));
}

#[test]
fn no_truncation_or_damage_of_a_file_panics() {
    let mut random = regrasp_api::Random::from_key(7, 0, 0, 0);
    let files = [
        ("a.stl", stl_binary(&cube(), 1.0)),
        ("b.stl", stl_ascii(&cube()).into_bytes()),
        ("c.obj", obj(&cube()).into_bytes()),
        ("d.ply", ply(&cube(), "ascii")),
        ("e.ply", ply(&cube(), "binary_little_endian")),
        ("f.ply", ply(&cube(), "binary_big_endian")),
    ];
    for (name, whole) in &files {
        let parse = match &name[2..] {
            "stl" => stl::parse,
            "obj" => obj::parse,
            _ => ply::parse,
        };
        for _ in 0..2000 {
            let mut bytes = whole.clone();
            bytes.truncate(1 + random.index(2 * bytes.len()).min(bytes.len() - 1));
            for _ in 0..random.index(4) {
                let place = random.index(bytes.len());
                bytes[place] = random.word() as u8;
            }
            if let Ok((vertices, facets)) = parse(&bytes).map(weld::welded) {
                let _ = Mesh::new(vertices, facets);
            }
        }
    }
}

#[test]
fn a_hundred_thousand_facets_load_whole() {
    let mesh = primitive_mesh(&Primitive::Torus { ring_radius: 0.04, tube_radius: 0.015 }, 100_000).unwrap();
    let folder = Folder::with("large.stl", stl_binary(&mesh, 1.0));
    let read = folder.load(file("large.stl")).unwrap();
    assert_eq!(read.facets().len(), mesh.facets().len());
    assert_eq!(read.vertices().len(), mesh.vertices().len());
}

#[test]
fn a_path_is_looked_for_below_the_base_and_an_absolute_one_as_it_is() {
    let folder = Folder::with("ring.stl", stl_binary(&ring(), 1.0));
    let absolute: PathBuf = folder.0.path().join("ring.stl");
    let source = file(absolute.to_str().unwrap());
    assert!(load_mesh(&source, Path::new("/nowhere"), "object.shape").is_ok());
}
