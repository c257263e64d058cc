"""Rank correlations of the studies, beside scipy's."""

import numpy as np
from scipy import stats

import ranks


def test_they_are_scipys():
    random = np.random.default_rng(0)
    for _ in range(20):
        a, b = random.integers(0, 6, size=40).astype(float), random.normal(size=40)
        assert abs(ranks.spearman(a, b) - stats.spearmanr(a, b).statistic) < 1e-12
        good, bad = a[:15], a[15:]
        by_scipy = stats.mannwhitneyu(good, bad).statistic / (len(good) * len(bad))
        assert abs(ranks.chance(good, bad) - by_scipy) < 1e-12


def test_what_says_nothing_is_no_number():
    assert np.isnan(ranks.spearman([1.0, 1.0, 1.0], [1.0, 2.0, 3.0]))
    assert np.isnan(ranks.chance([], [1.0]))


def test_worst_of_all_ranks_below_numbers():
    assert list(ranks.ranks([-np.inf, 3.0, -np.inf])) == [0.5, 2.0, 0.5]


def test_bootstrap_means_surround_the_mean():
    random = np.random.default_rng(1)
    groups = [random.normal(1.0, 1.0, size=(50, 1)), random.normal(3.0, 1.0, size=(50, 1))]
    mean, samples = ranks.means(groups, [lambda g: g[:, 0].mean()], random)
    low, high = ranks.interval(samples[:, 0])
    assert low < mean[0] < high and abs(mean[0] - 2.0) < 0.4 and 0.2 < high - low < 0.8
