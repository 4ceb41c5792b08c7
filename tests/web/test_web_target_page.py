"""Records for a target spectrum in a real Chromium: the form, the chart, the files, and the suite of the studies."""

import pytest

import rockflex as rf

pytestmark = pytest.mark.web

SUITE = rf.load_suite("fema-p695-far-field")
G = 9.81


def open_target(visitor) -> None:
    visitor.tab("earthquake")
    visitor.page.get_by_label("Task").select_option("target")
    visitor.page.wait_for_selector("#chosen table")


def wait_for_fit(visitor, chosen) -> None:
    visitor.page.wait_for_function(
        "v => Math.abs(Number(document.querySelector('[data-fact=misfit]')?.dataset.value) / v - 1) < 1e-9",
        arg=chosen.misfit,
    )


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
    assert "no table was given yet" in visitor.error("target.table").lower()
    table = page.get_by_label("Table of the spectrum")
    table.fill("period (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n0.5, 0.75\n3.0, <b>\n")
    table.blur()
    page.locator('[data-path="target.table"] > .error', has_text="<b>").wait_for()  # in the place of the first message
    visitor.upload("or from a file", "site.csv", b"period (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n0.5, 0.75\n3.0, 0.125\n")
    target = rf.TargetSpectrum([0.0, 0.1, 0.5, 3.0], [0.3 * G, 0.75 * G, 0.75 * G, 0.125 * G])
    wait_for_fit(visitor, SUITE.select(target, 4, (0.2, 2.0)))
    assert page.locator(".error:visible").count() == 0
    assert "[object" not in page.locator("main").inner_text()


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
        assert said.lower() in visitor.error(path).lower()
        page.wait_for_selector("#selection.stale")
        visitor.fill(path, kept)
        page.wait_for_selector("#selection:not(.stale)")
    visitor.fill("target.period", "soon")
    page.get_by_role("button", name="At this period").click()
    assert visitor.error("target.period") == "It must be a period in s, from 0 to 100, but soon was given."
    page.get_by_label("Target spectrum").select_option("table")
    visitor.error("target.table")
    visitor.upload("or from a file", "large.csv", b"1\n" * 20_000)
    assert visitor.error("target.file").startswith("large.csv has more than 20000 letters")


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
    page.wait_for_function(
        "p => Math.abs(Number(document.querySelector('[data-measure=PGA]')?.dataset.value) / p - 1) < 1e-9",
        arg=over.pga,
    )


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
