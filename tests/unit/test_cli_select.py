"""``rockflex select``: the same choice as in Python, as a table, a figure and records."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from report_page import read
from rockflex.cli._app import app
from rockflex.studies._run_matrix import record_groups

G = 9.81
SUITE = "fema-p695-far-field"
USUAL = (SUITE, "--target", "ec8:ag=0.25g,ground=C", "--count", 3, "--periods", "0.2,0.5,1.0")


def invoke(*arguments, columns=100):
    return CliRunner().invoke(app, ["select", *map(str, arguments)], env={"COLUMNS": str(columns)})


def refused(*arguments):
    result = invoke(*arguments)
    assert result.exit_code == 2
    return result.stderr


def test_document_is_the_selection():
    options = ("--per-event", 1, "--per-station", 2, "--limits", "0.5,3", "--record-weight", 0.2, "--least", 0.9)
    found = json.loads(invoke(*USUAL, *options, "--json").stdout)
    target = rf.ec8_spectrum(0.25 * G, "C")
    chosen = rf.load_suite(SUITE).select(
        target,
        3,
        [0.2, 0.5, 1.0],
        per_event=1,
        per_station=2,
        scale_limits=(0.5, 3.0),
        record_weight=0.2,
        least_ratio=0.9,
    )
    assert [row["record"] for row in found["records"]] == list(chosen.suite.names)
    assert [row["factor"] for row in found["records"]] == chosen.factors.tolist()
    assert [row["event"] for row in found["records"]] == [motion.metadata.event for motion in chosen.suite]
    assert (found["misfit"], found["least_ratio"]) == (chosen.misfit, chosen.least_ratio)
    assert found["zero_period_ratio"] == chosen.zero_period_ratio
    assert found["target"]["sa"] == target.sa.tolist()
    assert found["spectra"]["mean"] == chosen.mean.tolist()
    assert [each["name"] for each in found["motions"]] == list(chosen.suite.names)
    assert found["options"]["scale_limits"] == [0.5, 3.0]


def test_a_conditional_spectrum(tmp_path):
    model = tmp_path / "model.csv"
    model.write_text("period (s), median (g), sigma\n0.1, 0.5, 0.6\n1.0, 0.25, 0.65\n3.0, 0.06, 0.7\n", "utf-8")
    usual = (SUITE, "--count", 12, "--periods", "0.2,2", "--limits", "0.1,10")
    for ordinate, given in (("epsilon=0.5", {"epsilon": 0.5}), ("sa=0.4g", {"sa": 0.4 * G})):
        target = rf.read_conditional_spectrum(model, 1.0, **given)
        chosen = rf.load_suite(SUITE).select(target, 12, (0.2, 2.0), scale_limits=(0.1, 10.0))
        flags = (*usual, "--target", f"cs:file={model},period=1,{ordinate}")
        found = json.loads(invoke(*flags, "--json").stdout)
        assert [row["record"] for row in found["records"]] == list(chosen.suite.names)
        assert (found["misfit"], found["spread_misfit"]) == (chosen.misfit, chosen.spread_misfit)
        assert found["target"]["dispersion"] == target.dispersion.tolist()
        assert f"Median: misfit {chosen.misfit:.3g}" in invoke(*flags).stdout
    assert "period is missing" in refused(*usual, "--target", f"cs:file={model}")


@pytest.mark.parametrize(
    ("text", "target"),
    [
        ("ec8:ag=2m/s2", rf.ec8_spectrum(2.0)),
        ("ec8-2024:s_alpha=500 cm/s2,s_beta=0.15g,site=C,damping=0.02",
         rf.ec8_second_spectrum(5.0, 0.15 * G, "C", damping_ratio=0.02)),
        ("ec8-2024:s_alpha=5m/s²,s_beta=200gal,f_alpha=1.3,f_beta=1.7,topography=1.2",
         rf.ec8_second_spectrum(5.0, 2.0, amplification=(1.3, 1.7), topography=1.2)),
        ("ec8: ag = 2 m/s2, ground=E, type=2, importance=1.2, damping=0.02",
         rf.ec8_spectrum(2.0, "E", 2, importance=1.2, damping_ratio=0.02)),
        ("asce7:sds=1g,sd1=0.6g,tl=8", rf.asce7_spectrum(G, 0.6 * G, 8.0)),
        ("asce7:sds=9m/s2,sd1=5m/s2,tl=8,mce=yes", rf.asce7_spectrum(9.0, 5.0, 8.0, mce=True)),
        ("asce7:ss=1.5g,s1=0.6g,site=default,tl=8,mce=no", rf.asce7_site_spectrum(1.5 * G, 0.6 * G, "default", 8.0))
    ]
)  # fmt: skip
def test_targets_of_codes(text, target):
    arguments = (
        "el-centro-1940",
        "--target",
        text,
        "--count",
        1,
        "--periods",
        "0.2,2",
        "--limits",
        "0.01,100",
        "--json",
    )
    found = json.loads(invoke(*arguments).stdout)["target"]
    assert found["periods"] == target.periods.tolist()
    assert found["sa"] == pytest.approx(target.sa.tolist(), rel=1e-14)
    assert found["damping_ratio"] == target.damping_ratio


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("ec8:ag=0.25", "ag"),
        ("ec8-2024:s_alpha=0.6,s_beta=0.2g", "s_alpha"),
        ("ec8-2024:s_alpha=0.6g,s_beta=0.2", "s_beta"),
        ("asce7:sds=1,sd1=0.6g,tl=8", "sds"),
        ("asce7:sds=1g,sd1=0.6,tl=8", "sd1"),
        ("asce7:ss=1.5,s1=0.6g,site=C,tl=8", "ss"),
        ("asce7:ss=1.5g,s1=0.6,site=C,tl=8", "s1"),
    ],
)
def test_an_acceleration_of_a_code_needs_its_unit(text, key):
    said = " ".join(refused(*USUAL, "--target", text).split())
    assert f": {key} must be a number with its unit" in said
    assert all(unit in said for unit in ("g", "m/s2", "cm/s2", "in/s2"))


def test_target_from_a_file(tmp_path):
    file = tmp_path / "site.csv"
    file.write_text("period (s), sa (g)\n0.1, 0.75\n0.5, 0.75\n3.0, 0.1\n")
    arguments = (SUITE, "--target", file, "--count", 2, "--periods", "0.2,2", "--damping", 0.1)
    chosen = rf.load_suite(SUITE).select(rf.read_target(file, damping_ratio=0.1), 2, (0.2, 2.0))
    found = json.loads(invoke(*arguments, "--json").stdout)
    assert found["misfit"] == chosen.misfit
    assert found["zero_period_ratio"] is None
    shown = invoke(*arguments).stdout
    assert "Target: site, damping 0.1, 0.2 to 2 s" in shown
    assert "period of zero" not in shown


def test_printed_table():
    chosen = rf.load_suite(SUITE).select(rf.ec8_spectrum(0.25 * G, "C"), 3, [0.2, 0.5, 1.0])
    shown = invoke(*USUAL).stdout
    rows = {line.split()[0]: line.split() for line in shown.splitlines() if line.startswith("FF-")}
    assert list(rows) == list(chosen.suite.names)
    for name, factor in zip(chosen.suite.names, chosen.factors, strict=True):
        assert f"{factor:.4g}" in [f"{float(cell):.4g}" for cell in rows[name] if cell.replace(".", "").isdigit()]
    assert f"at least {chosen.least_ratio:.3f} of the target" in shown
    assert f"At a period of zero the mean is {chosen.zero_period_ratio:.3f} of the target" in shown
    spread = chosen.dispersion
    assert f"Standard deviation of ln Sa: {spread.min():.2f} to {spread.max():.2f}" in shown
    alone = invoke("el-centro-1940", *USUAL[1:3], "--count", 1, "--periods", "0.2,2").stdout
    assert "Standard deviation" not in alone
    assert "1940" in alone


@pytest.mark.slow
def test_files(tmp_path):
    out, records = tmp_path / "out", tmp_path / "records"
    result = invoke(*USUAL, "--measure", "rotd50", "--out", out, "--records", records)
    assert result.exit_code == 0
    assert "6 scaled records written to" in result.stderr
    chosen = rf.load_suite(SUITE).select(rf.ec8_spectrum(0.25 * G, "C"), 3, [0.2, 0.5, 1.0], measure="rotd50")
    assert sorted(file.name for file in out.iterdir()) == [
        "selection.csv", "selection.png", "spectra.csv", "summary.json"
    ]  # fmt: skip
    table = pd.read_csv(out / "selection.csv")
    assert table["record"].tolist() == [" + ".join(names) for names in chosen.names]
    np.testing.assert_allclose(pd.read_csv(out / "spectra.csv")["mean"], chosen.mean, rtol=1e-15)
    back = rf.read_suite(records)
    assert set(back.names) == set(chosen.suite.names)
    for motion in back:
        assert motion.dt == chosen.suite[motion.name].dt
        np.testing.assert_array_equal(motion.acceleration, chosen.suite[motion.name].acceleration)
    assert "The folder" in refused(*USUAL, "--records", records)
    assert invoke(*USUAL, "--records", records, "--force").exit_code == 0
    assert len(rf.read_suite(records)) == 3


@pytest.mark.slow
def test_scaled_records_keep_their_origin_and_their_scale(tmp_path):
    records, page = tmp_path / "records", tmp_path / "run.html"
    found = json.loads(invoke(*USUAL, "--measure", "geometric-mean", "--records", records, "--json").stdout)
    factors = {name: row["factor"] for row in found["records"] for name in row["record"].split(" + ")}
    original, back = rf.load_suite(SUITE), rf.read_suite(records)
    for motion in back:
        kept = replace(original[motion.name].metadata, scale=factors[motion.name], source_format="columns")
        assert motion.metadata == kept
        assert rf.read_motion(records / f"{motion.name}.csv").metadata == kept
    pairs = {frozenset(motion.name for motion in each.pair) for each in rf.group_stations(back)}
    assert pairs == {frozenset(row["record"].split(" + ")) for row in found["records"]}
    assert record_groups(back) == record_groups(original[motion.name] for motion in back)
    name, factor = next(iter(factors.items()))
    block = tmp_path / "block.toml"
    block.write_text("block = { slenderness = 0.3, half_diagonal = 2.5, mass = 5e3 }")
    ran = [block, records / f"{name}.csv", "--model", "rigid", "--scale", 0.5, "--report", page]
    assert CliRunner().invoke(app, ["run", *map(str, ran)]).exit_code == 0
    facts = read(page).facts
    assert facts["scale"][2] == pytest.approx(0.5 * factor)
    assert facts["pga"][2] == pytest.approx(0.5 * factor * original[name].pga)
    again = json.loads(invoke(records, *USUAL[1:], "--limits", "0.5,0.5", "--records", tmp_path / "b", "--json").stdout)
    twice = {motion.name: motion.metadata.scale for motion in rf.read_suite(tmp_path / "b")}
    assert twice == {row["record"]: pytest.approx(0.5 * factors[row["record"]]) for row in again["records"]}


@pytest.mark.parametrize(
    ("line", "word"), [("scale: twice", "scale"), ("year: 1999.5", "year"), ("direction: sideways", "direction")]
)
def test_a_fact_of_a_written_record_that_was_spoilt(tmp_path, line, word):
    (tmp_path / "a.csv").write_text(f"# Record of rockflex\n# {line}\ntime (s),acc (m/s2)\n0,0\n0.1,1\n0.2,0\n")
    with pytest.raises(rf.InputError, match=f"{word} must be"):
        rf.read_motion(tmp_path / "a.csv")


def test_records_keep_their_vertical_component(tmp_path):
    for name, direction in (("A-000.AT2", "0"), ("A-UP.AT2", "UP")):
        text = f"Event, 1/1/2001, Station, {direction}\nUNITS OF G\nNPTS= 4, DT= .1\n0 .4 -.2 0\n"
        (tmp_path / name).write_text(text)
    result = invoke(
        tmp_path / "A-000.AT2", "--vertical", tmp_path / "A-UP.AT2", *USUAL[1:3], "--count", 1, "--periods", "0.2,2",
        "--limits", "0.01,100", "--records", tmp_path / "scaled"
    )  # fmt: skip
    assert result.exit_code == 0
    assert "1 scaled record written" in result.stderr
    (back,) = rf.read_suite(tmp_path / "scaled")
    np.testing.assert_allclose(back.vertical, back.acceleration, rtol=1e-14)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("--target", "ec9:ag=1"), "--target 'ec9:ag=1' is neither a file nor a code. Write ec8:ag=0.25g,ground=C, or"),
        (("--target", "ec8:"), "--target ec8:...: ag is missing. The keys are ag, and ground, type, importance,"),
        (("--target", "ec8:ag=1,soil=C"), "--target ec8:...: 'soil' is not known. The keys are ag, and ground"),
        (("--target", "ec8-2024:s_alpha=5m/s²,s_beta=200gal,f_beta=2"), "--target ec8-2024:...: give both f_alpha and"),
        (("--target", "ec8:ag"), "--target ec8:...: 'ag' has no value. Write each key once, as in ec8:key=value"),
        (("--target", "ec8:ag=1,ag=2"), "--target ec8:...: 'ag' occurs twice"),
        (("--target", "ec8:ag=0.2 miles"), "--target ec8: ag must be a number with its unit"),
        (("--target", "ec8:ag=1g,ground=Z"), "ground must be one of A, B, C, D, E"),
        (("--target", "asce7:sds=1"), "--target asce7:...: sd1 is missing. The keys are sds, sd1, tl, and mce if"),
        (("--target", "asce7:ss=1"), "--target asce7:...: s1 is missing. The keys are ss, s1, site, tl, and mce"),
        (("--target", "asce7:sds=1g,sd1=1g,tl=8,mce=1"), "--target asce7: mce must be yes or no, but '1' was given"),
        (("--damping", 0.02), "--damping is for a target from a file. Write ec8:...,damping=0.02"),
        (("--periods", "0.2,x"), "--periods must be a number, but 'x' was given"),
        (("--periods", "2,0.2"), "periods must be a range such as (0.2, 2.0)"),
        (("--limits", "1"), "--limits needs 2 numbers separated by commas, but '1' was given"),
        (("--limits", "2,1"), "--limits must be the smallest and the largest factor"),
        (("--count", 99), "--count must be at most 44, the number of records, but 99 was given"),
        (("--force",), "--force was given without --out"),
    ],
)
def test_refuses(arguments, text):
    assert text in refused(*USUAL, *arguments)


def test_refuses_one_folder_for_both(tmp_path):
    text = refused(*USUAL, "--out", tmp_path / "a", "--records", tmp_path / "a")
    assert "is the folder of --out, too. Give it one of its own" in text
    (tmp_path / "file").write_text("x")
    assert "--records" in refused(*USUAL, "--records", tmp_path / "file")
