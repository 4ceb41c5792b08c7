"""The Earthquake tab in a browser: records, folders and targets."""

import io
import json
import math
import zipfile
from pathlib import Path

import pytest
from test_web_uploads import GIVEN

import rockflex as rf

pytestmark = pytest.mark.web

RECORD = b"time (s),acc (m/s2)\n" + b"".join(b"%.2f,%.4f\n" % (0.02 * i, 3 * math.sin(0.1 * i)) for i in range(400))


@pytest.mark.slow
def test_earthquake_by_suite_pulse_and_scale(visitor, el_centro) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    assert visitor.value('[data-measure="PGA"]') == el_centro.pga
    page.get_by_label("Suite", exact=True).select_option("fema-p695-far-field")
    page.locator('[data-record="FF-12-a"]').click()
    motion = rf.load_suite("fema-p695-far-field")["FF-12-a"]
    visitor.wait_for('[data-measure="PGA"]', motion.pga)
    assert page.locator(".thumbs button").count() == 44
    assert page.locator('[data-record="FF-12-a"]').get_attribute("aria-pressed") == "true"
    visitor.fill("scale", "2")
    visitor.wait_for('[data-measure="PGA"]', 2 * motion.pga)
    assert visitor.value('[data-measure="Arias"]') == pytest.approx(4 * motion.arias)
    page.get_by_label("Source").select_option("pulse")
    page.get_by_label("Shape").select_option("one_sine")
    slider = page.get_by_role("slider", name="Period")
    slider.focus()
    slider.press("ArrowRight")
    pulse = rf.one_sine_pulse(2.0, visitor.page.evaluate("rockflexPage.state.record.pulse.period")).scaled(2.0)
    visitor.wait_for('[data-measure="PGV"]', pulse.pgv)
    visitor.fill("record.pulse.period", "9999")
    visitor.wait_for_error("record.pulse.period", "It must be the period in s, from 0.05 to 20, but 9999 was given.")


@pytest.mark.slow
def test_an_upload_a_bad_one_and_one_that_is_too_large(visitor, frame, link) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Source").select_option("upload")
    assert page.get_by_text("Choose a file; its motion and spectrum will appear here.").is_visible()
    visitor.upload("File", "mine.csv", RECORD)
    page.wait_for_function("() => document.querySelector('#record-title').textContent === 'mine'")
    assert "400 samples" in page.locator("#uploaded").inner_text()
    visitor.respond()
    samples = [float(line.split(b",")[1]) for line in RECORD.splitlines()[1:]]
    expected = rf.simulate(frame, rf.GroundMotion(samples, 0.02), "2DOF-S", free_vibration=5.0)
    assert visitor.peak("2DOF-S", "max_rotation") == pytest.approx(expected.max_rotation, rel=1e-9)
    visitor.tab("earthquake")
    visitor.upload("File", "bad.csv", b"no numbers at all\n")
    visitor.wait_for_error("record.upload", "bad.csv holds no numbers")
    visitor.upload("File", "large.csv", b"1\n" * 3_000_000)
    visitor.wait_for_error("record.upload", "large.csv has 6.0 MB, but the page takes 5 MB at most.")
    # A link does not contain the file; another server would not know it.
    state = visitor.state() | {"record": visitor.state()["record"] | {"upload": "0" * 64}, "tab": "response"}
    page.goto(visitor.url + link(state))
    page.reload()
    page.wait_for_selector("text=Choose the file again.")


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


