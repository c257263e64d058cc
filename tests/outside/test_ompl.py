"""The benchmark logs of `regrasp compare`, read by OMPL's own program."""

import os
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from study_fixture import HOSTILE, SEEDS, VARIANTS, runs, study  # noqa: F401

#: Endings of OMPL in its order, and ours behind them.
SOLVED, NO_PLAN = 6, 10


@pytest.fixture(scope="module")
def database(study, tmp_path_factory):  # noqa: F811
    """What `ompl_benchmark_statistics` makes of the logs, its views computed."""
    file = tmp_path_factory.mktemp("ompl") / "benchmark.db"
    program = Path(sys.executable).parent / "ompl_benchmark_statistics"
    logs = sorted((study / "ompl").glob("*.log"))
    assert len(logs) == 2
    subprocess.run([program, "-d", file, *logs], check=True, stdout=subprocess.DEVNULL, env={**os.environ, "LC_ALL": "C"})
    connection = sqlite3.connect(file)
    connection.row_factory = sqlite3.Row
    yield connection
    connection.close()


def test_experiments_are_the_scenarios(database):
    rows = database.execute("SELECT * FROM experiments").fetchall()
    assert {row["name"] for row in rows} == {"sphere", "".join(c if c.isalnum() or c in "-._" else "_" for c in HOSTILE)}
    for row in rows:
        assert row["version"].startswith("Regrasp ") and row["runcount"] == SEEDS
        assert row["hostname"] and " " not in row["hostname"]
        assert row["totaltime"] > 0 and row["seed"] == "0"
        assert row["date"].startswith("20") and len(row["date"]) == len("2026-01-01 00:00:00")
        assert "regrasp compare" in row["setup"]


def test_every_run_is_there_with_its_values(database, runs):  # noqa: F811
    assert len(runs) == 2 * VARIANTS * SEEDS
    sql = """SELECT runs.*, plannerConfigs.name AS variant, experiments.name AS experiment FROM runs
        JOIN plannerConfigs ON plannerid = plannerConfigs.id JOIN experiments ON experimentid = experiments.id"""
    found = {(row["experiment"] == "sphere", row["variant"], row["run_seed"]): row for row in database.execute(sql)}
    assert len(found) == len(runs)
    for run in runs:
        row = found[run["scenario"] == "sphere", run["variant"], int(run["seed"])]
        is_solved = run["status"] == "solved" and run["verified"] == "true"
        assert row["solved"] == is_solved
        assert row["status"] == SOLVED if is_solved else row["status"] >= NO_PLAN
        assert row["time"] == float(run["planning_s"])
        assert row["memory"] == pytest.approx(float(run["memory_bytes"]) / 1e6)
        assert row["graph_states"] == int(run["graph_nodes"])
        assert row["regrasps"] == int(run["regrasps"])
        assert row["closure_margin"] == float(run["margin"])
        assert row["role_stability_test_time"] == float(run["self.stability-test_s"])


def test_planners_know_their_settings(database):
    settings = {row["name"]: row["settings"] for row in database.execute("SELECT * FROM plannerConfigs WHERE id <= ?", [VARIANTS])}
    assert len(settings) == VARIANTS
    for name, text in settings.items():
        assert f"stability-test = stability-test/{name.split(' + ')[0]}" in text
        assert f"graph-strategy = graph-strategy/{name.split(' + ')[1]}" in text


def test_endings_are_those_of_ompl_and_ours_behind_them(database):
    ours = dict(database.execute("SELECT value, description FROM enums WHERE name = 'status'"))
    from ompl import base

    status = base.PlannerStatus
    kinds = "UNKNOWN INVALID_START INVALID_GOAL UNRECOGNIZED_GOAL_TYPE TIMEOUT APPROXIMATE_SOLUTION EXACT_SOLUTION CRASH"
    for kind in kinds.split():
        value = getattr(status, kind)
        assert ours[value.value] == status(value).asString()
    assert len(ours) > status.TYPE_COUNT.value and ours[NO_PLAN] == "No plan"


def test_the_best_of_each_experiment_is_found(database):
    # What Planner Arena asks first.
    rows = database.execute("SELECT * FROM bestPlannerConfigsPerExperiment").fetchall()
    assert len(rows) == 2 * VARIANTS and all(0 <= row["avg_solved"] <= 1 for row in rows)
