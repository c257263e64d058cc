"""Hands from robots' files: joints, links and shapes must be where MuJoCo and Pinocchio have them."""

import mujoco
import numpy as np
import pytest
from robot_frames import Hand, pose

# (m; rad)
CLOSE = 1e-9
POSTURES = 100

FINGER = """
<body name="f{i}_base" pos="{x} {y} 0.01" euler="0 0 {angle}">
  <joint name="f{i}_j0" axis="1 0 0" pos="0 0 0.002" range="-50 50"/>
  <joint name="f{i}_j1" axis="0 1 0" range="-60 80" ref="10"/>
  <geom type="capsule" fromto="0 0 0 0 0 0.05" size="0.006"/>
  <body name="f{i}_middle" pos="0 0 0.06" axisangle="0 0 1 5">
    <joint name="f{i}_j2" class="flexion"/>
    <geom type="box" size="0.005 0.006 0.02" pos="0 0 0.02" quat="1 0.1 0 0"/>
    <body name="f{i}_tip" pos="0 0.001 0.045" xyaxes="1 0 0.1 0 1 0">
      <joint name="f{i}_j3" class="flexion" pos="0 0 0.001"/>
      <geom class="tip" pos="0 0 0.02"/>
    </body>
  </body>
</body>"""

HAND = """<mujoco model="four">
<compiler angle="degree" eulerseq="XYZ"/>
<default><position forcerange="-1 1"/><default class="flexion"><joint axis="0 1 0" range="0 90"/></default>
<default class="tip"><geom type="sphere" size="0.009"/></default></default>
<worldbody><body name="palm" pos="0.1 0.2 0.3" euler="10 20 30"><geom type="box" size="0.05 0.05 0.01"/>{fingers}</body></worldbody>
<equality>{couplings}</equality><actuator>{actuators}</actuator>
</mujoco>"""


def mjcf():
    """A hand of four fingers with four joints, the last driven by the one before."""
    fingers = couplings = actuators = ""
    for i in range(4):
        angle = 90 * i
        x, y = 0.05 * np.cos(np.radians(angle)), 0.05 * np.sin(np.radians(angle))
        fingers += FINGER.format(i=i, x=x, y=y, angle=angle)
        couplings += f'<joint joint1="f{i}_j3" joint2="f{i}_j2" polycoef="0.05 0.8 0 0 0"/>'
        actuators += "".join(f'<position joint="f{i}_j{k}"/>' for k in range(4))
    return HAND.format(fingers=fingers, couplings=couplings, actuators=actuators)


class Theirs:
    """MuJoCo's model of a file, its frames in that of one body."""

    def __init__(self, path, palm):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        self.palm = self.model.body(palm).id

    def set(self, positions):
        for name, q in positions.items():
            self.data.qpos[self.model.joint(name).qposadr[0]] = q
        mujoco.mj_kinematics(self.model, self.data)

    def pose(self, position, matrix):
        X = np.eye(4)
        X[:3, :3], X[:3, 3] = np.reshape(matrix, (3, 3)), position
        return X

    def in_palm(self, X):
        palm = self.pose(self.data.xpos[self.palm], self.data.xmat[self.palm])
        return np.linalg.inv(palm) @ X

    def anchor(self, name):
        """Where a joint's axis is, and its direction."""
        joint = self.model.joint(name).id
        X = self.in_palm(self.pose(self.data.xanchor[joint], np.eye(3)))
        return X[:3, 3], X[:3, :3] @ self.data.xaxis[joint]

    def body(self, name):
        joint = self.model.joint(name)
        body = joint.bodyid[0]
        return self.in_palm(self.pose(self.data.xpos[body], self.data.xmat[body]))

    def geoms(self, kind):
        for geom in np.flatnonzero(self.model.geom_type == kind):
            yield self.in_palm(self.pose(self.data.geom_xpos[geom], self.data.geom_xmat[geom]))


