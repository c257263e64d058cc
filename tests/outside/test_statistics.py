"""comparisons.csv against scipy, on random studies: a real study whose runs are replaced by random ones."""

import csv
import itertools
import json
import math
import random
import shutil

import numpy
import pytest
from scipy import stats

STUDIES = 50
SEEDS = 12
FACTORS = ["force-closure", "socp"], ["interleaved", "lazy"]
WORDS = ["--vary", f"stability-test={','.join(FACTORS[0])}", "--vary", f"graph-strategy={','.join(FACTORS[1])}", "--seeds", SEEDS]


@pytest.fixture(scope="session")
def base(regrasp, tmp_path_factory):
    """A study of two factors on the ball, to take the runs' form from."""
    folder = tmp_path_factory.mktemp("statistics") / "base"
    regrasp("compare", "sphere", *WORDS, "-o", folder)
    return folder


def random_runs(lines, generator):
    """The runs with random times, regrasps, margins and failures."""
    names = list(dict.fromkeys(run["variant"] for run in lines))
    effect = {name: generator.gauss(0, 0.3) for name in names}
    failing = {name: max(0, generator.uniform(-0.4, 0.4)) for name in names}
    hard = {run["seed"]: generator.gauss(0, 0.4) for run in lines}
    spread = generator.choice([0.02, 0.3, 1.0])
    for run in lines:
        run["times"]["planning_s"] = math.exp(effect[run["variant"]] + hard[run["seed"]] + spread * generator.gauss(0, 1))
        run["times"]["memory_bytes"] = round(2e6 * math.exp(0.1 * generator.gauss(0, 1)))
        run["motion"]["regrasps"] = generator.randrange(2 + names.index(run["variant"]))
        run["certified"]["margin"] = 0.1 + 0.01 * generator.gauss(0, 1)
        if generator.random() < failing[run["variant"]]:
            run.update(status="no-plan", verified=False, message="made up", motion=None, certified=None)
    return lines


def wilcoxon(differences):
    """The exact two-sided p-value: scipy's, and where there are ties, which that refuses, all signs of scipy's ranks."""
    kept = differences[differences != 0]
    if len(kept) == 0:
        return 1.0
    if len(numpy.unique(abs(kept))) == len(kept):
        return stats.wilcoxon(kept, method="exact").pvalue
    ranks = stats.rankdata(abs(kept))
    signs = numpy.array(list(itertools.product([0, 1], repeat=len(kept))))
    smaller = min(ranks[kept > 0].sum(), ranks[kept < 0].sum())
    return min(1, 2 * (signs @ ranks <= smaller).mean())


def holm(p, foremost):
    """Holm's correction with weights: three quarters of the level to the foremost hypotheses, none of which has less than another."""
    others = len(p) - sum(foremost)
    ratio = max(1, 3 * others / sum(foremost)) if any(foremost) else 1
    weights = numpy.where(foremost, ratio, 1.0)
    order = numpy.argsort(numpy.asarray(p) / weights, kind="stable")
    left = weights[order][::-1].cumsum()[::-1]
    corrected = numpy.empty(len(p))
    corrected[order] = numpy.minimum(numpy.maximum.accumulate(numpy.asarray(p)[order] * left / weights[order]), 1)
    return corrected


def walsh(differences):
    """All Walsh averages in rising order."""
    first, second = numpy.triu_indices(len(differences))
    return numpy.sort((differences[first] + differences[second]) / 2)


def newcombe(both, first, second, neither, alpha):
    """Newcombe's interval of paired shares (1998, method 10)."""
    n = both + first + second + neither
    level = stats.norm.ppf(1 - alpha / 2) if alpha > 0 else 0
    confidence = 2 * stats.norm.cdf(level) - 1
    ends = []
    for hits in (both + first, both + second):
        interval = stats.binomtest(hits, n).proportion_ci(confidence, method="wilson")
        ends.append((hits / n, interval.low, interval.high))
    (p1, l1, u1), (p2, l2, u2) = ends
    product = (both + first) * (second + neither) * (both + second) * (first + neither)
    surplus = both * neither - first * second
    surplus = max(surplus - n / 2, 0) if surplus > 0 else surplus
    phi = surplus / math.sqrt(product) if product else 0
    reach = lambda a, b: math.sqrt(max(a * a - 2 * phi * a * b + b * b, 0))  # noqa: E731
    return p1 - p2, p1 - p2 - reach(p1 - l1, u2 - p2), p1 - p2 + reach(u1 - p1, p2 - l2)


def value(run, measure, horizon):
    success = run["status"] == "solved" and run["verified"]
    if measure == "solved":
        return float(success)
    if measure == "planning_s":
        return min(run["times"]["planning_s"], horizon) if success else horizon
    if not success:
        return None
    found = {
        "regrasps": lambda: run["motion"]["regrasps"],
        "margin": lambda: run["certified"]["margin"],
        "memory_bytes": lambda: run["times"]["memory_bytes"],
    }
    return found[measure]()


