"""Target spectra: tables, files, and codes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rockflex as rf

TABLE = rf.TargetSpectrum([0.0, 0.1, 0.5, 2.0], [3.0, 7.5, 7.5, 1.875], name="site")
# EN 1998-1:2004: every ordinate is a product of the numbers of Tables 3.2 and 3.3, written out.
EC8 = [
    ("A", 1, 0.0, 1.0),
    ("A", 1, 0.075, 1.0 + 0.5 * 1.5),
    ("A", 1, 0.15, 2.5),
    ("A", 1, 0.4, 2.5),
    ("A", 1, 1.0, 2.5 * 0.4 / 1.0),
    ("A", 1, 2.0, 2.5 * 0.4 / 2.0),
    ("A", 1, 4.0, 2.5 * 0.4 * 2.0 / 16.0),
    ("B", 1, 0.5, 1.2 * 2.5),
    ("B", 1, 3.0, 1.2 * 2.5 * 0.5 * 2.0 / 9.0),
    ("C", 1, 0.2, 1.15 * 2.5),
    ("C", 1, 1.2, 1.15 * 2.5 * 0.6 / 1.2),
    ("D", 1, 0.1, 1.35 * (1.0 + 0.5 * 1.5)),
    ("D", 1, 0.8, 1.35 * 2.5),
    ("E", 1, 1.0, 1.4 * 2.5 * 0.5),
    ("A", 2, 0.05, 2.5),
    ("A", 2, 0.25, 2.5),
    ("A", 2, 1.2, 2.5 * 0.25 / 1.2),
    ("A", 2, 4.0, 2.5 * 0.25 * 1.2 / 16.0),
    ("B", 2, 0.1, 1.35 * 2.5),
    ("B", 2, 0.025, 1.35 * (1.0 + 0.5 * 1.5)),
    ("C", 2, 0.1, 1.5 * 2.5),
    ("C", 2, 0.5, 1.5 * 2.5 * 0.25 / 0.5),
    ("D", 2, 0.3, 1.8 * 2.5),
    ("D", 2, 2.4, 1.8 * 2.5 * 0.3 * 1.2 / 2.4**2),
    ("E", 2, 1.0, 1.6 * 2.5 * 0.25),
]
G = 9.81


def test_between_the_rows_of_a_table():
    assert TABLE.at([0.0, 0.1, 0.5, 2.0]) == pytest.approx([3.0, 7.5, 7.5, 1.875], rel=1e-14)
    assert TABLE.at([0.025])[0] == pytest.approx(3.0 + 0.25 * 4.5, rel=1e-14)  # linear in T from zero
    assert TABLE.at([1.0])[0] == pytest.approx(7.5 * 0.5 / 1.0, rel=1e-14)  # 1/T
    positive = rf.TargetSpectrum([0.1, 10.0], [1.0, 1e-4])
    assert positive.at([1.0])[0] == pytest.approx(1e-2, rel=1e-13)  # 1/T²


def test_scaled():
    assert TABLE.scaled(1.5).at([1.0])[0] == pytest.approx(1.5 * TABLE.at([1.0])[0], rel=1e-14)
    assert TABLE.scaled(1.5).name == "site"
    assert repr(TABLE.scaled(2.0)) == "TargetSpectrum('site', 0 to 2 s, up to 15 m/s², ζ = 0.05)"
    with pytest.raises(rf.InputError, match="factor must be a positive, finite number"):
        TABLE.scaled(0.0)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (([0.1], [1.0]), "periods and sa must have the same length of at least 2, but 1 and 1 values were given"),
        (([0.1, 0.2], [1.0]), "but 2 and 1 values were given"),
        (([0.1, 0.1], [1.0, 1.0]), r"periods must increase from zero or more, but 0\.1 s was given at index 1. Sort"),
        (([-0.1, 0.1], [1.0, 1.0]), r"but -0\.1 s was given at index 0"),
        (([0.1, 0.2], [1.0, 0.0]), r"sa must be positive, but sa\[1\] = 0 m/s² was given"),
        (([0.1, 0.2], [1.0, 1.0], 5), r"damping_ratio must lie in \[0, 1\), but 5 was given. It is a fraction"),
    ],
)
def test_refuses_tables(arguments, text):
    with pytest.raises(rf.InputError, match=text):
        rf.TargetSpectrum(*arguments)


def test_outside_the_table_it_is_unknown():
    with pytest.raises(rf.InputError, match=r"'site' is known from 0 to 2 s, but not at 2\.5 s"):
        TABLE.at([1.0, 2.5])


@pytest.mark.parametrize(("ground", "kind", "period", "over_ag"), EC8)
def test_ec8(ground, kind, period, over_ag):
    target = rf.ec8_spectrum(2.0, ground, kind, importance=1.4)
    assert target.at([period])[0] == pytest.approx(2.8 * over_ag, rel=1e-13)
    assert target.damping_ratio == 0.05
    assert target.periods[-1] == 4.0


def test_ec8_damping():
    for zeta, eta in ((0.02, math.sqrt(10 / 7)), (0.1, math.sqrt(10 / 15)), (0.3, 0.55), (0.5, 0.55)):
        target = rf.ec8_spectrum(1.0, "A", damping_ratio=zeta)
        assert target.damping_ratio == zeta
        assert target.at([0.3])[0] == pytest.approx(2.5 * eta, rel=1e-13)
        assert target.at([0.075])[0] == pytest.approx(1.0 + 0.5 * (2.5 * eta - 1.0), rel=1e-13)
        assert target.at([0.0])[0] == 1.0  # the ground acceleration does not depend on damping


@pytest.mark.parametrize(
    ("arguments", "options", "text"),
    [
        ((1.0, "F"), {}, "ground must be one of A, B, C, D, E, the ground type of EN 1998-1, but 'F' was given. Gro"),
        ((1.0, "A", 3), {}, "kind must be 1 or 2, the type of the spectrum, but 3 was given"),
    ],
)
def test_ec8_refuses(arguments, options, text):
    with pytest.raises(rf.InputError, match=text):
        rf.ec8_spectrum(*arguments, **options)


@pytest.mark.parametrize("mce", [False, True])
def test_asce7(mce):
    # 11.4.6 with S_DS = 1.2 g, S_D1 = 0.6 g, T_L = 6 s: T_0 = 0.1 s, T_S = 0.5 s.
    target = rf.asce7_spectrum(1.2 * G, 0.6 * G, 6.0, mce=mce)
    by_hand = {
        0.0: 0.4 * 1.2,
        0.05: 1.2 * (0.4 + 0.6 * 0.5),
        0.1: 1.2,
        0.3: 1.2,
        0.5: 1.2,
        1.0: 0.6,
        2.4: 0.25,
        6.0: 0.1,
        12.0: 0.6 * 6.0 / 144.0,
        60.0: 0.6 * 6.0 / 3600.0,
    }
    level = 1.5 if mce else 1.0
    assert target.at(list(by_hand)) == pytest.approx([level * G * sa for sa in by_hand.values()], rel=1e-12)
    assert target.name.startswith("ASCE 7-16 MCE_R" if mce else "ASCE 7-16 design")


@pytest.mark.parametrize(
    ("ss", "s1", "site", "fa", "fv"),
    [
        (1.5, 0.6, "A", 0.8, 0.8),
        (0.3, 0.05, "B", 0.9, 0.8),
        (0.25, 0.1, "C", 1.3, 1.5),
        (0.625, 0.55, "C", 1.25, 1.45),
        (2.0, 0.8, "C", 1.2, 1.4),
        (0.2, 0.05, "D", 1.6, 2.4),
        (0.6, 0.25, "D", 1.32, 2.1),
        (1.1, 0.45, "D", 1.06, 1.85),
        (1.5, 0.6, "D", 1.0, 1.7),
        (1.1, 0.45, "default", 1.2, 1.85),
        (0.5, 0.1, "default", 1.4, 2.4),
        (0.4, 0.05, "E", 1.98, 4.2),
        (0.9, 0.15, "E", 1.3, 4.2),
    ],
)
def test_asce7_site_coefficients(ss, s1, site, fa, fv):
    target = rf.asce7_site_spectrum(ss * G, s1 * G, site, 8.0)
    sds, sd1 = 2 / 3 * fa * ss, 2 / 3 * fv * s1
    assert target.at([0.2 * sd1 / sds, 4.0]) == pytest.approx([sds * G, sd1 * G / 4.0], rel=1e-12)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: rf.asce7_spectrum(1.0, 0.6, 0.5), r"between sd1/sds = 0\.6 s and 100 s, but 0\.5 was given"),
        (lambda: rf.asce7_spectrum(1.0, 0.6, 200.0), "but 200.0 was given"),
        (lambda: rf.asce7_spectrum(1.0, 0.6, 8.0, mce=1.5), "mce must be True or False, but 1.5 was given"),
        (lambda: rf.asce7_site_spectrum(G, G, "F", 8.0), 'one of A, B, C, D, E or "default".*Class F needs'),
        (lambda: rf.asce7_site_spectrum(1.0 * G, 0.1 * G, "E", 8.0), "site E with S_S = 1 g and S_1 = 0.1 g needs an"),
        (lambda: rf.asce7_site_spectrum(0.5 * G, 0.2 * G, "E", 8.0), "site E with S_S = 0.5 g and S_1 = 0.2 g needs"),
    ],
)
def test_asce7_refuses(call, text):
    with pytest.raises(rf.InputError, match=text):
        call()


def test_from_a_file(tmp_path):
    file = tmp_path / "site.csv"
    file.write_text("# a comment\nperiod (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n2.0, 0.2\n")
    target = rf.read_target(file, damping_ratio=0.02)
    assert target == rf.TargetSpectrum([0.0, 0.1, 2.0], G * np.array([0.3, 0.75, 0.2]), 0.02, "site")
    file.write_text("0.1 750\n\n2.0 200  # the end\n")
    assert rf.read_target(file, "cm/s2").sa.tolist() == [7.5, 2.0]


@pytest.mark.parametrize(
    ("head", "unit"),
    [
        ("T [s]; S_a [m/s²]", 1.0),
        ("T (s) Sa (cm/sec^2)", 0.01),
        ("T (s), Sa (gal)", 0.01),
        ("period, Sa (g)", G),
        ("% T (s), Sa (g)", G),
        ('"T (s)"; "Sa (mm/s2)"', 1e-3),
    ],
)
def test_units_of_the_header(tmp_path, head, unit):
    (tmp_path / "site.txt").write_text(f"{head}\n0.1; 2\n1.0; 1\n")
    assert rf.read_target(tmp_path / "site.txt").sa.tolist() == [2.0 * unit, unit]


def test_decimal_commas(tmp_path):
    (tmp_path / "site.csv").write_text("T [s];Sa [m/s²]\n0,1;2,5\n1;1,25\n")
    read = rf.read_target(tmp_path / "site.csv")
    assert (read.periods.tolist(), read.sa.tolist()) == ([0.1, 1.0], [2.5, 1.25])


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("0.1 1\n2.0 1\n", {}, r'does not state the unit.*read_target\(path, units="g"\).*header "period'),
        ("period (s), sa (g)\n0.1, 1\n2, 1\n", {"units": "m/s2"}, r"is g in the file \(label .*'m/s2' was given"),
        ("T (s), sa\n0.1, 1\n2, 1\n", {}, "does not state the unit of its acceleration"),
        ("0.1\n0.2\n", {"units": "g"}, "line 1: a target spectrum has two columns, the period.* but 1 were found"),
        ("0.1 1\n0.2 1 2\n", {"units": "g"}, "line 2: expected 2 columns as in line 1, but found 3"),
        ("0.1 1 2\n0.2 1 2\n", {"units": "g"}, "line 1: a target spectrum has two columns.* but 3 were found"),
        ("period\n", {"units": "g"}, "holds no numbers: a target spectrum is expected as two columns"),
        ("0.1 1\n0.2 x\n", {"units": "g"}, "line 2: expected a finite number, but found 'x'"),
        ("0.2 1\n0.1 1\n", {"units": "g"}, r"site\.txt: periods must increase"),
        ("0.1 1\n0.2 1\n", {"units": "ft"}, "units must be one of 'g', 'm/s2', .*'in/s2', but 'ft' was given"),
        ("0.1 1\n0.2 1\n", {"units": "g", "damping_ratio": 5}, r"^damping_ratio must lie in"),
    ],
)
def test_refuses_files(tmp_path, text, options, message):
    (tmp_path / "site.txt").write_text(text)
    with pytest.raises(rf.InputError, match=message):
        rf.read_target(tmp_path / "site.txt", **options)


@pytest.mark.parametrize(
    ("text", "options"),
    [
        ("Period (ms),Sa (g)\n100,0.3\n400,0.75\n2000,0.15\n", {}),
        ("Frequency (Hz),Sa (g)\n0.5,0.15\n2.5,0.75\n10,0.3\n", {}),
        ("Freq. [Hz]\tPSA [g]\n10\t0.3\n2.5\t0.75\n0.5\t0.15\n", {}),
        ("f Sa\n0.5 0.15\n2.5 0.75\n10 0.3\n", {"units": "g"}),
        ("Frequency (kHz);Sa (m/s2)\n0,0005;1,4715\n0,0025;7,3575\n0,01;2,943\n", {}),
        ("T (s);Sa (g)\n0,1;30%\n0,4;75%\n2;15 %\n", {}),
        ("T (s) Sa (%g)\n0.1 30\n0.4 75\n2 15\n", {}),
        ("T (s),Sa (%g)\n0.1,30%\n0.4,75%\n2,15%\n", {}),
        ("T,Sa\n0.1,30\n0.4,75\n2,15\n", {"units": "%g"}),
        ("Sa_g,T_s\n0.3,0.1\n0.75,0.4\n0.15,2\n", {}),
        ("No.,T (s),Sd (cm),Sv (cm/s),Sa (g)\n1,0.1,9,9,0.3\n2,0.4,9,9,0.75\n3,2,9,9,0.15\n", {}),
        (
            "Target spectrum, units: s, g\nNatural period  Spectral acceleration\n0.1 0.3\n0.4 0.75\n2 0.15\n",
            {"units": "g"},
        ),
        ("Spectral acceleration in units of g\nperiod,ordinate\n0.1,0.3\n0.4,0.75\n2,0.15\n", {}),
        ('"T (s)","Sa (g)"\n"0.1","0.3"\n"0.4","0.75"\n"2","0.15"\n', {}),
        ("Sa (g) vs T (s)\n0.1 0.3\n0.4 0.75\n2 0.15\n", {}),
        ("Natural period (s)  Spectral acceleration (g)\n0.1 0.3\n0.4 0.75\n2 0.15\n", {}),
        ("T (s)\tS_d(T) (g, 5%)\n0.1\t0.3\n0.4\t0.75\n2\t0.15\n", {}),
    ],
)
def test_periods_frequencies_and_percent(tmp_path, text, options):
    (tmp_path / "site.csv").write_text(text)
    found = rf.read_target(tmp_path / "site.csv", **options)
    assert found.periods == pytest.approx([0.1, 0.4, 2.0], rel=1e-14)
    assert found.sa / G == pytest.approx([0.3, 0.75, 0.15], rel=1e-14)


@pytest.mark.parametrize(
    ("text", "units", "field", "words"),
    [
        ("Period (s),Sd (cm)\n0.1,3\n2,20\n", None, None, ("displacement", "Sd (cm)")),
        ("Period (s),PSV\n0.1,3\n2,20\n", "g", None, ("velocity", "PSV")),
        ("Period (s),S (cm/s)\n0.1,3\n2,20\n", "g", None, ("velocity", "S (cm/s)")),
        ("time (s),acc (g)\n0.1,.3\n2,.2\n", None, None, ("time (s)", "read_motion", "period (s)")),
        ("Frequency (s),Sa (g)\n1,.3\n2,.2\n", None, None, ("Frequency (s)", "contradicts")),
        ("Frequency (Hz),Sa (g)\n0,.3\n2,.2\n", None, "periods", ("line 2", "frequency of 0")),
        ("omega (rad/s),Sa (g)\n1,.3\n2,.2\n", None, None, ("rad/s", "Hz")),
        ("Period,Sa (g)\n0,.3\n500,.2\n", None, "periods", ("500 s", "period (ms)")),
        ("0.1,.3\n33,.2\n", "g", "periods", ("33 s", "frequency (Hz)")),
        ("T (s),Sa (g)\n0.1,30\n2,75\n", None, "units", ("75 g", "above 10 g", "sa (%g)")),
        ("T (s),Sa (g)\n0.1,30%\n2,0.75\n", None, "units", ("percent sign",)),
        ("T (s),Sa (m/s2)\n0.1,30%\n2,75%\n", None, "units", ("percent", "m/s2")),
        ("T (s),Sa (%)\n0.1,30\n2,75\n", "g", None, ("'%'", "%g")),
        ("units: m/s2\nT (s),Sa (g)\n0.1,1\n2,1\n", None, "units", ('label "Sa (g)"', 'line 1: "units: m/s2"')),
        ("T (s),Sa X (g),Sa Y (g)\n1,1,1\n2,1,1\n", None, None, ("'Sa X (g)'", "'Sa Y (g)'", "Keep these two")),
        ("T (s),Sa (g),Sa (g)\n1,1,1\n2,1,1\n", None, None, ("one the acceleration",)),
    ],
)
def test_what_a_label_contradicts(tmp_path, text, units, field, words):
    (tmp_path / "site.csv").write_text(text)
    with pytest.raises(rf.InputError) as caught:
        rf.read_target(tmp_path / "site.csv", units)
    assert caught.value.field == field
    assert all(word in str(caught.value) for word in ("site.csv", *words))


def formula(period, s_alpha, s_beta, factors, rock, zeta):
    """S_e of EN 1998-1-1:2024, 5.2.2.2, case by case; `rock` is S_β,RP."""
    plateau, second = factors[0] * s_alpha, factors[1] * s_beta
    t_c = second / plateau
    t_b = 0.05 if t_c / 4 < 0.05 else 0.1 if t_c / 4 > 0.1 else t_c / 4
    t_d = 2.0 if rock <= 1.0 else 1.0 + rock
    eta = max(math.sqrt(10 / (5 + 100 * zeta)), 0.55)
    if period <= 0.02:
        return plateau / 2.5
    if period <= t_b:
        return plateau / (t_b - 0.02) * (eta * (period - 0.02) + (t_b - period) / 2.5)
    if period <= t_c:
        return eta * plateau
    return eta * second / period if period <= t_d else eta * t_d * second / period**2


@settings(deadline=None, max_examples=100)
@given(st.floats(1.0, 12.0), st.floats(0.15, 0.6), st.floats(0.0, 0.3), st.floats(0.0, 10.0))
def test_formulas_for_given_factors(s_alpha, share, zeta, period):
    s_beta = share * s_alpha
    target = rf.ec8_second_spectrum(s_alpha, s_beta, amplification=(1.2, 1.5), damping_ratio=zeta)
    expected = formula(period, s_alpha, s_beta, (1.2, 1.5), s_beta, zeta)
    assert target.at([period])[0] == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(
    ("site", "of_alpha", "of_beta"),
    [("A", 1.0, 1.0), ("B", 1.3 * 0.96, 1.6 * 0.98), ("C", 1.6 * 0.92, 2.3 * 0.97), ("D", 1.8 * 0.88, 3.2 * 0.9)],
)
def test_default_factors(site, of_alpha, of_beta):
    target = rf.ec8_second_spectrum(0.4 * G, 0.1 * G, site, topography=1.2)
    expected = 1.2 * G * np.array([0.4 * of_alpha / 2.5, 0.4 * of_alpha, 0.1 * of_beta])
    assert target.at([0.0, 0.15, 1.0]) == pytest.approx(expected)
    assert f"site {site}, S_α 0.4 g, S_β 0.1 g" in target.name


@pytest.mark.parametrize(
    ("arguments", "options", "text"),
    [
        ((0.0, 1.0), {}, r"s_alpha must be a positive, finite number in m/s²"),
        ((5.0, -1.0), {}, r"s_beta must be a positive, finite number"),
        ((5.0, 1.0, "E"), {}, r"site must be one of A, B, C, D, .* but 'E' was given\. For E and F, .*amplification="),
        ((5.0, 1.0), {"amplification": (1.0,)}, r"amplification must be the two positive factors F_α and F_β"),
        ((5.0, 1.0), {"amplification": (1.0, 0.0)}, r"amplification must be the two positive factors F_α and F_β"),
        ((5.0, 1.0), {"amplification": "ab"}, "amplification must be a sequence of numbers, but"),
        ((5.0, 1.0, "C"), {"amplification": (1.2, 1.5)}, "site='C' and amplification were both given. Give one"),
        ((5.0, 1.0), {"topography": 0.0}, "topography must be a positive, finite number, but 0.0 was"),
        ((5.0, 1.0), {"damping_ratio": 2.0}, "damping_ratio must lie in"),
        ((5.0, 0.1), {}, r"T_B = 0\.05 s, T_C = 0\.02 s and T_D = 2 s, which must increase"),
        ((5.0, 8.0, "D"), {}, r"F_α = 1\.52 and F_β = 0\.59, below 1\. .*amplification=\(F_α, F_β"),
    ],
)
def test_refuses(arguments, options, text):
    with pytest.raises(rf.InputError, match=text):
        rf.ec8_second_spectrum(*arguments, **options)
