"""The server: its command, requests and answers, and what it withstands."""

import asyncio
import io
import json
import math
import os
import signal
import socket
import subprocess
import sys
import threading
import time
import urllib.parse
import urllib.request
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.errors import InputError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.schema import IMPACT
from rockflex.structure._outline import DARK_ELEMENT_COLORS, ELEMENT_COLORS
from rockflex.studies._ground_tables import GroundTable
from rockflex.web import _app, make_app
from rockflex.web._forms import PRESETS
from rockflex.web._serve import serve

HANG = 120.0  # s: a guard against what never ends, not a measure of speed

FRAME = make_frame()
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
YIELDING = {"yield_displacement": 0.075}
CSV = b"time (s),acc (m/s2)\n" + b"".join(b"%.2f,%.4f\n" % (0.02 * i, 3.0 * math.sin(0.1 * i)) for i in range(400))


def upload(client, content=CSV, **query):
    path = "/api/upload?" + "&".join(f"{key}={value}" for key, value in ({"name": "mine.csv"} | query).items())
    status, _, body = client.request(path, content, Content_Type="application/octet-stream")
    return status, json.loads(body)


def test_the_numbers_are_the_librarys(client) -> None:
    state = client.state(scale=1.7, models=["MDOF-S", "2DOF-C", "fixed"])
    answer = client.ask("/api/response", state)
    for shown in answer["models"]:
        response = rf.simulate(FRAME, EL_CENTRO.scaled(1.7), shown["label"], free_vibration=5.0)
        assert shown["peaks"] == json.loads(json.dumps(response.peaks()))
        time, rotation = client.unpack(shown["t"]), client.unpack(shown["rotation"])
        assert np.isin(rotation, response.rotation.astype("f4")).all()
        assert np.interp(time, response.time, response.top_displacement) == pytest.approx(
            client.unpack(shown["top_displacement"]), abs=2e-3 * response.max_top_displacement
        )
        total = client.unpack(shown["total_top_displacement"])
        assert np.abs(total).max() == np.float32(np.abs(response.total_top_displacement).max())
        assert shown["warnings"] == list(response.warnings)
        assert np.abs(rotation).max() == np.float32(np.abs(response.rotation).max())
        assert shown["impact_times"] == response.impact_times[:600].tolist()
        floors = FRAME.rocking().floors
        points = client.unpack(shown["points"]).reshape(time.size, 6)
        n = response.modal_displacement.shape[1]
        whole = response.modal_displacement @ floors.displacement[:, :n].T
        assert np.abs(points[:, 1:]).max() == pytest.approx(np.abs(whole).max(), rel=0.05)
        assert (points[:, 0] == 0.0).all()
    structure = client.ask("/api/structure", state)
    assert structure["adequacy"]["reason"] == rf.adequacy(FRAME.rocking(), base_mass=40e3).reason
    assert [mode["period"] for mode in structure["modes"]] == pytest.approx(FRAME.modal().period.tolist(), rel=1e-12)
    measures = {each["name"]: each["value"] for each in client.ask("/api/record", state)["measures"]}
    scaled = EL_CENTRO.scaled(1.7)
    assert (measures["PGA"], measures["PGV"], measures["Arias"]) == (scaled.pga, scaled.pgv, scaled.arias)


