"""The texts of the page that a catalogue must have."""

import ast
import inspect
import io
from collections.abc import Iterator
from typing import Any

from babel.messages.extract import extract_javascript

from rockflex.motion import MEASURES
from rockflex.response._limit_checks import KINDS, SOURCES
from rockflex.response._outputs import DEMANDS_OF_SET, OF_MOTION, OUTPUTS, REACTIONS, outputs_of
from rockflex.web import _earthquake, _projects, _structure
from rockflex.web._app import STATIC, _answer_about_page


def texts_of_scripts() -> set[str]:
    """The texts in t("...") of all scripts."""
    found = set()
    for file in STATIC.rglob("*.js"):
        for _, _, text, _ in extract_javascript(io.BytesIO(file.read_bytes()), ("t",), (), {}):
            found.add(text if isinstance(text, str) else text[0])
    return found


def texts_of_answers() -> set[str]:
    """The texts of the server's answers that the page looks up where it shows them.

    They are titles, labels and help of forms, presets, pulses and limit states; names of measures, demands and checks;
    tendons of a design; and what stands beside the values of a structure and a record.
    """
    found = {*_of_forms(_answer_about_page()), *_of_facts(), "no tendon", "its own tendons", _structure.RECENTRING_HELP}
    found |= {"results", _projects.SETTLES}  # what the page leaves of a project
    found |= {text for measure in MEASURES.values() for text in (measure.head, measure.words, measure.title)}
    found |= {
        *SOURCES,
        *(each.name for each in KINDS),
    }
    listed = {*OF_MOTION, *REACTIONS, *outputs_of("sliding", "springs"), "residual_rotation", *DEMANDS_OF_SET}
    found |= {text for name in listed for text in (OUTPUTS[name].symbol, OUTPUTS[name].words)}
    return found - {""}


def _of_forms(part: Any) -> Iterator[str]:
    if isinstance(part, dict):
        yield from (part[key] for key in ("title", "label", "help", "clause", "noun") if key in part)
        part = [*part.values()]
    if isinstance(part, list | tuple):
        for each in part:
            yield from _of_forms(each)


def _of_facts() -> Iterator[str]:
    """The last argument of `_fact`, and the names, help and absence of values in tables."""
    for module in (_structure, _earthquake):
        nodes = [*ast.walk(ast.parse(inspect.getsource(module)))]
        calls = [node for node in nodes if isinstance(node, ast.Call)]
        shown = [call.args[-1] for call in calls if getattr(call.func, "id", "") == "_fact"]
        for node in nodes:
            if isinstance(node, ast.Dict):
                keyed = zip(node.keys, node.values, strict=True)
                shown += [value for key, value in keyed if getattr(key, "value", "") in ("name", "help", "none")]
        for part in shown:
            for node in [part.body, part.orelse] if isinstance(part, ast.IfExp) else [part]:
                if isinstance(node, ast.Constant):
                    yield str(node.value)
