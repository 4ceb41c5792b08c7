"""Studies that the page runs: their numbers, their end, and their privacy."""

import io
import time

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.studies.design import TendonLevel, smallest_width
from rockflex.web._forms import PRESETS
from rockflex.web._jobs import MAX_STUDIES, BackgroundJobs, StudyJob
from rockflex.web._refusal import Refusal

HANG = 120.0  # s: a guard against what never ends, not a measure of speed

FRAME = make_frame()
CLOUD = {"suites": ["fema-p695-near-field-pulse"], "scales": [1.0], "models": ["2DOF-S"]}
DESIGN = {"suites": ["fema-p695-near-field-pulse"], "scales": [1.0], "widths": 3, "tendons": [0.0, 0.2], "at": 0.8}


@pytest.fixture(scope="module")
def cloud(client):
    token, answer = client.study("cloud", client.state(cloud=CLOUD))
    assert answer["status"] == "done"
    return token


@pytest.fixture(scope="module")
def runs():
    return rf.run_cloud(FRAME, rf.load_suite(CLOUD["suites"][0]), "2DOF-S", free_vibration="settle")


@pytest.mark.parametrize("limit", ["rocking", "rotation", "nominal", "overturning"])
@pytest.mark.parametrize("measure", ["pgv", "sa_t1"])
def test_curves_are_the_librarys_and_refitted_at_once(client, cloud, runs, limit, measure) -> None:
    state = client.state(cloud=CLOUD | {"limit": limit, "measure": measure, "rotation": 0.02})
    begun = time.perf_counter()
    answer = client.ask(f"/api/study/cloud/{cloud}", state)
    assert time.perf_counter() - begun < HANG
    (curve,) = answer["curves"]
    (fit,) = rf.fit_clouds(runs, measure, nominal=limit == "nominal")
    im = np.array(curve["im"])
    if limit == "rotation":
        expected = fit.outcomes.exceedance(im, 0.02)
        assert (np.array(curve["low"]) <= np.array(curve["high"])).all()
        low, high = fit.outcomes.curve(0.02).band(im, 0.9)
    else:
        shown = fit.outcomes.initiation if limit == "rocking" else fit.outcomes.overturning
        expected = shown.probability(im)
        low, high = shown.band(im, 0.9)
    assert np.array(curve["p"]) == pytest.approx(expected, rel=1e-9)
    assert np.array(curve["low"]) == pytest.approx([low[: k + 1].max() for k in range(im.size)])  # rising
    assert np.array(curve["high"]) == pytest.approx([high[k:].min() for k in range(im.size)])
    assert curve["n"] == len(runs)


@pytest.mark.parametrize(
    ("limit", "column"),
    [("drift", "max_top_displacement"), ("ductility", "max_ductility"), ("residual_drift", "max_residual_drift_ratio")],
)
def test_drifts_and_ductilities_are_limits(client, limit, column) -> None:
    stories = {"strengths": 2e5, "post_yield_ratio": 0.05}
    structure = client.state()["structure"]
    frame = {"frame": structure["frame"] | {"stiffness_ratio": "inf"}, "stories": stories}
    bounds = {"drift": 0.006, "ductility": 8.0, "residual_drift": 1e-3}
    cloud = CLOUD | {"models": ["MDOF-S"], "limit": limit, **bounds}
    state = client.state(structure=frame, cloud=cloud)
    token, answer = client.study("cloud", state)
    runs = pd.read_csv(io.BytesIO(client.download(f"/api/study/cloud/{token}/table", state)[1]))
    height = 15.0 if limit == "drift" else 1.0
    beyond = (runs[column].abs() > bounds[limit] * height) | (runs["status"] == "overturned")
    (curve,) = answer["curves"]
    assert 0 < curve["n_exceeding"] == beyond.sum() < len(runs)
    fit = rf.fit_logistic(runs["pgv"], beyond, runs.get("group"))
    assert np.array(curve["p"]) == pytest.approx(fit.probability(np.array(curve["im"])), rel=1e-9)
    space = client.program("cloud-python", state)
    assert space["curves"]["MDOF-S"] == pytest.approx(fit.probability(space["im"]), rel=1e-6)


