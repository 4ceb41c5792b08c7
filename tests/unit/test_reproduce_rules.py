"""The rules by which a printed number reproduces, and what remarks rest on."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024 import _comparison as compare
from rockflex.papers.silva_stojadinovic_2024._comparison import (
    MAX_INTERVAL_WIDTH,
    RemarkKind,
    ResampledInterval,
    Verdict,
    printed_range,
)
from rockflex.papers.silva_stojadinovic_2024._inputs import TOWER
from rockflex.papers.silva_stojadinovic_2024._section_3_2 import friction_intervals
from rockflex.papers.silva_stojadinovic_2024._section_4 import (
    RITZ,
    first_frequency_by_elements,
    mixed_element_modes,
    ritz_modes_with_slices,
)


@pytest.mark.parametrize(
    ("printed", "low", "high"),
    [
        ("1.66", 1.655, 1.665),
        ("−0.24", -0.245, -0.235),
        ("-13", -13.5, -12.5),
        ("0.90", 0.895, 0.905),
        ("about 44", 43.5, 44.5),
        ("approximately 2", 1.6, 2.4),
        ("≈ 0.05", 0.045, 0.055),
        ("24'178'750", 24178749.5, 24178750.5),
        ("24 178 750", 24178749.5, 24178750.5),
        ("580000/3", 579999.5 / 3, 580000.5 / 3),
        ("+15", 14.5, 15.5),
    ],
)
def test_a_value_stands_for_what_rounds_to_it(printed, low, high):
    found = printed_range(printed)
    assert (found.low, found.high) == pytest.approx((low, high), rel=1e-12)
    assert not found.is_bound
    width = high - low
    for inside in (low, high, 0.5 * (low + high)):
        assert inside in found
    for outside in (low - 1e-6 * width, high + 1e-6 * width, math.nan, math.inf):
        assert outside not in found


@pytest.mark.parametrize(
    ("printed", "inside", "outside"),
    [
        ("≤ 3.2", (3.2, -5.0), (3.2000001, math.inf)),
        ("< 5", (4.999,), (5.0, 5.1)),
        ("> 2", (2.001, math.inf), (2.0, 1.0, -math.inf)),
        ("≥ 1.0", (1.0, 7.0), (0.999,)),
    ],
)
def test_bounds(printed, inside, outside):
    found = printed_range(printed)
    assert found.is_bound
    assert all(value in found for value in inside)
    assert not any(value in found for value in (*outside, math.nan))


def test_digits_may_be_cut_off_away_from_zero_only():
    positive, negative = printed_range("17.25", truncated=True), printed_range("−1.18", truncated=True)
    assert 17.2599 in positive
    assert 17.2449 not in positive
    assert -1.1899 in negative
    assert -1.1749 not in negative
    assert 17.2599 not in printed_range("17.25")


@pytest.mark.parametrize("printed", ["", "large", "1.2.3", "1.66 m", "8.485e6", "> large", "3 to 5"])
def test_what_is_no_number_is_refused(printed):
    with pytest.raises(rf.InputError) as raised:
        printed_range(printed)
    message = str(raised.value)
    assert "must read like '1.66', 'about 44', '580000/3' or '≤ 3.2'" in message
    assert repr(printed) in message


@given(st.floats(-1e4, 1e4), st.integers(0, 6))
def test_every_number_reproduces_its_own_rounding_and_not_the_next(value, decimals):
    printed = f"{value:.{decimals}f}"
    step = 10.0**-decimals
    assert compare.number("x", "y", printed, value).verdict is Verdict.REPRODUCED
    for off in (1.01, -1.01):
        line = compare.number("x", "y", printed, float(printed) + off * step)
        assert line.verdict is Verdict.NOT
        assert line.difference == pytest.approx(off * step, rel=1e-6, abs=1e-10)


def test_a_wrong_number_does_not_come_out_as_reproduced():
    line = compare.number("ω_1", "Section 4.1.1", "1.678", 1.65568, "rad/s")
    assert line.verdict is Verdict.NOT
    assert str(line.verdict) == "does not reproduce"
    assert line.difference == pytest.approx(-0.02232)
    assert line.difference_as_text == "−0.02232 (−1.3 %)"
    assert line.ours_as_text == "1.65568"
    assert compare.number("ω_1", "", "1.66", 1.65568).verdict is Verdict.REPRODUCED
    assert compare.number("ω_1", "", "1.66", math.nan).verdict is Verdict.NOT


@pytest.mark.parametrize(
    ("printed", "ours", "verdict"),
    [
        ("approximately 2", 2.48, Verdict.NOT),
        ("approximately 2", 2.39, Verdict.REPRODUCED),
        ("approximately 2", 1.55, Verdict.NOT),
        ("2", 2.48, Verdict.REPRODUCED),
        ("≈ 0.01", 0.0112, Verdict.REPRODUCED),
        ("≈ 0.01", 0.0121, Verdict.NOT),
        ("about 44", 44.4, Verdict.REPRODUCED),
        ("about 44", 45.0, Verdict.NOT),
    ],
)
def test_about_so_much_has_a_tolerance_that_the_line_states(printed, ours, verdict):
    line = compare.number("ratio", "Section 4.2", printed, ours)
    assert line.verdict is verdict
    assert ("20 %" in line.criterion) == (printed != "2")


@pytest.mark.parametrize(
    ("ours", "agreed", "verdict"),
    [
        (0.09, Verdict.REPRODUCED, Verdict.REPRODUCED),
        (0.09, Verdict.EQUIVALENT, Verdict.EQUIVALENT),
        (0.33, Verdict.REPRODUCED, Verdict.JUDGEMENT),
        (0.33, Verdict.EQUIVALENT, Verdict.JUDGEMENT),
    ],
)
def test_words_of_degree_that_miss_our_reading_are_the_authors_judgement(ours, agreed, verdict):
    line = compare.judgement("rise", "Section 3.4", "about 1", ours, "< 0.1", "%", agreed=agreed, note="at 1")
    assert line.verdict is verdict
    assert (line.criterion, line.note) == ("< 0.1", "0.1 % is our reading; at 1")


@pytest.mark.parametrize("ours", [0.05, 0.0784])
def test_what_an_assumed_parameter_decides_is_not_judged(ours):
    line = compare.assumed(compare.number("u_top", "Section 4.2", "≈ 0.05", ours, "m"), "D_y = 0.035 m")
    assert (line.verdict, line.note) == (Verdict.NOT_GIVEN, "D_y = 0.035 m is assumed")
    assert line.difference == pytest.approx(ours - 0.05)


@pytest.mark.parametrize(
    ("values", "verdict"),
    [
        ([-34.0, -10.0, 8.0], Verdict.UNDECIDED),
        ([-24.0, -21.0, -18.0], Verdict.COMPATIBLE),
        ([-18.0, -10.0, 8.0], Verdict.NOT),
    ],
)
def test_a_sweep_of_unpublished_values_is_an_interval(values, verdict):
    line = compare.swept("change", "Section 3.1", "about −21", -10.0, np.array(values), "%")
    assert line.verdict is verdict
    assert line.criterion.startswith("3 combinations of unpublished values, ")
    assert line.difference == 11.0


@pytest.mark.parametrize(
    ("interval", "weaker", "verdict"),
    [
        ((0.954, 0.980), (0.983, 0.991), Verdict.UNDECIDED),
        ((0.954, 0.980), (0.994, 0.999), Verdict.UNDECIDED),
        ((0.954, 0.980), (0.960, 0.983), Verdict.NOT),
        ((0.980, 0.987), (0.960, 0.983), Verdict.COMPATIBLE),
        ((0.954, 0.980), None, Verdict.NOT),
    ],
)
def test_the_strength_of_the_records_decides_where_weaker_ones_do_not_miss(interval, weaker, verdict):
    """Weaker records take a miss back, and never make a value agree."""
    ours = ResampledInterval(0.97, *interval)
    other = None if weaker is None else ResampledInterval(0.987, *weaker)
    line = compare.statistic("R²", "Section 3.3", "0.99", ours, weaker=other)
    bound = compare.tendency("R²", "Section 3.3", "high", ours, "> 0.985", weaker=other)
    assert line.verdict is verdict
    assert ("records times 0.6 decide" in line.criterion) == (verdict is Verdict.UNDECIDED)
    expected = {Verdict.COMPATIBLE: Verdict.UNDECIDED}  # only a part of the interval is above the bound
    assert bound.verdict is expected.get(verdict, verdict)


def test_a_reading_that_records_do_not_meet_is_the_authors_judgement():
    ours = ResampledInterval(0.4, 0.3, 0.5)
    line = compare.tendency("gap", "Section 3.2", "agree well", ours, "< 0.1", reading=True, weaker=ours, note="#2")
    assert (line.verdict, line.note) == (Verdict.JUDGEMENT, "0.1 is our reading; #2")
    near = ResampledInterval(0.1, 0.05, 0.5)
    line = compare.tendency("gap", "Section 3.2", "agree well", ours, "< 0.1", reading=True, weaker=near)
    assert line.verdict is Verdict.UNDECIDED


@pytest.mark.parametrize(("printed", "low", "high"), [("306", 94.0, 124.0), ("306", 290.0, 320.0), ("2", 0.0, 5.0)])
def test_a_count_of_outcomes_under_other_records_is_not_compared(printed, low, high):
    """Neither agreement nor difference is evidence, whatever the interval is."""
    line = compare.count("pairs", "Section 3.3", printed, ResampledInterval(0.5 * (low + high), low, high))
    assert line.verdict is Verdict.INCOMPARABLE
    assert line.difference == 0.5 * (low + high) - float(printed)


def test_ground_of_a_value_that_agrees_and_of_one_that_does_not():
    assert compare.number("B/h", "", "0.16", 0.16, agreed=Verdict.EQUIVALENT).verdict is Verdict.EQUIVALENT
    assert compare.number("μ", "", "0.27", 0.16, agreed=Verdict.EQUIVALENT).verdict is Verdict.NOT


def test_a_value_that_is_cut_off_says_so():
    cut = compare.number("h*_3", "Table 3", "31.40", 31.4076, "m", truncated=True)
    assert (cut.verdict, cut.criterion) == (Verdict.REPRODUCED, "cut off, not rounded, to it")
    rounded = compare.number("h*_1", "Table 3", "141.63", 141.6332, "m", truncated=True)
    assert (rounded.verdict, rounded.criterion) == (Verdict.REPRODUCED, "must round to it")
    assert compare.number("h*_2", "Table 3", "51.33", 51.3422, "m", truncated=True).verdict is Verdict.NOT


@pytest.mark.parametrize(
    ("printed", "low", "high", "verdict"),
    [
        ("0.99", 0.978, 0.988, Verdict.COMPATIBLE),
        ("0.99", 0.994, 0.999, Verdict.COMPATIBLE),
        ("0.99", 0.978, 0.984, Verdict.NOT),
        ("0.99", 0.996, 0.999, Verdict.NOT),
        ("0.99", math.nan, math.nan, Verdict.UNDECIDED),
        ("0.002", 0.0016, 0.0025, Verdict.COMPATIBLE),
        ("0.002", 0.00064, 0.00329, Verdict.UNDECIDED),
        ("0.002", 0.0026, 0.0099, Verdict.NOT),
        ("−10", -12.0, -8.0, Verdict.COMPATIBLE),
        ("−10", -12.0, -6.0, Verdict.UNDECIDED),
    ],
)
def test_statistics_are_judged_by_their_interval_and_its_width(printed, low, high, verdict):
    line = compare.statistic("x", "Section 3.3", printed, ResampledInterval(0.983, low, high))
    assert line.verdict is verdict
    known = not math.isnan(low)
    assert line.criterion.startswith("90 % interval" if known else "too few runs for an interval")
    assert ("wider than half of it" in line.criterion) == (known and verdict is Verdict.UNDECIDED)
    assert line.difference == pytest.approx(0.983 - float(printed.replace("−", "-")))


@given(st.floats(0.1, 100.0), st.floats(0.0, 2.0), st.floats(0.0, 2.0))
def test_a_wider_interval_is_never_compatible_where_a_narrower_one_tells_nothing(value, below, above):
    printed = f"{value:.2f}"
    inner = ResampledInterval(value, value - below * 0.25 * value, value + above * 0.25 * value)
    outer = ResampledInterval(value, inner.low - 0.5 * value, inner.high + 0.5 * value)
    assert compare.statistic("x", "y", printed, outer).verdict is Verdict.UNDECIDED
    narrow = inner.high - inner.low <= MAX_INTERVAL_WIDTH * float(printed)
    assert (compare.statistic("x", "y", printed, inner).verdict is Verdict.COMPATIBLE) == narrow


@pytest.mark.parametrize(
    ("criterion", "low", "high", "verdict"),
    [
        ("> 1", 1.07, 1.36, Verdict.COMPATIBLE),
        ("> 1", 0.97, 1.36, Verdict.UNDECIDED),
        ("> 1", 0.60, 0.97, Verdict.NOT),
        ("≤ 6", 5.0, 6.0, Verdict.COMPATIBLE),
        ("< 5", 0.0, 148.0, Verdict.UNDECIDED),
        ("> 1", math.nan, math.nan, Verdict.UNDECIDED),
    ],
)
def test_a_tendency_must_hold_over_the_whole_interval(criterion, low, high, verdict):
    line = compare.tendency("ratio", "Section 3.2", "more", ResampledInterval(1.2, low, high), criterion)
    assert line.verdict is verdict
    assert line.criterion.startswith(f"{criterion} over the 90 % interval ")
    assert (line.difference, line.difference_as_text) == (None, "")


def test_checks_hold_or_do_not_and_have_no_verdict():
    built = compare.check("T_1", "Section 3.1", "0.5", 0.4999, unit="s", note="built so")
    assert (built.holds, built.criterion, built.ours_as_text) == (True, "must round to it", "0.500")
    assert not compare.check("T_1", "Section 3.1", "0.5", 0.56).holds
    assert not compare.check("m*_1", "Table 2", "a formula", 1.1, "< 1").holds
    assert compare.check("m*_1", "Table 2", "a formula", 0.9, "< 1").criterion == "< 1"
    assert not hasattr(built, "verdict")


def test_statements_pass_by_their_criterion_alone():
    assert compare.statement("slope", "", "overestimates", 0.97, "< 1").verdict is Verdict.REPRODUCED
    wrong = compare.statement("ratio", "", "underestimates", 1.09, "< 1", agreed=Verdict.EQUIVALENT)
    assert wrong.verdict is Verdict.NOT
    assert (wrong.difference, wrong.difference_as_text) == (None, "")
    assert compare.statement("friction", "", "higher than 2", math.inf, "> 2").ours_as_text == "∞"
    assert compare.statement("bound", "", "below", 1.0009, "≤ 1").ours_as_text == "1.001"


def test_texts():
    assert compare.number("n", "", "306", 118.0).ours_as_text == "118"
    assert compare.number("n", "", "306", 118.0).difference_as_text == "−188 (−61 %)"
    assert compare.number("x", "", "0.5", 0.5 + 1e-16).difference_as_text == "0"
    assert compare.number("x", "", "≤ 3.2", 3.1).difference_as_text == ""
    assert compare.number("x", "", "< 5", 148.13).difference_as_text == "+143.13 (+2863 %)"
    assert compare.number("x", "", "0.1", -1e-9).ours_as_text == "−1.0e−09"
    assert compare.number("x", "", "1", math.nan).ours_as_text == "none"
    assert compare.number("x", "", "1", -math.inf).ours_as_text == "−∞"
    assert isinstance(compare.number("x", "", "1", np.float64(1.0)).ours, float)
    for kinds in (Verdict, RemarkKind):
        assert len({each.meaning for each in kinds}) == len(kinds)


def test_sliding_by_both_signs():
    """Ratios and counts of made-up runs, as medians by hand give them."""
    medians = {"#1": 0.2, "#2": 0.1, "#3": 0.3, "#4": 0.2, "#5": 0.5, "#6": 1.5}
    rows = [
        {"model": "2DOF-C", "structure": name, "group": f"{group}", "printed": value, "mended": 0.3 - 0.1 * value}
        for name, value in medians.items() for group in range(4)
    ]  # fmt: skip
    runs = pd.DataFrame(rows)
    printed, mended = (friction_intervals(runs, "2DOF-C", sign) for sign in ("printed", "mended"))
    assert printed["shear over flexure"].estimate == pytest.approx(0.5 / 1.5)
    assert printed["h*_1/B = 5 over 10"].estimate == pytest.approx(2.5)
    assert printed["T_1 = 0.5 s over 1 s"].estimate == pytest.approx(1.5)
    assert printed["runs that need more than 1.0"].estimate == 4.0
    assert mended["shear over flexure"].estimate == pytest.approx(0.27 / 0.28)
    assert mended["runs that need more than 1.0"].estimate == 0.0


def test_thin_slices_meet_every_entry_of_table_3():
    def missed(slices):
        ours = ritz_modes_with_slices(slices)
        return [
            (name, n) for name, (row, _) in RITZ.items() for n, text in enumerate(row)
            if f"{ours[name][n]:.2f}" != text.replace("−", "-")
        ]  # fmt: skip

    assert all(not missed(round(200 / height)) for height in (0.029, 0.032, 0.036))
    assert ("h*", 1) in missed(40_000)
    exact, fine = TOWER.rocking(), ritz_modes_with_slices(400_000)
    for name, values in (("ω", exact.omega), ("m*", exact.effective_mass / 1e6), ("h*", exact.effective_height)):
        assert fine[name] == pytest.approx(values, rel=2e-4)
    assert fine["Γ"] == pytest.approx(exact.top_ordinate, rel=2e-4)


def test_modes_mixed_a_little_meet_what_is_printed_of_the_finite_elements():
    printed = {"m*": (8.485, 3.233), "h*": (141.66, 50.02), "Γ": (1.725, -1.179)}
    digits = {"m*": 3, "h*": 2, "Γ": 3}

    def met(*parts):
        found = mixed_element_modes(*parts)
        return [
            round(float(found[name][n]), digits[name]) == row[n] for name, row in printed.items() for n in range(2)
        ]  # fmt: skip

    assert all(met(0.009, -0.0002))
    assert met(0.0, 0.0).count(True) == 1  # Γ_1
    assert not all(met(0.009, 0.0002))
    assert not all(met(-0.009, -0.0002))


def test_modes_of_the_elements_converge_to_those_of_the_library():
    exact = replace(TOWER, method="fe").rocking()
    found = mixed_element_modes(0.0, 0.0, 4000)
    assert found["m*"] == pytest.approx(exact.effective_mass[:2] / 1e6, rel=3e-4)
    assert found["h*"] == pytest.approx(exact.effective_height[:2], rel=3e-4)
    assert found["Γ"] == pytest.approx(exact.top_ordinate[:2], rel=1e-3)


def test_plain_finite_elements_converge_before_rounding_grows():
    """With few elements rounding is far below what sampling the stiffness at one place does, of the first order."""
    exact = TOWER.rocking().omega[0]
    low, high = ([first_frequency_by_elements(n, place) / exact - 1 for n in (25, 50, 100)] for place in (0.0, 1.0))
    assert all(value > 0 for value in low)
    assert all(value < 0 for value in high)
    for errors in (low, high):
        assert [errors[0] / errors[1], errors[1] / errors[2]] == pytest.approx([2.0, 2.0], rel=0.05)
    assert first_frequency_by_elements(100, 0.5) == pytest.approx(exact, rel=1e-4)
