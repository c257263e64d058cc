"""Exports, read back by programs that nobody here wrote: fingertips must be where the plan has them, at every state."""

import csv
import json

import mujoco
import numpy as np
import pygltflib
import pytest
import trimesh
import yourdfpy

# Four, five and three fingers; revolute and prismatic joints; obstacles; primitives, a convex and a concave mesh.
SCENARIOS = ["sphere", "cube-free", "ellip-obst", "sphere-five", "sphere-soft", "bracket"]
FORMATS = "gltf,urdf,mjcf,csv,npz"
# What exports must keep (m). glTF's 32-bit numbers leave about 1e-8 m of it unused at a hand's size.
CLOSE = 1e-6


class Exported:
    """A plan with its exports, and the arrays that all others are compared with."""

    def __init__(self, folder):
        self.folder = folder
        self.plan = json.loads((folder / "plan.json").read_text())
        self.arrays = np.load(folder / "plan.npz", allow_pickle=False)
        self.problem = self.plan["scenario"]["problem"]
        self.states = [state for segment in self.plan["segments"] for state in segment["states"]]
        self.joints = [str(name) for name in self.arrays["joint_names"]]
        self.tips = [f"{name}-tip" for name in self.arrays["finger_names"]]

    def __getitem__(self, name):
        return self.arrays[name]


@pytest.fixture(scope="module", params=SCENARIOS)
def exported(request, regrasp, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    regrasp("plan", request.param, "-o", "plan.json", cwd=folder)
    said = json.loads(regrasp("export", "plan.json", "--to", FORMATS, "-o", ".", "--json", cwd=folder))
    assert all((folder / entry["file"]).stat().st_size == entry["bytes"] for entry in said["files"])
    return Exported(folder)


def turn(quaternions):
    """Rotation matrices of unit quaternions w, x, y, z."""
    w, x, y, z = np.moveaxis(np.asarray(quaternions), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), [0, 1], [-2, -1])


def test_arrays_hold_the_plan(exported):
    assert np.array_equal(exported["time"], [state["time"] for state in exported.states])
    assert np.array_equal(exported["joints"], [sum(state["joints"], []) for state in exported.states])
    assert np.array_equal(exported["object_position"], [state["object"]["position"] for state in exported.states])
    assert np.array_equal(exported["object_orientation"], [state["object"]["orientation"] for state in exported.states])
    for row, state in zip(exported["contact_point_O"], exported.states, strict=True):
        for point, contact in zip(row, state["contacts"], strict=True):
            assert np.isnan(point).all() if contact is None else np.array_equal(point, contact["point_O"])


def test_fingertips_touch_where_the_contacts_are(exported):
    radius = exported.problem["hand"]["fingertip_radius"]
    center = exported["contact_point_H"] + radius * exported["contact_normal_H"]
    gap = np.linalg.norm(center - exported["tip_H"], axis=-1)
    # The verifier's own tolerance of closure.
    assert np.nanmax(gap) < 2e-5
    R_HO, p_HO = turn(exported["object_orientation"]), exported["object_position"]
    point_H = np.einsum("tij,tfj->tfi", R_HO, exported["contact_point_O"]) + p_HO[:, None]
    assert np.nanmax(np.abs(point_H - exported["contact_point_H"])) < 1e-12


def test_forces_balance_the_weight_inside_their_cones(exported):
    held = exported["force_margin"] > 0
    assert held.mean() > 0.5, "most states hold the weight"
    claim = exported.plan["claims"]["contact"]["cone"]
    force, normal = exported["force_H"][held], exported["contact_normal_H"][held]
    spin = np.nan_to_num(exported["torque_about_normal"][held])
    weight = exported.problem["object"]["mass"] * np.array(exported.problem["gravity"])
    assert np.abs(np.nansum(force, axis=1) + weight).max() < 1e-6
    # About the object's origin the weight has a lever as long as the centre of mass is off: the exported model says how long.
    model = mujoco.MjModel.from_xml_path(str(exported.folder / "plan.mjcf.xml"))
    center_O = model.body("object").ipos
    center_H = exported["object_position"][held] + turn(exported["object_orientation"][held]) @ center_O
    lever = exported["contact_point_H"][held] - center_H[:, None]
    torque = np.nansum(np.cross(lever, force), axis=1) + np.nansum(normal * spin[..., None], axis=1)
    assert np.abs(torque).max() < 1e-7
    pressing = -np.sum(force * normal, axis=-1)
    sliding = np.linalg.norm(force + normal * pressing[..., None], axis=-1)
    loaded = np.isfinite(pressing)
    used = sliding / claim["mu"]
    if claim["gamma"] > 0:
        used = np.hypot(used, spin / claim["gamma"])
    assert (used[loaded] < pressing[loaded]).all()


