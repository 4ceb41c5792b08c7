"""The examples in the docstrings of the public names: each runs and prints what it shows, and none is missing."""

import doctest
import inspect
import io
import re

import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest

import rockflex

WITHOUT = {
    "Check": "a row of a CheckTable",
    "FloorModes": "a part of RockingProperties, as its floors",
    "FloorPeaks": "a part of Response, as its floors",
}
"""Public names that need no example, and why: results that users neither build nor look up by name."""

NAMES = {name: getattr(rockflex, name) for name in sorted(rockflex.__all__) if not name.startswith("_")}
FINDER = doctest.DocTestFinder()
EXAMPLES = {
    test.name: test
    for name, thing in NAMES.items()
    for test in FINDER.find(thing, name, module=False, globs={})
    if test.examples
}  # fmt: skip
SECTION = re.compile(r"^(\w[\w ]*)\n-+$", re.MULTILINE)


def needs_an_example(name):
    thing = NAMES[name]
    if isinstance(thing, type) and issubclass(thing, BaseException):
        return False
    return name not in WITHOUT


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_prints_what_it_shows(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mpl.use("Agg")
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    report = io.StringIO()
    runner.run(EXAMPLES[name], out=report.write)
    plt.close("all")
    assert runner.failures == 0, report.getvalue()


def test_examples_have_78_columns():
    """So that the reference shows them whole beside its contents."""
    lines = [f"... {line}" for test in EXAMPLES.values() for each in test.examples for line in each.source.splitlines()]
    assert [line for line in lines if len(line) > 78] == []


@pytest.mark.parametrize("name", [name for name in NAMES if needs_an_example(name)])
def test_public_name_ends_with_an_example(name):
    sections = SECTION.findall(inspect.getdoc(NAMES[name]))
    assert sections[-1:] == ["Examples"], f"rockflex.{name} needs an Examples section, after its other sections"
    assert name in EXAMPLES
