"""The Response tab as a GIF: from the server, and by the button in a real Chromium."""

import io
import json
import threading
import time

import pytest
from PIL import Image

import rockflex as rf
from rockflex.web import _animation
from rockflex.web._animation import animation
from rockflex.web._jobs import FileJob
from rockflex.web._state import parse_state
from rockflex.web._uploads import Uploads

SHORT = {"source": "pulse", "pulse": {"shape": "one_sine", "amplitude": 4.0, "period": 0.8}}


def test_the_gif_is_that_of_the_library(client, frame, tmp_path) -> None:
    state = client.state(record=SHORT, models=["MDOF-S", "fixed"], scale=1.5, free_vibration=1.0)
    made = client.made("animation", state)
    assert (made["status"], made["name"]) == ("done", "animation.gif")
    pulse = rf.one_sine_pulse(4.0, 0.8).scaled(1.5)
    runs = [rf.simulate(frame, pulse, model, free_vibration=1.0) for model in ("MDOF-S", "fixed")]
    title = f"{pulse.name} × 1.5"
    same = rf.animate(runs, tmp_path / "same.gif", structure=frame, width=800, title=title)
    with Image.open(io.BytesIO(made["content"])) as image, Image.open(same) as other:
        assert image.size == other.size
        assert image.n_frames == other.n_frames > 40
        assert made["done"] == made["total"] == image.n_frames
        for place in (0, image.n_frames // 2, image.n_frames - 1):
            image.seek(place)
            other.seek(place)
            assert image.convert("RGB").tobytes() == other.convert("RGB").tobytes()


def test_a_long_one_has_fewer_frames_and_a_longer_one_is_refused(client, monkeypatch) -> None:
    state = client.state(record=SHORT, models=["fixed"], free_vibration=1.0)

    def frames() -> int:
        with Image.open(io.BytesIO(client.made("animation", state)["content"])) as image:
            return image.n_frames

    usual = frames()
    monkeypatch.setattr(_animation, "RATES", ((1.0, 25.0), (10.0, 12.5)))
    assert frames() == pytest.approx(usual / 2, abs=1)
    monkeypatch.setattr(_animation, "RATES", ((1.0, 25.0),))
    said = client.made("animation", state)["errors"]["free_vibration"]
    assert "the animation would last 1." in said
    assert "but the page draws 1 s at most. Choose a shorter record or less free vibration, or take Python" in said


LONG = {"record": SHORT, "models": ["MDOF-S", "2DOF-S", "fixed"], "free_vibration": 40.0}


def test_it_ends_when_nobody_waits(client, monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._jobs.FORGOTTEN", 0.5)
    state = parse_state(client.state(**LONG))
    job = FileJob(lambda told: animation(state, Uploads(), told))
    job.compute()
    assert job.status == "cancelled"
    assert job.file is None


def test_it_can_be_cancelled_and_says_how_far_it_is(client) -> None:
    token = client.make("animation", client.state(**LONG))
    path, seen = f"/api/file/{token}", []
    while len(seen) < 3:
        answer = json.loads(client.request(path)[2])
        assert answer["status"] in ("waiting", "running")
        if answer["done"] and answer["done"] not in seen:
            seen.append(answer["done"])
    assert seen == sorted(seen)
    assert seen[-1] < answer["total"]
    assert client.request(f"{path}/content")[0] == 404
    assert client.request(path, method="DELETE")[0] == 200
    while (answer := json.loads(client.request(path)[2]))["status"] == "running":
        time.sleep(0.05)
    assert answer["status"] == "cancelled"
    assert answer["done"] < answer["total"]


def test_an_unknown_file_is_refused(client) -> None:
    assert "no file named 'soul'" in client.refused("/api/file/soul", client.state())[""]
    assert client.request("/api/file/none")[0] == 404


def test_the_page_answers_while_it_draws(client) -> None:
    state = client.state(record=SHORT, models=["MDOF-S", "2DOF-S", "fixed"], free_vibration=10.0)
    done: list[float] = []

    def draw() -> None:
        client.made("animation", state)
        done.append(time.monotonic())

    drawing = threading.Thread(target=draw)
    drawing.start()
    time.sleep(0.5)
    for _ in range(3):
        client.ask("/api/structure", state)
    answered = time.monotonic()
    drawing.join()
    assert answered < done[0]


@pytest.mark.web
def test_the_button_saves_the_gif_and_says_that_it_works(visit, link) -> None:
    visitor = visit(link({"record": SHORT, "models": ["MDOF-S", "2DOF-S", "fixed"]}))
    page = visitor.page
    visitor.tab("response")
    visitor.shown(1, ["MDOF-S", "2DOF-S", "fixed"])
    button = page.get_by_role("button", name="Animation (GIF)")
    with page.expect_download(timeout=120_000) as got:
        button.click()
        page.wait_for_function("b => b.ariaBusy === 'true'", arg=button.element_handle())
        button.click()  # once is enough
        page.wait_for_function(
            "() => /[1-9]\\d* of \\d+ frames/.test(document.querySelector('#making-animation').innerText)"
        )
        assert 0.0 < page.locator("#making-animation progress").evaluate("bar => bar.value") < 1.0
    content = got.value.path().read_bytes()
    assert got.value.suggested_filename == "animation.gif"
    with Image.open(io.BytesIO(content)) as image:
        assert image.format == "GIF"
        assert image.n_frames > 100
        assert image.size[0] == 800
    page.wait_for_function("b => b.ariaBusy === 'false'", arg=button.element_handle())
    assert page.locator("#making-animation").inner_text() == "Saved."
    assert not visitor.said


@pytest.mark.web
def test_an_animation_can_be_cancelled_on_the_page(visit, link) -> None:
    visitor = visit(link(LONG))
    page = visitor.page
    visitor.tab("response")
    visitor.shown(1, LONG["models"])
    saved = []
    page.on("download", lambda each: saved.append(each))
    page.get_by_role("button", name="Animation (GIF)").click()
    page.locator("#making-animation").get_by_role("button", name="Cancel").click()
    page.wait_for_function("() => document.querySelector('#making-animation').innerText === 'Cancelled.'")
    assert page.locator('[data-file="animation"]').evaluate("b => b.ariaBusy") == "false"
    assert saved == []


@pytest.mark.web
def test_the_page_says_that_an_animation_would_be_too_long(visitor, monkeypatch) -> None:
    monkeypatch.setattr(_animation, "RATES", ((1.0, 25.0),))
    visitor.tab("response")
    visitor.shown(1, ["MDOF-S", "2DOF-S", "fixed"])
    visitor.page.get_by_role("button", name="Animation (GIF)").click()
    assert visitor.error("free_vibration").startswith("The animation would last ")
