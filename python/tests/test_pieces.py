"""The planner's pieces over arrays, against closed forms and against themselves."""

import numpy as np
import pytest
import regrasp as rg

TETRAHEDRON = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(3)


def random_grasps(count: int, contacts: int = 4) -> tuple[np.ndarray, np.ndarray]:
    normals = np.random.default_rng(7).normal(size=(count, contacts, 3))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return 0.03 * normals, normals


def test_a_tetrahedron_holds_a_ball_and_one_side_does_not() -> None:
    assert rg.force_closure(TETRAHEDRON, TETRAHEDRON, 0.5)
    side = np.array([[1, 0, 0], [1, 0.1, 0], [1, 0, 0.1], [1, 0.1, 0.1]])
    assert not rg.force_closure(side, np.tile([1.0, 0, 0], (4, 1)), 0.5)


def test_batches_equal_single_calls_and_strided_arrays_their_copies() -> None:
    points, normals = random_grasps(200)
    verdicts = rg.force_closure(points, normals, 0.4)
    assert 0 < verdicts.sum() < len(verdicts)
    assert [
        bool(rg.force_closure(p, n, 0.4)) for p, n in zip(points, normals, strict=True)
    ] == verdicts.tolist()
    assert (rg.force_closure(points[::2], normals[::2], 0.4) == verdicts[::2]).all()
    fortran = np.asfortranarray(points)
    fortran.flags.writeable = False
    assert (rg.force_closure(fortran, normals.astype(np.float32).astype(float), 0.4) == verdicts).all()


def test_margins_and_forces_prove_the_verdicts() -> None:
    points, normals = random_grasps(100)
    verdicts = rg.force_closure(points, normals, 0.6)
    margins = rg.closure_margin(points, normals, 0.6)
    assert ((margins[:, 0] > 0) == verdicts).all() and (margins[:, 0] <= margins[:, 1] + 1e-12).all()
    forces = rg.internal_forces(points, normals, 0.6)
    assert (np.isnan(forces).any(axis=(1, 2)) == ~verdicts).all()
    f, p, n = forces[verdicts], points[verdicts], normals[verdicts]
    scale = np.abs(f).sum(axis=(1, 2))
    assert (np.abs(f.sum(axis=1)).max(axis=1) < 1e-9 * scale).all()
    assert (np.abs(np.cross(p, f).sum(axis=1)).max(axis=1) < 1e-9 * scale).all()
    normal = -np.einsum("nki,nki->nk", f, n)
    tangential = np.linalg.norm(f + normal[..., None] * n, axis=-1)
    assert (tangential < 0.6 * normal).all()


def test_edges_of_wrench_cones_lie_on_the_cones() -> None:
    points, normals = random_grasps(10)
    cones = rg.wrench_cones(points, normals, 0.5, edges=6)
    assert cones.shape == (10, 4, 6, 6)
    force = cones[..., :3]
    normal = -np.einsum("nkei,nki->nke", force, normals)
    assert np.allclose(normal, 1) and np.allclose(np.linalg.norm(force, axis=-1), np.sqrt(1.25))
    assert np.allclose(cones[..., 3:], np.cross(points[:, :, None], force))


def test_kinematics_go_there_and_back() -> None:
    hand = rg.Hand.built_in("four-finger")
    generator = np.random.default_rng(3)
    for index, finger in enumerate(hand.fingers):
        q = generator.uniform(finger.lower, finger.upper, size=(50, len(finger.joints)))
        centers = hand.fk(finger.name, q)
        found = hand.ik(index, centers, near=q)
        assert np.abs(hand.fk(index, found) - centers).max() < 1e-9
        step = 1e-6
        J = hand.jacobian(index, q)
        for joint in range(q.shape[1]):
            moved = q.copy()
            moved[:, joint] += step
            assert np.allclose((hand.fk(index, moved) - centers) / step, J[:, :, joint], atol=1e-5)
    assert np.isnan(hand.ik(0, [1.0, 1.0, 1.0])).all()


