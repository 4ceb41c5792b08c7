"""Records chosen and scaled for a target spectrum, and the search against every set there is."""

import dataclasses
import math
from itertools import combinations

import numpy as np
import pytest

import rockflex as rf
from rockflex.motion._selection import SelectionProblem, best_record_set, log_spectrum_misfit

SUITE = rf.load_suite("fema-p695-far-field")
TARGET = rf.ec8_spectrum(2.5, "C")
RANGE = (0.2, 2.0)
PERIODS = np.geomspace(0.2, 2.0, 50)
BOTH = "scaled_to needs either a target and periods, or sa and period"


def fitted(motion, target=TARGET):
    """Factor and scaled spectrum with the least mean square of logarithms."""
    sa = motion.spectrum(PERIODS, target.damping_ratio).sa
    factor = math.exp(np.mean(np.log(target.at(PERIODS)) - np.log(sa)))
    return factor, factor * sa


def test_one_motion_to_an_ordinate():
    motion = SUITE[3]
    assert motion.scaled_to(sa=4.0, period=0.8).sa(0.8) == pytest.approx(4.0, rel=1e-12)
    assert motion.scaled_to(sa=4.0, period=0.8, damping_ratio=0.02).sa(0.8, 0.02) == pytest.approx(4.0, rel=1e-12)
    assert motion.scaled_to(sa=4.0, period=0.0).pga == pytest.approx(4.0, rel=1e-12)


def test_one_motion_to_a_target():
    motion = SUITE[3]
    factor, _ = fitted(motion)
    scaled = motion.scaled_to(TARGET, RANGE)
    assert scaled.name == motion.name
    np.testing.assert_allclose(scaled.acceleration, factor * motion.acceleration, rtol=1e-12)
    damped = TARGET.scaled(1.0)
    damped = rf.TargetSpectrum(damped.periods, damped.sa, 0.1)
    ratio = motion.scaled_to(damped, [0.3, 0.5, 1.0]).spectrum([0.3, 0.5, 1.0], 0.1).sa / damped.at([0.3, 0.5, 1.0])
    assert np.mean(np.log(ratio)) == pytest.approx(0.0, abs=1e-12)


def test_both_components_of_a_motion_are_scaled():
    both = SUITE[0].with_vertical(SUITE[1].acceleration)
    scaled = both.scaled_to(sa=1.0, period=1.0)
    np.testing.assert_allclose(scaled.vertical / both.vertical, 1.0 / both.sa(1.0), rtol=1e-12)


def test_every_motion_of_a_suite():
    few = SUITE[:3].scaled_to(TARGET, RANGE)
    assert few.names == SUITE[:3].names
    assert few.name == SUITE.name
    for one, other in zip(few, SUITE, strict=False):
        np.testing.assert_allclose(one.acceleration, fitted(other)[0] * other.acceleration, rtol=1e-12)
    assert [each.sa(1.0) for each in SUITE[:3].scaled_to(sa=2.0, period=1.0)] == pytest.approx([2.0] * 3, rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({}, BOTH),
        ({"target": TARGET}, BOTH),
        ({"sa": 1.0}, BOTH),
        ({"target": TARGET, "periods": RANGE, "sa": 1.0}, BOTH),
        ({"target": TARGET, "periods": RANGE, "damping_ratio": 0.05}, BOTH),
        ({"target": TARGET, "sa": 1.0, "period": 1.0}, BOTH),
        ({"target": TARGET, "periods": (2.0, 0.2)}, r"periods must be a range such as \(0.2, 2.0\), but \(2, 0.2\)"),
        ({"target": TARGET, "periods": [0.0, 1.0]}, r"but \(0, 1\) was given. Two periods are the ends of a range"),
        ({"target": TARGET, "periods": []}, r"periods must be the two ends of a range, or increasing .* but \[\] was"),
        ({"target": TARGET, "periods": [0.1, 0.3, 0.3]}, "periods must be the two ends of a range, or increasing"),
        ({"target": TARGET, "periods": (1.0, 5.0)}, "is known from 0 to 4 s, but not at "),
    ],
)
def test_scaling_refuses(arguments, text):
    with pytest.raises(rf.InputError, match=text):
        SUITE[0].scaled_to(**arguments)


def test_a_quiet_motion_cannot_be_scaled():
    quiet = rf.GroundMotion(np.zeros(50), 0.01, "still")
    for call in (lambda: quiet.scaled_to(sa=1.0, period=1.0), lambda: rf.Suite([quiet]).select(TARGET, 1, RANGE)):
        with pytest.raises(rf.InputError, match="The motion 'still' cannot be scaled to a spectrum: its own is 0 m/s²"):
            call()


