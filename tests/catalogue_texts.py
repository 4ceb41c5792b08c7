"""All texts for which the catalogues of languages have translations, and which of them are missing."""

import ast
import re
from functools import cache

from jinja2.ext import extract_from_ast

import rockflex as rf
from page_texts import texts_of_answers, texts_of_scripts
from rockflex.foundation.language import Language, catalogue
from rockflex.fragility import LIMIT_STATES
from rockflex.fragility._jackknife import ONE_RECORDING
from rockflex.fragility._outcomes import FEW_RUNS, PARTS
from rockflex.plot._design import _AXES
from rockflex.plot._history import PANELS
from rockflex.plot._motion import _NAMES as _SPECTRA
from rockflex.plot._record_set import LINES
from rockflex.report._publication_files import jinja_templates_in
from rockflex.report.run._report_tables import ASSUMPTIONS, SIDES, STATUS
from rockflex.report.run._set_page import STATISTIC_HEADS
from rockflex.report.run._sheet import TEMPLATES
from rockflex.response._comparison import STATISTICS
from rockflex.response._limit_checks import KINDS, SOURCES
from rockflex.response._outputs import COMPARED_DEMANDS, DEMANDS_OF_SET, HISTORY, OUTPUTS
from rockflex.structure._elements import ELEMENTS
from rockflex.structure._law_bars import BARS

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


def words_of_class(name):
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).capitalize()


def labels():
    """The texts that are looked up by value, from the tables that hold them."""
    kinds = {name: it for name, it in vars(rf.structure).items() if isinstance(it, type) and hasattr(it, "rocking")}
    modified = {name for name, it in kinds.items() if issubclass(it, rf.structure._structure.ModifiedStructure)}
    yield from (words_of_class(name) for name in kinds if name not in (*modified, "RockingProperties"))
    yield from (words_of_class(name).lower() for name in modified)
    yield from (*STATUS.values(), *ASSUMPTIONS, *SIDES, *STATISTICS.values(), *STATISTIC_HEADS.values(), *SOURCES)
    yield from (OUTPUTS[name].symbol for name in (*DEMANDS_OF_SET, *COMPARED_DEMANDS))
    yield from (each.name for each in KINDS)
    yield from (HISTORY[name].symbol for name in PANELS)
    yield from (each.words for each in OUTPUTS.values() if each.of == "tendons")
    yield from (
        *FEW_RUNS,
        *(f"{part}: {{note}}" for part in PARTS),
        ONE_RECORDING,
        *_SPECTRA.values(),
    )
    yield from (each.symbol for each in LIMIT_STATES.values() if "\\" not in each.symbol)
    yield from (text for name, (_, words, _) in _AXES.items() for text in (words, name.replace("_", " ")))
    yield from (label for *_, label in LINES.values())
    yield from (object.__new__(each).words for each in (ELEMENTS | BARS).values())
    yield from (state for each in (ELEMENTS | BARS).values() for state in each.states)
    yield from texts_of_answers()


def has_word(text):
    """Whether there is more than symbols, which are the same in all languages."""
    return re.search(r"\b[^\W\d_]{3,}", re.sub(r"\$[^$]*\$|\{\w+\}", "", text))


@cache
def used_texts() -> tuple[set[str], set[str]]:
    """Return the texts of calls, templates and scripts, and these with all labels that have words."""
    used = {*texts_in_python(), *texts_in_templates(), *texts_of_scripts()}
    return used, used | {text for text in labels() if has_word(text)}


def missing_texts(name: Language) -> list[str]:
    """Return the texts that a language lacks; they appear in English."""
    return sorted(used_texts()[1] - set(catalogue(name)))
