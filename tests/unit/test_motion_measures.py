"""Intensity measures of motions and structures."""

import json
import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PPoly
from scipy.optimize import brentq
from scipy.signal import butter, find_peaks, lfilter
from scipy.stats import gmean
from typer.testing import CliRunner

import rockflex as rf
from rockflex.cli._app import app
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.motion import MEASURES, GroundMotion, IntensityMeasure, quiet_motion
from rockflex.motion._measures import MeasureInput, record_measures, scalable_measure, scalable_measures
from rockflex.plot import plot_clouds
from rockflex.studies import load_study
from rockflex.studies._run_plan import run_plan
from rockflex.studies.stripes import StripeStudy

RECORDS = [GroundMotion(np.random.default_rng(seed).normal(size=n), dt) for seed, n, dt in [(1, 40, 0.3), (2, 7, 0.02)]]
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
BLOCK = rf.rigid_block(0.2, 1.5)
MEAN = IntensityMeasure(
    name="mean_a",
    label="MA",
    unit="m/s²",
    words="mean absolute acceleration",
    of=lambda shaking: float(np.abs(shaking.motion.acceleration).mean()),
    symbol="$M_a$",
)
STUDY = """
records = {suites = ["el-centro-1940"]}
models = ["rigid"]
[[structures]]
name = "one"
block = {slenderness = 0.15, half_diagonal = 1.5}
"""


def polynomial(motion):
    """Acceleration as SciPy's piecewise polynomial: integrals and roots by independent code."""
    a = motion.acceleration
    return PPoly(np.array([np.diff(a) / motion.dt, a[:-1]]), motion.time, extrapolate=False)


def largest(function, motion):
    stops = np.concatenate((motion.time, function.derivative().roots(discontinuity=False)))
    return np.nanmax(np.abs(function(stops)))


@pytest.mark.parametrize("motion", RECORDS)
def test_integrals_and_their_peaks(motion):
    velocity = polynomial(motion).antiderivative()
    displacement = velocity.antiderivative()
    assert motion.velocity == pytest.approx(velocity(motion.time), rel=1e-12, abs=1e-14)
    assert motion.displacement == pytest.approx(displacement(motion.time), rel=1e-12, abs=1e-14)
    assert motion.pgv == pytest.approx(largest(velocity, motion), rel=1e-13)
    assert motion.pgd == pytest.approx(largest(displacement, motion), rel=1e-13)
    assert motion.pgv > np.max(np.abs(motion.velocity))


def test_peaks_hidden_between_samples():
    # v = t - t² returns to zero at the second sample.
    swing = GroundMotion([1.0, -1.0, 1.0], 1.0)
    assert np.max(np.abs(swing.velocity)) < 1e-15
    assert swing.pgv == pytest.approx(0.25)
    # v = t - 1.05 t² passes through zero at t = 1/1.05, just before the second sample.
    turn = GroundMotion([1.0, -1.1, 1.2], 1.0)
    assert turn.pgd == pytest.approx(1 / (6 * 1.05**2))
    assert turn.pgd > 1.007 * np.max(np.abs(turn.displacement))


@pytest.mark.parametrize("motion", RECORDS)
def test_arias_and_cav(motion):
    a = polynomial(motion)
    nodes, weights = leggauss(2)  # exact for cubics
    t = motion.time[:-1, None] + motion.dt * (nodes + 1) / 2
    energy = np.sum(a(t) ** 2 * weights) * motion.dt / 2
    assert motion.arias == pytest.approx(math.pi / (2 * GRAVITY) * energy, rel=1e-13)
    v = a.antiderivative()
    stops = np.sort(np.concatenate((motion.time, a.roots(discontinuity=False))))
    assert motion.cav == pytest.approx(np.nansum(np.abs(np.diff(v(stops)))), rel=1e-12)


