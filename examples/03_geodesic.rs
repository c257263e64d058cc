//! The shortest way over a mesh: H. E. Dudeney's spider and fly ("The Canterbury Puzzles", 1907).
//!
//! `cargo run --example 03_geodesic`
//!
//! A room is 30 long, 12 wide and 12 high. The spider sits in the middle of one end wall, 1 below the
//! ceiling, the fly in the middle of the other, 1 above the floor. Straight over the ceiling the way is 42.
//! The shortest one crosses five of the six walls, and is 40.
//!
//! Surfaces are for fingertips: they know the way of the contact point, and the way of the fingertip's centre
//! above it.

use regrasp::api::{Context, Primitive, SurfaceParam, SurfacePath, Vec3};
use regrasp::plugins::surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp::world::primitive_mesh;
use std::error::Error;

/// Radius of the fingertip (m).
const FINGERTIP: f64 = 0.01;

fn main() -> Result<(), Box<dyn Error>> {
    // One unit of the puzzle is a centimetre here.
    let room = Primitive::Cuboid { half_size: Vec3::new(0.15, 0.06, 0.06) };
    let mesh = primitive_mesh(&room, 12)?; // any closed mesh will do: `regrasp::world::load_mesh` reads files
    let surface = Geodesic::new(&GeodesicSettings::default(), &mesh, FINGERTIP)?;

    // The contact of a fingertip is where its centre is closest to the object.
    let at = |x: f64, z: f64| surface.project(&Vec3::new(x * (0.15 + FINGERTIP), 0.0, z), None).contact;
    let (spider, fly) = (at(-1.0, 0.05), at(1.0, -0.05));

    let mut path = SurfacePath::default();
    let found = surface.geodesic(&spider, &fly, &mut path, &mut Context::seeded(0))?;
    assert!(found, "on a convex object a fingertip can follow every path");

    println!("straight through the room {:.2} cm", 100.0 * (spider.p_OC - fly.p_OC).norm());
    println!("over the surface          {:.2} cm", 100.0 * path.length);
    println!(
        "the fingertip's centre    {:.2} cm, since it turns about every edge",
        100.0 * path.lift_length()
    );
    println!("\n  x (cm)   y (cm)   z (cm)   wall");
    let mut wall = Vec3::zeros();
    let mut walls = 0;
    for waypoint in &path.waypoints {
        let contact = waypoint.contact;
        let n_O = mesh.normal(contact.facet);
        if (n_O - wall).norm() > 0.5 {
            (wall, walls) = (n_O, walls + 1);
            let p = contact.p_OC * 100.0;
            println!("{:>8.2} {:>8.2} {:>8.2}   {}", p.x, p.y, p.z, name(&n_O));
        }
    }
    let longer = path.length / 0.40 - 1.0;
    assert!((0.0..2e-4).contains(&longer.max(0.0)), "{longer}"); // the setting `tolerance`: 0.02 %
    assert_eq!(walls, 5, "the way crosses five walls");
    Ok(())
}

fn name(n_O: &Vec3) -> &'static str {
    let names = [["end", "other end"], ["left", "right"], ["floor", "ceiling"]];
    let axis = n_O.iamax();
    names[axis][usize::from(n_O[axis] > 0.0)]
}
