"""Target spectra of the page: the target, the choice and the files are those of the library."""

import io
import zipfile

import numpy as np
import pandas as pd
import pytest
from test_web_uploads import GIVEN, body_of, give

import rockflex as rf
from rockflex.engine.stops import RunStoppedError, stopping_when
from rockflex.web._selection import selection_view
from rockflex.web._state import parse_page_state
from rockflex.web._uploads import UploadedRecords

SUITE = rf.load_suite("fema-p695-far-field")
SITE = "period (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n0.5, 0.75\n2.0, 0.1875\n"
G = 9.81
TARGETS = [
    ({"kind": "ec8", "ag": 0.3, "ground": "B", "type": "2", "importance": 1.2, "damping": 0.03},
     rf.ec8_spectrum(0.3 * G, "B", 2, importance=1.2, damping_ratio=0.03)),
    ({"kind": "ec8_second", "s_alpha": 0.5, "s_beta": 0.15, "category": "B"},
     rf.ec8_second_spectrum(0.5 * G, 0.15 * G, "B", damping_ratio=0.05)),
    ({"kind": "asce7", "sds": 1.0, "sd1": 0.6, "tl": 8.0, "mce": True},
     rf.asce7_spectrum(1.0 * G, 0.6 * G, 8.0, mce=True)),
    ({"kind": "asce7_site", "ss": 1.5, "s1": 0.6, "site": "C", "tl": 8.0},
     rf.asce7_site_spectrum(1.5 * G, 0.6 * G, "C", 8.0)),
    ({"kind": "table", "table": SITE},
     rf.TargetSpectrum([0.0, 0.1, 0.5, 2.0], np.array([0.3, 0.75, 0.75, 0.1875]) * G)),
]  # fmt: skip
LONG = {"longest": 1.9}


@pytest.mark.slow
@pytest.mark.parametrize(("choice", "target"), TARGETS, ids=[choice["kind"] for choice, _ in TARGETS])
def test_the_choice_is_that_of_the_library(client, choice, target) -> None:
    state = client.state(target=choice | LONG)
    view = client.ask("/api/selection", state)
    chosen = SUITE.select(target, 7, (0.2, 1.9))
    assert [each["record"] for each in view["records"]] == [names[0] for names in chosen.names]
    assert [each["factor"] for each in view["records"]] == pytest.approx(chosen.factors.tolist(), rel=1e-12)
    assert view["target"] == (target.name or "table")
    assert view["misfit"] == pytest.approx(chosen.misfit, rel=1e-9)
    assert view["least_ratio"] == pytest.approx(chosen.least_ratio, rel=1e-9)
    periods = np.array(view["periods"])
    assert np.all(np.diff(periods) > 0.0)
    assert {0.2, 1.9} <= set(periods)
    rows = chosen.at(periods)
    assert view["wanted"] == pytest.approx(target.at(periods).tolist(), rel=1e-9)
    assert view["mean"] == pytest.approx(rows.mean(axis=0).tolist(), rel=1e-9)
    assert np.array(view["singles"]) == pytest.approx(rows, rel=1e-9)
    logs = np.log(rows)
    assert view["high"] == pytest.approx(np.exp(logs.mean(axis=0) + logs.std(axis=0, ddof=1)).tolist(), rel=1e-9)


@pytest.mark.slow
def test_options_of_the_choice(client) -> None:
    options = {"measure": "rotd50", "per_event": 1, "record_weight": 0.3, "least_ratio": 0.9}
    choice = {"count": 5, "smallest": 0.2, "largest": 6.0, **options}
    view = client.ask("/api/selection", client.state(target=choice))
    chosen = SUITE.select(rf.ec8_spectrum(0.25 * G, "C"), 5, (0.2, 2.0), scale_limits=(0.2, 6.0), **options)
    assert [each["record"] for each in view["records"]] == [" + ".join(names) for names in chosen.names]
    assert [each["factor"] for each in view["records"]] == pytest.approx(chosen.factors.tolist(), rel=1e-12)
    assert view["offered"] == 44


