"""The registry of the kinds of study: each record is complete, and reading it costs nothing."""

import subprocess
import sys

import pytest

import rockflex as rf
from rockflex.kinds import KINDS, Findings, kind_named
from rockflex.study.plan import Spec


@pytest.mark.parametrize("name", KINDS)
def test_a_record_describes_its_kind(name):
    kind = KINDS[name]
    spec = kind.spec()
    assert issubclass(spec, Spec)
    assert (kind.name, spec.model_fields["study"].default) == (name, name)
    assert kind.summary.endswith(".")


def test_commands_differ():
    assert len({kind.command for kind in KINDS.values()}) == len(KINDS)


def test_the_page_shows_kinds_of_the_registry():
    from rockflex.web._studies import PAGES

    assert PAGES.keys() <= KINDS.keys()


def test_an_unknown_kind():
    with pytest.raises(rf.InputError) as caught:
        kind_named("clod")
    assert str(caught.value) == (
        'study must be one of "cloud", "incremental", "stripes", "population", "monte_carlo", "design", but '
        "'clod' was given. Did you mean \"cloud\"?"
    )


def test_a_fit_that_fails_is_named():
    found = Findings()

    def fit():
        raise rf.InputError("No run rocks.")

    assert found.fitted(lambda: 1.0, "A") == 1.0
    assert found.fitted(fit, "B") is None
    assert found.unfitted == ["B: No run rocks."]


def test_the_registry_loads_no_heavy_library():
    heavy = {"numpy", "scipy", "numba", "pydantic", "pandas", "matplotlib", "pyarrow"}
    program = f"import sys; from rockflex.kinds import KINDS; print(len(KINDS), *({heavy!r} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["6"]
