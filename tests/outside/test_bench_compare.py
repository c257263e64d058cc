"""Records of speed: a difference that is there is shown, one that is not is not."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from bench_compare import MEASURES, compare, ratio, verdict

SCRIPT = Path(__file__).with_name("bench_compare.py")


def record(factor, seed, unsolved=()):
    """A record of one scenario whose seeds take very different times, the noise of a machine on top."""
    times = np.random.default_rng(1).lognormal(-4, 1, 20)
    noise = np.random.default_rng(seed).normal(1, 0.03, 20)
    kept = [float(time * factor * n) for k, (time, n) in enumerate(zip(times, noise, strict=True)) if k not in unsolved]
    entry = {"unsolved": list(unsolved), **dict.fromkeys(MEASURES, kept)}
    return {"format": "regrasp-record", "version": 1, "seeds": 20, "origin": {"cores": 2}, "scenarios": {"sphere": entry}}


def test_a_tenth_is_seen_through_the_spread_of_seeds_and_nothing_is_seen_where_nothing_is():
    verdicts = {}
    for factor, says in ((1.1, "slower"), (0.9, "faster"), (1.0, "no difference shown")):
        found = [compare(record(1, 2 * k), record(factor, 2 * k + 1), "planning_s")[0][-1] for k in range(20)]
        verdicts[factor] = found.count(says)
    assert verdicts[1.1] == verdicts[0.9] == 20
    # One in twenty is wrong by the interval's own word; five would be no accident (p < 0.003).
    assert verdicts[1.0] >= 16


def test_pairs_are_those_that_both_have_solved():
    row = compare(record(1, 0, unsolved=(3, 4)), record(1, 0, unsolved=(5,)), "process_s")[0]
    assert row[5] == (1.0, 1.0, 1.0) and row[6] == "no difference shown"
    assert ratio({1: 1.0}, {2: 1.0}) is None
    assert verdict(1.2, 1.3) == "slower"


def test_the_command_prints_a_table_and_refuses_what_is_no_record(tmp_path):
    for name, factor in (("old.json", 1), ("new.json", 2)):
        (tmp_path / name).write_text(json.dumps(record(factor, 7)))
    (tmp_path / "plan.json").write_text("{}")

    def run(*words):
        return subprocess.run([sys.executable, SCRIPT, *words], cwd=tmp_path, capture_output=True, text=True)

    done = run("old.json", "new.json", "--measure", "verification_s")
    assert done.returncode == 0 and "2.000 (2.000-2.000)  slower" in done.stdout, done.stdout
    done = run("old.json", "plan.json")
    assert done.returncode == 1 and "no record of speed" in done.stderr