def weights(row):
    """The weights of the variants of a row's question."""
    a, b = row["what"], row["against"]
    name = lambda x, y: f"{x} + {y}"  # noqa: E731
    (x0, x1), (y0, y1) = FACTORS
    if row["question"] == "pair":
        return {a: 1, b: -1}
    if row["question"] == "effect" and a.startswith("stability-test"):
        return {name(x1, y0): 0.5, name(x1, y1): 0.5, name(x0, y0): -0.5, name(x0, y1): -0.5}
    if row["question"] == "effect":
        return {name(x0, y1): 0.5, name(x1, y1): 0.5, name(x0, y0): -0.5, name(x1, y0): -0.5}
    return {name(x1, y1): 1, name(x1, y0): -1, name(x0, y1): -1, name(x0, y0): 1}


def differences(by_key, row, horizon):
    weighed = weights(row)
    found = []
    for seed in range(SEEDS):
        values = [(weight, value(by_key[variant, seed], row["measure"], horizon)) for variant, weight in weighed.items()]
        if all(x is not None for _, x in values):
            found.append(sum(weight * x for weight, x in values))
    return numpy.round(numpy.array(found), 12), [x for _, x in values]


def check_row(row, by_key, horizon):
    d, _ = differences(by_key, row, horizon)
    assert int(row["seeds"]) == len(d)
    if len(d) == 0:
        return
    assert [int(row["more"]), int(row["less"])] == [(d > 0).sum(), (d < 0).sum()]
    assert float(row["p"]) == pytest.approx(wilcoxon(d), rel=1e-9)
    alpha = 1 - float(row["confidence"])
    if row["measure"] == "solved" and row["question"] == "pair":
        pairs = [(by_key[row["what"], seed], by_key[row["against"], seed]) for seed in range(SEEDS)]
        solved = [tuple(value(run, "solved", 0) for run in pair) for pair in pairs]
        expected = newcombe(*(solved.count(kind) for kind in [(1, 1), (1, 0), (0, 1), (0, 0)]), alpha)
    else:
        averages = walsh(d)
        # How many averages on each side are so few that chance alone leaves them out.
        chances = numpy.zeros(len(d) * (len(d) + 1) // 2 + 1)
        chances[0] = 1
        for rank in range(1, len(d) + 1):
            chances[rank:] = chances[rank:] + chances[:-rank]
        chances = numpy.cumsum(chances / 2 ** len(d))
        skipped = int((chances <= alpha / 2 * (1 + 1e-12)).sum()) - 1
        expected = (numpy.median(averages), averages[skipped], averages[-1 - skipped]) if skipped >= 0 else (numpy.median(averages), -math.inf, math.inf)
    mean, low, high = expected
    if row["verdict"] == "more":
        mean, low, high = max(mean, 0), max(low, 0), max(high, 0)
    elif row["verdict"] == "less":
        mean, low, high = min(mean, 0), min(low, 0), min(high, 0)
    else:
        low, high = min(low, 0), max(high, 0)
    close = lambda text, x: (text == "" and math.isinf(x)) or float(text) == pytest.approx(x, abs=1e-9)  # noqa: E731
    assert close(row["difference"], mean) and close(row["low"], low) and close(row["high"], high), (row, expected)


@pytest.mark.parametrize("number", range(STUDIES))
def test_every_figure_is_that_of_scipy(regrasp, base, tmp_path, number):
    folder = tmp_path / "study"
    shutil.copytree(base, folder)
    lines = [json.loads(line) for line in (folder / "runs.jsonl").read_text().splitlines()]
    runs = random_runs(lines, random.Random(number))
    (folder / "runs.jsonl").write_text("".join(json.dumps(run) + "\n" for run in runs))
    pairs = ["baseline", "all"][number % 2]
    words = ["--pairs", pairs, "--measures", "solved,planning,memory,regrasps,margin"]
    regrasp("compare", "sphere", *WORDS, *words, "-o", folder)
    by_key = {(run["variant"], run["seed"]): run for run in runs}
    horizon = max(run["times"]["planning_s"] for run in runs)
    with open(folder / "comparisons.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 5 * ({"baseline": 3, "all": 6}[pairs] + 3)
    for row in rows:
        check_row(row, by_key, horizon)
    # The correction is over those that could show anything: six seeds on which the two differ.
    able = [row for row in rows if int(row["more"]) + int(row["less"]) >= 6]
    foremost = [row["measure"] in ("solved", "planning_s") for row in able]
    for row, corrected in zip(able, holm([float(row["p"]) for row in able], foremost)):
        assert float(row["p_holm"]) == pytest.approx(corrected, rel=1e-9)
    for row in rows:
        assert (float(row["p_holm"]) < 0.05) == (row["verdict"] in ("more", "less"))
    summary = (folder / "summary.md").read_text()
    for row in rows:
        assert (row["says"] in summary) if row["says"] else True
        assert bool(row["says"]) == (row["verdict"] in ("more", "less"))

