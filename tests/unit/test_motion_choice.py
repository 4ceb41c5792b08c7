"""The search for a set of records, against every set there is."""

from itertools import combinations

import numpy as np
import pytest

from rockflex.motion._selection import SelectionProblem, best_set, misfit


def random_choice(seed, n_records=12, weight=0.0, group_limits=()):
    rng = np.random.default_rng(seed)
    walks = np.cumsum(rng.normal(scale=0.1, size=(n_records, 25)), axis=1)
    return SelectionProblem(np.exp(walks - walks.mean(axis=1, keepdims=True)), weight, group_limits)


def plain(choice, chosen):
    """What is minimised, written out."""
    rows = [choice.spectra[i] for i in chosen]
    mean = np.mean(np.log(np.mean(rows, axis=0)) ** 2)
    own = np.mean([np.mean(np.log(row) ** 2) for row in rows])
    return (1.0 - choice.record_weight) * mean + choice.record_weight * own


def within(choice, chosen):
    found = [[groups[i] for i in chosen if groups[i] is not None] for groups, _ in choice.group_limits]
    return all(
        found_in.count(group) <= most
        for found_in, (_, most) in zip(found, choice.group_limits, strict=True)
        for group in found_in
    )


def test_the_objective():
    choice = random_choice(3, weight=0.3)
    assert choice.objective_of([1, 4, 7]) == pytest.approx(plain(choice, [1, 4, 7]), rel=1e-12)
    assert misfit(np.exp([[3.0, 4.0]])) == pytest.approx([np.sqrt(12.5)], rel=1e-14)


@pytest.mark.parametrize("weight", [0.0, 0.4, 1.0])
def test_near_the_best_of_all_sets(weight):
    for seed in range(12):
        choice = random_choice(seed, weight=weight)
        for n in (1, 2, 4):
            best = min(plain(choice, each) for each in combinations(range(12), n))
            found = best_set(choice, n)
            assert found == sorted(set(found))
            assert len(found) == n
            # Exchanges of one record stop at the best set in nearly all cases, otherwise close to it.
            assert np.sqrt(choice.objective_of(found)) <= 1.3 * np.sqrt(best)
            if weight == 1.0 or n == 1:
                assert choice.objective_of(found) == pytest.approx(best, rel=1e-12)


def test_no_exchange_of_one_record_helps():
    for seed in range(8):
        choice = random_choice(seed, 20)
        found = best_set(choice, 5)
        for i in found:
            for other in set(range(20)) - set(found):
                assert plain(choice, [*(set(found) - {i}), other]) >= choice.objective_of(found) * (1.0 - 1e-9)


def test_group_limits_hold():
    events, stations = list("aaaaaabbbccc"), [1, 2, None, 1, 2, None, 1, 2, None, 1, 2, None]
    for seed in range(8):
        choice = random_choice(seed, group_limits=((events, 2), (stations, 1)))
        found = best_set(choice, 4)
        assert within(choice, found)
        best = min(plain(choice, each) for each in combinations(range(12), 4) if within(choice, each))
        assert np.sqrt(choice.objective_of(found)) <= 1.3 * np.sqrt(best)
    choice = random_choice(0, group_limits=((events, 1),))
    assert len(best_set(choice, 5)) == 3
    assert len(best_set(choice, 3)) == 3


def test_all_records_may_be_chosen():
    assert best_set(random_choice(1, 6), 6) == list(range(6))


def test_the_same_records_give_the_same_set():
    assert best_set(random_choice(5, 30), 7) == best_set(random_choice(5, 30), 7)
    equal = SelectionProblem(np.ones((6, 4)), 0.0, ())
    assert best_set(equal, 2) == [0, 1]