@pytest.mark.parametrize("motion", RECORDS)
@pytest.mark.parametrize(("low", "high"), [(0.05, 0.95), (0.2, 0.21), (0.0, 1.0), (0.0, 0.75)])
def test_significant_duration(motion, low, high):
    a = polynomial(motion)
    nodes, weights = leggauss(2)

    def energy(t):
        stops = np.append(motion.time[motion.time < t], t)
        left, width = stops[:-1, None], np.diff(stops)[:, None]
        return float(np.sum(a(left + width * (nodes + 1) / 2) ** 2 * weights * width / 2))

    total = energy(motion.duration)
    ends = [
        motion.duration * x if x in (0, 1) else brentq(lambda t, x=x: energy(t) - x * total, 0, motion.duration)
        for x in (low, high)
    ]
    assert motion.significant_duration(low, high) == pytest.approx(ends[1] - ends[0], abs=1e-10)


def test_significant_duration_of_simple_shapes():
    assert GroundMotion(np.ones(11), 0.1).d5_95 == pytest.approx(0.9)
    # ∫t² dt grows like t³.
    ramp = GroundMotion(np.linspace(0, 1, 11), 0.1)
    assert ramp.significant_duration(0.125, 0.512) == pytest.approx(0.3)
    assert quiet_motion(1.0).d5_95 == 0.0


@pytest.mark.parametrize(("low", "high"), [(0.9, 0.1), (-0.1, 0.5), (0.5, 0.5), (0.5, 1.1), (math.nan, 1)])
def test_significant_duration_refuses(low, high):
    with pytest.raises(InputError, match="fractions with 0 <= low < high <= 1"):
        RECORDS[0].significant_duration(low, high)


def test_simple_closed_forms():
    motion = GroundMotion([0.0, 2.0, 0.0], 0.5)
    assert motion.velocity.tolist() == [0.0, 0.5, 1.0]
    assert motion.pgv == motion.cav == pytest.approx(1.0)
    assert motion.arias == pytest.approx(math.pi / (2 * GRAVITY) * 4 / 3)
    # Equal and opposite values: two triangles, and no net velocity.
    swing = GroundMotion([1.0, -1.0, 1.0], 1.0)
    assert swing.cav == pytest.approx(1.0)
    assert swing.velocity == pytest.approx([0.0, 0.0, 0.0])
    assert swing.pgv == pytest.approx(0.25)


@pytest.mark.parametrize("period", [0.3, 1.0, 2.5])
def test_average_spectral_acceleration(period):
    ordinates = [EL_CENTRO.sa(k * period / 10.0, 0.02) for k in range(2, 31)]
    assert EL_CENTRO.sa_avg(period, 0.02) == pytest.approx(gmean(ordinates), rel=1e-13)
    with pytest.raises(InputError, match="period must be") as caught:
        EL_CENTRO.sa_avg(0.0)
    assert caught.value.field == "period"


def scipy_fiv3(motion, period, alpha, beta):
    """FIV3 by SciPy's bilinear filter, trapezia and peaks of a record sampled so finely that they are exact to 1e-5."""
    fine = motion.refined(math.ceil(motion.dt / period * 3e3))
    a = np.append(fine.acceleration, np.zeros(math.ceil(2.0 * alpha * period / fine.dt)))
    y = lfilter(*butter(2, beta / period, fs=1.0 / fine.dt), a)
    whole, t = cumulative_trapezoid(y, dx=fine.dt, initial=0.0), np.arange(fine.acceleration.size)
    gained = np.interp(t + alpha * period / fine.dt, np.arange(a.size), whole) - whole[t]
    return max(np.sort(side[find_peaks(side)[0]])[-3:].sum() for side in (gained, -gained))


@pytest.mark.parametrize("period", [0.2, 1.0, 3.0])
@pytest.mark.parametrize(("alpha", "beta"), [(0.7, 0.85), (0.31, 1.5)])
def test_filtered_incremental_velocity_against_scipy(period, alpha, beta):
    # Steps that are long for the filter, too: it is exact between samples.
    for motion in (EL_CENTRO, GroundMotion(EL_CENTRO.acceleration[::5], 5.0 * EL_CENTRO.dt)):
        found = motion.fiv3(period, alpha, beta)
        assert found == pytest.approx(scipy_fiv3(motion, period, alpha, beta), rel=1e-4)


