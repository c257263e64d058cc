"""Hands from files of other programs, and back."""

import numpy as np
import pytest
import regrasp as rg

#: One finger of a MuJoCo model: two hinges, a rod for each link, a ball at the end.
FINGER = """
<body name="{name}-base" pos="{x} {y} 0" euler="0 0 {turn}">
  <joint name="{name}-swing" axis="0 0 1" range="-40 40"/>
  <geom type="capsule" fromto="0 0 0 0 0 0.02" size="0.006"/>
  <body name="{name}-proximal" pos="0 0 0.02">
    <joint name="{name}-knee" axis="0 1 0" range="-60 60"/>
    <geom type="capsule" fromto="0 0 0 0 0 0.05" size="0.006"/>
    <body name="{name}-distal" pos="0 0 0.05">
      <joint name="{name}-end" axis="0 1 0" range="-90 90"/>
      <geom type="capsule" fromto="0 0 0 0 0 0.04" size="0.006"/>
      <body name="{name}-tip" pos="0 0 0.05"><geom type="sphere" size="0.01"/></body>
    </body>
  </body>
</body>"""


def mjcf() -> str:
    corners = [(0.06, 0, 180), (-0.03, 0.052, -60), (-0.03, -0.052, 60)]
    fingers = [FINGER.format(name=f"f{i}", x=x, y=y, turn=turn) for i, (x, y, turn) in enumerate(corners)]
    palm = '<geom type="cylinder" size="0.07 0.005" pos="0 0 -0.02"/>'
    body = f'<body name="palm">{palm}{"".join(fingers)}</body>'
    return f'<mujoco model="three"><compiler angle="degree"/><worldbody>{body}</worldbody></mujoco>'


def in_mujoco(text: str, tips: list[str], posture: dict[str, float]) -> np.ndarray:
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for name, position in posture.items():
        data.joint(name).qpos = position
    mujoco.mj_kinematics(model, data)
    return np.array([data.body(tip).xpos for tip in tips])


@pytest.mark.parametrize("ending", ["xml", "mjcf"])
def test_a_mujoco_model_is_a_hand(tmp_path, ending: str) -> None:
    path = tmp_path / f"three.{ending}"
    path.write_text(mjcf())
    tips = [f"f{i}-tip" for i in range(3)]
    hand = rg.Hand.from_file(path, tips=tips, palm="palm", effort=0.8)
    assert "mjcf" in hand.tree and len(hand.fingers) == 3 and hand.fingertip_radius == 0.01
    names = [finger.joints for finger in hand.fingers]
    assert names[0] == ["f0-swing", "f0-knee", "f0-end"]
    assert np.allclose(hand.fingers[0].upper, np.radians([40, 60, 90]))
    q = np.random.default_rng(1).uniform(-0.6, 0.6, size=(3, 3))
    posture = {
        name: value for row, some in zip(q, names, strict=True) for name, value in zip(some, row, strict=True)
    }
    ours = np.array([hand.fk(i, q[i]) for i in range(3)])
    assert np.abs(in_mujoco(mjcf(), tips, posture) - ours).max() < 1e-12


def test_a_robot_file_that_is_none_names_its_key(tmp_path) -> None:
    (tmp_path / "bad.xml").write_text("<mujoco><worldbody/></mujoco>")
    with pytest.raises(rg.ScenarioError) as refusal:
        rg.Hand.from_file(tmp_path / "bad.xml")
    assert "bad.xml" in str(refusal.value)
    with pytest.raises(rg.ScenarioError, match="mjcf"):
        rg.Hand.from_file(tmp_path / "none.xml")


HANDS = ["four-finger", "five-finger", "allegro-like", "trifinger-like"]


@pytest.mark.parametrize("name", HANDS)
def test_a_hand_written_as_urdf_is_the_same_hand(tmp_path, name: str) -> None:
    hand = rg.Hand.built_in(name)
    text = hand.to_urdf(tmp_path / "new")
    assert (tmp_path / "new" / "hand.urdf").read_text() == text and "object" not in text
    tips = [f"{finger.name}-tip" for finger in hand.fingers]
    back = rg.Hand.from_file(
        tmp_path / "new" / "hand.urdf", tips=tips, fingertip_radius=hand.fingertip_radius
    )
    assert [name for finger in back.fingers for name in finger.joints] == hand.joint_names
    generator = np.random.default_rng(2)
    for i, (finger, other) in enumerate(zip(hand.fingers, back.fingers, strict=True)):
        q = generator.uniform(finger.lower, finger.upper, size=(20, len(finger.joints)))
        assert np.abs(hand.fk(i, q) - back.fk(i, q)).max() < 1e-12
        assert np.allclose(finger.lower, other.lower) and np.allclose(finger.effort, other.effort)


@pytest.mark.parametrize("name", [*HANDS, "free-fingertips"])
def test_pinocchio_puts_the_fingertips_where_we_do(name: str) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    hand = rg.Hand.built_in(name)
    model = pinocchio.buildModelFromXML(hand.to_urdf())
    data = model.createData()
    columns = [model.idx_qs[model.getJointId(joint)] for joint in hand.joint_names]
    lower = np.concatenate([finger.lower for finger in hand.fingers])
    upper = np.concatenate([finger.upper for finger in hand.fingers])
    for joints in np.random.default_rng(3).uniform(lower, upper, size=(20, len(lower))):
        q = np.empty(model.nq)
        q[columns] = joints
        pinocchio.framesForwardKinematics(model, data, q)
        tips = [data.oMf[model.getFrameId(f"{finger.name}-tip")].translation for finger in hand.fingers]
        assert np.abs(hand.fingertips(joints) - tips).max() < 1e-12
