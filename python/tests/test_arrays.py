"""Arrays of every kind: strided, read-only, of other types; with NaN; of wrong shapes."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import regrasp as rg

Call = Callable[[np.ndarray], np.ndarray]

HAND = rg.Hand.built_in("four-finger")
BENCH = rg.Bench("sphere")
CONTACTS = BENCH.sample_contacts(12, seed=1)
GENERATOR = np.random.default_rng(4)
NORMALS = GENERATOR.normal(size=(12, 4, 3))
POINTS = 0.03 * NORMALS / np.linalg.norm(NORMALS, axis=-1, keepdims=True)
POSTURES = GENERATOR.uniform(HAND.fingers[0].lower, HAND.fingers[0].upper, size=(12, 3))
CENTERS = HAND.fk(0, POSTURES)

#: Everything that takes arrays: the call, one array that it takes, and what messages call that.
CALLS: dict[str, tuple[Call, np.ndarray, str]] = {
    "fk": (lambda q: HAND.fk(0, q), POSTURES, "joints"),
    "fingertips": (HAND.fingertips, np.tile(POSTURES, 4), "joints"),
    "jacobian": (lambda q: HAND.jacobian(0, q), POSTURES, "joints"),
    "ik": (lambda p: HAND.ik(0, p), CENTERS, "centers"),
    "ik near": (lambda q: HAND.ik(0, CENTERS, near=q), POSTURES, "near"),
    "force_closure": (lambda p: rg.force_closure(p, NORMALS), POINTS, "points"),
    "force_closure normals": (lambda n: rg.force_closure(POINTS, n), NORMALS, "normals"),
    "closure_margin": (lambda p: rg.closure_margin(p, NORMALS), POINTS, "points"),
    "internal_forces": (lambda p: rg.internal_forces(p, NORMALS), POINTS, "points"),
    "wrench_cones": (lambda p: rg.wrench_cones(p, NORMALS), POINTS, "points"),
    "closest_points": (lambda p: BENCH.closest_points(p)[0].points, 0.04 / 0.03 * POINTS[:, 0], "centers"),
    "geodesics": (
        lambda p: BENCH.geodesics(replace(CONTACTS, points=p), CONTACTS),
        CONTACTS.points,
        "points",
    ),
}
EACH = pytest.mark.parametrize(("call", "given", "key"), CALLS.values(), ids=CALLS.keys())


def same(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.array_equal(a, b, equal_nan=a.dtype.kind == "f"))


@EACH
def test_strides_order_and_flags_do_not_matter(call: Call, given: np.ndarray, key: str) -> None:
    wanted = call(given.copy())
    wide = np.full((2 * len(given), *given.shape[1:]), np.nan)
    wide[::2] = given
    backwards = np.ascontiguousarray(given[::-1])[::-1]
    fixed = given.copy()
    fixed.flags.writeable = False
    swapped = given.astype(given.dtype.newbyteorder())
    for form in (wide[::2], np.asfortranarray(given), backwards, fixed, swapped, given.tolist()):
        assert same(call(form), wanted)
    assert same(call(fixed), wanted) and not fixed.flags.writeable


@EACH
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_have_their_place(
    call: Call, given: np.ndarray, key: str, bad: float
) -> None:
    spoilt = given.copy()
    place = (len(given) - 1,) + (0,) * (given.ndim - 1)
    spoilt[place] = bad
    with pytest.raises(rg.ArgumentError) as refusal:
        call(spoilt)
    assert refusal.value.key == f"{key}{list(place)}" and "outside the finite numbers" in str(refusal.value)


@EACH
def test_other_shapes_and_kinds_are_refused(call: Call, given: np.ndarray, key: str) -> None:
    for wrong in (given[..., :2], given[None, None], np.full(given.shape, "x"), np.full(given.shape, 1j)):
        with pytest.raises(rg.ArgumentError, match=key):
            call(wrong)


@EACH
def test_no_rows_give_no_rows(call: Call, given: np.ndarray, key: str) -> None:
    if key in {"centers", "joints"}:
        assert len(call(given[:0])) == 0
    else:
        with pytest.raises(rg.ArgumentError):
            call(given[:0])


@EACH
def test_what_comes_out_is_its_own(call: Call, given: np.ndarray, key: str) -> None:
    mine = given.copy()
    out = call(mine)
    kept = out.copy()
    mine[:] = 0.0
    del mine
    assert same(out, kept)