def test_what_is_assumed_is_simulated(client) -> None:
    labels = ["2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW"]
    answer = client.ask("/api/response", client.state(models=labels, bouc_wen=YIELDING))
    hysteresis = [None, rf.BoucWen(0.075), rf.BoucWen(0.075)]
    for label, shown, bouc_wen in zip(labels, answer["models"], hysteresis, strict=True):
        expected = rf.simulate(FRAME, EL_CENTRO, label, free_vibration=5.0, bouc_wen=bouc_wen)
        assert shown["peaks"] == json.loads(json.dumps(expected.peaks()))
    p = FRAME.rocking()
    lifts = p.resisting_moment / (p.effective_mass[0] * p.effective_height[0] * p.omega[0] ** 2)
    assert lifts < answer["suggested_yield"] < EL_CENTRO.sd(1.0, 0.02)
    bouncing = client.state(models=["2DOF-S"], impact="restitution", restitution=0.8)
    shown = client.ask("/api/response", bouncing)["models"][0]["peaks"]
    expected = rf.simulate(FRAME, EL_CENTRO, "2DOF-S", free_vibration=5.0, impact=rf.Restitution(0.8))
    assert shown == json.loads(json.dumps(expected.peaks()))
    block = client.state(structure={"block": {"slenderness": 0.2, "half_diagonal": 3.0}}, models=["rigid"])
    assert client.ask("/api/response", block)["suggested_yield"] is None


@pytest.mark.slow
@pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset["title"])
def test_every_preset_answers_on_every_tab(client, preset) -> None:
    rigid = {"models": ["rigid"]} if "block" in preset["structure"] else {}
    state = client.state(structure=as_json_value(preset["structure"]), **rigid)
    for path in ("/api/structure", "/api/record", "/api/response"):
        json.dumps(client.ask(path, state), allow_nan=False)


def test_overturning_is_told(client) -> None:
    answer = client.ask("/api/response", client.state(scale=20.0, models=["2DOF-S"]))
    (shown,) = answer["models"]
    assert shown["status"] == "overturned"
    assert 0.0 < shown["fall_time"] < shown["peaks"]["end_time"]


def test_an_upload_is_simulated(client) -> None:
    status, found = upload(client)
    assert status == 200
    state = client.state(record={"source": "upload", "upload": found["upload"]}, models=["2DOF-S"])
    time = 0.02 * np.arange(400)
    motion = rf.GroundMotion([float(f"{3.0 * math.sin(0.1 * i):.4f}") for i in range(400)], 0.02, name="mine")
    assert time[-1] == motion.duration
    shown = client.ask("/api/response", state)["models"][0]["peaks"]
    expected = rf.simulate(FRAME, motion, "2DOF-S", free_vibration=5.0)
    assert shown["max_rotation"] == pytest.approx(expected.max_rotation, rel=1e-9)
    gone = state | {"record": {"source": "upload", "upload": "0" * 64}}
    assert "Choose the file again" in client.refused("/api/response", gone)["record.upload"]


def test_a_bad_upload_is_refused(client) -> None:
    status, answer = upload(client, b"nothing\n")
    assert (status, answer["errors"]["record.upload"][:8]) == (422, "mine.csv")
    assert upload(client, dt="abc")[1]["errors"]["record.upload"].startswith("the sampling step must be a number")
    assert upload(client, dt="-1")[0] == 422
    assert upload(client, units="miles")[0] == 422
    assert upload(client, name="../../../etc/passwd")[1]["name"] == "passwd"
    assert upload(client, b"1" * 7_000_000)[0] == 413


