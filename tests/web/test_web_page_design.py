"""The Design tab in a real Chromium, used as a person would."""

import re

import pytest

pytestmark = pytest.mark.web


def test_design_answers_how_wide(visitor) -> None:
    page = visitor.page
    visitor.tab("design")
    visitor.fill("design.widths", "4")
    assert page.locator("#status").inner_text() == "No search yet."
    visitor.run_study()
    answers = page.locator("#width p")
    assert answers.count() == 2
    assert re.search(
        r"no tendon: a base [\d.]+ m wide \(B = [\d.]+ m\) is enough \(now 2\.11 m", answers.first.inner_text()
    )
    free, held = (visitor.value(f'#width p[data-tendon="{name}"]') for name in ("no tendon", "F₀ = 0.2 W"))
    assert held < free
    visitor.fill("design.target", "0.0001")
    page.wait_for_selector("text=no base tried is wide enough")
    visitor.fill("design.widest", "999")
    assert "from 1 to 10, but 999 was given" in visitor.error("design.widest")


def test_a_search_is_cancelled_and_told_of_changes(visitor) -> None:
    page = visitor.page
    visitor.fill("structure.frame.n_stories", "15")
    visitor.tab("design")
    page.get_by_label("Model").select_option("MDOF-S")
    visitor.fill("design.widths", "20")  # takes longer than it takes to cancel it
    page.get_by_role("button", name="Search", exact=True).click()
    page.wait_for_function("() => /^[1-9]\\d* of/.test(document.querySelector('#status').textContent)")
    page.get_by_role("button", name="Cancel").click()
    page.wait_for_function("() => document.querySelector('#status').textContent.startsWith('Cancelled after')")
    visitor.fill("design.widths", "5")
    page.get_by_text("The input has changed: search again.").wait_for()
    visitor.fill("design.target", "0.5")  # a question, for which nothing runs again
    assert page.locator("#cancel").is_disabled()
