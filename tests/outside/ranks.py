"""Rank correlations, and intervals by bootstrap."""

import numpy as np

SAMPLES = 2000


def ranks(values):
    """Ranks from 0 on, equal values sharing their mean rank."""
    values = np.asarray(values, float)
    order = np.argsort(values, kind="stable")
    ordered = values[order]
    first = np.flatnonzero(np.r_[True, ordered[1:] != ordered[:-1]])
    counts = np.diff(np.r_[first, len(values)])
    shared = np.repeat(first + (counts - 1) / 2, counts)
    found = np.empty(len(values))
    found[order] = shared
    return found


def spearman(a, b):
    """Spearman's ρ; NaN where one of the two is constant."""
    a, b = ranks(a), ranks(b)
    a, b = a - a.mean(), b - b.mean()
    size = np.sqrt((a @ a) * (b @ b))
    return a @ b / size if size > 0 else np.nan


def chance(good, bad):
    """How often a value of the good ones is above one of the bad ones, equal ones counted half."""
    if not len(good) or not len(bad):
        return np.nan
    both = ranks(np.r_[good, bad])[: len(good)]
    return (both.sum() - len(good) * (len(good) - 1) / 2) / (len(good) * len(bad))


def interval(samples):
    """The middle 95 %."""
    low, high = np.nanquantile(samples, [0.025, 0.975])
    return low, high


def means(groups, measures, random):
    """Means over the groups of every measure: as they are, and in each bootstrap sample of the groups' rows.

    A group is an array whose rows are resampled; a measure takes such an array.
    """
    of = lambda drawn: [np.nanmean([measure(group) for group in drawn]) for measure in measures]
    drawn = lambda: [group[random.integers(len(group), size=len(group))] for group in groups]
    return np.array(of(groups)), np.array([of(drawn()) for _ in range(SAMPLES)])