@pytest.mark.parametrize(
    ("change", "path", "text"),
    [
        ({"scale": 1e300}, "scale", "from 0.01 to 20"),
        ({"scale": math.nan}, "scale", "it must be a number from 0.01"),
        ({"free_vibration": 36_000.0}, "free_vibration", "from 0 to 60"),
        ({"record": {"source": "suite", "suite": "../../x"}}, "record.suite", "No embedded suite is named"),
        ({"record": {"suite": "el-centro-1940", "name": "X"}}, "record.name", "No motion of the suite"),
        ({"record": {"source": "pulse", "pulse": {"period": 36_000.0}}}, "record.pulse.period", "from 0.05 to 20"),
        ({"models": ["9DOF-S"]}, "models", "needs 8 modes, but the structure has 5"),
        ({"models": ["2DOF-S-BW"]}, "models", "2DOF-S-BW yields, but no yield displacement was given."),
        ({"models": ["MDOF-S-BW"], "bouc_wen": YIELDING}, "models", "bouc_wen applies to models with one mode"),
        ({"impact": "restitution"}, "restitution", "needs its coefficient. Give restitution, a number from 0 to 1."),
        ({"impact": "simplified", "restitution": 0.5}, "restitution", "but the impact law is 'simplified'. Choose"),
        ({"impact": "restitution", "restitution": 1.5}, "restitution", "1.5"),
        (
            {"impact": "model"},
            "impact",
            f"it must be {IMPACT.expected}, but 'model' was given.",
        ),
        ({"bouc_wen": {"yield_displacement": 1e9}}, "bouc_wen.yield_displacement", "from 1e-06 to 100"),
        ({"bouc_wen": {"yield_displacement": 0.1, "exponent": 0.5}}, "bouc_wen.exponent", "from 1 to 50"),
        ({"bouc_wen": {"yield_displacement": 0.1, "gamma": 0.2}}, "bouc_wen.gamma", "return more energy"),
        ({"bouc_wen": {}}, "bouc_wen.yield_displacement", "it is missing: D_y of the first mode"),
    ],
)
def test_absurd_requests_are_refused_beside_their_field(client, change, path, text) -> None:
    assert text in client.refused("/api/response", client.state(**change))[path]


NARROW = PRESETS[10]["structure"]["lumped"]
TALL = PRESETS[0]["structure"]["frame"] | {"n_stories": 200, "period": 5.0, "aspect_ratio": 5.0, "stiffness_ratio": 0.0}
MANY = PRESETS[0]["structure"]["frame"] | {"n_stories": 130, "period": 4.0, "stiffness_ratio": "inf"}
WEAKLY_DAMPED = {
    "n_stories": 71, "story_height": 22.924, "story_mass": 2.39656, "base_mass": 0.010754,
    "stiffness_ratio": 0.0020881, "period": 0.22484, "aspect_ratio": 12.8329, "damping_ratio": 0.00021412,
}  # fmt: skip


@pytest.mark.parametrize(
    ("structure", "models", "free", "said"),
    [
        ({"frame": TALL}, ["MDOF-S"], 5.0, "takes too long for a page"),
        ({"frame": MANY}, ["MDOF-S", "90DOF-S", "80DOF-S", "fixed"], 5.0, "too long together"),
        ({"lumped": NARROW | {"half_width": 1e-3}}, ["MDOF-S"], 60.0, "a wider base or a shorter record"),
        ({"frame": WEAKLY_DAMPED}, ["MDOF-C-SI"], 5.0, "takes too long for a page"),
    ],
    ids=["tall", "together", "narrow", "weakly damped"],
)
def test_runs_that_take_too_long_are_refused(client, structure, models, free, said) -> None:
    record = {"suite": "fema-p695-far-field", "name": "FF-12-a"}
    state = client.state(structure=structure, record=record, models=models, scale=20.0, free_vibration=free)
    begun = time.perf_counter()
    assert said in client.refused("/api/response", state)["models"]
    assert time.perf_counter() - begun < HANG


@pytest.mark.slow
@pytest.mark.parametrize(("frame", "model"), [(TALL, "3DOF-S"), (MANY, "MDOF-S")])
def test_tall_structures_with_fewer_models_or_modes_are_not_refused(client, frame, model) -> None:
    record = {"suite": "fema-p695-far-field", "name": "FF-12-a"}
    answer = client.ask("/api/response", client.state(structure={"frame": frame}, record=record, models=[model]))
    assert answer["models"][0]["label"] == model


def test_energies_that_take_long_are_left_out(client) -> None:
    state = client.state(structure={"lumped": NARROW | {"half_width": 0.008}}, models=["MDOF-S"])
    answer = client.ask("/api/response", state)
    assert answer["models"][0]["peaks"]["n_impacts"] >= 0
    assert answer["energy"]["note"].startswith("The energy is not computed here for so many or such fast modes")