@pytest.mark.parametrize("period", [0.05, 0.6, 2.0])
def test_filtered_incremental_velocity_of_a_sine(period):
    """In the steady state every peak of V_s is 2 A/ω sin(ω α T/2), with A = a / √(1 + (f T/β)⁴)."""
    f, alpha, beta = 1.0, 0.7, 0.85
    t = np.arange(0.0, 40.0, 0.001)
    growth = np.sin(0.5 * np.pi * np.clip(np.minimum(t, 40.0 - t) / 15.0, 0.0, 1.0)) ** 2  # no transients
    motion = GroundMotion(growth * np.sin(2.0 * np.pi * f * t), 0.001)
    amplitude = 1.0 / math.sqrt(1.0 + (f * period / beta) ** 4)
    peak = 2.0 * amplitude / (2.0 * math.pi * f) * abs(math.sin(math.pi * f * alpha * period))
    assert motion.fiv3(period) == pytest.approx(3.0 * peak, rel=2e-3)


@pytest.mark.parametrize("period", [0.4, 2.0])
def test_filtered_incremental_velocity_of_an_impulse(period):
    """V_s = S(x) - S(x - q) with S = 1 - exp(-x) (cos x + sin x), x = ω t/√2: peaks fall by exp(-2π) each."""
    dt, q = 1e-4 * period, math.sqrt(2.0) * math.pi * 0.85 * 0.7
    motion = GroundMotion(np.concatenate((np.zeros(9), [1.0 / dt], np.zeros(100_000))), dt)  # a velocity of 1 m/s
    x = math.atan2(math.exp(q) * math.sin(q), math.exp(q) * math.cos(q) - 1.0) % math.pi
    x += math.pi * math.ceil((q - x) / math.pi)

    def step(x):
        return 1.0 - math.exp(-x) * (math.cos(x) + math.sin(x))

    peak = step(x) - step(x - q)
    assert motion.fiv3(period) == pytest.approx(
        peak * (1.0 + math.exp(-2.0 * math.pi) + math.exp(-4.0 * math.pi)), rel=1e-6
    )


def test_filtered_incremental_velocity_of_short_windows():
    """Without a filter, a short window sees the highest acceleration, and a mirrored record has the same measure."""
    pulse = GroundMotion(np.append(np.zeros(300), np.sin(np.pi * np.linspace(0.0, 1.0, 101))), 0.005)
    assert pulse.fiv3(0.02, alpha=0.5, beta=10.0) == pytest.approx(0.01, rel=1e-3)
    assert pulse.scaled(-2.0).fiv3(1.0) == pytest.approx(2.0 * pulse.fiv3(1.0), rel=1e-13)
    with pytest.raises(InputError, match="beta must be") as caught:
        pulse.fiv3(1.0, beta=-1.0)
    assert caught.value.field == "beta"


def test_quiet_motion_has_no_measure():
    quiet = quiet_motion(1.0)
    assert (quiet.sa_avg(1.0), quiet.fiv3(1.0)) == (0.0, 0.0)
    assert (quiet.pga, quiet.pgv, quiet.pgd, quiet.arias, quiet.cav) == (0, 0, 0, 0, 0)


@pytest.fixture
def added(monkeypatch):
    monkeypatch.setitem(MEASURES, MEAN.name, MEAN)


@pytest.mark.parametrize("name", MEASURES)
def test_names(name):
    measure = MEASURES[name]
    assert measure.name == name
    assert measure.unit or measure.of_what == "base" or not measure.power
    assert measure.title.startswith(measure.label)
    assert measure.axis.endswith(f" [{measure.unit}]") == bool(measure.unit)


def test_words_of_a_label_that_is_words():
    arias = MEASURES["arias"]
    assert (arias.title, arias.axis) == ("Arias intensity", "Arias intensity [m/s]")
    assert (arias.head, arias.sign) == ("Arias", "$I_a$")
    assert MEASURES["sa_t1"].title == "Sa(T₁, ζ₁), spectral acceleration at the structure's damping"
    assert MEASURES["sa_t1"].axis == "$S_a(T_1,ζ_1)$ [m/s²]"
    assert MEASURES["sa_t1_5"].axis == r"$S_a(T_1,5\,\%)$ [m/s²]"
    assert MEASURES["relative_pga"].title == "PGA/(g tan α)"
    assert MEASURES["relative_pga"].axis == r"PGA/($g\,\tan α$)"