@pytest.mark.slow
def test_a_folder_is_reported_and_a_record_of_it_is_simulated(visitor, folder, frame) -> None:
    page = visitor.page
    give(visitor, folder)
    assert page.locator("#taken").inner_text().startswith("3 records taken. 5 entries not taken. Recordings: ")
    row = page.locator('tr[data-file="RSN7_TEST000.AT2"]')
    motion = motion_of(folder, "RSN7_TEST000")
    assert float(row.locator("[data-value]").get_attribute("data-value")) == motion.pga
    cells = row.inner_text().split("\t")
    assert cells[2:8] == ["1.19", "0.01", "6.6", "12.1", "366", "RSN7 with vertical"]
    assert cells[8:] == ["0", "AT2", "RSN7_TEST000.AT2"]
    assert "holds no numbers" in page.locator('tr[data-file="notes.txt"]').inner_text()
    assert "unit: g (line" in page.locator("#report").text_content()  # folded
    assert page.locator('[data-given="RSN7_TEST000"]').get_attribute("aria-pressed") == "true"
    page.locator('[data-given="RSN7_TEST090"]').click()
    other = motion_of(folder, "RSN7_TEST090")
    visitor.wait_for('[data-measure="PGA"]', other.pga)
    page.get_by_label("With the vertical components").check()
    page.wait_for_selector('[data-measure="PVA"]')
    visitor.fill("scale", "3")
    visitor.respond(3)
    both = motion_of(folder, "RSN7_TEST090", "pair")
    run = rf.simulate(frame, both.scaled(3.0), "2DOF-S", free_vibration=5.0)
    visitor.wait_for_peak("2DOF-S", "max_rotation", run.max_rotation)


@pytest.mark.slow
def test_it_survives_a_reload_and_a_server_without_it_says_so(visitor, folder, link) -> None:
    page = visitor.page
    give(visitor, folder)
    page.reload()
    page.wait_for_selector("#report table")
    assert page.locator("#report tbody tr").first.is_visible()
    state = visitor.state()
    page.goto(visitor.url + link(state | {"record": state["record"] | {"folder": "0" * 64}}))
    page.reload()
    visitor.wait_for_error("record.folder", "Give the folder again on the Earthquake tab; a link does not contain it.")
    assert page.locator("#report").is_hidden()


@pytest.mark.slow
def test_files_and_archives_and_what_is_wrong_with_them(visitor, folder) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Source").select_option("folder")
    assert page.get_by_text("a report of them will appear here").is_visible()
    files = page.locator("#files")

    def given(name: str, content: bytes) -> None:
        files.set_input_files([{"name": name, "mimeType": "application/zip", "buffer": content}])

    given("a.zip", b"no archive")
    visitor.wait_for_error("record.folder", "a.zip is a damaged archive")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("../../evil.AT2", GIVEN["set/RSN7_TEST000.AT2"])
    given("evil.zip", packed.getvalue())
    page.wait_for_selector("text=points out of its folder")
    files.set_input_files([{"name": f"{i}.txt", "mimeType": "text/plain", "buffer": b""} for i in range(501)])
    visitor.wait_for_error("record.folder", "There are 501 files, but the page takes 500 at most. Choose fewer.")
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