def test_selection_is_what_it_says():
    chosen = SUITE.select(TARGET, 5, RANGE)
    np.testing.assert_allclose(chosen.periods, PERIODS, rtol=1e-14)
    aim = TARGET.at(PERIODS)
    for (name,), factor, row, motion in zip(chosen.names, chosen.factors, chosen.sa, chosen.suite, strict=True):
        expected, spectrum = fitted(SUITE[name])
        assert factor == pytest.approx(expected, rel=1e-12)
        np.testing.assert_allclose(row, spectrum, rtol=1e-11)
        np.testing.assert_allclose(motion.acceleration, factor * SUITE[name].acceleration, rtol=1e-14)
        assert motion.metadata == dataclasses.replace(SUITE[name].metadata, scale=factor)
    rows = chosen.sa
    np.testing.assert_allclose(chosen.mean, rows.sum(axis=0) / 5, rtol=1e-12)
    np.testing.assert_allclose(chosen.median, np.prod(rows, axis=0) ** 0.2, rtol=1e-12)
    deviation = np.log(rows) - np.log(rows).mean(axis=0)
    np.testing.assert_allclose(chosen.dispersion, np.sqrt((deviation**2).sum(axis=0) / 4), rtol=1e-10)
    np.testing.assert_allclose(chosen.misfits, [np.sqrt(np.mean(np.log(row / aim) ** 2)) for row in rows], rtol=1e-10)
    assert chosen.misfit == pytest.approx(np.sqrt(np.mean(np.log(chosen.mean / aim) ** 2)), rel=1e-10)
    assert chosen.least_ratio == pytest.approx(np.min(chosen.mean / aim), rel=1e-12)
    ground = np.mean([motion.pga for motion in chosen.suite]) / TARGET.at([0.0])[0]
    assert chosen.zero_period_ratio == pytest.approx(ground, rel=1e-12)
    np.testing.assert_allclose(chosen.at(PERIODS), rows, rtol=1e-10)


def test_selection_against_every_set():
    few = SUITE[:12]
    spectra = [fitted(motion)[1] / TARGET.at(PERIODS) for motion in few]
    best = min(np.sqrt(np.mean(np.log(np.mean(rows, axis=0)) ** 2)) for rows in combinations(spectra, 4))
    assert few.select(TARGET, 4, RANGE).misfit == pytest.approx(best, rel=1e-9)


def test_selection_of_single_periods_and_of_one_record():
    chosen = SUITE.select(TARGET, 1, [0.0, 0.5, 1.0])
    assert chosen.periods.tolist() == [0.0, 0.5, 1.0]
    assert np.isnan(chosen.dispersion).all()
    assert chosen.misfit == pytest.approx(chosen.misfits[0], rel=1e-12)
    table = rf.TargetSpectrum([0.1, 3.0], [5.0, 1.0])
    assert math.isnan(SUITE.select(table, 2, RANGE).zero_period_ratio)


def test_weight_of_the_records():
    ranked = sorted(SUITE, key=lambda motion: np.mean(np.log(fitted(motion)[1] / TARGET.at(PERIODS)) ** 2))
    chosen = SUITE.select(TARGET, 6, RANGE, record_weight=1.0)
    assert set(chosen.suite.names) == {motion.name for motion in ranked[:6]}
    assert chosen.misfit >= SUITE.select(TARGET, 6, RANGE).misfit


def test_limits_of_the_factors():
    weak = TARGET.scaled(0.1)
    chosen = SUITE.select(weak, 6, RANGE, scale_limits=(0.5, 2.0))
    assert (chosen.factors >= 0.5).all()
    assert 0.5 in chosen.factors
    assert (chosen.sa.mean(axis=1) > weak.at(PERIODS).mean()).any()


def test_one_record_of_an_earthquake_or_a_station():
    chosen = SUITE.select(TARGET, 10, RANGE, per_event=1)
    events = [motion.metadata.event for motion in chosen.suite]
    assert len(set(events)) == 10
    chosen = SUITE.select(TARGET, 12, RANGE, per_station=1)
    assert len({motion.metadata.station for motion in chosen.suite}) == 12
    unknown = rf.Suite(dataclasses.replace(motion, metadata=None) for motion in SUITE)
    assert len(unknown.select(TARGET, 30, RANGE, per_event=1).suite) == 30
    with pytest.raises(rf.InputError) as caught:
        SUITE.select(TARGET, 30, RANGE, per_event=1, per_station=1)
    n_events = len({(motion.metadata.event, motion.metadata.year) for motion in SUITE})
    assert f"with per_event=1 and per_station=1 only {n_events} of 44 can be chosen" in str(caught.value)