@pytest.mark.parametrize(("choice", "path", "said"), [
    ({"ag": -1}, "target.ag", "it must be a_gR in g, from 0.001 to 5, but -1 was given."),
    ({"kind": "asce7", "sd1": 2.0, "sds": 0.1}, "target.tl", "tl must lie between sd1/sds = 20 s"),
    ({"kind": "asce7_site", "site": "E"}, "target.site", "needs an analysis of the hazard"),
    ({"kind": "table"}, "target.table", "no table was given yet"),
    ({"kind": "table", "table": "words"}, "target.table", "the table holds no numbers"),
    ({"kind": "table", "table": "0 0.3\n1 0.5\n"}, "target.units", "the table does not state the unit"),
    ({"kind": "table", "table": SITE, "longest": 3.0}, "target.longest", "2 s"),
    ({"kind": "table", "table": "x" * 20_001}, "target.table", "a table of at most 20000 letters"),
    ({"longest": 0.1}, "target.longest", "periods must be a range such as (0.2, 2.0)"),
    ({"longest": 50.0}, "target.longest", "4 s"),
    ({"count": 60}, "target.count", "n must be at most 44"),
    ({"smallest": 5.0}, "target.largest", "scale_limits must be"),
    ({"source": "el-centro-1940", "measure": "rotd50"}, "target.measure", "needs the two horizontal components"),
    ({"source": "nowhere"}, "target.source", "nowhere"),
    ({"source": "given"}, "target.source", "no records were given yet"),
    ({"least_ratio": 1.9, "largest": 1.0}, "target.least_ratio", "Raise the limit"),
])  # fmt: skip
def test_what_cannot_be_is_said_beside_its_field(client, choice, path, said) -> None:
    errors = client.refused("/api/selection", client.state(target=choice))
    assert list(errors) == [path]
    assert said in errors[path]
    assert "/tmp" not in errors[path]


def test_a_choice_that_nobody_waits_for_is_not_begun(client) -> None:
    state = parse_page_state(client.state(target={"count": 9, "longest": 1.23}))
    with stopping_when(lambda: True), pytest.raises(RunStoppedError):
        selection_view(state, UploadedRecords())
    assert len(selection_view(state, UploadedRecords())["records"]) == 9


@pytest.mark.slow
def test_files_of_the_choice(client, tmp_path, monkeypatch) -> None:
    state = client.state(target={"count": 3})
    chosen = SUITE.select(rf.ec8_spectrum(0.25 * G, "C"), 3, (0.2, 2.0))
    name, spectra = client.download("/api/file/selection-spectra", state)
    assert name == "spectra.csv"
    assert pd.read_csv(io.BytesIO(spectra))["mean"].tolist() == pytest.approx(chosen.mean.tolist(), rel=1e-12)
    table = pd.read_csv(io.BytesIO(client.download("/api/file/selection", state)[1]))
    assert table["factor"].tolist() == pytest.approx(chosen.factors.tolist(), rel=1e-12)
    assert b"<svg" in client.download("/api/file/selection-figure", state)[1]
    packed = client.download("/api/file/selection-records", state)[1]
    zipfile.ZipFile(io.BytesIO(packed)).extractall(tmp_path / "scaled")
    read = rf.read_suite(tmp_path / "scaled")
    assert [motion.pga for motion in read] == [motion.pga for motion in chosen.suite]
    monkeypatch.chdir(tmp_path)
    for choice, target in TARGETS:
        space = client.program("selection-python", client.state(target=choice | LONG))
        assert space["chosen"].names == SUITE.select(target, 7, (0.2, 1.9)).names