@pytest.mark.slow
def test_a_late_answer_about_the_record_leaves_the_message_about_the_files(visit) -> None:
    visitor = visit("/")
    page = visitor.page
    page.evaluate(
        """() => {
          const { fetch } = window;
          window.fetch = async (path, ...more) => {
            const answer = await fetch(path, ...more);
            if (String(path).includes("/api/folder?")) window.refused = true;
            if (String(path).endsWith("/api/record")) await new Promise((resolve) => { window.letGo = resolve; });
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
    visitor.wait_for_error("record.folder", "a.zip is a damaged archive")
    visitor.settle()
    visitor.wait_for_error("record.folder", "a.zip is a damaged archive")


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_of_two_folders_given_quickly_the_later_one_counts(visitor, folder) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Source").select_option("folder")
    page.evaluate(
        """() => {
          const { fetch } = window;
          let first = true;
          window.fetch = async (path, ...more) => {
            const late = first && String(path).includes("/api/folder?");
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
    visitor.settle()
    assert page.locator("#taken").inner_text().startswith("1 record taken")
    assert visitor.state()["record"]["given"] == "alone"


def test_a_lost_folder_is_told_on_other_tabs_in_words(visit, link, client) -> None:
    visitor = visit(link(client.state(tab="response", record={"source": "folder"})))
    foot = visitor.page.locator(".foot:visible").filter(has_text="Earthquake")
    foot.wait_for()
    assert foot.inner_text() == "Earthquake: no records were given yet. Choose a folder on the Earthquake tab first."


SUITE = rf.load_suite("fema-p695-far-field")
G = 9.81


def open_target(visitor) -> None:
    visitor.tab("earthquake")
    visitor.page.get_by_label("Task").select_option("target")
    visitor.page.wait_for_selector("#chosen table")


def wait_for_fit(visitor, chosen) -> None:
    visitor.wait_for("[data-fact=misfit]", chosen.misfit, 1e-9)


def test_a_record_without_a_unit_is_read_again_and_begins_at_scale_one(visitor) -> None:
    """Dropped on another tab; unit and step are chosen after the file."""
    page = visitor.page
    visitor.tab("earthquake")
    visitor.fill("scale", "3")
    visitor.tab("design")
    rows = "\n".join(f"{0.1 * math.sin(0.2 * k):.5f}" for k in range(400))
    page.evaluate(
        """text => {
          const dataTransfer = new DataTransfer();
          dataTransfer.items.add(new File([text], "own.txt"));
          document.body.dispatchEvent(new DragEvent("drop", { bubbles: true, cancelable: true, dataTransfer }));
        }""",
        rows,
    )
    page.wait_for_selector('#view[data-shown="earthquake"]')
    visitor.wait_for_error("record.upload")
    assert visitor.state()["scale"] == 3
    visitor.fill("upload.dt", "0.01")
    page.locator('[data-path="upload.units"] select').select_option("g")
    page.wait_for_function("() => rockflexPage.state.record.upload")
    assert visitor.state()["scale"] == 1
    page.locator("#record-title", has_text="own").wait_for()
    visitor.wait_for('[data-measure="PGA"]', 0.1 * G, 1e-3)
    visitor.fill("scale", "2")
    page.locator('[data-path="upload.units"] select').select_option("m/s2")  # the same file, at the scale it has
    visitor.wait_for('[data-measure="PGA"]', 0.2, 1e-3)


@pytest.mark.slow
def test_records_are_chosen_for_codes_and_tables(visitor) -> None:
    page = visitor.page
    open_target(visitor)
    chosen = SUITE.select(rf.ec8_spectrum(0.25 * G, "C"), 7, (0.2, 2.0))
    wait_for_fit(visitor, chosen)
    assert page.locator("#target-title").inner_text() == "7 of 44 records for EC8 type 1, ground C, 0.25 g"
    rows = page.locator("#chosen tbody tr")
    assert [row.get_attribute("data-record") for row in rows.all()] == [names[0] for names in chosen.names]
    factors = [float(cell.get_attribute("data-value")) for cell in page.locator('#chosen [data-name="factor"]').all()]
    assert factors == pytest.approx(chosen.factors.tolist(), rel=1e-12)
    page.locator("#periods").click()
    page.wait_for_function("""() => document.querySelector('[data-path="target.shortest"] input').value === '0.2'""")
    page.wait_for_function("""() => document.querySelector('[data-path="target.longest"] input').value !== '2'""")
    assert (
        float(page.locator('[data-path="target.longest"] input').input_value()) == visitor.state()["target"]["longest"]
    )
    visitor.fill("target.longest", "2")
    visitor.fill("target.count", "4")
    page.get_by_label("Ground type").select_option("A")
    page.get_by_label("Spectrum of a record").select_option("rotd50")
    page.get_by_text("More options").click()
    visitor.fill("target.per_event", "1")
    options = {"measure": "rotd50", "per_event": 1}
    wait_for_fit(visitor, SUITE.select(rf.ec8_spectrum(0.25 * G, "A"), 4, (0.2, 2.0), **options))
    visitor.fill("target.per_event", "")
    page.get_by_label("Spectrum of a record").select_option("component")
    page.get_by_label("Target spectrum").select_option("asce7_site")
    assert page.get_by_label("Ground type").is_hidden()
    wait_for_fit(visitor, SUITE.select(rf.asce7_site_spectrum(1.5 * G, 0.6 * G, "C", 8.0), 4, (0.2, 2.0)))
    page.get_by_label("Target spectrum").select_option("table")
    visitor.wait_for_error("target.table", "no table was given yet")
    table = page.get_by_label("Table of the spectrum")
    table.fill("period (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n0.5, 0.75\n3.0, <b>\n")
    table.blur()
    page.locator('[data-path="target.table"] > .error', has_text="<b>").wait_for()  # in the place of the first message
    visitor.upload("or from a file", "site.csv", b"period (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n0.5, 0.75\n3.0, 0.125\n")
    target = rf.TargetSpectrum([0.0, 0.1, 0.5, 3.0], [0.3 * G, 0.75 * G, 0.75 * G, 0.125 * G])
    wait_for_fit(visitor, SUITE.select(target, 4, (0.2, 2.0)))
    assert page.locator(".error:visible").count() == 0
    assert "[object" not in page.locator("main").inner_text()


@pytest.mark.slow
def test_bad_values_are_answered_beside_their_fields(visitor) -> None:
    page = visitor.page
    open_target(visitor)
    for path, value, said in (
        ("target.ag", "0", "It must be a_gR in g, from 0.001 to 5, but 0 was given."),
        ("target.count", "50", "N must be at most 44"),
        ("target.longest", "9", "4 s"),
        ("target.importance", "much", "It must be the importance factor"),
    ):
        kept = page.locator(f'[data-path="{path}"] input').input_value()
        visitor.fill(path, value)
        visitor.wait_for_error(path, said)
        page.wait_for_selector("#selection.stale")
        visitor.fill(path, kept)
        page.wait_for_selector("#selection:not(.stale)")
    visitor.fill("target.period", "soon")
    page.get_by_role("button", name="At this period").click()
    visitor.wait_for_error("target.period", "It must be a period in s, from 0 to 100, but soon was given.")
    page.get_by_label("Target spectrum").select_option("table")
    visitor.wait_for_error("target.table")
    visitor.upload("or from a file", "large.csv", b"1\n" * 20_000)
    visitor.wait_for_error("target.file", "large.csv has more than 20000 letters")


@pytest.mark.slow
def test_the_record_is_scaled_and_the_choice_survives_a_reload(visitor, el_centro) -> None:
    page = visitor.page
    open_target(visitor)
    visitor.fill("target.period", "0.7")
    page.get_by_role("button", name="At this period").click()
    page.wait_for_function("() => document.querySelector('#scaled').textContent.startsWith('Scaled by')")
    target = rf.ec8_spectrum(0.25 * G, "C")
    motion = el_centro.scaled_to(sa=float(target.at([0.7])[0]), period=0.7)
    assert visitor.state()["scale"] == pytest.approx(motion.pga / el_centro.pga, rel=1e-12)
    page.get_by_role("button", name="Over the range").click()
    over = el_centro.scaled_to(target, (0.2, 2.0))
    page.wait_for_function("f => Math.abs(rockflexPage.state.scale / f - 1) < 1e-9", arg=over.pga / el_centro.pga)
    page.reload()
    page.wait_for_selector("#chosen table")
    page.get_by_label("Task").select_option("")
    visitor.wait_for("[data-measure=PGA]", over.pga, 1e-9)


@pytest.mark.slow
def test_chosen_records_are_used_by_the_studies_and_saved(visitor) -> None:
    page = visitor.page
    open_target(visitor)
    page.locator("#use").click()
    assert "use these records, with these factors times the scale factors" in page.locator("#used").inner_text()
    assert page.locator('[data-file="records"]').is_hidden()
    for what, name in (("selection-records", "scaled-records.zip"), ("selection-figure", "selection.svg")):
        with page.expect_download() as waiting:
            page.locator(f'[data-file="{what}"]').click()
        assert waiting.value.suggested_filename == name
    visitor.tab("design")
    assert page.get_by_label("records for the target").is_checked()
    visitor.tab("fragility")
    assert page.get_by_label("records for the target").is_checked()
    assert visitor.state()["cloud"]["suites"] == ["chosen"]
    visitor.run_study()
    assert page.locator("#status").inner_text() == "Done: 21 runs."
    visitor.tab("earthquake")
    visitor.fill("target.count", "6")
    page.wait_for_function("() => document.querySelector('#target-title').textContent.startsWith('6 of')")
    visitor.tab("fragility")
    page.wait_for_function("() => document.querySelector('#status').textContent.includes('The input has changed')")
