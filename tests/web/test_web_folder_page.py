"""A folder of records in a real Chromium: given, reported, chosen, kept over a reload, and used by studies."""

import io
import json
import zipfile
from pathlib import Path

import pytest
from test_web_folders import GIVEN

import rockflex as rf

pytestmark = pytest.mark.web

KINDS = {"design": "design", "fragility": "cloud"}
NASTY = b"time (s),<img src=x onerror=alert(1)> (g)\n0,0\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "set"
    for name, content in GIVEN.items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
    return place


def give(visitor, folder: Path) -> None:
    visitor.tab("earthquake")
    visitor.page.get_by_label("Source").select_option("folder")
    visitor.page.locator("#folder").set_input_files(folder)
    visitor.page.wait_for_selector("#report table")
    visitor.page.wait_for_function("() => document.querySelector('#record-title').textContent.startsWith('RSN7_TEST')")


def motion_of(folder: Path, name: str, vertical: str | None = None) -> rf.GroundMotion:
    files = [file for file in folder.rglob("*") if file.suffix in (".AT2", ".csv")]
    return rf.survey_records(files, vertical=vertical).suite()[name]


def test_a_folder_is_reported_and_a_record_of_it_is_simulated(visitor, folder, frame) -> None:
    page = visitor.page
    give(visitor, folder)
    assert page.locator("#taken").inner_text().startswith("3 records taken, 5 entries not. 1 of ")
    row = page.locator('tr[data-file="RSN7_TEST000.AT2"]')
    motion = motion_of(folder, "RSN7_TEST000")
    assert float(row.locator("[data-value]").get_attribute("data-value")) == motion.pga
    cells = row.inner_text().split("\t")
    assert cells[2:8] == ["1.19", "0.01", "6.6", "12.1", "366", "RSN7 with vertical"]
    assert cells[8:] == ["0", "AT2", "RSN7_TEST000.AT2"]
    assert "notes.txt holds no numbers" in page.locator('tr[data-file="notes.txt"]').inner_text()
    assert page.locator('[data-given="RSN7_TEST000"]').get_attribute("aria-pressed") == "true"
    page.locator('[data-given="RSN7_TEST090"]').click()
    other = motion_of(folder, "RSN7_TEST090")
    visitor.wait_for('[data-measure="PGA"]', other.pga)
    page.get_by_label("With the vertical components").check()
    page.wait_for_selector('[data-measure="PVA"]')
    visitor.fill("scale", "3")
    visitor.tab("response")
    visitor.shown(3, ["MDOF-S", "2DOF-S", "fixed"])
    both = motion_of(folder, "RSN7_TEST090", "pair")
    run = rf.simulate(frame, both.scaled(3.0), "2DOF-S", free_vibration=5.0)
    visitor.wait_for_peak("2DOF-S", "max_rotation", run.max_rotation)


def test_it_survives_a_reload_and_a_server_without_it_says_so(visitor, folder, link) -> None:
    page = visitor.page
    give(visitor, folder)
    page.reload()
    page.wait_for_selector("#report table")
    assert page.locator("#report tbody tr").first.is_visible()
    state = visitor.state()
    page.goto(visitor.url + link(state | {"record": state["record"] | {"folder": "0" * 64}}))
    page.reload()
    assert "Give the folder again on the Earthquake tab; a link does not contain it." in visitor.error("record.folder")
    assert page.locator("#report").is_hidden()


def test_files_and_archives_and_what_is_wrong_with_them(visitor, folder) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Source").select_option("folder")
    assert page.get_by_text("a report of them will appear here").is_visible()
    files = page.locator("#files")

    def given(name: str, content: bytes) -> None:
        files.set_input_files([{"name": name, "mimeType": "application/zip", "buffer": content}])

    given("a.zip", b"no archive")
    assert "a.zip is a damaged archive" in visitor.error("record.folder")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("../../evil.AT2", GIVEN["set/RSN7_TEST000.AT2"])
    given("evil.zip", packed.getvalue())
    page.wait_for_selector("text=points out of its folder")
    files.set_input_files([{"name": f"{i}.txt", "mimeType": "text/plain", "buffer": b""} for i in range(501)])
    assert visitor.error("record.folder") == "There are 501 files, but the page takes 500 at most. Choose fewer."
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, content in (GIVEN | {"<b>bad</b>.csv": NASTY}).items():
            archive.writestr(name, content)
    given("records.zip", packed.getvalue())
    page.wait_for_selector("#report table")
    assert page.locator(".error:visible").count() == 0
    assert page.locator("#report b").count() == 0
    assert page.locator("#report img").count() == 0
    assert "[object" not in page.locator("main").inner_text()