def test_a_limit_that_the_structure_cannot_have_is_refused(client, cloud) -> None:
    path = f"/api/study/cloud/{cloud}"
    assert "no story" in client.refused(path, client.state(cloud=CLOUD | {"limit": "ductility"}))["cloud.limit"]
    block = {"block": {"width": 0.6, "height": 2.0, "mass": 250.0}}
    state = client.state(structure=block, models=["rigid"], cloud=CLOUD | {"limit": "drift", "models": ["rigid"]})
    assert "drift" in client.refused(path, state)["cloud.limit"]


def test_files_of_a_cloud(client, cloud, tmp_path, monkeypatch, runs) -> None:
    monkeypatch.chdir(tmp_path)
    state = client.state(cloud=CLOUD | {"limit": "rocking"})
    assert b"max_rotation" in client.download(f"/api/study/cloud/{cloud}/table", state)[1]
    assert b"<svg" in client.download(f"/api/study/cloud/{cloud}/figure", state)[1]
    name, study = client.download("/api/file/cloud-study", state)
    (tmp_path / name).write_bytes(study)
    assert rf.run_study(tmp_path / name)["max_rotation"].tolist() == runs["max_rotation"].tolist()
    space = client.program("cloud-python", state)
    (fit,) = rf.fit_clouds(runs, "pgv")
    assert space["curves"]["2DOF-S"] == pytest.approx(fit.outcomes.initiation.probability(space["im"]))


@pytest.mark.parametrize("what", ["nonsense", "report", "report-pdf", "comparison-pdf", "table-pdf"])
def test_a_file_that_a_cloud_does_not_have(client, cloud, what) -> None:
    status, answer = client.post(f"/api/study/cloud/{cloud}/{what}", {"state": client.state(cloud=CLOUD)})
    assert status == 404
    assert what in answer["errors"][""]


def test_a_cloud_is_cancelled(client) -> None:
    state = client.state(cloud=CLOUD | {"models": ["MDOF-C-SI"], "scales": [1.0, 1.5, 2.0, 3.0, 5.0]})
    token = client.ask("/api/study/cloud", state)["token"]
    assert client.request(f"/api/job/{token}", method="DELETE")[0] == 200
    answer = client.wait("cloud", token, state)
    assert answer["status"] == "cancelled"
    assert answer["done"] < answer["total"]