def test_a_structure_comes_with_how_it_moves(client, frame, el_centro) -> None:
    ground = {"mat_mass": 4e4, "springs": {"stiffness": 4e8, "heave_damping_ratio": 0.3}}
    state = client.state(ground=ground, models=["fixed", "MDOF-S"][1:])
    under = GroundTable.model_validate(ground).under(frame.rocking())
    for quick, main, held in ((False, "MDOF-S", "fixed"), (True, "2DOF-S", "1DOF-fixed")):
        answer = client.ask("/api/structure", state, quick=quick)
        assert ("adequacy" in answer) != quick
        run, fixed = answer["run"], rf.simulate(frame, el_centro, held, free_vibration=5.0)
        expected = rf.simulate(frame, el_centro, main, free_vibration=5.0, ground=under)
        (model,) = run["models"]
        assert model["label"] == main
        assert model["peaks"]["max_rotation"] == expected.max_rotation
        assert answer["heights"] == [0.0, 3.0, 6.0, 9.0, 12.0, 15.0]
        assert not {"heights", "strokes", "ground"} & set(run)
        assert [name for name in model["peaks"] if name.startswith("time_of_")] == ["time_of_max_rotation"]
        assert run["fixed_base_moment"] == pytest.approx(fixed.max_base_moment, rel=1e-9)  # on rigid ground
        assert run["fixed_top_displacement"] == pytest.approx(fixed.max_total_top_displacement, rel=1e-9)
        assert np.abs(client.unpack(model["rotation"])).max() == pytest.approx(expected.max_rotation, rel=0.01)
    missing = client.ask("/api/structure", client.state(record={"source": "upload", "upload": "0" * 64}))
    assert missing["adequacy"]
    assert "file" in missing["run"]["note"]
    block = client.ask(
        "/api/structure",
        client.state(structure={"block": {"slenderness": 0.2, "half_diagonal": 3.0}}, models=["fixed"]),
    )
    assert block["run"]["models"][0]["label"] == "rigid"
    assert block["run"]["fixed_base_moment"] is None


@pytest.mark.slow
def test_many_stories_are_judged_in_time(client) -> None:
    tall = client.state()["structure"]
    tall["frame"] |= {"n_stories": 100, "period": 4.0}
    begun = time.perf_counter()
    view = client.ask("/api/structure", client.state(structure=tall))
    assert time.perf_counter() - begun < HANG
    expected = rf.adequacy(make_frame(n_stories=100, period=4.0).rocking(), base_mass=40e3)
    assert view["adequacy"]["reason"] == expected.reason


def test_what_is_no_question_is_refused(client) -> None:
    assert client.request("/api/response", b"{}")[0] == 415
    assert client.post("/api/response", b"[1, 2")[0] == 400
    assert client.post("/api/response", b"[" * 200_000)[0] == 400
    assert client.post("/api/response", [1])[0] == 400
    assert client.post("/api/response", {})[0] == 422
    assert client.post("/api/response", b'{"state": "' + b"x" * 7_000_000 + b'"}')[0] == 413
    assert client.post("/api/study/nonsense", {})[0] == 404
    assert client.post("/api/study/cloud/guess", {"state": client.state()})[0] == 404
    assert client.request("/api/job/guess", method="DELETE")[0] == 404
    assert client.post("/api/file/secrets", {"state": client.state()})[0] == 404
    for path in ("/static/../_app.py", "/static/..%2f_app.py", "/static/%2e%2e/_app.py", "/etc/passwd"):
        assert client.request(path)[0] == 404
    assert client.request("/api/suite/..%2f..%2fetc")[0] in (404, 422)


def test_only_this_machines_names_are_answered(client) -> None:
    assert client.request("/", Host="evil.example")[0] == 400
    assert client.request("/", Host="localhost:1")[0] == 200
    assert client.request("/", Host="[::1]:1")[0] == 200
    assert client.request("/", Origin="http://evil.example")[0] == 400
    assert client.request("/", Origin="null")[0] == 400
    assert client.request("/", Origin=client.url)[0] == 200


