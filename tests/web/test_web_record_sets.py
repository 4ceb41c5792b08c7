"""A set of records on the page as one result, and the checks of runs and sets."""

import re
import shutil
import time
from dataclasses import replace

import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.json import as_json_value
from rockflex.studies._prepared_case import PreparedCase
from rockflex.web import _record_sets
from rockflex.web._forms import PRESETS
from rockflex.web._jobs import BackgroundFileJob
from rockflex.web._state import parse_page_state
from rockflex.web._uploads import LatestValuesCache

FRAME = make_frame(aspect_ratio=8.0)
STRUCTURE = {"name": "Frame", "frame": as_json_value(PRESETS[0]["structure"]["frame"]) | {"aspect_ratio": 8.0}}
TARGET = rf.ec8_spectrum(0.25 * 9.81, "C")  # of the first state of the page
LIMITS = {"drift_ratio": 0.01, "friction": 0.3, "seat_width": 0.5}
SPRINGS = {"mat_mass": 2e5, "springs": {"stiffness": 2e9}}


@pytest.fixture(scope="module")
def state(client):
    return client.state(structure=STRUCTURE, record_set={"shown": True}, limits=LIMITS)


@pytest.fixture(scope="module")
def done(client, state):
    token, answer = client.study("record_set", state)
    assert answer["status"] == "done"
    return token, answer


@pytest.fixture(scope="module")
def same():
    """The set by the library."""
    chosen = rf.load_suite("fema-p695-far-field").select(TARGET, 7, (0.2, 2.0), scale_limits=(0.25, 4.0))
    return rf.simulate_set(FRAME, chosen, "MDOF-S", rule="ec8", free_vibration=5.0)


@pytest.mark.slow
def test_the_numbers_are_the_librarys(done, same) -> None:
    _, answer = done
    assert (answer["done"], answer["total"]) == (14, 14)  # with a fixed base
    fixed = rf.simulate_set(FRAME, same.motions, "fixed", rule="ec8", free_vibration=5.0)
    assert answer["fixed_moment"] == pytest.approx(fixed.statistics.loc["max_base_moment", "design"], rel=1e-9)
    assert answer["compared"] is None
    assert [each["name"] for each in answer["records"]] == list(same.peaks.index)
    assert [each["name"] for each in answer["demands"]] == list(same.statistics.index)
    for each in answer["demands"]:
        assert each["peaks"] == same.peaks[each["name"]].tolist()
        for column in ("mean", "worst", "median", "fractile_84", "design", "reason"):
            assert each[column] == same.statistics.loc[each["name"], column]
    assert answer["warnings"] == list(same.warnings)
    assert any("chosen for periods up to 2 s" in text for text in answer["warnings"])
    table = rf.check(same, rf.CheckLimits(**LIMITS))
    for shown, row in zip(answer["checks"]["rows"], table.rows, strict=True):
        assert (shown["name"], shown["value"], shown["ratio"]) == (row.name, row.demand, row.ratio)
        assert (shown["ok"], shown["source"]) == (row.ok, row.source)
    assert {False, True} <= {each["ok"] for each in answer["checks"]["rows"]}


def test_rule_and_limits_change_without_another_run(client, state, done, same) -> None:
    path = f"/api/study/record_set/{done[0]}"
    answer = client.ask(path, state | {"record_set": {"rule": ""}, "limits": {"drift_ratio": 1.0}})
    rotation = next(each for each in answer["demands"] if each["name"] == "max_rotation")
    assert rotation["design"] == same.peaks["max_rotation"].max()
    ratios = {each["name"]: each["ratio"] for each in answer["checks"]["rows"]}
    worst = max(rf.check(run, rf.CheckLimits(drift_ratio=1.0)).to_frame().loc["story drift", "ratio"]
                for run in same.responses)  # fmt: skip
    assert ratios["story drift"] == worst
    errors = client.refused(path, state | {"record_set": {"rule": "asce7"}})
    assert "at least 11 records, but 7 were given" in errors["record_set.rule"]
    assert (
        "at least 11"
        in client.refused("/api/study/record_set", state | {"record_set": {"rule": "asce7"}})["record_set.rule"]
    )


