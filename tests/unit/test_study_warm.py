"""Compilation ahead of need, and the notice that a first run compiles."""

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rockflex as rf
from rockflex import _kernel, study
from rockflex._kernel import KERNELS, Notice
from rockflex.cli import app
from rockflex.cli._console import steps
from rockflex.study._warm import STEPS, Warmth


@pytest.fixture
def notice(monkeypatch):
    fresh = Notice()
    monkeypatch.setattr("rockflex.study._warm.notice", fresh)
    return fresh


def test_everything_that_simulations_call_is_compiled_once(notice):
    rf.warm()
    assert not notice.told
    assert [kernel.__name__ for kernel in KERNELS if not kernel.overloads] == []
    told: list[str] = []
    again = rf.warm(told.append)
    assert told == list(STEPS)
    assert notice.told  # by the caller
    assert again.compiled == 0
    assert again.duration > 0.0
    assert again.folder is not None
    assert all(Path(kernel.stats.cache_path).is_relative_to(again.folder) for kernel in KERNELS)


class Terminal:
    def __init__(self, *, is_one):
        self.is_one, self.lines = is_one, []

    def isatty(self):
        return self.is_one

    def write(self, text):
        self.lines.append(text)

    def flush(self):
        pass


@pytest.mark.parametrize(
    ("is_terminal", "in_notebook", "said"), [(True, False, True), (False, False, False), (False, True, True)]
)
def test_a_person_is_told_once_that_kernels_are_compiled(monkeypatch, is_terminal, in_notebook, said):
    stream, tells = Terminal(is_one=is_terminal), Notice()
    monkeypatch.setattr(sys, "stderr", stream)
    if in_notebook:
        monkeypatch.setitem(sys.modules, "ipykernel", sys)
    tells(object())  # a kernel of somebody else
    assert not tells.told
    tells(KERNELS[0])
    tells(KERNELS[-1])
    assert "".join(stream.lines) == (f"{_kernel.NOTICE}\n" if said else "")


def test_a_process_without_stderr_is_told_nothing(monkeypatch):
    monkeypatch.setattr(sys, "stderr", None)
    Notice()(KERNELS[0])


@pytest.mark.parametrize(
    ("done", "message"),
    [
        (Warmth(5, 31.4, Path("/somewhere")), "5 kernels compiled in 31 s, kept under /somewhere."),
        (Warmth(0, 0.4, Path("/somewhere")), "All kernels are compiled already, under /somewhere."),
        (
            Warmth(5, 31.4, None),
            "The compiled kernels cannot be kept, because no folder can be written. Set NUMBA_CACHE_DIR to one.",
        ),
    ],
)
def test_the_command_says_what_it_did(monkeypatch, done, message):
    monkeypatch.setattr(study, "warm", lambda _: done)
    result = CliRunner().invoke(app, ["warm"])
    assert result.exit_code == 0
    assert result.stdout == ""
    assert result.stderr == f"{message}\n"


def test_a_terminal_shows_the_present_step(monkeypatch, capsys):
    monkeypatch.setenv("FORCE_COLOR", "1")
    with steps("Compiling") as show:
        for name in STEPS:
            show(name)
    assert "Compiling simplified models" in capsys.readouterr().err
    monkeypatch.delenv("FORCE_COLOR")
    with steps("Compiling") as show:
        show("simplified models")
    assert capsys.readouterr().err == ""