@pytest.mark.slow
def test_the_mean_reaches_the_target():
    plain = SUITE.select(TARGET, 7, RANGE)
    raised = SUITE.select(TARGET, 7, RANGE, least_ratio=1.1)
    assert raised.least_ratio == pytest.approx(1.1, rel=1e-12)
    np.testing.assert_allclose(raised.factors / plain.factors, 1.1 / plain.least_ratio, rtol=1e-12)
    assert SUITE.select(TARGET, 7, RANGE, least_ratio=0.1) == plain
    with pytest.raises(rf.InputError, match=r"at least 9 of the target, factors up to .* scale_limits end at 4"):
        SUITE.select(TARGET, 7, RANGE, least_ratio=9.0)


@pytest.mark.parametrize("measure", ["geometric mean", "rotd50", "rotd100"])
def test_pairs(measure):
    few = SUITE[:12]
    periods = [0.2, 0.5, 1.0]
    chosen = few.select(TARGET, 3, periods, measure=measure)
    assert len(chosen.names) == 3
    assert len(chosen.suite) == 6
    for (first, second), factor, row in zip(chosen.names, chosen.factors, chosen.sa, strict=True):
        assert first[:-1] == second[:-1]
        spectrum = rf.rotated_spectrum(few[first], few[second], periods)
        ordinates = {
            "geometric mean": np.sqrt(few[first].spectrum(periods).sa * few[second].spectrum(periods).sa),
            "rotd50": spectrum.rotd50,
            "rotd100": spectrum.rotd100,
        }[measure]
        np.testing.assert_allclose(row, factor * ordinates, rtol=1e-10)
        assert np.mean(np.log(row / TARGET.at(periods))) == pytest.approx(0.0, abs=1e-10)
        for name in (first, second):
            np.testing.assert_allclose(chosen.suite[name].acceleration, factor * few[name].acceleration, rtol=1e-14)
    np.testing.assert_allclose(chosen.at(periods), chosen.sa, rtol=1e-10)
    assert chosen.table()["record"].tolist() == [" + ".join(names) for names in chosen.names]


def test_what_is_a_pair():
    def named(name, info=None, dt=0.01):
        return rf.GroundMotion(SUITE[0].acceleration, dt, name, info)

    station = {"event": "E", "year": 1999, "station": "S"}
    motions = [
        named("x", rf.RecordInfo(rsn=7)),
        named("y", rf.RecordInfo(**station)),
        named("ABC-NS"),
        named("G1230"),
        named("z", rf.RecordInfo(rsn=7)),
        named("w", rf.RecordInfo(**station)),
        named("abc-EW"),
        named("G1320"),
    ]
    odd = [named("alone"), named("D-N", dt=0.01), named("D-E", dt=0.02), *map(named, ("T1", "T2", "T3"))]
    with pytest.warns(rf.RecordWarning) as caught:
        chosen = rf.Suite([*motions, *odd]).select(TARGET, 4, [0.5], measure="rotd50")
    assert chosen.names == (("x", "z"), ("y", "w"), ("ABC-NS", "abc-EW"), ("G1230", "G1320"))
    assert "6 motions that are not one of two components" in str(caught[0].message)
    assert "alone, D-N, D-E, T1, T2 and 1 more" in str(caught[0].message)
    with pytest.warns(rf.RecordWarning, match="1 motion that is not one of two components .* alone"):
        rf.Suite([*motions, named("alone")]).select(TARGET, 4, [0.5], measure="rotd50")