@pytest.mark.slow
def test_the_design_is_the_librarys(client, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    state = client.state(design=DESIGN)
    token, answer = client.study("design", state)
    assert answer["status"] == "done"
    widths = [float(f"{share * FRAME.rocking().half_width:.6g}") for share in (1.0, 2.0, 3.0)]
    levels = [TendonLevel(name="no tendon"), TendonLevel(0.2, 0.5, name="F₀ = 0.2 W")]
    found = rf.run_design(FRAME, rf.load_suite(DESIGN["suites"][0]), widths, levels, "2DOF-S")
    table = rf.design_table(found, 0.02, at=0.8)
    shown = [value for curve in answer["curves"] for value in curve["probability"]]
    assert shown == pytest.approx(table["probability"].tolist())
    answers = smallest_width(table, 0.25)
    assert [each["outcome"] for each in answer["answers"]] == answers["outcome"].tolist()
    space = client.program("design-python", state)
    assert space["answer"]["half_width"].tolist() == pytest.approx(answers["half_width"].tolist(), nan_ok=True)
    assert b"<svg" in client.download(f"/api/study/design/{token}/figure", state)[1]
    assert b"half_width" in client.download(f"/api/study/design/{token}/table", state)[1]
    assert client.post(f"/api/study/cloud/{token}", {"state": state})[0] == 404  # of another kind
    name, study = client.download("/api/file/design-study", state)
    (tmp_path / name).write_bytes(study)
    assert rf.run_study(tmp_path / name)["max_rotation"].tolist() == found["max_rotation"].tolist()


@pytest.mark.slow
def test_studies_have_the_assumptions_of_the_response(client, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assumed = {"impact": "complete", "bouc_wen": {"yield_displacement": 0.05}}
    state = client.state(
        **assumed,
        cloud=CLOUD | {"models": ["2DOF-S", "2DOF-S-BW"]},
        design=DESIGN | {"model": "2DOF-S-BW", "tendons": [0.0]},
    )
    for kind in ("cloud", "design"):
        token, answer = client.study(kind, state, 120.0)
        assert answer["status"] == "done"
        space = client.program(f"{kind}-python", state)
        name, study = client.download(f"/api/file/{kind}-study", state)
        (tmp_path / name).write_bytes(study)
        again = rf.run_study(tmp_path / name)
        assert again["error"].isna().all()
        assert space["runs"]["max_rotation"].tolist() == again["max_rotation"].tolist()
        if kind == "cloud":
            runs = pd.read_csv(io.BytesIO(client.download(f"/api/study/cloud/{token}/table", state)[1]))
            assert runs["max_rotation"].tolist() == again["max_rotation"].tolist()
            elastic, yielding = (part["max_rotation"].to_numpy() for _, part in runs.groupby("model"))
            assert (elastic != yielding).any()


def test_a_narrow_base_of_a_search_is_refused_where_its_runs_take_too_long(client) -> None:
    narrow = {"lumped": PRESETS[10]["structure"]["lumped"] | {"half_width": 0.004}}
    design = DESIGN | {"model": "MDOF-S", "narrowest": 0.2}
    state = client.state(structure=narrow, design=design)
    assert "MDOF-S with 2 modes" in client.refused("/api/study/design", state)["design"]
    state["design"]["narrowest"] = 0.9
    client.request(f"/api/job/{client.ask('/api/study/design', state)['token']}", method="DELETE")


@pytest.mark.parametrize(
    ("kind", "change", "path", "text"),
    [
        ("cloud", {"cloud": {"suites": ["nowhere"]}}, "cloud", "No embedded suite is named"),
        ("cloud", {"cloud": {"scales": [1e9]}}, "cloud.scales", "one to twenty scale factors"),
        ("design", {"design": {"narrowest": 2.0, "widest": 1.5}}, "design.widest", "more than the narrowest"),
        ("design", {"design": {"model": "fixed"}}, "design", "has a fixed base"),
        ("design", {"design": {"rotation": 2.0}}, "design.rotation", "a rotation in rad"),
    ],
)
def test_absurd_studies_are_refused(client, kind, change, path, text) -> None:
    assert text in client.refused(f"/api/study/{kind}", client.state(**change))[path]


def test_a_study_that_takes_too_long_is_refused(client) -> None:
    tall = client.state()["structure"]
    tall["frame"] |= {"n_stories": 200, "period": 4.0, "stiffness_ratio": 0.0}
    suites = ["fema-p695-far-field", "fema-p695-near-field-no-pulse"]
    cloud = {"suites": suites, "scales": [0.1 * n for n in range(1, 16)], "models": ["MDOF-S"]}
    found = client.refused("/api/study/cloud", client.state(structure=tall, cloud=cloud))
    assert "takes too long for a page" in " ".join(found.values())


class Plan:
    """A plan whose chunks wait until they may end."""

    n_chunks, n_runs, checksums = 100, 100, {}

    def __init__(self, error=None) -> None:
        self.error = error

    def chunk(self, number):
        time.sleep(0.01)
        if self.error:
            raise self.error
        return type("Table", (), {"num_rows": 1})()


def ended(job, seconds=5.0):
    end = time.monotonic() + seconds
    while not job.over and time.monotonic() < end:
        time.sleep(0.01)
    return job.status


def test_a_job_that_nobody_looks_at_ends(monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._jobs.ABANDONED_AFTER", 0.05)
    job = StudyJob(Plan(), "cloud")
    job.compute()
    assert job.status == "cancelled"
    assert 0 < job.runs < 100


def test_a_failure_is_told_without_a_traceback(caplog) -> None:
    job = StudyJob(Plan(rf.InputError("The record is wrong.")), "cloud")
    job.compute()
    assert (job.status, job.message) == ("failed", "The record is wrong.")
    job = StudyJob(Plan(ZeroDivisionError("secret")), "cloud")
    job.compute()
    assert (job.status, job.message) == ("failed", "An internal error occurred; the log of the server has the details.")
    assert "ZeroDivisionError" in caplog.text


def test_jobs_are_many_but_limited() -> None:
    jobs = BackgroundJobs("studies", MAX_STUDIES)
    tokens = [jobs.start(StudyJob(Plan(), "cloud")) for _ in range(12)]
    with pytest.raises(Refusal, match="12 studies of yours"):
        jobs.start(StudyJob(Plan(), "cloud"))
    jobs.cancel(tokens[-1])
    assert jobs.get(tokens[-1]).status == "cancelled"
    assert len(set(tokens)) == 12
    jobs.close()
    assert ended(jobs.get(tokens[0])) == "cancelled"