def answers(app, host: str) -> bool:
    """Whether an application answers to a host name."""
    said = []

    async def send(message) -> None:
        said.append(message)

    async def receive():
        await asyncio.Event().wait()  # the visitor stays

    scope = {"type": "http", "method": "GET", "path": "/", "query_string": b"", "headers": [(b"host", host.encode())]}
    with ThreadPoolExecutor(1) as other:  # a browser's tests leave an event loop in this thread
        other.submit(lambda: asyncio.run(app(scope, receive, send))).result()
    return said[0]["status"] == 200


@pytest.mark.parametrize(
    ("host", "known", "foreign"),
    [
        ("127.0.0.1", ["127.0.0.1:80", "localhost", "[::1]:80"], ["evil.example", "10.0.0.1", "", "localhost.evil"]),
        ("127.0.0.2", ["127.0.0.2:80", "LOCALHOST:80"], ["evil.example", "10.0.0.1"]),
        ("::1", ["[::1]:80", "localhost:80"], ["evil.example", "::1.evil.example"]),
        ("localhost", ["localhost:80", "127.0.0.1"], ["evil.example"]),
        ("10.0.0.1", ["10.0.0.1:80", "localhost"], ["evil.example", "10.0.0.2"]),
        ("0.0.0.0", ["10.0.0.1:80", "[fd00::1]", socket.gethostname()], ["evil.example", "[evil"]),
        ("::", ["10.0.0.1:80", "[fd00::1]:80"], ["evil.example"]),
    ],
)  # fmt: skip
def test_every_address_to_listen_on_has_its_own_names(host, known, foreign) -> None:
    app = make_app(host)
    assert [name for name in known if not answers(app, name)] == []
    assert [name for name in foreign if answers(app, name)] == []
    assert answers(make_app(host, ["page.example"]), "page.example:80")


def test_an_error_of_the_server_shows_no_traceback(client, monkeypatch) -> None:
    def broken(*_):
        raise RuntimeError("secret")

    monkeypatch.setattr("rockflex.web._app.structure_view", broken)
    status, answer = client.post("/api/structure", {"state": client.state()})
    assert status == 500
    assert answer == {"errors": {"": "An internal error occurred; the log of the server has the details."}}


FACADE = {
    "block": {"width": 0.6, "height": 6.0, "mass": 7e3},
    "one_sided": {"restitution": 0.4, "side": "left"},
    "elements": [{"kind": "tendon", "initial_force": 0.0, "stiffness": 2e6, "height": 5.8, "rupture_elongation": 0.02}],
}
COLUMNS = {"n_columns": 4, "column_width": 1.6, "column_height": 9.6, "column_mass": 6e4, "cap_mass": 2.4e5}