def test_closest_points_and_geodesics_on_a_ball() -> None:
    task = rg.Scenario(object=rg.Sphere(0.03), start=rg.pose(z=0.085), goals=[rg.pose(z=0.086)])
    bench = rg.Bench(task, use={"surface": "parametric"})
    contacts = bench.sample_contacts(40, seed=1)
    assert np.allclose(np.linalg.norm(contacts.points, axis=1), 0.03, rtol=0.02)
    back, distances = bench.closest_points(contacts.points + 0.01 * contacts.normals)
    assert np.allclose(distances, 0.01, atol=1e-6) and np.allclose(back.points, contacts.points, atol=1e-6)
    ends = rg.SurfacePoints(contacts.facets[::-1], contacts.points[::-1], contacts.normals[::-1])
    lengths = bench.geodesics(contacts, ends)
    a, b = (c.points / np.linalg.norm(c.points, axis=1, keepdims=True) for c in (contacts, ends))
    assert np.allclose(lengths, 0.03 * np.arccos(np.clip((a * b).sum(axis=1), -1, 1)), rtol=0.02, atol=1e-6)


def test_sampled_grasps_are_admissible_and_the_seed_decides() -> None:
    bench = rg.Bench("sphere")
    grasps = bench.sample_grasps(5, seed=4)
    assert len(grasps) == 5 and (bench.margins(grasps)[:, 0] > 0).all()
    again = rg.sample_grasps("sphere", 5, seed=4)
    assert all((a.pose == b.pose).all() for a, b in zip(grasps, again, strict=True))
    three = bench.sample_grasps(2, seed=4, holding=[0, 1, 3])
    assert all([contact is not None for contact in q.contacts] == [True, True, False, True] for q in three)


def test_grasps_in_bulk_are_arrays() -> None:
    found = rg.grasps("sphere", 50, seed=4, graph=True)
    assert len(found) == 50 and (found.margin > 0).all() and (found.clearance > 0).all()
    assert not (found.liftable & ~found.holding).any()
    assert np.allclose(np.linalg.norm(found.contact_point_O[found.holding], axis=-1), 0.03, atol=3e-4)
    assert (found.pose[found.edges[:, 0]] == found.pose[found.edges[:, 1]]).all()
    fewer = rg.grasps("sphere", 10, seed=4, graph=True, threads=2)
    assert np.array_equal(fewer.joints, found.joints[:10])
    with pytest.raises(rg.ArgumentError, match="`spread`"):
        rg.grasps("sphere", 5, spread=0.0)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: rg.force_closure(np.zeros((4, 2)), np.ones((4, 2))), "shape (1, 4, 2)"),
        (lambda: rg.force_closure(np.full((4, 3), np.nan), np.ones((4, 3))), "outside the finite numbers"),
        (lambda: rg.force_closure(np.ones((4, 3)), np.zeros((4, 3))), "length 0"),
        (lambda: rg.force_closure(np.ones((9, 3)), np.ones((9, 3))), "outside 1..=8"),
        (lambda: rg.force_closure(np.ones((4, 3)), np.ones((4, 3)), -1), "`friction`"),
        (lambda: rg.force_closure(np.ones((4, 3)), np.ones((4, 3)), [1, 1]), "`friction` has shape (2,)"),
        (lambda: rg.closure_margin(np.ones((4, 3)), np.ones((4, 3)), length=-1), "`length`"),
        (lambda: rg.Hand.built_in("four-finger").fk(9, [0, 0, 0]), "`finger` = 9"),
        (lambda: rg.Hand.built_in("four-finger").fk("thum", [0, 0, 0]), "there is no finger"),
        (lambda: rg.Hand.built_in("four-finger").fk(0, [0, 0]), "shape (1, 2), not (any, 3)"),
        (lambda: rg.Bench("sphere").closest_points([[0.0, 0.0]]), "shape (1, 2), not (any, 3)"),
        (lambda: rg.force_closure([["a", 1, 2]], [[1, 2, 3]]), "no number"),
        (lambda: rg.force_closure(np.ones((4, 3)), np.ones((4, 3)), "rough"), "`friction` holds something"),
        (lambda: rg.force_closure(np.ones((4, 3)), np.ones((4, 3)), np.nan), "`friction`"),
    ],
)
def test_bad_input_is_refused_with_its_name(call, words: str) -> None:
    with pytest.raises(rg.ArgumentError) as refusal:
        call()
    assert words in str(refusal.value)


