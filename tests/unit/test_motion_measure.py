"""Measures as values; one that is added to the registry is known wherever measures are asked for."""

import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from rockflex.cli import app
from rockflex.kinds import load_study
from rockflex.motion import MEASURES, Measure, Shaking, intensities, intensity, record_measures
from rockflex.plot import plot_clouds
from rockflex.study import run_plan
from rockflex.study.stripes import StripeStudy

EL_CENTRO = rf.load_suite("el-centro-1940")[0]
BLOCK = rf.rigid_block(0.2, 1.5)
MEAN = Measure(
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


@pytest.mark.parametrize("measure", intensities(), ids=lambda measure: measure.name)
@pytest.mark.parametrize("factor", [-1.3, 0.4])
def test_scaled_is_computed_from_the_scaled_motion(measure, factor):
    def of(motion):
        return measure.of(Shaking(motion, omega=6.0, damping_ratio=0.02, lifting=1.3, rate=2.1))

    both = EL_CENTRO.with_vertical(0.5 * EL_CENTRO.acceleration[::-1])
    value = of(both)
    assert measure.scaled(value, factor) == pytest.approx(of(both.scaled(factor)), rel=1e-12)
    assert measure.factor(value, measure.scaled(value, factor)) == pytest.approx(abs(factor), rel=1e-12)
    assert measure.factor(0.0, 1.0) == measure.factor(math.nan, 1.0) == math.inf


def test_no_factor_takes_a_motion_to_a_duration():
    duration = MEASURES["d5_95"]
    assert duration not in intensities()
    assert duration.scaled(3.0, 2.0) == 3.0
    assert duration.factor(3.0, 6.0) == math.inf
    with pytest.raises(rf.InputError, match=r"relative_pgv, but 'd5_95' was given\."):
        intensity("d5_95")


def test_without_a_structure_its_measures_are_missing():
    for measure in MEASURES.values():
        assert math.isnan(measure.of(Shaking(EL_CENTRO))) == (measure not in record_measures())


def test_the_spectrum_of_a_stiff_structure_is_the_peak_of_the_ground():
    stiff = Shaking(EL_CENTRO, omega=1e8, damping_ratio=0.02)
    assert MEASURES["sa_t1"].of(stiff) == MEASURES["sa_t1_5"].of(stiff) == pytest.approx(EL_CENTRO.pga)


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
    assert found["motions"][0]["mean_a"] == MEAN.of(Shaking(EL_CENTRO))
    printed = CliRunner().invoke(app, ["motion", "el-centro-1940"]).stdout
    rows = [line.split() for line in printed.splitlines()]
    assert ["PGA", "PGV", "PGD", "Arias", "CAV", "D5-95", "MA", "Sa(1", "s)"] in rows


def test_what_is_not_added_is_unknown(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(f'study = "stripes"\nmeasure = "mean_a"\nlevels = [0.5]\n{STUDY}', "utf-8")
    with pytest.raises(rf.InputError, match=r"relative_pgv, but 'mean_a' was given\."):
        load_study(file).plan()
