"""The page in another language: each text is looked up in the catalogue, and numbers have its decimal sign."""

import json
import re

import pytest

from page_texts import texts_of_answers, texts_of_scripts
from record_samples import at2
from rockflex.foundation import language
from rockflex.web._forms import PRESETS

pytestmark = pytest.mark.web

FUSES = next(each["structure"] for each in PRESETS if each["structure"]["name"] == "Pier with fuses")
SPRINGS = {"friction": 0.5, "mat_mass": 2e4, "springs": {"stiffness": 5e8, "heave_damping_ratio": 0.3}}
SOURCES = ("pulse", "upload", "folder")
TARGETS = ("ec8", "ec8_second", "asce7", "asce7_site", "table")
# Texts of elements that are shown and of their attributes, without subscripts, that were not looked up.
LEFT = """([left, sentences]) => {
  const found = new Set();
  const keep = (text, of) => {
    if (/^[^ ]+ = |^Σ/.test(text)) return; // a formula
    const seen = (of.closest("select") ?? of).checkVisibility() && !of.closest(sentences);
    if (seen && !text.includes("«")) found.add(text.trim());
  };
  const bare = (of) => [...of.childNodes].map((each) => (each.nodeName === "SUB" ? "" : each.textContent)).join("");
  const nodes = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (nodes.nextNode()) {
    const { parentElement: of, data } = nodes.currentNode;
    const whole = of.closest("sub")?.parentElement ?? (of.querySelector(":scope > sub") ? of : null);
    if (!whole?.textContent.includes("«")) keep(whole ? bare(whole) : data, of);
  }
  for (const name of ["aria-label", "title", "placeholder", "aria-roledescription", "aria-valuetext"])
    for (const of of document.querySelectorAll(`[${name}]`)) keep(of.getAttribute(name), of);
  return [...found].filter((text) => !left.includes(text));
}"""
# Messages of errors; names of languages, units, arrays of files and records; what files say; the example of a table.
SENTENCES = (
    ".error, #language, #units, #part, .thumbs, #record-title, #chosen td:nth-child(2), #report tbody, #report .notes, "
    "textarea"
)


class Marks(dict[str, str]):
    """A catalogue of the server that puts every text in quotation marks."""

    def get(self, text: str, _: object = None) -> str:
        return f"«{text}»"


@pytest.fixture
def marked(visit, monkeypatch):
    """A visitor whose language has every text in quotation marks, on the page and in what the server words."""
    monkeypatch.setattr(language, "catalogue", lambda name: Marks() if name == "de" else {})
    visitor = visit(None, locale="de-DE")
    catalogue = {text: f"«{text}»" for text in texts_of_scripts() | texts_of_answers()}
    visitor.page.route("**/languages/de.json", lambda route: route.fulfill(json=catalogue))
    return visitor


@pytest.fixture(scope="module")
def names(client) -> list[str]:
    """Names of records and suites, models, and a symbol."""
    suites = json.loads(client.request("/api/about")[2])["suites"]
    found = {
        "rockflex",
        "El Centro 1940",
        "rigid",
        "fixed",
        "Σkx²",
        *suites,
        *(name[len("fema-p695-") :] for name in suites),
    }
    for suite in suites:
        for each in json.loads(client.request(f"/api/suite/{suite}")[2])["records"]:
            found |= {each["name"], f"{each['event']}, {each['name']}"}
    return sorted(found)


