"""The documentation against the package: its code runs and prints what it says, its links lead somewhere.

Blocks of a page are run in their order, in one namespace and one folder: `python` as it stands, `sql` by DuckDB,
`console` lines that begin with "$ rockflex". A `text` block right after a `python` block is what that prints. A block
that begins with a comment such as "# structure.toml" is a file.
"""

import re
import shutil
from importlib import import_module
from pathlib import Path

import pytest

import rockflex
from doc_blocks import blocks_of, run_page

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted([*DOCS.glob("*.md"), *DOCS.glob("howto/*.md"), *DOCS.glob("theory/*.md")])
LINK = re.compile(r"\]\(([^)\s#]+)(?:#[^)\s]*)?\)")
INDENTED = re.compile(r"(?:^    \S.*\n)+", re.MULTILINE)
PRIVATE = re.compile(r"\brockflex(?:\.\w+)*\._\w|\brf\._\w|\bimport _\w")
GUIDES = [page for page in PAGES if page.parent.name == "howto" and page.stem != "index"]
FEW = [f"FF-{number}-*" for number in (1, 3, 5, 9, 10, 19)]  # of an example's records: some stand still, some fall
PLACES = ("studies", "engine", "papers.silva_stojadinovic_2024.population")  # of names that the front does not have
GENERATED = ("gallery/", "../gallery/")


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(DOCS)))
def test_code_of_a_page_runs_and_prints_what_it_says(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for block, printed in run_page(page, tmp_path):
        if block.output is not None:
            lines = [line.rstrip() for line in printed.splitlines()]
            assert lines == block.output.splitlines(), f"{page.name}, line {block.line}"


def test_code_of_the_readme_runs_and_prints_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    for name, runs in {"cloud": 2592, "population": 2000, "incremental": 2420}.items():
        file = tmp_path / "examples" / f"{name}.toml"
        assert rockflex.load_study(file).plan().n_runs == runs, name
        text = file.read_text("utf-8").replace("pairs = 1000", "pairs = 150")
        file.write_text(text.replace("[records]", f"[records]\ninclude = {FEW}"), "utf-8")

    def console(found: re.Match[str]) -> str:
        commands = [command.strip() for line in found[0].splitlines() for command in line.split("&&")]
        return "".join(["```console\n", *(f"$ {command}\n" for command in commands), "```\n"])

    page = tmp_path / "README.md"
    parts = re.split(r"(^```\w+\n.*?^```$)", (ROOT / "README.md").read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
    parts[::2] = [INDENTED.sub(console, prose) for prose in parts[::2]]
    page.write_text("".join(parts), "utf-8")
    commands = [block.source for block in blocks_of(page.read_text("utf-8")) if block.language == "console"]
    assert sum(text.count("$ rockflex ") for text in commands) == 11
    told = [(block, printed) for block, printed in run_page(page, tmp_path) if block.output is not None]
    assert len(told) == 1
    for block, printed in told:
        assert [line.rstrip() for line in printed.splitlines()] == block.output.splitlines()


@pytest.mark.parametrize("page", [*PAGES, ROOT / "README.md"], ids=lambda page: str(page.relative_to(ROOT)))
def test_pages_name_nothing_private(page):
    assert PRIVATE.findall(page.read_text("utf-8")) == []


@pytest.mark.parametrize(
    "text", ["`rockflex._x`", "from rockflex.cli._y import z", "rf._z(1)", "from rockflex import _a"]
)
def test_private_names_are_seen(text):
    assert PRIVATE.search(text)


@pytest.mark.parametrize(
    "page",
    [*PAGES, *sorted(DOCS.glob("*/*.md")), ROOT / "README.md", ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"],
    ids=lambda page: str(page.relative_to(ROOT)),
)
def test_links_lead_somewhere(page):
    missing = []
    for target in LINK.findall(page.read_text("utf-8")):
        if "://" in target or target.startswith("mailto:"):
            continue
        if target.startswith(GENERATED):  # written by the build from a script of the same name
            script = re.sub(r"^(?:\.\./)?gallery/(?:images/sphx_glr_)?(.*?)(?:_\d{3}\.png|\.rst)$", r"\1", target)
            known = script == "index" or (ROOT / "examples" / "gallery" / f"{script}.py").exists()
        else:
            known = (page.parent / target).exists()
        if not known:
            missing.append(target)
    assert missing == []


@pytest.mark.parametrize("page", GUIDES, ids=lambda page: page.stem)
def test_a_guide_has_the_form_of_a_guide(page):
    """A question, a picture, what to do, where it fails, and what comes next; short enough to be read."""
    text = page.read_text("utf-8")
    title, _, rest = text.partition("\n\n")
    assert re.fullmatch(r"# .*\?", title)
    assert rest.startswith(("```{drawing}\n", "![")), "the picture comes first"
    assert text.rindex("\n## Where it fails\n") < text.index("\n## What next\n")
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    assert len(prose.split()) <= 900
    code = re.findall(r"^```(?:python|toml|bash|sql)\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    assert max((len(line) for block in code for line in block.splitlines()), default=0) <= 78


def listed() -> list[str]:
    """Names of the reference, in the order of its pages."""
    return [
        name
        for page in sorted(DOCS.glob("api/*.md"))
        for name in re.findall(r"^   rockflex\.(\S+)$", page.read_text("utf-8"), re.M)
    ]


def test_the_reference_has_every_public_name_once():
    names = listed()
    assert sorted(name for name in names if "." not in name) == sorted(rockflex.__all__)
    assert len(set(names)) == len(names)
    for name in names:
        if "." in name:
            place, _, last = name.rpartition(".")
            assert last not in rockflex.__all__
            assert place in PLACES
            assert last in import_module(f"rockflex.{place}").__all__


def test_the_style_of_formulas_is_of_the_version_of_their_script():
    """With another one formulas are set wrongly; without its fonts they need the network, or look like text."""
    place = pytest.importorskip("sphinxcontrib.katex").__file__
    style = (DOCS / "_static" / "katex" / "katex.min.css").read_text("utf-8")
    version = re.search(r'version:"([\d.]+)"', Path(place).with_name("katex.min.js").read_text("utf-8"))
    assert version is not None
    assert f'content:"{version[1]}"' in style
    fonts = re.findall(r"url\((fonts/[\w-]+\.woff2)\)", style)
    assert len(fonts) > 15
    assert all((DOCS / "_static" / "katex" / font).is_file() for font in fonts)


@pytest.mark.parametrize("page", [*PAGES, *DOCS.glob("design/*.md")], ids=lambda page: str(page.relative_to(DOCS)))
def test_the_largest_rotation_is_set_as_a_formula(page):
    """Outside code and tables, where it stands as programs print it."""
    text = re.sub(r"^ *```.*?^ *```$", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
    assert "θ_max" not in re.sub(r"`[^`\n]*`|^(?:\||    ).*$", "", text, flags=re.MULTILINE)


def test_every_page_is_in_a_table_of_contents():
    entries = set()
    for page in DOCS.rglob("*.md"):
        for body in re.findall(r"^```\{toctree\}\n(.*?)^```$", page.read_text("utf-8"), re.MULTILINE | re.DOTALL):
            for line in body.splitlines():
                if line.strip() and not line.startswith(":"):
                    entry = line.strip().removesuffix(">").rpartition("<")[2]
                    entries |= {path.with_suffix("").resolve() for path in page.parent.glob(f"{entry}.md")}
                    if not entry.endswith("*"):
                        entries.add((page.parent / entry).resolve())
    apart = {DOCS / "index", DOCS / "joss" / "paper"}  # the front page, and a paper that is no page
    pages = {page.with_suffix("") for page in DOCS.rglob("*.md")} - apart
    assert pages <= entries
    assert all(Path(f"{entry}.md").exists() or {"gallery", "reproduced"} & set(entry.parts) for entry in entries)


@pytest.mark.parametrize("script", sorted((ROOT / "examples" / "gallery").glob("*.py")), ids=lambda path: path.stem)
def test_a_script_of_the_gallery_has_its_heading(script):
    source = script.read_text("utf-8")
    compile(source, script.name, "exec")
    heading, rule = source.removeprefix('"""').strip().splitlines()[:2]
    assert source.startswith('"""')
    assert set(rule) == {"="}
    assert len(rule) >= len(heading)


def test_the_table_of_the_gallery_says_what_its_scripts_have():
    words = {
        "tendons": r'rf\.Tendon|"tendon"',
        "fuses": r"YieldingDissipator|bar_fuse",
        "springs": r"Springs|_bed\(",
        "complete models": r'DOF-C"|rigid-C',
        "fragility": r"plot_fragility|plot_stripes|fit_capacities|fit_clouds",
    }
    folder = ROOT / "examples" / "gallery"
    table = (folder / "README.rst").read_text("utf-8")
    rows = [re.findall(r"- ?(.*)", row) for row in table.partition("   * - ")[2].split("\n   * ")]
    assert [cell.strip() for cell in rows[0]] == list(words)
    found = {
        row[0].strip().removeprefix(":doc:").strip("`"): [bool(cell.strip()) for cell in row[1:]] for row in rows[1:]
    }
    for script in folder.glob("*.py"):
        text = script.read_text("utf-8")
        assert found[script.stem] == [bool(re.search(each, text)) for each in words.values()], script.stem
        if script.stem != "records_for_a_target":
            assert text.index("drawing = rf.plot_structure(") < text.find("rf.plot_history") % len(text)


@pytest.mark.parametrize(
    ("text", "languages", "outputs"),
    [
        ("```python\nprint(1)\n```\n\n```text\n1\n```\n", ["python", "text"], ["1\n", None]),
        ("```python\nprint(1)\n```\nprose\n```text\n1\n```\n", ["python", "text"], [None, None]),
        ("no block", [], []),
    ],
)
def test_blocks_are_found(text, languages, outputs):
    blocks = blocks_of(text)
    assert [block.language for block in blocks] == languages
    assert [block.output for block in blocks] == outputs


def test_wrong_output_and_dead_links_are_seen(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("[nowhere](gone.md)\n\n```python\nprint(2)\n```\n\n```text\n1\n```\n", "utf-8")
    ((block, printed),) = run_page(page, tmp_path)
    assert printed != block.output
    with pytest.raises(AssertionError, match=r"gone\.md"):
        test_links_lead_somewhere(page)