def test_alternatives_are_compared_under_the_set(client, state, done, monkeypatch) -> None:
    """All are the library's, and what ran once is not run again."""
    wide = {"name": "Wide", "frame": STRUCTURE["frame"] | {"aspect_ratio": 6.0}}
    kept = [{"name": "wide", "structure": wide, "models": ["fixed", "MDOF-S"]}]
    state = state | {"alternatives": kept, "limits": {"drift_ratio": 0.01}}
    token, answer = client.study("record_set", state)
    assert (answer["status"], answer["total"]) == ("done", 21)
    found = answer["compared"]
    assert [each["name"] for each in found["columns"]] == ["wide", "A", "fixed"]
    chosen = rf.load_suite("fema-p695-far-field").select(TARGET, 7, (0.2, 2.0), scale_limits=(0.25, 4.0))
    for place, (aspect, model) in enumerate([(6.0, "MDOF-S"), (8.0, "MDOF-S"), (8.0, "fixed")]):
        own = rf.simulate_set(make_frame(aspect_ratio=aspect), chosen, model, rule="ec8", free_vibration=5.0)
        for demand in found["demands"]:
            known = own.statistics["design"].to_dict().get(demand["name"])
            assert demand["values"][place] == known
        table = rf.check(own, rf.CheckLimits(drift_ratio=0.01))
        shown = found["columns"][place]
        assert [each["ratio"] for each in shown["checks"]] == [row.ratio for row in table.rows]
        lifted = sum(run.status == "rocking" for run in own.responses)
        assert shown["lifted"] == (0 if model == "fixed" else lifted)
    report = client.download(f"/api/study/record_set/{token}/comparison", state)[1].decode()
    base = next(each for each in found["demands"] if each["name"] == "max_base_moment")["values"]
    assert all(f'data-of="max_base_moment" data-value="{value!r}"' in report for value in base)
    assert "story drift" in report
    monkeypatch.delattr(PreparedCase, "run")  # nothing is run a second time
    again = client.study("record_set", state | {"alternatives": [*kept, {**kept[0], "name": "again"}]})[1]
    assert (again["status"], again["done"]) == ("done", 28)
    refused = client.made(f"/api/study/record_set/{done[0]}/comparison", state)
    assert "Keep the present structure" in refused["errors"]["alternatives"]


def test_demands_checks_and_the_report_are_in_the_units_of_the_page(client, state, done) -> None:
    path, state = f"/api/study/record_set/{done[0]}", state | {"units": "kip-in"}
    answer = client.ask(path, state)
    top = next(each for each in answer["demands"] if each["name"] == "max_total_top_displacement")
    assert (top["unit"], top["size"]) == ("in", 0.0254)
    (seat,) = (each for each in answer["checks"]["rows"] if each["unit"] == "in")
    assert seat["demand"] == pytest.approx(seat["value"] / 0.0254, rel=1e-12)
    report = client.download(f"{path}/report", state)[1].decode()
    assert "kip in" in report
    assert "kN m" not in report


def test_the_friction_on_springs_is_that_of_the_library_or_says_what_it_takes(client, monkeypatch) -> None:
    springs = {"base_inertia": 5e5, "springs": {"positions": [-1.0, 0.0, 1.0], "stiffness": 4e8, "damping": 1e6}}
    state = client.state(models=["2DOF-S"], ground=springs, limits={"friction": 0.3})

    def row(view):
        return next((each for each in view["checks"]["rows"] if each["name"] == "sliding"), None)

    one = row(client.ask("/api/response", state))
    state["record_set"] = {"suites": ["el-centro-1940"], "rule": "", "shown": True}
    _, answer = client.study("record_set", state)
    assert row(answer)["ratio"] == pytest.approx(one["ratio"], rel=1e-12)
    ground = rf.Ground(springs=rf.Springs([-1.0, 0.0, 1.0], stiffness=4e8, damping=1e6), base_inertia=5e5)
    motion = rf.load_suite("el-centro-1940")[0]
    run = rf.simulate(make_frame(), motion, "2DOF-S", ground=ground, free_vibration=5.0, output="history")
    assert one["value"] == pytest.approx(run.required_friction_excluding_impacts(), rel=1e-9)
    monkeypatch.setattr("rockflex.web._response.FRICTION_SECONDS", 0.0)
    view = client.ask("/api/response", state | {"scale": 1.1})
    assert row(view) is None
    assert any(name == "sliding" and "set of records" in lacks for name, lacks in view["checks"]["missing"])


