"""Scenarios in all their forms, and their errors."""

import json

import numpy as np
import pytest
import regrasp as rg
import tomllib


def sphere_tree() -> dict:
    return tomllib.loads(rg.scenario_text("sphere"))


def motion(scenario: object) -> str:
    return json.dumps(rg.plan(scenario, seed=1).to_dict()["segments"])


def test_all_forms_are_the_same_scenario(tmp_path) -> None:
    toml, as_json = tmp_path / "a.toml", tmp_path / "a.json"
    toml.write_text(rg.scenario_text("sphere"))
    as_json.write_text(json.dumps(sphere_tree()))
    wanted = motion("sphere")
    for form in (str(toml), toml, as_json, sphere_tree(), rg.Scenario.load("sphere")):
        assert motion(form) == wanted


def test_objects_make_scenarios() -> None:
    task = rg.Scenario(
        hand="four-finger",
        object=rg.Sphere(0.03, mass=0.1, friction=0.8),
        start=rg.pose(z=0.085),
        goals=[rg.pose(z=0.085, axis="z", angle_deg=40)],
        use={"stability-test": "force-closure", "local-planner.transfer": {"use": "rolling"}},
        name="mine",
    )
    plan = task.plan(seed=1)
    assert plan.scenario["name"] == "mine" and plan.verify()
    turn = plan.object_poses[-1][:3, :3]
    assert np.allclose(turn, rg.pose(axis="z", angle_deg=40)[:3, :3], atol=1e-6)
    assert np.allclose(plan.object_poses[0], rg.pose(z=0.085))


def cube() -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.02
    facets = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 6, 7),
        (4, 7, 5),
        (0, 4, 5),
        (0, 5, 1),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
    ]
    return corners, np.array([*facets, (1, 5, 7), (1, 7, 3)])


def test_meshes_of_arrays_and_of_trimesh_are_objects(tmp_path) -> None:
    trimesh = pytest.importorskip("trimesh")
    vertices, facets = cube()
    given = trimesh.Trimesh(vertices, facets, process=False)
    given.export(tmp_path / "cube.stl")
    volumes = []
    for shape in (rg.Mesh(vertices, facets), given, rg.Mesh(given), rg.Mesh(tmp_path / "cube.stl")):
        task = rg.Scenario(object=shape, start=rg.pose(z=0.085), goals=[rg.pose(z=0.086)])
        mesh = task.problem["object"]["shape"]
        p, f = np.array(mesh["vertices"]), np.array(mesh["facets"])
        volumes.append(np.einsum("ij,ij->i", p[f[:, 0]], np.cross(p[f[:, 1]], p[f[:, 2]])).sum() / 6)
    assert np.allclose(volumes, 0.04**3)


def test_errors_say_where_what_range_and_remedy() -> None:
    tree = sphere_tree()
    tree["object"]["friction"] = -1.0
    with pytest.raises(rg.ScenarioError) as refusal:
        rg.plan(tree)
    error = refusal.value
    assert error.key == "object.friction" and "0..=10" in str(error) and isinstance(error.line, int)
    tree["object"]["friction"] = 0.8
    tree["object"]["fricton"] = 0.8
    with pytest.raises(rg.ScenarioError, match="did you mean `friction`"):
        rg.plan(tree)
    with pytest.raises(rg.ScenarioError, match="did you mean `sphere`"):
        rg.plan("spere")
    with pytest.raises(rg.RegraspError):
        rg.plan("nowhere/none.toml")


def test_numbers_that_are_not_finite_have_their_path() -> None:
    tree = sphere_tree()
    tree["goal"][0]["pose"]["position"] = [0.0, float("nan"), 0.0]
    with pytest.raises(rg.ArgumentError) as refusal:
        rg.Scenario.from_dict(tree)
    assert refusal.value.key == "goal[0].pose.position[1]"


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: rg.pose(z=np.nan), "`position[2]` = nan"),
        (lambda: rg.pose(axis="w", angle_deg=3), "`axis`"),
        (lambda: rg.pose(axis="x"), "angle_deg"),
        (lambda: rg.pose(quaternion=(0, 0, 0, 0)), "length 0"),
        (lambda: rg.Mesh(np.zeros((3, 2)), [[0, 1, 2]]), "shape (3, 2), not (any, 3)"),
        (lambda: rg.Mesh(np.zeros((3, 3)), [[0, 1, 3]]), "outside 0..=2"),
        (lambda: rg.Mesh(np.zeros((3, 3)), [[0.5, 1, 2]]), "not whole numbers"),
        (lambda: rg.Mesh(np.full((3, 3), np.inf), [[0, 1, 2]]), "outside the finite numbers"),
        (
            lambda: rg.Scenario(object=rg.Sphere(0.03), start=np.eye(3), goals=[np.eye(4)]),
            "shape (3, 3), not (4, 4)",
        ),
        (
            lambda: rg.Scenario(object=rg.Sphere(0.03), start=2 * np.eye(4), goals=[np.eye(4)]),
            "not a rotation",
        ),
    ],
)
def test_bad_arrays_are_refused_with_their_name(make, words: str) -> None:
    with pytest.raises(rg.ArgumentError) as refusal:
        make()
    assert words in str(refusal.value)


def test_quaternions_and_matrices_agree() -> None:
    generator = np.random.default_rng(1)
    for q in generator.normal(size=(50, 4)):
        q *= np.sign(q[0]) / np.linalg.norm(q)
        assert np.allclose(rg._spatial.quaternion(rg.pose(quaternion=q)[:3, :3]), q)