def test_tables_hold_the_arrays(exported):
    with open(exported.folder / "plan.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(exported.states)
    number = lambda text: float(text) if text else np.nan
    for index, joint in enumerate(exported.joints):
        assert np.array_equal([float(row[f"joint.{joint}"]) for row in rows], exported["joints"][:, index])
    for index, finger in enumerate(exported["finger_names"]):
        for what in ["tip_H", "contact_point_O", "force_H"]:
            column = [[number(row[f"{finger}.{what}.{axis}"]) for axis in "xyz"] for row in rows]
            assert np.array_equal(column, exported[what][:, index], equal_nan=True)


def test_urdf_moves_the_fingertips_alike(exported):
    robot = yourdfpy.URDF.load(str(exported.folder / "plan.hand.urdf"))
    with open(exported.folder / "plan.trajectory.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    driven = set(robot.actuated_joint_names)
    for row, tips in zip(rows, exported["tip_H"], strict=True):
        robot.update_cfg({joint: float(row[f"joint.{joint}"]) for joint in exported.joints if joint in driven})
        for name, tip in zip(exported.tips, tips, strict=True):
            assert np.abs(robot.get_transform(name, "hand")[:3, 3] - tip).max() < CLOSE
    thing = yourdfpy.URDF.load(str(exported.folder / "plan.object.urdf"))
    inertial = thing.link_map["object"].inertial
    assert inertial.mass == exported.problem["object"]["mass"]
    mesh = trimesh.load(str(exported.folder / "plan.object.stl"))
    assert mesh.is_watertight and mesh.volume > 0


def test_mujoco_moves_the_fingertips_alike(exported):
    model = mujoco.MjModel.from_xml_path(str(exported.folder / "plan.mjcf.xml"))
    data = mujoco.MjData(model)
    count = len(exported.joints)
    assert [model.joint(index).name for index in range(count)] == exported.joints
    for index in range(len(exported.states)):
        data.qpos[:count] = exported["joints"][index]
        data.qpos[count : count + 3] = exported["object_position"][index]
        data.qpos[count + 3 : count + 7] = exported["object_orientation"][index]
        mujoco.mj_kinematics(model, data)
        places = np.array([data.body(name).xpos for name in exported.tips])
        assert np.abs(places - exported["tip_H"][index]).max() < CLOSE
        assert np.abs(data.body("object").xpos - exported["object_position"][index]).max() < CLOSE
    assert model.body_mass[model.body("object").id] == exported.problem["object"]["mass"]


def test_mujoco_holds_the_object(exported):
    if exported["force_margin"][0] <= 0:
        pytest.fail("the first grasp of these scenarios holds the object's weight")
    model = mujoco.MjModel.from_xml_path(str(exported.folder / "plan.mjcf.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    before = exported["object_position"][0]
    for _ in range(int(0.5 / model.opt.timestep)):
        mujoco.mj_step(model, data)
    assert np.isfinite(data.qpos).all()
    # The motors are springs and so are MuJoCo's contacts: a grasp settles by tenths of a millimetre; one that slips is gone in half a second.
    assert np.linalg.norm(data.body("object").xpos - before) < 2e-3


def accessor(document, index):
    """The numbers of a glTF accessor."""
    item = document.accessors[index]
    view = document.bufferViews[item.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[item.type]
    kind = {5126: np.float32, 5121: np.uint8}[item.componentType]
    start = (view.byteOffset or 0) + (item.byteOffset or 0)
    return np.frombuffer(document.binary_blob(), kind, item.count * width, start).reshape(item.count, width)


def local(node, translation=None, rotation=None):
    """A node's own transform; rotations are x, y, z, w."""
    x, y, z, w = rotation if rotation is not None else node.rotation or [0, 0, 0, 1]
    matrix = np.eye(4)
    matrix[:3, :3] = turn(np.array([w, x, y, z], dtype=float))
    matrix[:3, 3] = translation if translation is not None else node.translation or [0, 0, 0]
    return matrix


def test_gltf_moves_the_fingertips_alike(exported):
    document = pygltflib.GLTF2().load(str(exported.folder / "plan.glb"))
    parents = {child: index for index, node in enumerate(document.nodes) for child in node.children or []}
    names = {node.name: index for index, node in enumerate(document.nodes)}
    animation = document.animations[0]
    moved, times = {}, None
    for channel in animation.channels:
        sampler = animation.samplers[channel.sampler]
        times = accessor(document, sampler.input)[:, 0]
        moved.setdefault(channel.target.node, {})[channel.target.path] = accessor(document, sampler.output)
    assert (np.diff(times) > 0).all()
    fresh = np.concatenate([[True], np.diff(exported["time"]) > 0])
    assert np.abs(times - exported["time"][fresh]).max() < 1e-5

    def place(index, key):
        matrix = np.eye(4)
        while document.nodes[index].name != "hand":
            motion = moved.get(index, {})
            here = {path: values[key] for path, values in motion.items()}
            matrix = local(document.nodes[index], **here) @ matrix
            index = parents[index]
        return matrix[:3, 3]

    tips, objects = exported["tip_H"][fresh], exported["object_position"][fresh]
    for key in range(len(times)):
        for name, tip in zip(exported.tips, tips[key], strict=True):
            assert np.abs(place(names[name], key) - tip).max() < CLOSE
        assert np.abs(place(names["object"], key) - objects[key]).max() < CLOSE
    scene = trimesh.load(str(exported.folder / "plan.glb"))
    assert {"hand", "object", *exported.tips} <= set(scene.graph.nodes)


def test_grasps_are_kept_alike_in_both_forms(regrasp, tmp_path):
    for name in ["grasps.json", "grasps.npz"]:
        # Without relays there is a graph, with grasps to keep.
        regrasp("plan", "sphere", "--set", "graph-strategy.relays=0", "--grasps", name, cwd=tmp_path)
    text = json.loads((tmp_path / "grasps.json").read_text())
    arrays = np.load(tmp_path / "grasps.npz", allow_pickle=False)
    grasps = text["grasps"]
    assert len(grasps) == len(arrays["margin"]) > 5
    assert np.array_equal(arrays["margin"], [grasp["margin"] for grasp in grasps]) and (arrays["margin"] > 0).all()
    assert np.array_equal(arrays["joints"], [sum(grasp["joints"], []) for grasp in grasps])
    assert np.array_equal(arrays["object_orientation"], [grasp["object"]["orientation"] for grasp in grasps])
    touching = ~np.isnan(arrays["contact_point_O"]).any(axis=-1)
    assert (touching.sum(axis=1) >= 4).all()
    assert np.abs(np.linalg.norm(arrays["contact_point_O"][touching], axis=-1) - 0.030).max() < 3e-4