@pytest.mark.slow
def test_files_of_a_set(client, state, done, same, tmp_path, monkeypatch) -> None:
    path = f"/api/study/record_set/{done[0]}"
    name, report = client.download(f"{path}/report", state)
    assert name == "report.html"
    text = report.decode()
    assert "<title>Frame under 7 records</title>" in text
    assert ", fails)" in text
    assert "Target: EC8 type 1, ground C, 0.25 g, 0.200–2.00 s; T_1 = 1.00 s" in text
    assert text.count("<svg") == 2  # the target with the spectra, and the peaks
    for column in ("mean", "design"):
        assert f'data-of="{column}" data-value="{float(same.statistics.loc["max_rotation", column])!r}"' in text
    assert b"<svg" in client.download(f"{path}/figure", state)[1]
    assert client.download(f"{path}/table", state)[1].startswith(b"motion,")
    monkeypatch.chdir(tmp_path)
    packed = client.download("/api/file/record_set-records", state)[1]
    (tmp_path / "records.zip").write_bytes(packed)
    shutil.unpack_archive(tmp_path / "records.zip", tmp_path / "records")
    space = client.program("record_set-python", state)
    assert space["found"].statistics["design"].tolist() == pytest.approx(same.statistics["design"].tolist(), rel=1e-6)
    assert space["found"].warnings == same.warnings
    assert space["table"].to_frame()["ok"].tolist() == [each["ok"] for each in done[1]["checks"]["rows"]]
    assert client.post("/api/file/record_set-study", {"state": state})[0] == 404


def test_a_set_is_cancelled_and_has_no_statistics(client) -> None:
    state = client.state(record_set={"suites": ["fema-p695-far-field"]}, models=["MDOF-C-SI"])
    token = client.ask("/api/study/record_set", state)["token"]
    assert client.request(f"/api/job/{token}", method="DELETE")[0] == 200
    answer = client.wait("record_set", token, state)
    assert (answer["status"], answer["ready"]) == ("cancelled", False)
    assert answer["done"] < answer["total"] == 88
    said = client.made(f"/api/study/record_set/{token}/report", state)
    assert said["status"] == "failed"
    assert "Simulate it again" in said["errors"][""]


def test_the_range_of_periods_that_matters(client, state, done, same) -> None:
    found = client.ask("/api/periods", state)  # of the set, which ran
    assert found["shortest"] == pytest.approx(0.2, rel=1e-2)
    assert found["longest"] == pytest.approx(min(same.rocking_period, 4.0), rel=1e-2)
    alone = client.ask("/api/periods", client.state(structure=STRUCTURE, scale=0.01, record_set={"scale": 0.5}))
    # of the record: it does not lift
    assert alone["longest"] == pytest.approx(1.0, rel=1e-2)


def test_a_set_that_is_no_longer_kept_is_told(client, state, done, monkeypatch) -> None:
    monkeypatch.setattr(_record_sets, "_SETS", LatestValuesCache(1))
    assert "Simulate it again" in client.refused(f"/api/study/record_set/{done[0]}", state)[""]


@pytest.mark.slow
def test_the_checks_of_a_run_are_the_librarys(client, state, el_centro) -> None:
    found = client.ask("/api/response", state | {"scale": 2.0})["checks"]
    run = rf.simulate(FRAME, el_centro.scaled(2.0), "MDOF-S", free_vibration=5.0)
    table = rf.check(run, rf.CheckLimits(**LIMITS))
    assert [(each["name"], each["ratio"], each["ok"]) for each in found["rows"]] == [
        (row.name, row.ratio, row.ok) for row in table.rows
    ]
    assert "toe stress" in found["unlimited"]
    text = client.download("/api/file/report", state)[1].decode()
    assert re.search(r"story drift.*?\(([\d.]+, (ok|fails))\)", text)
    on_springs = client.ask("/api/response", state | {"ground": SPRINGS, "models": ["MDOF-S"]})["checks"]
    assert "sliding" in [each["name"] for each in on_springs["rows"]]


@pytest.mark.parametrize(("name", "value"), [("friction", "x"), ("friction", -1), ("contact_ratio", 2.0), ("soul", 1)])
def test_a_wrong_limit_is_told_at_its_field(client, name, value) -> None:
    errors = client.refused("/api/response", client.state(limits={name: value}))
    assert list(errors) == ["limits" if name == "soul" else f"limits.{name}"]


def test_a_file_cancelled_while_it_is_written_is_dropped() -> None:
    def make(_):
        job.cancelled.set()
        return "report.html", b""

    job = BackgroundFileJob(make)
    job.compute()
    assert (job.status, job.file) == ("cancelled", None)