@pytest.mark.parametrize("measure", scalable_measures(), ids=lambda measure: measure.name)
@pytest.mark.parametrize("factor", [-1.3, 0.4])
def test_scaled_is_computed_from_the_scaled_motion(measure, factor):
    def of(motion):
        return measure.of(MeasureInput(motion, omega=6.0, damping_ratio=0.02, lifting=1.3, rate=2.1))

    both = EL_CENTRO.with_vertical(0.5 * EL_CENTRO.acceleration[::-1])
    value = of(both)
    assert measure.scaled(value, factor) == pytest.approx(of(both.scaled(factor)), rel=1e-12)
    assert measure.factor(value, measure.scaled(value, factor)) == pytest.approx(abs(factor), rel=1e-12)
    assert measure.factor(0.0, 1.0) == measure.factor(math.nan, 1.0) == math.inf


def test_no_factor_takes_a_motion_to_a_duration():
    duration = MEASURES["d5_95"]
    assert duration not in scalable_measures()
    assert duration.scaled(3.0, 2.0) == 3.0
    assert duration.factor(3.0, 6.0) == math.inf
    with pytest.raises(rf.InputError, match=r"relative_pgv, but 'd5_95' was given\."):
        scalable_measure("d5_95")


def test_without_a_structure_its_measures_are_missing():
    for measure in MEASURES.values():
        assert math.isnan(measure.of(MeasureInput(EL_CENTRO))) == (measure not in record_measures())


def test_the_spectrum_of_a_stiff_structure_is_the_peak_of_the_ground():
    stiff = MeasureInput(EL_CENTRO, omega=1e8, damping_ratio=0.02)
    assert MEASURES["sa_t1"].of(stiff) == MEASURES["sa_t1_5"].of(stiff) == pytest.approx(EL_CENTRO.pga)
    assert MEASURES["sa_avg"].of(stiff) == pytest.approx(EL_CENTRO.pga)
    assert 0.0 < MEASURES["fiv3"].of(stiff) <= 3.0 * 0.7 * 2.0 * math.pi / 1e8 * EL_CENTRO.pga


@pytest.mark.usefixtures("added")
def test_an_added_measure_is_a_column_of_clouds_and_an_axis():
    runs = rf.run_cloud(BLOCK, rf.load_suite("fema-p695-far-field")[:4], "rigid", [1.0, 2.0])
    assert runs["mean_a"].iloc[1] == pytest.approx(2.0 * runs["mean_a"].iloc[0])
    assert plot_clouds(runs, measure="mean_a").axes[0].get_xlabel() == "$M_a$ [m/s²]"


@pytest.mark.usefixtures("added")
def test_an_added_measure_is_accepted_in_a_study_file(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(f'study = "stripes"\nmeasure = "mean_a"\nlevels = [0.5, 0.7]\n{STUDY}', "utf-8")
    study = load_study(file)
    assert isinstance(study, StripeStudy)
    assert run_plan(study.plan())["mean_a"].tolist() == pytest.approx([0.5, 0.7])
    with pytest.raises(rf.InputError, match=r"relative_pgv, mean_a, but 'pgx' was given\."):
        study.model_copy(update={"measure": "pgx"}).plan()


@pytest.mark.usefixtures("added")
def test_an_added_measure_is_told_on_the_command_line():
    found = json.loads(CliRunner().invoke(app, ["motion", "el-centro-1940", "--json"]).stdout)
    assert found["units"]["mean_a"] == "m/s²"
    assert found["motions"][0]["mean_a"] == MEAN.of(MeasureInput(EL_CENTRO))
    printed = CliRunner().invoke(app, ["motion", "el-centro-1940"]).stdout
    rows = [line.split() for line in printed.splitlines()]
    assert ["PGA", "PGV", "PGD", "Arias", "CAV", "D5-95", "MA", "Sa(1", "s)"] in rows


def test_what_is_not_added_is_unknown(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(f'study = "stripes"\nmeasure = "mean_a"\nlevels = [0.5]\n{STUDY}', "utf-8")
    with pytest.raises(rf.InputError, match=r"relative_pgv, but 'mean_a' was given\."):
        load_study(file).plan()