def test_tables():
    chosen = SUITE.select(TARGET, 3, RANGE)
    table = chosen.table()
    assert table.columns.tolist() == [
        "record", "event", "year", "magnitude", "distance_km", "vs30", "station", "factor", "misfit", "least_ratio",
        "largest_ratio",
    ]  # fmt: skip
    assert table["record"].tolist() == list(chosen.suite.names)
    assert table["year"].tolist() == [motion.metadata.year for motion in chosen.suite]
    np.testing.assert_array_equal(table["factor"], chosen.factors)
    np.testing.assert_array_equal(table["misfit"], chosen.misfits)
    assert table["least_ratio"].tolist() == [row.min() for row in chosen.sa / TARGET.at(PERIODS)]
    assert table["largest_ratio"].tolist() == [row.max() for row in chosen.sa / TARGET.at(PERIODS)]
    spectra = chosen.spectra()
    assert spectra.columns.tolist() == ["period", "target", "mean", "median", "dispersion", *chosen.suite.names]
    np.testing.assert_array_equal(spectra[chosen.suite.names[1]], chosen.sa[1])
    np.testing.assert_array_equal(spectra["target"], TARGET.at(chosen.periods))
    nameless = rf.Suite(rf.GroundMotion(each.acceleration, each.dt, each.name) for each in SUITE[:2])
    assert nameless.select(TARGET, 1, RANGE).table()["event"].tolist() == [None]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"n": 45}, "n must be at most 44, the number of records, but 45 was given"),
        ({"n": 23, "measure": "rotd50"}, "n must be at most 22, the number of pairs, but 23 was given"),
        ({"measure": "srss"}, "measure must be one of 'component', 'geometric mean', 'rotd50', 'rotd100', but 'srss'"),
        ({"scale_limits": (2.0, 1.0)}, "scale_limits must be the smallest and the largest factor, both positive"),
        ({"scale_limits": (0.0, 1.0)}, "scale_limits must be the smallest and the largest factor"),
        ({"record_weight": 1.1}, r"record_weight must lie in \[0, 1\]"),
    ],
)
def test_select_refuses(arguments, text):
    with pytest.raises(rf.InputError, match=text):
        SUITE.select(**{"target": TARGET, "n": 3, "periods": [0.5, 1.0, 2.0]} | arguments)


def test_select_refuses_suites_without_pairs_and_vertical_motions():
    with pytest.raises(rf.InputError, match='measure="rotd50" needs the two horizontal components'):
        rf.load_suite("el-centro-1940").select(TARGET, 1, RANGE, measure="rotd50")
    upright = dataclasses.replace(SUITE[0], metadata=rf.RecordInfo(direction="vertical"))
    with pytest.raises(rf.InputError, match="A horizontal ground motion is expected"):
        rf.Suite([upright]).select(TARGET, 1, RANGE)


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
    assert log_spectrum_misfit(np.exp([[3.0, 4.0]])) == pytest.approx([np.sqrt(12.5)], rel=1e-14)


@pytest.mark.parametrize(
    ("n_records", "n", "weight", "seeds"),
    [
        *((12, n, weight, range(12)) for n in (1, 2, 4) for weight in (0.0, 0.4, 1.0)),
        # The misfits of the records count a little: a search that takes them for something else misses the best set.
        (16, 5, 0.05, [1]),
        (20, 4, 0.05, [16]),
    ],
)
def test_the_best_of_all_sets_is_found(n_records, n, weight, seeds):
    """As here nearly always, though exchanges of one record may stop at another set that none of them improves."""
    sets = np.array(list(combinations(range(n_records), n)))
    for seed in seeds:
        choice = random_choice(seed, n_records, weight=weight)
        squares = np.mean(np.log(choice.spectra) ** 2, axis=1)
        mean = np.mean(np.log(choice.spectra[sets].mean(axis=1)) ** 2, axis=1)
        best = sets[np.argmin((1.0 - weight) * mean + weight * squares[sets].mean(axis=1))]
        assert best_record_set(choice, n) == best.tolist(), seed


def test_no_exchange_of_one_record_helps():
    for seed in range(8):
        choice = random_choice(seed, 20)
        found = best_record_set(choice, 5)
        for i in found:
            for other in set(range(20)) - set(found):
                assert plain(choice, [*(set(found) - {i}), other]) >= choice.objective_of(found) * (1.0 - 1e-9)


def test_group_limits_hold():
    events, stations = list("aaaaaabbbccc"), [1, 2, None, 1, 2, None, 1, 2, None, 1, 2, None]
    for seed in range(8):
        choice = random_choice(seed, group_limits=((events, 2), (stations, 1)))
        found = best_record_set(choice, 4)
        assert within(choice, found)
        best = min(plain(choice, each) for each in combinations(range(12), 4) if within(choice, each))
        assert np.sqrt(choice.objective_of(found)) <= 1.3 * np.sqrt(best)
    choice = random_choice(0, group_limits=((events, 1),))
    assert len(best_record_set(choice, 5)) == 3
    assert len(best_record_set(choice, 3)) == 3


def test_all_records_may_be_chosen():
    assert best_record_set(random_choice(1, 6), 6) == list(range(6))


def test_the_same_records_give_the_same_set():
    assert best_record_set(random_choice(5, 30), 7) == best_record_set(random_choice(5, 30), 7)
    equal = SelectionProblem(np.ones((6, 4)), 0.0, ())
    assert best_record_set(equal, 2) == [0, 1]
