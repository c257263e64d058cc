//! The laws of surfaces.
//!
//! There is one true surface, the object's mesh: points and normals are the mesh's, whatever closed form
//! stood behind it.

mod ground;
mod motion;
mod path;
mod point;

use crate::law::Law;

pub(crate) const LAWS: &[Law] = &[
    Law {
        name: "sample-on-surface",
        why: "every contact of a plan begins as a sample, and points and normals are the mesh's",
        check: point::sample_on_surface,
    },
    Law {
        name: "sample-uniform",
        why: "regions that are drawn too seldom are where the planner finds no grasp",
        check: point::sample_uniform,
    },
    Law {
        name: "project-exact",
        why: "rolling projects the fingertip's centre, and points and normals are the mesh's",
        check: point::project_exact,
    },
    Law {
        name: "project-ignores-hint",
        why: "an answer that depends on the hint depends on what was asked before",
        check: point::project_ignores_hint,
    },
    Law { name: "edge-distance", why: "contacts on sharp edges cannot be held", check: point::edge_distance },
    Law {
        name: "geodesic-endpoints",
        why: "consecutive pieces of a plan share their end states exactly",
        check: path::endpoints,
    },
    Law {
        name: "geodesic-on-surface",
        why: "a finger that slides along the path must touch all the way",
        check: path::on_surface,
    },
    Law {
        name: "geodesic-lift",
        why: "steps along a path are counted by the way of the fingertip's centre",
        check: path::lift,
    },
    Law {
        name: "geodesic-length",
        why: "lengths are what distances between grasps are made of",
        check: path::length,
    },
    Law {
        name: "geodesic-shortest",
        why: "detours make regrasps longer and turn the planner's distances wrong",
        check: path::shortest,
    },
    Law { name: "geodesic-symmetric", why: "a path used backwards is the same path", check: path::symmetric },
    Law {
        name: "walk",
        why: "local search moves contacts by walking, and counts on the distance",
        check: motion::walk,
    },
    Law {
        name: "surface-rigid-motion",
        why: "where the object's frame lies is a modeller's whim",
        check: motion::rigid_motion,
    },
    Law {
        name: "geodesic-counted",
        why: "every call is counted once, by the plugin itself, or the statistics of a run are wrong",
        check: path::counted,
    },
    Law {
        name: "surface-pure",
        why: "threads share the surface, and the same plan must come out on any number of them",
        check: motion::surface_pure,
    },
];
