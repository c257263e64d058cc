"""Many distinct, verified grasps, and what they need."""

import numpy as np
import regrasp as rg

if __name__ == "__main__":
    grasps = rg.grasps("allegro-cube", 400, spread=0.003, threads=2)  # start and goals do not count
    print("fingers  grasps  of which a finger may be lifted  median friction needed")
    fingers = grasps.holding.sum(axis=1)
    for count in np.unique(fingers):
        own = fingers == count
        liftable = int(grasps.liftable[own].any(axis=1).sum())
        print(f"{count:>7}  {own.sum():>6}  {liftable:>32}  {np.nanmedian(grasps.friction[own]):>22.2f}")
    assert len(grasps) == 400 and (grasps.margin > 0).all() and (grasps.clearance > 0).all()
