"""Count at how many places one thing is said: `python scripts/count_places.py [ROOT]`, here or in another tree.

A number that rises tells that something is described twice; see docs/design/0001-layers.md for what should hold it.
"""

import ast
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path

ROOT = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[1]).resolve()
SOURCE = ROOT / "src" / "rockflex"
TEXTS = {file: file.read_text("utf-8") for file in sorted(SOURCE.rglob("*")) if file.suffix in (".py", ".pyi", ".js")}

OPTION = "free_vibration"
FIELDS = ("rupture_elongation", "initial_force")
OUTPUTS = ("max_slip", "residual_slip")
HEADINGS = ("x_end", "slip_end", "slip left")  # of the slip that is left, today and before
LAWS = {"VVELSimplified", "VVELComplete", "Restitution", "AngularMomentum", "PivotImpulse", "SidedRestitution"}
ELEMENTS = {
    "Tendon", "YieldingDissipator", "ViscousDamper", "FrictionDamper", "ElementLaw", "BaseElement", "Attachment",
    "YieldingStory", "Element", "ElasticElement", "ViscousElement", "YieldingElement", "FrictionElement", "LawElement",
}  # fmt: skip
BASES = {"Ground", "GivenGround", "Springs", "SlidingModel", "SpringModel"}
# What runs are the product of, by the words with which loops and products name them.
FACTORS = {
    "structure": r"structures?|designs?|everything|each_structure|alternatives|built",
    "record": r"motions?|records?|suites?|rows",
    "model": r"models?|labels|chosen|cases",
    "scale": r"scales?|factors|levels",
}
KNOWN = ("_compare.compare", "_response.simulate_state_models", "_run_matrix.cross")  # in other words
RUNS = re.compile(r"simulate|\.run\(|\.task\(|BatchRun|PreparedCase|case\(|tasks|runs")
HEADER = ("what is said", "places", "files")
Places = Iterator[tuple[Path, str]]


def trees(*words: str) -> Iterator[tuple[Path, ast.AST]]:
    """Yield the modules that have one of these words, and all nodes of each."""
    for file, text in TEXTS.items():
        if file.suffix == ".py" and any(word in text for word in words):
            yield from ((file, node) for node in ast.walk(ast.parse(text)))


def lines_with(*words: str) -> Places:
    """Yield the lines with one of these words, as a whole word."""
    pattern = re.compile(rf"(?<![\w])(?:{'|'.join(words)})(?!\w)")
    for file, text in TEXTS.items():
        yield from ((file, line) for line in text.splitlines() if pattern.search(line))


def option_places() -> Iterator[tuple[str, Path]]:
    """Yield how and where the option is said."""
    entry = re.compile(rf"^ *(?:\w+, )*{OPTION}(?:, \w+)*(?: :.*)?$", re.MULTILINE)
    for file, node in trees(OPTION):
        if isinstance(node, ast.arguments):
            given = [*node.posonlyargs, *node.args, *node.kwonlyargs]
            yield from (("parameter", file) for each in given if each.arg == OPTION)
        elif isinstance(node, ast.ClassDef):
            fields = [each.target for each in node.body if isinstance(each, ast.AnnAssign)]
            yield from (("field", file) for each in fields if isinstance(each, ast.Name) and each.id == OPTION)
        elif isinstance(node, ast.keyword) and node.arg == OPTION and OPTION in ast.unparse(node.value):
            yield "forwarded keyword", file
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            text = ast.get_docstring(node) or ""
            yield from (("docstring entry", file) for _ in entry.finditer(text))


def registries() -> Places:
    """Yield the tuples, lists, sets and dictionaries that list several of our impact laws."""
    for file, node in trees(*LAWS):
        if isinstance(node, ast.Tuple | ast.List | ast.Set | ast.Dict):
            parts = node.elts if not isinstance(node, ast.Dict) else [*filter(None, node.keys), *node.values]
            names = {getattr(each, "id", getattr(each, "value", None)) for each in parts}
            if len(LAWS & {name for name in names if isinstance(name, str)}) > 1 and file.name != "__init__.py":
                yield file, ast.unparse(node)[:60]


