"""Is a grasp stable, and by how much? Three fingers on a ball, higher and higher above its equator.

At latitude φ the three forces balance only if each is tilted by φ from its contact's normal. So the grasp is
force closure exactly where tan φ is below the coefficient of friction.
"""

import numpy as np
import regrasp as rg

RADIUS, FRICTION = 0.03, 0.5  # m; no unit

if __name__ == "__main__":
    latitudes = np.radians([0.0, 10.0, 20.0, 26.0, 26.5, 26.6, 27.0, 30.0, 40.0])
    around = 2 * np.pi * np.arange(3) / 3
    # (N, 3, 3): for each latitude three outward normals, evenly round the ball.
    flat = np.stack([np.cos(around), np.sin(around), np.zeros(3)], axis=-1)
    normals = np.cos(latitudes)[:, None, None] * flat
    normals[..., 2] = np.sin(latitudes)[:, None]

    closed = rg.force_closure(RADIUS * normals, normals, FRICTION)
    margins = rg.closure_margin(RADIUS * normals, normals, FRICTION)
    for latitude, yes, (lower, _) in zip(np.degrees(latitudes), closed, margins, strict=True):
        print(f"{latitude:>7.1f}°  {'yes' if yes else 'no':>13}  {lower:.4f}")
    assert (closed == (np.tan(latitudes) < FRICTION)).all(), "the verdict is exact"

    # A verdict comes with a proof: forces that balance each other, every one inside its friction cone.
    forces = rg.internal_forces(RADIUS * normals[1], normals[1], FRICTION)
    pressed = -(forces * normals[1]).sum(axis=1)
    sideways = np.linalg.norm(forces + pressed[:, None] * normals[1], axis=1)
    assert (sideways < FRICTION * pressed).all() and np.abs(forces.sum(axis=0)).max() < 1e-9
