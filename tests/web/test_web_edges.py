"""Answers of the server to names, nests and aborted questions, and to studies none of whose runs can be made."""

import json
import socket
import time
import urllib.parse

import pytest

RECORD = "\n".join(f"{i * 0.01:.2f},{(i % 7 - 3) * 0.5}" for i in range(500)).encode()
BEGUN = b"POST /api/state HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: Application/JSON\r\nContent-Length: 999\r\n\r\n{"


@pytest.mark.parametrize("name", ["запись.csv", "记录.csv", "θ.csv"])
def test_a_record_with_a_foreign_name_comes_back(client, name) -> None:
    query = f"/api/upload?units=m/s2&name={urllib.parse.quote(name)}"
    key = json.loads(client.request(query, RECORD, Content_Type="application/octet-stream")[2])["upload"]
    state = client.state(record={"source": "upload", "upload": key})
    status, headers, _ = client.request(
        "/api/download/record", json.dumps({"state": state}).encode(), Content_Type="application/json"
    )
    assert status == 200
    assert urllib.parse.unquote(headers["content-disposition"].split("UTF-8''")[1]) == name


@pytest.mark.parametrize("endpoint", ["state", "structure"])
def test_half_a_character_in_a_name_is_refused(client, endpoint) -> None:
    text = json.dumps({"state": client.state()}).replace("Structure #1 of Table 1", "\\ud800")
    assert client.post(f"/api/{endpoint}", text.encode())[0] == 422


@pytest.mark.parametrize("depth", range(900, 1000, 5))
def test_a_nested_focus_is_no_error(client, depth) -> None:
    text = json.dumps({"state": client.state()})[:-1] + ',"focus":' + "[" * depth + "]" * depth + "}"
    assert client.post("/api/response", text.encode())[0] in (200, 400, 422)


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
    token = client.ask("/api/study/cloud", state)["token"]
    curve = client.wait("cloud", token, state)["curves"][0]
    crossing = next(im for im, p in zip(curve["im"], curve["p"], strict=True) if p >= 0.5)
    assert curve["median"] == pytest.approx(crossing, rel=0.1)


def test_weakly_damped_modes_in_complete_models_are_refused_where_they_take_long(client) -> None:
    frame = {
        "n_stories": 71, "story_height": 22.924, "story_mass": 2.39656, "base_mass": 0.010754,
        "stiffness_ratio": 0.0020881, "period": 0.22484, "aspect_ratio": 12.8329, "damping_ratio": 0.00021412,
    }  # fmt: skip
    state = client.state(structure={"frame": frame}, models=["MDOF-C-SI"], scale=20.0)
    assert "takes too long for a page" in client.refused("/api/response", state)["models"]


def test_models_that_take_long_together_are_refused(client) -> None:
    tall = client.state()["structure"]
    tall["frame"] |= {"n_stories": 130, "period": 4.0}
    record = {"suite": "fema-p695-far-field", "name": "FF-12-a"}
    state = client.state(structure=tall, record=record, models=["MDOF-S", "90DOF-S", "80DOF-S", "fixed"])
    assert "too long together" in client.refused("/api/response", state)["models"]
    client.ask("/api/response", state | {"models": ["MDOF-S"]})


def test_histories_of_too_many_rows_are_refused(client, monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._download.ROWS", 1000)
    assert "Python lines." in client.refused("/api/download/histories", client.state())["models"]


def test_foreign_pages_cannot_send_files(client) -> None:
    for path in ("/api/upload?name=a.csv", "/api/matrices?name=a.npz"):
        status, _, body = client.request(path, RECORD, Content_Type="text/plain")
        assert (status, json.loads(body)["errors"][""]) == (415, "A request must be application/octet-stream.")


def test_a_visitor_who_leaves_in_the_middle_leaves_no_traceback(client, caplog) -> None:
    host, port = client.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port))) as connection:
        connection.sendall(BEGUN)
        time.sleep(0.2)
    time.sleep(0.5)
    assert not [record for record in caplog.records if record.exc_info]
    assert client.request("/api/about")[0] == 200


def test_a_body_that_does_not_arrive_is_given_up(client, monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._exchange.PATIENCE", 0.2)
    host, port = client.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=60) as connection:
        connection.sendall(BEGUN)
        assert connection.recv(1000).startswith(b"HTTP/1.1 408")


def test_every_answer_forbids_foreign_content(client) -> None:
    for path in ("/", "/api/about", "/static/main.js", "/nowhere"):
        assert "default-src 'self'" in client.request(path)[1]["content-security-policy"]


def test_long_messages_are_cut(client) -> None:
    errors = client.refused("/api/response", client.state(record={"suite": "x" * 120}))
    assert all(len(text) <= 1000 for text in errors.values())
    status, _, body = client.request(
        f"/api/upload?name=a.csv&units={'x' * 5000}", RECORD, Content_Type="application/octet-stream"
    )
    assert status == 422
    assert len(body) < 1200