@pytest.mark.slow
def test_the_python_lines_repeat_the_numbers(client, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    _, found = upload(client)
    states = [
        client.state(scale=1.3, impact="complete", models=["2DOF-S", "fixed"]),
        client.state(record={"source": "pulse", "pulse": {"shape": "mavroeidis", "amplitude": 0.6, "nu": 0.3}}),
        client.state(record={"source": "upload", "upload": found["upload"]}, models=["2DOF-S"]),
        client.state(structure=PRESETS[8]["structure"]),
        client.state(structure=PRESETS[-1]["structure"], models=["2DOF-S"]),
        client.state(
            structure={"block": {"slenderness": 0.2, "half_diagonal": 3.0}, "eccentricity": 0.1}, models=["rigid"]
        ),
        client.state(structure=FACADE, models=["rigid"]),
        client.state(structure={"rocking_frame": COLUMNS}, models=["rigid"]),
        client.state(impact="restitution", restitution=0.4, models=["2DOF-S-BW", "MDOF-S"], bouc_wen=YIELDING),
    ]
    for state in states:
        if state["record"]["source"] == "upload":
            name, record = client.download("/api/file/record", state)
            (tmp_path / name).write_bytes(record)
        space = client.program("python", state)
        shown = {each["label"]: each["peaks"] for each in client.ask("/api/response", state)["models"]}
        for label, response in space["responses"].items():
            for key in ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear"):
                assert getattr(response, key) == pytest.approx(shown[label][key], rel=1e-9)
        assert (tmp_path / "response.svg").read_text().startswith("<?xml")


@pytest.mark.slow
def test_the_case_file_repeats_the_numbers(client, tmp_path) -> None:
    _, found = upload(client)
    states = [
        client.state(scale=1.3, impact="complete", models=["2DOF-S", "fixed"]),
        client.state(record={"source": "pulse", "pulse": {"shape": "mavroeidis", "amplitude": 0.6, "nu": 0.3}}),
        client.state(record={"source": "upload", "upload": found["upload"]}, models=["2DOF-S"]),
        client.state(structure=PRESETS[8]["structure"], ground={"friction": 0.3}, models=["2DOF-S", "MDOF-S"]),
        client.state(impact="restitution", restitution=0.4, models=["2DOF-S-BW", "MDOF-S"], bouc_wen=YIELDING),
    ]
    for state in states:
        name, case = client.download("/api/file/case", state)
        (tmp_path / name).write_bytes(case)
        name, record = client.download("/api/file/record", state)
        (tmp_path / name).write_bytes(record)
        table = rf.read_case(tmp_path / "case.toml").run().set_index("model")
        for each in client.ask("/api/response", state)["models"]:
            for key in ("max_rotation", "max_top_displacement", "max_base_moment"):
                assert table[key][each["label"]] == pytest.approx(each["peaks"][key], rel=1e-9)


def test_every_download_is_what_it_says(client) -> None:
    state = client.state(models=["2DOF-S", "fixed"])
    response = rf.simulate(FRAME, EL_CENTRO, "2DOF-S", free_vibration=5.0)
    assert b"<svg" in client.download("/api/file/figure", state)[1]
    histories = pd.read_csv(io.BytesIO(client.download("/api/file/histories", state)[1]))
    mine = histories[histories["model"] == "2DOF-S"]
    assert mine["rotation (rad)"].to_numpy() == pytest.approx(response.rotation, rel=1e-8, abs=1e-300)


def test_a_port_that_is_taken_or_absurd_is_told() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(
            InputError, match=r"The page cannot listen on 127\.0\.0\.1, port .*: .* Choose another --port\."
        ):
            serve(taken.getsockname()[1])
    with pytest.raises(InputError, match="port"):
        serve(70_000)


BEGUN = b"POST /api/state HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: Application/JSON\r\nContent-Length: 999\r\n\r\n{"


@pytest.mark.parametrize("name", ["запись.csv", "记录.csv", "θ.csv"])
def test_a_record_with_a_foreign_name_comes_back(client, name) -> None:
    key = upload(client, name=urllib.parse.quote(name))[1]["upload"]
    state = client.state(record={"source": "upload", "upload": key})
    assert client.download("/api/file/record", state)[0] == name


@pytest.mark.parametrize("endpoint", ["state", "structure"])
def test_half_a_character_in_a_name_is_refused(client, endpoint) -> None:
    text = json.dumps({"state": client.state()}).replace("Structure #1 of Table 1", "\\ud800")
    assert client.post(f"/api/{endpoint}", text.encode())[0] == 422


def test_a_nested_focus_is_no_error(client) -> None:
    state = json.dumps({"state": client.state(models=["2DOF-S"], free_vibration=0.0)})
    for depth in range(900, 1000, 5):
        text = f'{state[:-1]},"focus":{"[" * depth}{"]" * depth}}}'
        assert client.post("/api/response", text.encode())[0] in (200, 400, 422), depth


def test_all_fields_at_fault_are_named_at_once(client) -> None:
    frame = client.state()["structure"]["frame"] | {"story_mass": "lots", "story_height": -3.0, "n_stories": 5}
    errors = client.refused("/api/structure", client.state(structure={"frame": frame}))
    assert set(errors) == {"structure.frame.story_mass", "structure.frame.story_height"}


@pytest.mark.parametrize(("kind", "choice"), [("cloud", {"models": ["MDOF-S"]}), ("design", {"model": "2DOF-S"})])
def test_a_study_that_no_run_of_can_be_made_is_refused(client, kind, choice) -> None:
    """A block has no modes: refused at the start, or at least not "done" without a word."""
    state = client.state(structure={"block": {"slenderness": 0.2, "half_diagonal": 3.0, "mass": 1000.0}})
    state[kind] |= choice | {"scales": [1.0]}
    errors = client.refused(f"/api/study/{kind}", state)
    assert "rigid" in " ".join(errors.values())


def test_the_limit_of_a_rotation_has_a_median(client) -> None:
    state = client.state()
    state["cloud"] |= {"limit": "rotation", "rotation": 0.005}
    curve = client.study("cloud", state)[1]["curves"][0]
    crossing = next(im for im, p in zip(curve["im"], curve["p"], strict=True) if p >= 0.5)
    assert curve["median"] == pytest.approx(crossing, rel=0.1)


def test_histories_of_too_many_rows_are_refused(client, monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._downloads.MAX_HISTORY_ROWS", 1000)
    assert "Python lines." in client.made("histories", client.state())["errors"]["models"]


def test_foreign_pages_cannot_send_files(client) -> None:
    for path in ("/api/upload?name=a.csv", "/api/matrices?name=a.npz"):
        status, _, body = client.request(path, CSV, Content_Type="text/plain")
        assert (status, json.loads(body)["errors"][""]) == (415, "A request must be application/octet-stream.")


def test_a_visitor_who_leaves_in_the_middle_leaves_no_traceback(client, caplog, monkeypatch) -> None:
    begun, over = threading.Event(), threading.Event()

    async def watched(*given) -> bytes:
        begun.set()
        try:
            return await read(*given)
        finally:
            over.set()

    read = _app._request_body
    monkeypatch.setattr(_app, "_request_body", watched)
    host, port = client.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port))) as connection:
        connection.sendall(BEGUN)
        assert begun.wait(HANG)
    assert over.wait(HANG)
    assert not [record for record in caplog.records if record.exc_info]
    assert client.request("/api/about")[0] == 200