def left_on(visitor, names) -> list[str]:
    """Texts with a word that is no symbol, unit or name, and was not looked up, once what is asked for has come."""
    page, found = visitor.page, list[str]()
    for _ in range(20):
        visitor.settle()
        page.evaluate("for (const folded of document.querySelectorAll('details')) folded.open = true")
        texts = page.evaluate(LEFT, [[*names, visitor.state()["structure"]["name"]], SENTENCES])
        found = [text for text in texts if re.search(r"[^\W\d_A-Z]{3,}", re.sub(r"\bm?rad\b", "", text))]
        if not found and page.evaluate("!document.querySelector('.stale')"):
            return []
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes",
    [
        {
            "structure": PRESETS[-1]["structure"],
            "alternatives": [{"name": "A", "structure": FUSES, "models": ["MDOF-S"]}],
        },
        {"structure": FUSES, "ground": SPRINGS, "models": ["MDOF-S", "2DOF-S"]},
        {"bouc_wen": {"yield_displacement": 0.05}, "models": ["2DOF-S", "2DOF-S-BW"], "impact": "restitution"},
    ],
)
def test_every_text_is_looked_up(marked, names, client, link, changes) -> None:
    page = marked.page
    marked.open("/?lang=de" + link(client.state(**changes))[1:])
    for tab in ("structure", "response"):
        marked.tab(tab)
        page.wait_for_selector({"structure": "#modes", "response": "#keys .legend"}[tab])
        assert left_on(marked, names) == []
    marked.tab("earthquake")
    page.wait_for_selector("#measures dt")
    assert left_on(marked, names) == []


@pytest.mark.slow
@pytest.mark.parametrize("tab", ["fragility", "design", "response"])
def test_every_text_of_a_study_is_looked_up(marked, names, client, link, tab) -> None:
    changes = {"record_set": {"shown": True, "suites": ["fema-p695-near-field-pulse"]}, "limits": {"drift_ratio": 0.01}}
    marked.open("/?lang=de" + link(client.state(tab=tab, **changes))[1:])
    if tab == "response":
        marked.page.locator("#run").click()
    marked.page.wait_for_function("() => document.querySelector('#status').textContent.includes('«Done: ')")
    assert left_on(marked, names) == []


@pytest.mark.slow
def test_every_text_about_records_is_looked_up(marked, names, client, link) -> None:
    page = marked.page
    marked.open("/?lang=de" + link(client.state(tab="earthquake"))[1:])
    for source in SOURCES:
        page.locator('[data-path="record.source"] select').select_option(source)
        assert left_on(marked, names) == []
    page.locator('[data-path="record.source"] select').select_option("folder")
    page.locator("#files").set_input_files([{"name": "A.AT2", "mimeType": "text/plain", "buffer": at2("000").encode()}])
    page.wait_for_selector("#report table")
    assert left_on(marked, names) == []
    page.locator('[data-path="task"] select').select_option("target")
    for kind in TARGETS:
        page.locator('[data-path="target.kind"] select').select_option(kind)
        page.wait_for_selector("#chosen table, .error:visible")
        assert left_on(marked, names) == []


@pytest.mark.slow
def test_the_language_is_chosen_and_kept(marked, client) -> None:
    page = marked.open().page
    lang = "document.documentElement.lang"
    assert page.evaluate(lang) == "en"  # whatever that of the browser
    assert page.get_by_role("tab").first.inner_text() == "Structure"
    marked.tab("response")
    state = marked.state()
    page.get_by_label("Language").select_option("de")
    page.wait_for_function(f"() => {lang} === 'de'")
    page.wait_for_selector('#view[data-shown="response"]')
    assert page.get_by_role("tab").first.inner_text() == "«Structure»"
    assert marked.state() == state | {"language": "de"}
    scale = page.locator('[data-path="scale"]')
    assert "0,01" in scale.text_content()
    for typed, value, shown in (("1.5", 1.5, "1,5"), ("1,234", 1.234, "1,234")):
        marked.fill("scale", typed)
        assert (marked.state()["scale"], scale.locator('input[type="text"]').input_value()) == (value, shown)
    marked.tab("fragility")
    scales = page.locator('[data-path="cloud.scales"] input')
    assert scales.input_value() == "0,5; 1; 2"
    marked.fill("cloud.scales", "0,25; 1,5")
    assert marked.state()["cloud"]["scales"] == [0.25, 1.5]
    page.goto("about:blank")
    marked.open("/")
    assert page.evaluate(lang) == "de"
    marked.open("/?lang=en")
    assert page.evaluate(lang) == "en"


@pytest.mark.slow
def test_a_catalogue_that_is_missing_leaves_the_page_in_english(visit) -> None:
    visitor = visit(None)
    visitor.page.route("**/languages/de.json", lambda route: route.fulfill(status=404))
    visitor.open("/?lang=de")
    assert visitor.page.get_by_role("tab").first.inner_text() == "Structure"
