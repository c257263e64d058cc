"""Carries out a plan in MuJoCo (`pip install mujoco`): does the object arrive?

The motors aim where the export says: at the plan's joints, with the forces of the grasp fed forward through
their springs. The object is free and held by friction alone; nothing looks at where it is.
"""

import csv
import tempfile
from pathlib import Path

import mujoco
import numpy as np
import numpy.typing as npt
import regrasp as rg

#: Seconds in which forces pass over to other fingers, while everything rests.
PASSING = 0.2

plan = rg.plan("sphere", seed=1)
files = plan.export("mjcf", Path(tempfile.mkdtemp()))
model = mujoco.MjModel.from_xml_path(str(next(file for file in files if file.suffix == ".xml")))
with next(file for file in files if file.suffix == ".csv").open(newline="") as file:
    table = list(csv.DictReader(file))


def column(name: str) -> npt.NDArray[np.float64]:
    """The numbers in a column of the export's table."""
    return np.array([float(row[name]) for row in table])


# A time that occurs twice is a border of two segments: there the forces pass over.
steps = np.diff(column("time"))
times = PASSING + np.concatenate([[0.0], np.cumsum(np.where(steps > 0, steps, PASSING))])
clock = np.arange(0.0, times[-1] + PASSING, model.opt.timestep)
motors = [model.actuator(index).name for index in range(model.nu)]
joints = np.stack([np.interp(clock, times, column(f"joint.{name}")) for name in motors], axis=1)
targets = np.stack([np.interp(clock, times, column(f"target.{name}")) for name in motors], axis=1)
# Motors damp their speed; so that they damp what differs from the plan's, they aim ahead.
ahead = -model.actuator_biasprm[:, 2] / model.actuator_gainprm[:, 0]
targets += ahead * np.diff(joints, axis=0, append=joints[-1:]) / model.opt.timestep

data = mujoco.MjData(model)
mujoco.mj_resetDataKeyframe(model, data, 0)
for target in targets:
    data.ctrl[:] = target
    mujoco.mj_step(model, data)

body = data.body("object")
distance = float(np.linalg.norm(body.xpos - plan.positions[-1]))
cosine = abs(float(body.xquat @ plan.orientations[-1]))
angle_deg = float(np.degrees(2 * np.arccos(min(1.0, cosine))))
print(f"after {plan.duration:.1f} s the object is {1e3 * distance:.2f} mm and {angle_deg:.2f}° from its goal")