def test_a_body_that_does_not_arrive_is_given_up(client, monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._app.BODY_TIMEOUT", 0.2)
    host, port = client.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=60) as connection:
        connection.sendall(BEGUN)
        assert connection.recv(1000).startswith(b"HTTP/1.1 408")


def test_every_answer_forbids_foreign_content(client) -> None:
    for path in ("/", "/api/about", "/static/main.js", "/nowhere"):
        policy = client.request(path)[1]["content-security-policy"]
        assert "default-src 'self'" in policy
        assert "frame-ancestors 'none'" in policy
    assert b"http" not in client.request("/")[2]  # nothing from elsewhere


def test_long_messages_are_cut(client) -> None:
    errors = client.refused("/api/response", client.state(record={"suite": "x" * 120}))
    assert all(len(text) <= 1000 for text in errors.values())
    status, answer = upload(client, units="x" * 5000)
    assert status == 422
    assert len(json.dumps(answer)) < 1200


RUN = [sys.executable, "-m", "rockflex", "serve"]


@contextmanager
def served(*command: str) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """The process of a server, and its port, once it has told its address; from then on it answers."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    # A shell lets what it starts in the background ignore Ctrl-C; the server must not inherit that.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with subprocess.Popen([*command, "--port", str(port)], stderr=subprocess.PIPE, text=True) as process:
        signal.signal(signal.SIGINT, before)
        limit = threading.Timer(HANG, process.kill)
        limit.start()
        try:
            assert f"http://127.0.0.1:{port} (stop with Ctrl-C)" in process.stderr.readline()
            assert b"rockflex" in page(port)
            limit.cancel()
            yield process, port
        finally:
            limit.cancel()
            process.kill()


def page(port: int) -> bytes:
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=20) as answer:
        return answer.read()


def test_the_page_is_served_on_loopback_and_stops_cleanly() -> None:
    with served(*RUN) as (process, port):
        with socket.socket() as other:
            other.settimeout(1.0)
            # Another address of this machine reaches nothing.
            assert other.connect_ex(("127.0.0.2", port)) != 0
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=HANG)
    assert "Traceback" not in said


@pytest.mark.slow
def test_it_waits_for_a_file_that_is_drawn_when_it_is_stopped(client) -> None:
    program = """
