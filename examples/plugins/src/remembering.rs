//! A surface that remembers: shortest paths are asked for again and again between the contacts of nodes.

use regrasp_api::{
    Build, CallError, Contact, Context, Entry, Memo, NoSettings, Projection, Random, Settings, Slot,
    SurfaceParam, SurfacePath, Vec3, check_settings, inventory,
};

/// Paths that are remembered; a path of some dozen waypoints takes a few kilobytes.
const MOST: usize = 2000;

/// The bits of a contact: what its path is known by.
type Key = [u64; 7];

/// The default surface, with a memory.
struct Remembering {
    inner: Box<dyn SurfaceParam>,
    paths: Memo<(Key, Key), Option<SurfacePath>>,
}

fn key(contact: &Contact) -> Key {
    let [p, n] = [&contact.p_OC, &contact.n_O].map(|v| v.map(f64::to_bits));
    [u64::from(contact.facet), p.x, p.y, p.z, n.x, n.y, n.z]
}

impl SurfaceParam for Remembering {
    fn sample(&self, random: &mut Random) -> Contact {
        self.inner.sample(random)
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        // The plugin answers, so the plugin counts; what the wrapped one counts goes nowhere.
        context.count_call(Slot::Surface);
        let mut apart = context.twin();
        let known = self.paths.get((key(from), key(to)), || {
            let mut path = SurfacePath::default();
            Ok(self.inner.geodesic(from, to, &mut path, &mut apart)?.then_some(path))
        })?;
        let found = known.is_some();
        if let Some(known) = known {
            *path = known;
        }
        Ok(found)
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        self.inner.project(p_OF, hint)
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.inner.walk(from, direction_O, distance)
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.inner.edge_distance(contact)
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "surface/remembering",
    slots: &[Slot::Surface],
    summary: "the default surface, with a memory for shortest paths",
    references: &["Michie, Memo functions and machine learning, Nature 218, 1968"],
    schema: NoSettings::schema,
    check: check_settings::<NoSettings>,
    build: Build::Surface(|json, parts| {
        NoSettings::from_json(json)?;
        let inner = parts.plugins.surface(None, "", parts)?;
        Ok(Box::new(Remembering { inner, paths: Memo::new(MOST) }))
    }),
};
inventory::submit! { ENTRY }