def test_unknown_hands_and_files_are_scenario_errors(tmp_path) -> None:
    with pytest.raises(rg.ScenarioError, match="did you mean `four-finger`"):
        rg.Hand.built_in("for-finger")
    with pytest.raises(rg.ScenarioError):
        rg.Hand.from_file(tmp_path / "none.urdf")


def test_what_holds_the_object_is_balanced_within_friction_and_efforts() -> None:
    bench = rg.Bench("sphere")
    grasps = bench.sample_grasps(8, seed=3)
    held = bench.holds(grasps)
    problem = bench.scenario.problem
    mass, friction = problem["object"]["mass"], problem["object"]["friction"]
    limits = np.concatenate([finger.effort for finger in rg.Hand.built_in("four-finger").fingers])
    for row, q in enumerate(grasps):
        R = np.asarray(q.pose)[:3, :3]
        points = np.array([contact.point for contact in q.contacts])
        normals = np.array([contact.normal for contact in q.contacts])
        f = held.forces[row]
        weight = R.T @ [0, 0, -9.81 * mass]
        assert np.abs(f.sum(axis=0) + weight).max() < 1e-6
        assert np.abs(np.cross(points, f).sum(axis=0)).max() < 1e-7
        pressed = -(f * normals).sum(axis=1)
        sideways = np.linalg.norm(f + pressed[:, None] * normals, axis=1)
        assert (sideways <= (1 + 1e-6) * held.friction_share[row] * friction * pressed).all()
        assert (np.abs(held.efforts[row]) <= (1 + 1e-6) * held.effort_share[row] * limits).all()
    assert (held.mass > mass).all() and (held.friction_share <= 1).all()
    # With as little of the friction as can be there are forces still, and they rely on less.
    assert (bench.holds(grasps, share=0.01).friction_share < held.friction_share).all()
    with pytest.raises(rg.ArgumentError, match="`share`"):
        bench.holds(grasps, share=0)


def test_local_planners_go_from_grasp_to_grasp() -> None:
    bench = rg.Bench("sphere")
    start = bench.sample_grasps(1, seed=3)[0]
    turned = np.asarray(start.pose) @ rg.pose(axis="z", angle_deg=5)
    way = bench.connect(start, turned)
    assert isinstance(way, rg.Way) and way and way.fraction == 1 and len(way.states) > 2
    assert np.allclose(way.states[0].pose, start.pose) and np.allclose(way.states[-1].pose, turned)
    # Balls roll: a contact moves on the object and on the fingertip alike, and stays in touch.
    assert [c is None for c in way.states[-1].contacts] == [c is None for c in start.contacts]
    far = bench.connect(start, np.asarray(start.pose) @ rg.pose(axis="z", angle_deg=170))
    assert isinstance(far, rg.Way) and not far and far.reason and far.fraction < 1
    ways = bench.connect([start] * 3, [turned] * 3, seed=1)
    assert isinstance(ways, list) and all(len(own.states) == len(way.states) for own in ways)
    lifted = bench.connect(start, way.states[-1], finger=1)
    assert isinstance(lifted, rg.Way)
    with pytest.raises(rg.ArgumentError, match="entries"):
        bench.connect([start, start], [turned] * 3)
    with pytest.raises((rg.RegraspError, ValueError)):
        bench.connect(start, 2 * np.eye(4))
