"""A study that the tests of its files share: two scenarios, one with a hostile name, four variants, eight seeds."""

import csv
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
#: What a user may call a scenario, and what it must not become.
HOSTILE = "</script><img src=x onerror=alert(1)>"
VARIANTS = 4
SEEDS = 8


@pytest.fixture(scope="session")
def study(regrasp, tmp_path_factory):
    """The folder of the study."""
    place = tmp_path_factory.mktemp("study")
    # JSON's strings are TOML's, too.
    text = (ROOT / "scenarios/cube-free.toml").read_text().replace('name = "cube-free"', f"name = {json.dumps(HOSTILE)}")
    (place / "hostile.toml").write_text(text)
    words = ["--vary", "stability-test=force-closure,socp", "--vary", "graph-strategy=interleaved,lazy", "--seeds", SEEDS]
    regrasp("compare", "sphere", place / "hostile.toml", *words, "-o", place / "out")
    return place / "out"


@pytest.fixture(scope="session")
def runs(study):
    """The rows of runs.csv."""
    with open(study / "runs.csv", newline="") as file:
        return list(csv.DictReader(file))
