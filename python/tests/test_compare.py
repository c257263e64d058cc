"""Studies: tables, resuming, parts on a cluster."""

import dataclasses
import os
import signal
import threading
import time

import pytest
import regrasp as rg

pandas = pytest.importorskip("pandas")

VARY = {"stability-test": ["force-closure", "socp"]}
#: Columns that a run's clock fills.
TIMED = ("_s", "time", "machine", "host")


class Reluctant(rg.StabilityTest):
    """Force closure with friction to spare."""

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the test."""

        share: float = rg.setting(0.9, range=(0.1, 1.0), doc="The share of the friction that it relies on.")

    def test(self, grasp: rg.Grasp) -> bool:
        return bool(rg.force_closure(grasp.points, grasp.normals, self.settings.share * grasp.friction))


def counted(study: rg.Study) -> "pandas.DataFrame":
    runs = study.runs
    return runs[[name for name in runs.columns if not any(part in name for part in TIMED)]]


def test_a_study_is_a_table_and_a_summary(tmp_path) -> None:
    study = rg.compare("sphere", VARY, seeds=3, output=tmp_path / "study")
    assert len(study.runs) == 6 and "socp" in study.summary
    again = rg.compare("sphere", VARY, seeds=3, output=tmp_path / "study")
    pandas.testing.assert_frame_equal(again.runs, study.runs)
    with pytest.raises(rg.StudyError):
        rg.compare("sphere", VARY, seeds=4, output=tmp_path / "study")


def test_classes_and_settings_are_compared() -> None:
    told = []
    study = rg.compare(
        ["sphere"], {"stability-test": ["force-closure", Reluctant]}, seeds=2, progress=told.append
    )
    assert len(study.runs) == 4 and "reluctant" in study.summary
    assert all(progress.stage == "study" for progress in told)
    settings = rg.compare("sphere", {"graph-strategy.end": [0.3, 0.8]}, seeds=2)
    assert len(settings.runs) == 4


def test_presets_are_compared() -> None:
    study = rg.compare("sphere", {"preset": ["paper", "default"]}, seeds=2, time_limit=20)
    assert len(study.runs) == 4 and "paper" in study.summary
    with pytest.raises(rg.RegraspError, match="did you mean `paper`"):
        rg.compare("sphere", {"preset": ["papre"]}, seeds=1)
    with pytest.raises(TypeError, match="preset"):
        rg.compare("sphere", {"preset": [3]}, seeds=1)


def test_what_cannot_be_compared_is_refused() -> None:
    with pytest.raises(rg.RegraspError, match="did you mean"):
        rg.compare("sphere", {"stability-test": ["scop"]}, seeds=1)
    with pytest.raises(rg.ArgumentError, match="nothing to plan"):
        rg.compare([], VARY)


def test_a_cluster_makes_the_same_rows(tmp_path) -> None:
    distributed = pytest.importorskip("distributed")
    here = rg.compare("sphere", VARY, seeds=4, output=tmp_path / "here")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            there = rg.compare("sphere", VARY, seeds=4, output=tmp_path / "there", client=client, chunks=3)
    pandas.testing.assert_frame_equal(counted(here), counted(there))


def test_a_worker_that_dies_costs_its_part_alone(tmp_path) -> None:
    distributed = pytest.importorskip("distributed")
    here = rg.compare("cubic", VARY, seeds=4, output=tmp_path / "here")
    studies: list[rg.Study] = []

    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:

            def make() -> None:
                studies.append(
                    rg.compare("cubic", VARY, seeds=4, output=tmp_path / "there", client=client, chunks=4)
                )

            thread = threading.Thread(target=make)
            thread.start()
            deadline = time.monotonic() + 20
            while not any(client.processing().values()) and time.monotonic() < deadline:
                time.sleep(0.01)
            victim = next(iter(client.run(os.getpid).values()))
            os.kill(victim, signal.SIGKILL)
            thread.join(timeout=400)
    pandas.testing.assert_frame_equal(counted(here), counted(studies[0]))
