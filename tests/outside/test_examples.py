"""The example in Python: it reads what the program writes, and refuses what is no plan."""

import subprocess
import sys
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "examples" / "12_read_a_plan.py"


def read(*words):
    """Runs the example without anybody's site packages: the standard library must do."""
    command = [sys.executable, "-I", "-S", str(EXAMPLE), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def test_a_plan_is_read_and_told(regrasp, tmp_path):
    plan = tmp_path / "plan.json"
    regrasp("plan", "cubic", "--seed", 1, "-o", plan)
    done = read(plan)
    assert done.returncode == 0, done.stderr
    head, *rows = done.stdout.splitlines()
    assert head.startswith("cubic, seed 1: ")
    assert sum("transfer" in row for row in rows) >= 4, "four quarters, a transfer each at least"
    assert any("regrasp" in row and "moves its contact by" in row for row in rows)
    assert rows[-1].startswith("smallest margin of force closure: 0.")


def test_a_damaged_plan_is_noticed(regrasp, tmp_path):
    plan = tmp_path / "plan.json"
    regrasp("plan", "sphere", "-o", plan)
    text = plan.read_text(encoding="utf-8")
    # The first orientation of the motion, no longer of unit length.
    start = text.index('"orientation"', text.index('"segments"'))
    number = text.index("[", start) + 1
    plan.write_text(text[:number] + "9" + text[number:], encoding="utf-8")
    done = read(plan)
    assert done.returncode != 0
    assert "unit quaternions" in done.stderr


def test_what_is_no_plan_is_refused_without_a_trace(tmp_path):
    other = tmp_path / "other.json"
    other.write_text('{"format": "something"}', encoding="utf-8")
    for words in [(), (tmp_path / "missing.json",), (other,), (EXAMPLE,), (tmp_path,)]:
        done = read(*words)
        assert done.returncode != 0
        assert "Traceback" not in done.stderr, done.stderr
