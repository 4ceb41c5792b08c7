"""What matters most on the Response tab: a tornado of one record or of a set, by the server and in a browser."""

import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.json import as_json_value
from rockflex.web._forms import PRESETS

FRAME = make_frame(aspect_ratio=8.0)
STRUCTURE = {"name": "Frame", "frame": as_json_value(PRESETS[0]["structure"]["frame"]) | {"aspect_ratio": 8.0}}
SUITE = {"shown": True, "suites": ["el-centro-1940", "fema-p695-near-field-pulse"], "scale": 1.5}


def ranges(structure, share, **options):
    return dict.fromkeys((*rf.parameter_names(structure, **options), "scale"), share)


def assert_is(answer, bars):
    assert (answer["status"], answer["demand"], answer["n_records"]) == ("done", bars.demand, bars.n_records)
    assert answer["base"] == bars.base
    assert [row["name"] for row in answer["rows"]] == list(bars.parameters)
    assert [row["values"] for row in answer["rows"]] == bars.values.tolist()
    assert [row["factors"] for row in answer["rows"]] == bars.factors.tolist()


def test_a_record_has_the_bars_of_the_library(client) -> None:
    state = client.state(structure=STRUCTURE, scale=1.5, tornado={"share": 0.2, "demand": "max_base_moment"})
    token, answer = client.study("tornado", state)
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    bars = rf.tornado(FRAME, motion, "MDOF-S", ranges(FRAME, 0.2), demand="max_base_moment", free_vibration=5.0)
    assert_is(answer, bars)
    assert answer["done"] == answer["total"] == 1 + 2 * len(bars.parameters)
    table = client.download(f"/api/study/tornado/{token}/table", state)[1].decode()
    assert table.splitlines()[0].startswith("parameter,factor_low,low")
    assert b"<svg" in client.download(f"/api/study/tornado/{token}/figure", state)[1]


def test_a_set_has_medians_and_the_python_lines_repeat_it(client) -> None:
    state = client.state(structure=STRUCTURE, record_set=SUITE, tornado={"share": 0.1})
    answer = client.study("tornado", state)[1]
    motions = [each.scaled(1.5) for name in SUITE["suites"] for each in rf.load_suite(name)]
    assert_is(answer, rf.tornado(FRAME, motions, "MDOF-S", ranges(FRAME, 0.1), free_vibration=5.0))


@pytest.mark.parametrize("shown", [False, True])
def test_the_python_lines_repeat_it(client, shown, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    set_ = {"shown": shown, "suites": ["el-centro-1940"], "scale": 1.2}
    ground = {"friction": 0.4, "mat_mass": 2e5, "springs": {"stiffness": 2e9}}
    more = {"impact": "restitution", "restitution": 0.5} if not shown else {"ground": ground}
    state = client.state(structure=STRUCTURE, record_set=set_, models=["2DOF-S"], scale=1.2, **more)
    answer = client.study("tornado", state)[1]
    names = {row["name"] for row in answer["rows"]}
    assert ("ground.friction" in names) if shown else ("impact.e" in names)
    found = {}
    exec(client.download("/api/file/tornado-python", state)[1].decode(), found)
    assert_is(answer, found["bars"])


def test_what_cannot_be_so_far_from_its_value_is_left_out(client) -> None:
    state = client.state(structure=STRUCTURE, impact="restitution", restitution=0.95, models=["2DOF-S"])
    names = {row["name"] for row in client.study("tornado", state)[1]["rows"]}
    assert "impact.e" not in names
    assert "period" in names


def test_refusals_name_the_field(client) -> None:
    path = "/api/study/tornado"
    assert "from 0.01 to 0.5" in client.refused(path, client.state(tornado={"share": 2.0}))["tornado.share"]
    assert "tornado.demand" in client.refused(path, client.state(tornado={"demand": "status"}))
    slow = client.state(record_set=SUITE | {"suites": ["fema-p695-far-field"]}, models=["MDOF-C"])
    slow["structure"] = {"frame": STRUCTURE["frame"] | {"n_stories": 100}}
    assert client.refused(path, slow)


@pytest.mark.web
@pytest.mark.slow
def test_a_visitor_varies_the_numbers_of_one_record_and_of_a_set(visitor, link) -> None:
    page = visitor.page
    visitor.open(link({"structure": STRUCTURE, "scale": 1.5, "tab": "response"}))
    page.locator("#tornado-task summary").click()
    page.locator("#tornado-status", has_text="Done").wait_for()
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    bars = rf.tornado(FRAME, motion, "MDOF-S", ranges(FRAME, 0.1), free_vibration=5.0)
    first = page.locator("#tornado tbody tr").first
    assert first.get_attribute("data-parameter") == bars.parameters[0]
    assert float(first.locator('[data-end="1"]').get_attribute("data-value")) == bars.values[0, 1]
    assert first.locator("rect").count() == 2
    visitor.fill("tornado.share", "0.2")
    page.get_by_text("The input has changed: vary again.").wait_for()
    page.locator("#tornado-run").click()
    wide = rf.tornado(FRAME, motion, "MDOF-S", ranges(FRAME, 0.2), free_vibration=5.0)
    visitor.wait_for(f'#tornado tr[data-parameter="{wide.parameters[0]}"] [data-end="0"]', wide.values[0, 0])
    page.get_by_label("Records", exact=True).select_option("set")
    page.locator("#tornado-run").click()
    page.locator("#tornado-task .answer", has_text="the median over 7 records").wait_for()