def test_a_link_without_sets_and_limits_opens() -> None:
    state = parse_page_state({"structure": PRESETS[0]["structure"]})
    assert (state.record_set.shown, state.record_set.suites, state.model_of_set) == (False, ["chosen"], "MDOF-S")
    assert state.check_limits() == rf.CheckLimits()


@pytest.mark.web
def test_the_way_from_the_first_screen_to_the_report_of_a_set(visit) -> None:
    """A pier with fuses on springs under seven records: a choice in a list counts as two clicks."""
    page, clicks = visit(folded=True).page, 0
    page.wait_for_selector("#adequacy", state="attached")
    begun = time.monotonic()
    start = page.get_by_label("Start from")
    start.select_option(label=next(each for each in start.locator("option").all_inner_texts() if "fuses" in each))
    clicks += 2
    page.locator('[data-task="ground"] > summary').click()
    clicks += 1
    page.get_by_label("Ground", exact=True).select_option("springs")
    clicks += 2
    page.wait_for_function("() => rockflexPage.state.ground?.springs")
    page.get_by_role("button", name="Set of records").click()
    clicks += 1
    page.wait_for_selector("#statistics", state="visible")
    with page.expect_download() as got:
        page.get_by_role("button", name="Report (HTML)").click()
        clicks += 1
    text = got.value.path().read_text("utf-8")
    print(f"{clicks} clicks, {time.monotonic() - begun:.1f} s")
    assert clicks == 7
    assert "2 × fuse" in text
    assert "springs without tension" in text
    assert "7 records" in text
    assert page.locator("#statistics tbody tr").count() > 8
    assert page.locator("#of-records tbody tr").count() == 7


@pytest.mark.slow
@pytest.mark.web
def test_the_set_on_the_page(visit, link, state, same, axe) -> None:
    visitor = visit(link(as_json_value(state) | {"tab": "response", "limits": {"drift_ratio": 0.01}}))
    page = visitor.page
    design = '#statistics [data-demand="max_rotation"] [data-name="design"]'
    visitor.wait_for(design, same.statistics.loc["max_rotation", "design"])
    warned = page.locator("#record-set .warning")
    assert "chosen for periods up to 2 s" in warned.inner_text()
    assert page.locator('#record-set .checks [data-check="story drift"] [data-name="ok"]').inner_text() == "fails"
    assert page.locator('#record-set .checks [data-check="rotation"] [data-name="ok"]').inner_text() == "ok"
    assert page.locator("#worst").get_attribute("data-worst") == "story drift"
    assert "fails" in page.locator("#worst").inner_text()
    page.get_by_label("Value for design").select_option("")  # needs no other run
    visitor.wait_for(design, same.statistics.loc["max_rotation", "worst"])
    visitor.fill("limits.drift_ratio", "1")
    page.locator('#record-set .checks [data-check="story drift"]').get_by_text("ok", exact=True).wait_for()
    visitor.fill("limits.drift_ratio", "-1")
    visitor.wait_for_error("limits.drift_ratio", "positive")
    visitor.fill("limits.drift_ratio", "")
    page.locator('#record-set .checks [data-check="story drift"]').wait_for(state="detached")
    assert "drift_ratio" not in visitor.state()["limits"]
    for rules in ([], ["color-contrast"]):  # in the other theme, only contrast differs
        assert axe(page, *rules) == []
        page.click("#theme")
    visitor.fill("limits.friction", "0.3")  # of the same runs: nothing turns gray, and no button is pressed
    page.wait_for_selector('#record-set .checks [data-check="sliding"]')
    assert page.locator("#record-set.stale").count() == 0
    ratio = rf.check(replace(same, rule=None), rf.CheckLimits(friction=0.3)).to_frame().loc["sliding", "ratio"]
    visitor.wait_for('#record-set .checks [data-check="sliding"] [data-name="ratio"]', ratio, 1e-9)
    page.locator("#longer").click()  # the range ends at the rocking period, or with the target
    page.wait_for_function("() => rockflexPage.state.target.longest > 2")
    page.wait_for_function("() => !document.querySelector('#longer')?.checkVisibility()")
    visitor.fill("record_set.scale", "2")
    page.get_by_text("The input has changed: simulate again.").wait_for()
    page.get_by_label("Records", exact=True).select_option("")
    visitor.shown()
    assert (
        page.locator('.results:not([hidden]) .checks [data-check="rotation"] [data-name="ok"]').first.inner_text()
        == "ok"
    )