import sys, time
from rockflex.cli import main
from rockflex.web._jobs import BackgroundFileJob

def work(job):
    while not job.cancelled.is_set():
        time.sleep(0.01)
    time.sleep(0.5)
    print("drawn", file=sys.stderr, flush=True)

BackgroundFileJob.work = work
main()
"""
    with served(sys.executable, "-c", program, "serve") as (process, port):
        other = type(client)(f"http://127.0.0.1:{port}")
        token = other.ask("/api/file/record", client.state())["token"]
        while json.loads(other.request(f"/api/file/{token}")[2])["status"] != "running":
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=HANG)
    assert process.returncode == 0
    assert "drawn" in said


@pytest.mark.slow
def test_a_file_that_is_read_for_ever_does_not_keep_the_server_from_stopping(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    (tmp_path / "reading_for_ever.py").write_text(
        "import sys, tempfile, time\n"
        "def read(*_):\n"
        "  with tempfile.TemporaryDirectory():\n"
        "    print('reading', file=sys.stderr, flush=True)\n"
        "    while True: time.sleep(0.01)\n"
    )
    program = (
        "import rockflex.web._app as app, reading_for_ever\n"
        "app.read_uploaded_record = reading_for_ever.read\nfrom rockflex.cli import main; main()"
    )
    with served(sys.executable, "-c", program, "serve") as (process, port), ExitStack() as held:
        connection = held.enter_context(socket.create_connection(("127.0.0.1", port)))
        connection.sendall(
            b"POST /api/upload?name=a.csv HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/octet-stream\r\n"
            b"Content-Length: 1\r\n\r\n1"
        )
        while "reading" not in (line := process.stderr.readline()):
            assert line  # at its end nothing would come any more
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=HANG)
    assert "Traceback" not in said
    assert [*(tmp_path / "temporary").iterdir()] == []


@pytest.mark.slow
def test_an_address_for_everybody_is_warned_of_and_a_port_checked() -> None:
    done = subprocess.run([*RUN, "--host", "192.0.2.1", "--port", "8080"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert "--no-token" in done.stderr
    assert "cannot listen on 192.0.2.1, port 8080" in " ".join(done.stderr.split())
    assert "http://" not in done.stderr  # no address of a page that does not answer


def test_help_loads_no_server() -> None:
    program = "import sys; from rockflex.cli import main; sys.argv = ['rockflex', 'serve', '--help']\ntry: main()\n"
    program += "except SystemExit: print({'starlette', 'uvicorn', 'numba', 'matplotlib'} & sys.modules.keys())"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert "--port" in done.stdout
    assert done.stdout.rstrip().endswith("set()")


def test_the_page_has_the_colours_of_the_drawings(client):
    status, headers, body = client.request("/static/elements.css")
    assert status == 200
    assert headers["content-type"].startswith("text/css")
    light, dark = body.decode().splitlines()
    assert light.startswith(":root {")
    assert 'data-theme="dark"' in dark
    for name in ELEMENT_COLORS:
        assert f"--{name}: {ELEMENT_COLORS[name]};" in light
        assert f"--{name}: {DARK_ELEMENT_COLORS[name]};" in dark