def test_a_late_answer_about_the_record_leaves_the_message_about_the_files(visit) -> None:
    visitor = visit("/")
    page = visitor.page
    page.evaluate(
        """() => {
          const { fetch } = window;
          window.fetch = async (path, ...more) => {
            const answer = await fetch(path, ...more);
            if (path === "/api/folder?units=&dt=") window.refused = true;
            if (path === "/api/record") await new Promise((resolve) => { window.letGo = resolve; });
            return answer;
          };
        }"""
    )
    visitor.tab("earthquake")
    page.wait_for_function("() => window.letGo")
    page.get_by_label("Source").select_option("folder")
    page.locator("#files").set_input_files([{"name": "a.zip", "mimeType": "application/zip", "buffer": b"no archive"}])
    page.wait_for_function("() => window.refused")
    page.evaluate("letGo()")
    assert "a.zip is a damaged archive" in visitor.error("record.folder")
    page.wait_for_load_state("networkidle")
    assert "a.zip is a damaged archive" in visitor.error("record.folder")


def test_it_is_a_suite_of_the_fragility_and_design_tabs(visitor, folder, frame) -> None:
    page = visitor.page
    visitor.tab("fragility")
    assert page.get_by_label("your folder").count() == 0
    give(visitor, folder)
    for tab in ("design", "fragility"):
        visitor.tab(tab)
        assert page.locator(f'[data-file="{KINDS[tab]}-records"]').is_hidden()
        page.get_by_label("your folder").check()
        page.get_by_label("far-field", exact=True).uncheck()
        assert visitor.state()[KINDS[tab]]["suites"] == ["given"]
    visitor.fill("cloud.scales", "1 2 3 4 5")
    visitor.run_study()
    assert page.locator("#status").inner_text().startswith("Done: 15 runs.")
    with page.expect_download() as waiting:
        page.locator('[data-file="cloud-records"]').click()
    with zipfile.ZipFile(waiting.value.path()) as archive:
        assert set(archive.namelist()) == {"RSN7_TEST000.csv", "RSN7_TEST090.csv", "alone.csv"}
    assert json.loads(json.dumps(visitor.state()))["record"]["folder"]


def test_on_paper_the_records_have_names_and_the_sheet_says_which_one(visitor, folder) -> None:
    page = visitor.page
    give(visitor, folder)
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    title = page.locator("#printed")
    assert title.inner_text().startswith("Structure #1 of Table 1 under RSN7_TEST000 · Earthquake · ")
    assert page.locator('#report tr[data-file="RSN7_TEST090.AT2"] td').first.inner_text() == "RSN7_TEST090"
    assert page.locator("#report .downloads").is_hidden()
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.emulate_media(media="screen")
    page.get_by_label("Task").select_option("target")
    page.wait_for_selector("#chosen table")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert title.inner_text().startswith("Structure #1 of Table 1 under records for a target spectrum · Earthquake · ")


def test_of_two_folders_given_quickly_the_later_one_counts(visitor, folder) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Source").select_option("folder")
    page.evaluate(
        """() => {
          const { fetch } = window;
          let first = true;
          window.fetch = async (path, ...more) => {
            const late = first && String(path).startsWith("/api/folder?");
            if (late) first = false;
            const answer = await fetch(path, ...more);
            if (late) {
              await new Promise((resolve) => { window.letGo = resolve; });
              window.gone = true;
            }
            return answer;
          };
        }"""
    )
    page.locator("#folder").set_input_files(folder)
    page.wait_for_function("() => window.letGo")
    page.locator("#files").set_input_files(folder / "other" / "alone.csv")
    page.wait_for_function("() => document.querySelector('#taken').textContent.startsWith('1 record taken')")
    page.evaluate("letGo()")
    page.wait_for_function("() => window.gone")
    page.wait_for_load_state("networkidle")
    assert page.locator("#taken").inner_text().startswith("1 record taken")
    assert visitor.state()["record"]["given"] == "alone"


def test_a_lost_folder_is_told_on_other_tabs_in_words(visit, link, client) -> None:
    visitor = visit(link(client.state(tab="response", record={"source": "folder"})))
    foot = visitor.page.locator(".foot:visible").filter(has_text="Earthquake")
    foot.wait_for()
    assert foot.inner_text() == "Earthquake: no records were given yet. Choose a folder on the Earthquake tab first."
