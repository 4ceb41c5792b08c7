"""The catalogues of texts: complete, without leftovers, and used by reports, figures and commands."""

import html
import re
import warnings
from collections import Counter
from pathlib import Path
from string import Formatter
from typing import get_args

import numpy as np
import pandas as pd
import pytest
from scipy import constants
from typer.testing import CliRunner

import rockflex as rf
from catalogue_texts import missing_texts, used_texts
from report_case import FRAME, HELD, PULSE, SPRINGS, runs
from rockflex.cli._app import app
from rockflex.foundation.language import Language, catalogue, chosen_language, translated, use_language
from rockflex.report.run._sheet import TEMPLATES

STRIPES = pd.DataFrame({"level": [0.2] * 10 + [0.4] * 10, "max_rotation": [0.001] * 8 + [0.01] * 12})
STRIPES = STRIPES.assign(structure="a", model="MDOF-S", status="rocking", nominal_overturning=False)
EXAMPLES = Path(rf.__file__).parents[2] / "examples"
OTHERS = [name for name in get_args(Language) if name != "en"]
SOURCE = TEMPLATES.parents[2]


def names_in(text):
    return {name for _, name, _, _ in Formatter().parse(text) if name}


@pytest.mark.slow
def test_every_source_is_read():
    texts, _ = used_texts()
    assert {"Length of the run", "{n} records", "{n} record", "Largest values", "Keep as {name}"} <= texts


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("name", OTHERS)
def test_no_translation_is_unused_and_missing_ones_are_told(name):
    if missing := missing_texts(name):
        warnings.warn(f"{len(missing)} texts are in English in {name}: python scripts/missing_texts.py", stacklevel=1)
    assert sorted(set(catalogue(name)) - used_texts()[1]) == []


def test_a_text_without_translation_is_english():
    with use_language("de"):
        assert translated("A text that no catalogue has: {n}", n=0.5) == "A text that no catalogue has: 0,5"


@pytest.mark.parametrize("name", OTHERS)
def test_translations_have_the_values_and_symbols_of_their_texts(name):
    symbols = re.compile(r"[A-Za-zα-ωΑ-Ω]+\*?_[\w*–]+(?![\w}])|[θμαλΣ|≥<>†²]")
    for text, other in catalogue(name).items():
        assert other.strip() == other if text.strip() == text else other[0] == text[0], text
        assert names_in(other) == names_in(text), text
        assert Counter(symbols.findall(other)) == Counter(symbols.findall(text)), text
        assert text[-1] not in ".:" or other[-1] == text[-1], text


RESULTS = {
    "run": lambda: runs(HELD, PULSE, ["2DOF-S"], ground=SPRINGS),
    "fall": lambda: runs(FRAME, rf.ricker_pulse(9.0, 1.6), ["2DOF-S", "MDOF-C"]),
    "set": lambda: rf.simulate_set(FRAME, [rf.one_sine_pulse(3.0, period) for period in (0.5, 0.6, 0.7)], "2DOF-S"),
    "comparison": lambda: rf.compare({"a": FRAME, "b": HELD}, [PULSE, rf.one_sine_pulse(3.0, 0.6)]),
}


def values_in(page):
    return re.findall(r'data-of="(\w+)" data-value="([^"]*)"', page)


@pytest.mark.slow
@pytest.mark.parametrize("kind", RESULTS)
def test_a_report_has_no_english_text_left_and_the_same_values(kind, tmp_path):
    result = RESULTS[kind]()
    in_english = rf.write_report(result, tmp_path / "en.html", date="2030").read_text("utf-8")
    assert '<html lang="en">' in in_english
    for name in OTHERS if kind == "run" else ["de"]:
        page = rf.write_report(result, tmp_path / f"{name}.html", date="2030", language=name).read_text("utf-8")
        assert f'<html lang="{name}">' in page
        assert values_in(page) == values_in(in_english)
        shown = re.sub(r"<style.*?</style>|<path[^>]*>|</?su[bp]>", "", page, flags=re.DOTALL)
        words = {text for text, other in catalogue(name).items() if len(text.split()) > 2 and text != other}
        left = [text for text in words if re.sub(r"\b_|\^", "", html.escape(text)) in shown]
        assert left == []
        assert not re.search(r'data-value="[^"]*">[^<]*\d\.\d', shown)


def test_a_block_ends_with_the_language_around_it():
    assert chosen_language() == ("en", ".")
    with use_language("de"):
        assert (translated("Largest values"), chosen_language()) == ("Größtwerte", ("de", ","))
        with use_language("en"):
            assert (translated("Largest values"), chosen_language()[1]) == ("Largest values", ".")
        with use_language(None, "."):
            assert chosen_language() == ("de", ".")
        assert translated("a name of {a user}") == "a name of {a user}"
    assert chosen_language() == ("en", ".")


def test_the_decimal_sign_may_be_chosen(tmp_path):
    (run,) = runs(FRAME, PULSE, ["2DOF-S"])
    page = rf.write_report(run, tmp_path / "r.html", language="de", decimal=".").read_text("utf-8")
    assert "Größtwerte" in page
    assert re.search(r">\d+\.\d+<", page)
    assert not re.search(r">\d+,\d+<", page)


def labels_of(axes):
    axes.figure.draw_without_rendering()
    return [text.get_text() for text in axes.get_yticklabels()]