@pytest.mark.slow
def test_chosen_records_are_a_suite_of_the_studies(client, frame, tmp_path) -> None:
    cloud = {"suites": ["chosen"], "models": ["2DOF-S"], "scales": [1.0]}
    state = client.state(target={"count": 4, "kind": "asce7"}, cloud=cloud)
    token, answer = client.study("cloud", state)
    assert answer["total"] == 4
    table = client.download(f"/api/study/cloud/{token}/table", state)[1]
    chosen = SUITE.select(rf.asce7_spectrum(G, 0.6 * G, 8.0), 4, (0.2, 2.0))
    runs = rf.run_cloud(frame, chosen.suite, ["2DOF-S"], free_vibration="settle")
    assert pd.read_csv(io.BytesIO(table))["max_rotation"].tolist() == pytest.approx(
        runs["max_rotation"].tolist(), rel=1e-9
    )
    packed = client.download("/api/file/cloud-records", state)[1]
    zipfile.ZipFile(io.BytesIO(packed)).extractall(tmp_path / "records")
    assert set(rf.read_suite(tmp_path / "records").names) == set(chosen.suite.names)
    both = client.state(cloud=cloud | {"suites": ["chosen", "fema-p695-far-field"]})
    said = client.refused("/api/study/cloud", both)["cloud.suites"]
    assert "of two of these suites: fema-p695-far-field and the records for the target. Choose one of the two." in said
    bad = client.state(cloud=cloud, target={"count": 60})
    assert "n must be at most 44" in client.refused("/api/study/cloud", bad)["cloud.suites"]


def test_records_of_a_folder_are_chosen(client, tmp_path, monkeypatch) -> None:
    _, found = give(client, body_of(GIVEN))
    target = {"source": "given", "count": 2, "largest": 100.0, "smallest": 0.01}
    state = client.state(record={"folder": found["folder"], "vertical": True}, target=target)
    view = client.ask("/api/selection", state)
    assert view["offered"] == 3
    packed = client.download("/api/file/selection-records", state)[1]
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        assert len(archive.namelist()) == 2
        archive.extractall(tmp_path / "scaled")
    scaled = rf.read_suite(tmp_path / "scaled")
    factors = {each["record"]: each["factor"] for each in view["records"]}
    assert {motion.name: motion.metadata.scale for motion in scaled} == pytest.approx(factors)
    program = client.download("/api/file/selection-python", state)[1].decode()
    name, packed = client.download("/api/file/records", state)
    assert f"# unpacked from {name}, which the page saves: Your records (ZIP)" in program
    monkeypatch.chdir(tmp_path)
    zipfile.ZipFile(io.BytesIO(packed)).extractall("your-records")
    space = client.program("selection-python", state)
    assert [" + ".join(names) for names in space["chosen"].names] == [each["record"] for each in view["records"]]
    both = client.state(record=state["record"], target=target, cloud={"suites": ["given", "chosen"]})
    said = client.refused("/api/study/cloud", both)["cloud.suites"]
    assert "your folder and the records for the target. Choose one of the two." in said


def test_the_present_record_is_scaled_to_the_target(client, el_centro) -> None:
    state, target = client.state(), rf.ec8_spectrum(0.25 * G, "C")
    body = client.ask("/api/factor", state, period=0.7)
    expected = el_centro.scaled_to(sa=float(target.at([0.7])[0]), period=0.7)
    assert body["factor"] == pytest.approx(expected.pga / el_centro.pga, rel=1e-12)
    over = client.ask("/api/factor", state)
    assert over["factor"] == pytest.approx(el_centro.scaled_to(target, (0.2, 2.0)).pga / el_centro.pga, rel=1e-12)
    for period, said in (
        ("soon", "it must be a period in s, from 0 to 100, but soon was given."),
        (9.0, "4 s"),
        (-1, "but -1"),
    ):
        status, answer = client.post("/api/factor", {"state": state, "period": period})
        assert status == 422
        assert said in answer["errors"]["target.period"]
    pulse = client.state(record={"source": "pulse", "pulse": {"amplitude": 0.001}})
    assert "the factor would be" in client.refused("/api/factor", pulse)["target.period"]
