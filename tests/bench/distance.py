"""Lookups without a focus distance, on the lenses that Lensfun has at several distances.

Queried are lenses, focal lengths and apertures with rows at several distances whose curves differ. Truth: M in the
corner at the distances of photographs, USUAL, down to the lens's nearest row, linear in 1/D between its rows; the
farthest row applies to everything beyond. Errors are root mean squares over these distances, weighted by their shares,
and over the settings. Each setting is queried without a distance in these ways:

there      all rows are in the database: the error comes from the distance alone
left out   all rows of the focal length and aperture are removed
one        per focal length and aperture of the lens, only the farthest row is in the database
one, left out: both

LONE_DISTANCE_SIGMA of lookup_distance.c is the limit for 68 of 100 errors of `one`, with equal weight per lens.
"""
import collections

import numpy as np

import lensprof as lp
from report import header, row

USUAL = ((np.inf, 10.0, 5.0, 3.0, 1.5, 0.7, 0.3), (0.25, 0.2, 0.19, 0.14, 0.11, 0.08, 0.03))  # as in lookup_distance.c
ALL_RULES = ("usual", "weakest", "farthest")
RULES = {"there": ALL_RULES, "left out": ALL_RULES, "one": ("usual",), "one, left out": ("usual",)}
SAME_DISTANCE = 0.95  # ratio of distances up to which a row counts as at this distance

Answer = collections.namedtuple("Answer", "way rule share error sigma")


class Undo(Exception):
    """Ends a transaction without storing it."""


def corner(one):
    return 1.0 + sum(one.k)


def groups_of(rows):
    """Rows of each focal length and aperture, nearest first."""
    groups = collections.defaultdict(list)
    for one in rows:
        groups[one.setting[:2]].append(one)
    return [sorted(group, key=lambda one: one.setting[2]) for group in groups.values()]


def has_several(group):
    return len({one.setting[2] for one in group}) > 1 and len({one.k for one in group}) > 1


def truth(group):
    """-> (shares, M in the corner) at the usual distances that the lens can focus."""
    by_distance = {one.setting[2]: corner(one) for one in group}
    near = 1.0 / np.array(sorted(by_distance, reverse=True))  # ascending
    values = np.array([by_distance[d] for d in sorted(by_distance, reverse=True)])
    distances, shares = (np.array(column) for column in USUAL)
    reached = distances >= SAME_DISTANCE * min(by_distance)
    return shares[reached] / shares[reached].sum(), np.interp(1.0 / distances[reached], near, values)


def ask(store, group, way):
    key = group[0].key.copy()
    key.distance_m = lp.UNKNOWN
    shares, values = truth(group)
    for rule in RULES[way]:
        try:
            profile, how = store.lookup(key, lp.LookupOptions(distance_rule=lp.DistanceRule[rule.upper()]))
        except lp.Error as error:
            if error.status != lp.Status.ERROR_NOT_FOUND:
                raise
            continue
        answered = 1.0 + sum(profile.vignetting[0].k)
        yield Answer(way, rule, shares, answered - values, how.sigma)


def without(store, removed, groups, way):
    """Lookups with some rows removed, which are restored afterwards."""
    answers = []
    try:
        with store.transaction():
            for one in removed:
                store.remove(one.id)
            for group in groups:
                answers += ask(store, group, way)
            raise Undo
    except Undo:
        return answers


def ask_lens(store, rows):
    """-> answers for all its settings with several distances."""
    groups = groups_of(rows)
    asked = [group for group in groups if has_several(group)]
    if not asked:
        return []
    answers = [answer for group in asked for answer in ask(store, group, "there")]
    for group in asked:
        answers += without(store, group, [group], "left out")
    nearer = [one for group in groups for one in group[:-1]]
    answers += without(store, nearer, asked, "one")
    for group in asked:
        answers += without(store, {one.id: one for one in nearer + group}.values(), [group], "one, left out")
    return answers


def cells(answers):
    """RMS, bias, and how often the truth is within 1 and 2 stated standard errors."""
    shares = np.concatenate([answer.share for answer in answers]) / len(answers)
    errors = np.concatenate([answer.error for answer in answers])
    stated = np.concatenate([np.full(len(answer.error), answer.sigma) for answer in answers])
    held = ["%.1f %%" % (100.0 * shares @ (np.abs(errors) <= limit * stated)) for limit in (1.0, 2.0)]
    return "%.4f" % np.sqrt(shares @ errors ** 2), "%+.4f" % (shares @ errors), *held


def lone_sigma(lenses):
    """The limit for 68 of 100 errors if one distance is known; lenses: answers per lens."""
    of = [[a for a in answers if (a.way, a.rule) == ("one", "usual")] for answers in lenses]
    shares = np.concatenate([a.share / len(answers) for answers in of for a in answers])
    errors = np.abs(np.concatenate([a.error for answers in of for a in answers]))
    order = np.argsort(errors)
    return errors[order][np.searchsorted(np.cumsum(shares[order]), 0.68 * shares.sum())]


def document(halves):
    """halves: {name: answers per lens}"""
    lines = ["", "Unknown focus distance: error of M in the corner over the distances of photographs.", ""]
    lines += header("lenses", "number", "rows", "rule", "settings", "RMS", "bias", "within 1 sigma", "2 sigma")
    for name, lenses in halves.items():
        for way, rules in RULES.items():
            for rule in rules:
                of = [a for answers in lenses for a in answers if (a.way, a.rule) == (way, rule)]
                lines.append(row(name, len(lenses), way, rule, len(of), *cells(of)))
    sigmas = ", ".join("%s %.4f" % (name, lone_sigma(lenses)) for name, lenses in halves.items())
    return "\n".join(lines + ["", "If one distance is known, 68 of 100 errors are below: " + sigmas]) + "\n"