def test_figures_follow_the_language_the_units_and_the_sign():
    (run,) = runs(HELD, PULSE, ["2DOF-S"])
    usual = rf.plot_history(run, panels=["rotation", "base_moment"])
    with rf.figure_style(units="kip-in", language="fr"):
        figure = rf.plot_history(run, panels=["rotation", "base_moment"])
        loops = rf.plot_loops(run)
    rotation, moment = figure.axes
    assert (rotation.get_ylabel(), moment.get_ylabel()) == ("θ [rad]", "$M_b$ [kip in]")
    assert moment.get_xlabel() == "temps [s]"
    inches = constants.lbf * constants.inch
    drawn, before = (axes.get_lines()[0].get_ydata() for axes in (moment, usual.axes[1]))
    assert usual.axes[1].get_ylabel() == "$M_b$ [MN m]"
    np.testing.assert_allclose(drawn * 1e3 * inches, before * 1e6, rtol=1e-12)
    assert any("," in text for text in labels_of(rotation))
    assert not any("." in text for axes in figure.axes for text in labels_of(axes))
    assert [axes.get_xlabel() for axes in loops.axes[1:]] == ["δ [in]"] * (len(loops.axes) - 1)
    assert not any("," in text for text in labels_of(usual.axes[0]))


@pytest.mark.slow
def test_figures_of_motions_and_shapes_have_the_units_and_commas_in_mathematics():
    motion, inch = rf.ricker_pulse(4.0, 0.6), constants.inch
    with rf.figure_style(units="kip-in", language="de"):
        drawn, modes = rf.plot_motion(motion), rf.plot_mode_shapes(FRAME)
        fragility = rf.plot_stripes(STRIPES, 0.005)
    acceleration, _, velocity, _ = drawn.axes
    assert (acceleration.get_ylabel(), velocity.get_ylabel()) == ("$a$ [g]", "$v$ [in/s]")
    np.testing.assert_allclose(acceleration.get_lines()[0].get_ydata() * 9.81, motion.acceleration, rtol=1e-12)
    np.testing.assert_allclose(velocity.get_lines()[0].get_ydata() * inch, motion.velocity, rtol=1e-12)
    assert modes.axes[0].get_ylabel() == "Höhe [in]"
    np.testing.assert_allclose(modes.axes[0].get_lines()[1].get_ydata()[1:] * inch, FRAME.modal().heights, rtol=1e-12)
    assert "0{,}005" in fragility.axes[0].get_ylabel()


def test_a_design_has_its_widths_in_the_units():
    rows = {"half_width": [1.0, 2.0], "aspect_ratio": [8.0, 4.0], "probability": [0.6, 0.2], "limit": [np.pi / 2] * 2}
    same = {"model": "2DOF-S", "tendon": "no tendon", "prestress_ratio": 0.0, "stiffness_ratio": 0.0}
    table = pd.DataFrame(rows | {"low": np.nan, "high": np.nan, "state": "overturning", "note": ""} | same)
    with rf.figure_style(units="kip-in", language="es"):
        axes = rf.plot_design(table, 0.4).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("semiancho $B$ [in]", "P(vuelco)")
    np.testing.assert_allclose(axes.get_lines()[0].get_xdata() * constants.inch, rows["half_width"], rtol=1e-12)
    assert list(table["half_width"]) == rows["half_width"]
    met = rf.smallest_width(table, 0.4)["half_width"].iloc[0]
    assert f"B = {met / constants.inch:.3g} in".replace(".", ",") in [text.get_text() for text in axes.texts]


def test_notes_and_reasons_follow_the_language_and_its_sign():
    with use_language("de"):
        reason = rf.adequacy(FRAME.rocking()).reason
        notes = rf.fit_outcomes([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [0.0, 0.0, 0.01, 0.0, 0.02, 0.05], [False] * 6).notes
    assert "Fußquerkraft" in reason
    assert not re.search(r"\d\.\d", reason)
    assert any(note.kind == "overturning" and note.startswith("Umkippen: keine von 6") for note in notes)


@pytest.mark.parametrize(("option", "value"), [("language", "la"), ("units", "kips"), ("decimal", ";")])
def test_unknown_styles_are_refused(option, value):
    with pytest.raises(rf.InputError, match=option) as caught, rf.figure_style(**{option: value}):
        pass
    assert caught.value.field == option


@pytest.mark.slow
def test_commands_write_reports_in_a_language(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pier = str(EXAMPLES / "bridge_pier.toml")
    commands = {
        "run": ["run", pier, "el-centro-1940", "--model", "2DOF-S", "--report", "run.html"],
        "compare": [
            *("compare", pier, str(EXAMPLES / "restrained_pier.toml"), "el-centro-1940"),
            "--report",
            "compare.html",
        ],
        "check": [*("check", pier, "el-centro-1940", "--report", "check.html")],
    }
    for name, words in commands.items():
        done = CliRunner().invoke(app, [*words, "--language", "it"])
        assert done.exit_code == 0, done.output
        page = (tmp_path / f"{name}.html").read_text("utf-8")
        assert '<html lang="it">' in page
        assert "Legge d&#39;urto" in page
    refused = CliRunner().invoke(app, ["run", pier, "el-centro-1940", "--language", "it"])
    assert refused.exit_code == 2
    assert "--language" in refused.output
