"""The catalogues of texts: complete, without leftovers, and used by reports, figures and commands."""

import ast
import io
import re
from collections import Counter
from string import Formatter
from typing import get_args

import pytest
from babel.messages.extract import extract_javascript
from jinja2.ext import extract_from_ast

import rockflex as rf
from rockflex._language import Language, catalogue
from rockflex.modal import BARS
from rockflex.plot._history import _QUANTITIES
from rockflex.plot._loops import _ELEMENT_NAMES
from rockflex.plot._record_set import LABELS, LINES
from rockflex.report._publication_files import jinja_templates_in
from rockflex.report.run._report_tables import ASSUMPTIONS, SIDES, STATUS
from rockflex.report.run._set_page import STATISTIC_HEADS
from rockflex.report.run._sheet import TEMPLATES
from rockflex.response import DEMANDS, STATISTICS
from rockflex.response._limit_checks import KINDS, SOURCES

OTHERS = [name for name in get_args(Language) if name != "en"]
SOURCE = TEMPLATES.parents[2]


def texts_of_call(argument):
    """The texts that the first argument of translated() may have."""
    if isinstance(argument, ast.IfExp):
        yield from (*texts_of_call(argument.body), *texts_of_call(argument.orelse))
    elif isinstance(argument, ast.Constant):
        yield argument.value


def texts_in_python():
    for file in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "translated":
                yield from texts_of_call(node.args[0])


def texts_in_templates():
    environment = jinja_templates_in(TEMPLATES)
    for file in TEMPLATES.glob("*.jinja"):
        for _, _, text in extract_from_ast(environment.parse(file.read_text("utf-8")), ("t",)):
            yield text if isinstance(text, str) else text[0]


def texts_in_scripts():
    for file in (SOURCE / "web" / "static").rglob("*.js"):
        with file.open("rb") as content:
            for _, _, text, _ in extract_javascript(content, ("t",), (), {"template_string": True}):
                yield text if isinstance(text, str) else text[0]


def words_of_class(name):
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).capitalize()


def labels():
    """The texts that are looked up by value, from the tables that hold them."""
    kinds = {name: it for name, it in vars(rf.structure).items() if isinstance(it, type) and hasattr(it, "rocking")}
    modified = {name for name, it in kinds.items() if issubclass(it, rf.structure._structure.ModifiedStructure)}
    yield from (words_of_class(name) for name in kinds if name not in modified)
    yield from (words_of_class(name).lower() for name in modified)
    yield from (*STATUS.values(), *ASSUMPTIONS, *SIDES, *STATISTICS.values(), *STATISTIC_HEADS.values(), *SOURCES)
    yield from (text for demand in DEMANDS.values() for text in (demand.symbol, demand.compared_as))
    yield from (each.name for each in KINDS)
    yield from (text for each in _QUANTITIES.values() for text in (each.symbol, each.words))
    yield from (*_ELEMENT_NAMES.values(), *LABELS.values(), *(label for *_, label in LINES.values()))
    yield from (re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", bar.__name__).lower() for bar in BARS.values())


def has_word(text):
    """Whether there is more than symbols, which are the same in all languages."""
    return re.search(r"\b[^\W\d_]{3,}", re.sub(r"\$[^$]*\$|\{\w+\}", "", text))


def names_in(text):
    return {name for _, name, _, _ in Formatter().parse(text) if name}


@pytest.fixture(scope="module")
def known():
    used = {*texts_in_python(), *texts_in_templates(), *texts_in_scripts()}
    return used, used | {text for text in labels() if has_word(text)}


def test_every_source_is_read(known):
    texts, _ = known
    assert {"Length of the run", "{n} records", "{n} record", "Largest values"} <= texts
    script = io.BytesIO(b'h("p", t("{count} records", { count: 7 })); t("one"); t(`two`)')
    found = [text for _, _, text, _ in extract_javascript(script, ("t",), (), {"template_string": True})]
    assert [text if isinstance(text, str) else text[0] for text in found] == ["{count} records", "one", "two"]


@pytest.mark.parametrize("name", OTHERS)
def test_no_text_is_missing_and_none_is_unused(known, name):
    texts, have = known[1], set(catalogue(name))
    assert (sorted(texts - have), sorted(have - texts)) == ([], [])


@pytest.mark.parametrize("name", OTHERS)
def test_translations_have_the_values_and_symbols_of_their_texts(name):
    symbols = re.compile(r"[A-Za-zα-ωΑ-Ω]+\*?_[\w*–]+(?![\w}])|[θμαλΣ|≥<>†²]")
    for text, other in catalogue(name).items():
        assert other.strip() == other if text.strip() == text else other[0] == text[0], text
        assert names_in(other) == names_in(text), text
        assert Counter(symbols.findall(other)) == Counter(symbols.findall(text)), text
        assert text[-1] not in ".:" or other[-1] == text[-1], text
