"""Plays a plan in MuJoCo (`pip install mujoco`): the object arrives, or how far it is off."""

import tempfile
from pathlib import Path

import mujoco
import numpy as np
import regrasp as rg

plan = rg.plan("sphere", seed=1)
files = plan.export("mjcf", Path(tempfile.mkdtemp()))
model_file = next(file for file in files if file.suffix == ".xml")
model = mujoco.MjModel.from_xml_path(str(model_file))
data = mujoco.MjData(model)
print(f"{model.nbody} bodies, {model.nu} actuators, {model.nq} coordinates, from {model_file.name}")
mujoco.mj_resetDataKeyframe(model, data, 0)
mujoco.mj_forward(model, data)
body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "object")
print(
    "the object stands", 1e3 * np.linalg.norm(data.xpos[body] - plan.positions[0]), "mm from the plan's start"
)