def compare(hand, theirs, random):
    """Holds 100 postures against each other; the largest difference (m) of what was compared, and how much that was."""
    kinds = {"box": mujoco.mjtGeom.mjGEOM_BOX, "sphere": mujoco.mjtGeom.mjGEOM_SPHERE}
    last = {finger["joint"][-1]["name"] for finger in hand.fingers}
    fixed, worst, count = {}, 0.0, 0
    for _ in range(POSTURES):
        positions = hand.random_positions(random)
        theirs.set(positions)
        for name, (X, joint) in hand.frames(positions).items():
            place, axis = theirs.anchor(name)
            worst = max(worst, np.abs(X[:3, 3] - place).max())
            worst = max(worst, np.abs(X[:3, :3] @ joint["axis"] - axis).max())
            # The body is fixed to the joint's moved frame: its pose there is the same in every posture.
            count += 1
            if is_last_of_its_body(theirs, name):
                X_LB = np.linalg.inv(X) @ theirs.body(name)
                worst = max(worst, np.abs(X_LB - fixed.setdefault(name, X_LB)).max())
            if name in last:
                continue  # its shapes make room for the fingertip's ball
            for shape in joint.get("link", []):
                kind = kinds.get(shape["shape"]["kind"])
                if kind is None:
                    continue
                ours = X @ pose(shape.get("pose"))
                nearest = min(np.abs(ours[:3, 3] - geom[:3, 3]).max() for geom in theirs.geoms(kind))
                worst, count = max(worst, nearest), count + 1
    return worst, count


def is_last_of_its_body(theirs, name):
    joint = theirs.model.joint(name)
    body = theirs.model.body(joint.bodyid[0])
    return joint.id == body.jntadr[0] + body.jntnum[0] - 1


def test_an_mjcf_is_read_as_mujoco_reads_it(regrasp, tmp_path):
    (tmp_path / "hand.xml").write_text(mjcf())
    hand = Hand(regrasp("hand", "hand.xml", "--json", cwd=tmp_path))
    assert hand.report["palm"] == "palm"
    worst, count = compare(hand, Theirs(tmp_path / "hand.xml", "palm"), np.random.default_rng(1))
    assert count > POSTURES * 16
    assert worst < CLOSE


URDF_FINGER = """
<link name="f{i}_a"/><joint name="f{i}_j0" type="revolute"><origin xyz="{x} {y} 0.01" rpy="0.1 0.2 {angle}"/>
<parent link="palm"/><child link="f{i}_a"/><axis xyz="1 0 0"/><limit lower="-0.9" upper="0.9" velocity="3" effort="1"/></joint>
<link name="f{i}_b"><collision><origin xyz="0 0 0.03" rpy="0.3 0 0"/><geometry><box size="0.01 0.012 0.05"/></geometry></collision></link>
<joint name="f{i}_j1" type="revolute"><parent link="f{i}_a"/><child link="f{i}_b"/><axis xyz="0 1 0.1"/>
<limit lower="-1" upper="1.4" velocity="3" effort="1"/></joint>
<link name="f{i}_c"/><joint name="f{i}_j2" type="continuous"><origin xyz="0.001 0 0.06" rpy="0 0.1 0"/>
<parent link="f{i}_b"/><child link="f{i}_c"/><axis xyz="0 1 0"/><limit velocity="3" effort="1"/></joint>
<link name="f{i}_tip"><collision><geometry><sphere radius="0.009"/></geometry></collision></link>
<joint name="f{i}_end" type="fixed"><origin xyz="0 0 0.05"/><parent link="f{i}_c"/><child link="f{i}_tip"/></joint>"""


def urdf():
    """A hand of four fingers with three joints."""
    fingers = ""
    for i in range(4):
        angle = np.pi / 2 * i
        fingers += URDF_FINGER.format(i=i, x=0.05 * np.cos(angle), y=0.05 * np.sin(angle), angle=angle)
    return f'<robot name="four"><link name="palm"/>{fingers}</robot>'


def test_a_urdf_is_read_as_pinocchio_reads_it(regrasp, tmp_path):
    pin = pytest.importorskip("pinocchio")
    (tmp_path / "hand.urdf").write_text(urdf())
    hand = Hand(regrasp("hand", "hand.urdf", "--json", cwd=tmp_path))
    model = pin.buildModelFromUrdf(str(tmp_path / "hand.urdf"))
    data, random, worst = model.createData(), np.random.default_rng(2), 0.0
    for _ in range(POSTURES):
        positions = hand.random_positions(random)
        q = pin.neutral(model)
        for name, angle in positions.items():
            joint = model.joints[model.getJointId(name)]
            # A joint without limits is a point of the unit circle there.
            q[joint.idx_q : joint.idx_q + joint.nq] = angle if joint.nq == 1 else [np.cos(angle), np.sin(angle)]
        pin.forwardKinematics(model, data, q)
        for name, (X, _) in hand.frames(positions).items():
            theirs = data.oMi[model.getJointId(name)].homogeneous
            worst = max(worst, np.abs(X[:3, 3] - theirs[:3, 3]).max(), np.abs(X[:3, :3] - theirs[:3, :3]).max())
    assert worst < CLOSE
