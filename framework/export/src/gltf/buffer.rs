//! The binary part of a glTF file, and what describes it.

use regrasp_api::{Rotation, Vec3};
use serde_json::{Value, json};

/// Numbers in one buffer. Each method adds an accessor and gives its number.
#[derive(Default)]
pub struct Buffer {
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// glTF's code of 32-bit floating-point numbers.
const FLOAT: u32 = 5126;
/// glTF's code of bytes.
const BYTE: u32 = 5121;

impl Buffer {
    /// Vectors of three; positions must have `bounds`.
    pub fn vectors(&mut self, vectors: impl IntoIterator<Item = Vec3>, bounds: bool) -> usize {
        let values: Vec<[f32; 3]> =
            vectors.into_iter().map(|v| [v.x as f32, v.y as f32, v.z as f32]).collect();
        let accessor = self.floats(values.as_flattened(), values.len(), "VEC3");
        if bounds {
            let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                let of = |axis: usize| values.iter().map(|v| v[axis]).reduce(pick).unwrap_or_default();
                (0..3).map(of).collect()
            };
            (self.accessors[accessor]["min"], self.accessors[accessor]["max"]) =
                (json!(bound(f32::min)), json!(bound(f32::max)));
        }
        accessor
    }

    /// Rotations as quaternions x, y, z, w, each on the side of the one before, so that none goes the long
    /// way.
    pub fn rotations(&mut self, rotations: impl IntoIterator<Item = Rotation>) -> usize {
        let mut values: Vec<[f32; 4]> = Vec::new();
        let mut before = None;
        for rotation in rotations {
            let q = rotation.into_inner();
            let q =
                if before.is_some_and(|last: nalgebra::Quaternion<f64>| last.dot(&q) < 0.0) { -q } else { q };
            before = Some(q);
            values.push([q.i as f32, q.j as f32, q.k as f32, q.w as f32]);
        }
        self.floats(values.as_flattened(), values.len(), "VEC4")
    }

    /// Times (s), ascending: where rounding makes two alike the later moves on by the least step.
    pub fn times(&mut self, times: impl IntoIterator<Item = f64>) -> usize {
        let mut values: Vec<f32> = Vec::new();
        for time in times {
            let time = time as f32;
            values.push(values.last().map_or(time, |&last| time.max(last.next_up())));
        }
        let accessor = self.floats(&values, values.len(), "SCALAR");
        (self.accessors[accessor]["min"], self.accessors[accessor]["max"]) =
            (json!([values[0]]), json!([values[values.len() - 1]]));
        accessor
    }

    /// Colours, red, green, blue, written with full opacity.
    pub fn colours(&mut self, colours: impl IntoIterator<Item = [u8; 3]>) -> usize {
        let bytes: Vec<u8> = colours.into_iter().flat_map(|[r, g, b]| [r, g, b, 255]).collect();
        let accessor = self.accessor(&bytes, bytes.len() / 4, "VEC4", BYTE);
        self.accessors[accessor]["normalized"] = json!(true);
        accessor
    }

    /// Descriptions of views and accessors, and the data.
    pub fn into_parts(self) -> (Vec<Value>, Vec<Value>, Vec<u8>) {
        (self.views, self.accessors, self.data)
    }

    fn floats(&mut self, values: &[f32], count: usize, kind: &str) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, count, kind, FLOAT)
    }

    fn accessor(&mut self, bytes: &[u8], count: usize, kind: &str, code: u32) -> usize {
        let view = json!({ "buffer": 0, "byteOffset": self.data.len(), "byteLength": bytes.len() });
        self.data.extend(bytes);
        self.views.push(view);
        let number = self.views.len() - 1;
        self.accessors
            .push(json!({ "bufferView": number, "componentType": code, "count": count, "type": kind }));
        number
    }
}