def kind_checks(kinds: set[str]) -> Places:
    """Yield the lines that ask for one of these classes, outside the modules that define them."""
    own = {file for file, text in TEXTS.items() if re.search(rf"^class (?:{'|'.join(kinds)})\b", text, re.MULTILINE)}
    found = set[tuple[Path, int]]()
    for file, node in trees("isinstance"):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "isinstance" and file not in own:
            named = {each.id for each in ast.walk(node.args[-1]) if isinstance(each, ast.Name)}
            if named & kinds:
                found.add((file, node.lineno))
    yield from ((file, str(line)) for file, line in sorted(found))


def products() -> Places:
    """Yield the products and nested loops over structures, records, models or scales that make runs."""

    def factors(*sources: ast.expr) -> int:
        text = " ".join(ast.unparse(each) for each in sources)
        return sum(re.search(rf"\b_?(?:{words})\b", text) is not None for words in FACTORS.values())

    for file, node in trees("product", "for "):
        if "papers" in file.parts or not isinstance(node, ast.FunctionDef):
            continue
        known = f"{file.stem}.{node.name}" in KNOWN and "cli" not in file.parts
        if known or (RUNS.search(ast.unparse(node)) and any(_is_product(each, factors) for each in ast.walk(node))):
            yield file, node.name


def _is_product(node: ast.AST, factors: Callable[..., int]) -> bool:
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "product":
        return factors(*node.args) > 1
    if isinstance(node, ast.ListComp | ast.GeneratorExp | ast.DictComp):
        return len(node.generators) > 1 and factors(*(each.iter for each in node.generators)) > 1
    if isinstance(node, ast.For):
        inner = [each for part in node.body for each in ast.walk(part) if isinstance(each, ast.For)]
        return any(factors(node.iter, each.iter) > 1 for each in inner)
    return False


def public_names() -> set[str]:
    """Return the names that the package or its reference has."""
    stub = (SOURCE / "__init__.pyi").read_text("utf-8")
    named = chain.from_iterable(
        re.findall(r"\w+", file.read_text("utf-8")) for file in (ROOT / "docs" / "api").glob("*.md")
    )
    return {*re.findall(r"import \w+ as (\w+)", stub), *named}


def handed_on() -> Places:
    """Yield the names that layers import for others."""
    for file, text in TEXTS.items():
        if file.stem == "__init__" and file.parent != SOURCE:
            for node in ast.walk(ast.parse(text)):
                if isinstance(node, ast.ImportFrom):
                    yield from ((file, each.asname or each.name) for each in node.names)


def lines_of_layers() -> Places:
    """Yield the lines of code of the `__init__` of layers."""
    for file, text in TEXTS.items():
        if file.stem == "__init__" and file.parent != SOURCE:
            yield from ((file, line) for line in text.splitlines() if line.strip() and not line.startswith('"""'))


def counted(what: str, places: Places) -> tuple[str, int, int]:
    """Return a row of the table."""
    found = list(places)
    return what, len(found), len({file for file, _ in found})


def rows() -> Iterator[tuple[str, int, int]]:
    """Yield the rows of the table."""
    said = list(option_places())
    count = Counter(how for how, _ in said)
    for how in ("parameter", "field", "docstring entry", "forwarded keyword"):
        yield f"run option {OPTION}: {how}", count[how], len({file for each, file in said if each == how})
    yield counted(f"run option {OPTION}: any", lines_with(OPTION))
    for name in FIELDS:
        yield counted(f"field {name}", lines_with(name))
    for name in OUTPUTS:
        yield counted(f"output {name}", lines_with(name))
    yield counted("headings of the residual slip", lines_with(*HEADINGS))
    yield counted("registries of impact laws", registries())
    yield counted("isinstance on elements, elsewhere", kind_checks(ELEMENTS))
    yield counted("isinstance on bases, elsewhere", kind_checks(BASES))
    yield counted("products of structures, records, models", products())
    names, known = list(handed_on()), public_names()
    yield counted("names that layers hand on", iter(names))
    yield counted("of which not public", (each for each in names if each[1] not in known))
    yield counted("lines of code in __init__ of layers", lines_of_layers())


def main() -> None:
    """Print the table."""
    print(f"{HEADER[0]:44}{HEADER[1]:>8}{HEADER[2]:>7}")
    for what, places, files in rows():
        print(f"{what:44}{places:8}{files:7}")


if __name__ == "__main__":
    main()
