"""``rockflex reproduce``: targets, records of one's own, files and refusals."""

import json
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from page import check_page
from rockflex.cli import _kept_work, _reproduce, _reproduction
from rockflex.cli._app import app
from rockflex.cli._kept_work import KeptWork
from rockflex.cli._reproduction import Done, Job, planned_jobs
from rockflex.papers.silva_stojadinovic_2024 import _section_3_3
from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords
from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS, finish_target, reproduce_targets, target_pieces
from rockflex.report._document import PublicationReport
from rockflex.report._publication_files import report_numbers_to_csv


def invoke(*arguments):
    return CliRunner().invoke(app, ["reproduce", *map(str, arguments)], env={"COLUMNS": "120"})


@pytest.fixture(scope="module")
def at2(tmp_path_factory):
    """Eight components of the embedded records as AT2 files."""
    folder = tmp_path_factory.mktemp("peer")
    for motion in list(rf.load_suite("fema-p695-far-field"))[:16:2]:
        in_g = motion.acceleration / 9.81
        lines = [" ".join(f"{value:15.7E}" for value in in_g[i : i + 5]) for i in range(0, in_g.size, 5)]
        head = f"PEER\n{motion.name}, 1/1/2000, Station {motion.name}, 0\nACCELERATION IN UNITS OF G\n"
        text = f"{head}NPTS={in_g.size}, DT={motion.dt:.6f} SEC\n" + "\n".join(lines) + "\n"
        (folder / f"{motion.name}.AT2").write_text(text)
    return folder


def test_list_names_every_target():
    done = invoke("--list")
    assert done.exit_code == 0
    assert [line.split()[0] for line in done.stdout.splitlines()] == list(TARGETS)
    assert "Chimney under El Centro times 2" in done.stdout


def test_targets_alone_with_counts_in_the_order_of_the_paper():
    done = invoke("figure-15", "table-3")
    assert done.exit_code == 0
    counts = done.stdout[done.stdout.index("does not reproduce", done.stdout.rindex("target")) :]
    assert counts.index("table-3") < counts.index("figure-15")
    assert "figure-3" not in done.stdout
    assert "141.6332" in done.stdout
    last = done.stdout.splitlines()[-1].split()
    assert last == ["all", "38", "0", "0", "0", "0", "0", "0", "8"]
    assert "72 components of FEMA P-695" in done.stderr


@pytest.mark.parametrize(
    ("target", "hint"),
    [
        ("tabel-3", "The nearest are table-3"),
        ("Figure 15", "The nearest are figure-15"),
        ("fig_9", "figure-9"),
        ("quux", "There are figure-3, figure-4"),
    ],
)
def test_unknown_targets_are_refused_with_close_matches(target, hint):
    done = invoke("table-1", target)
    assert done.exit_code == 2
    assert f"There is no target {target!r}." in done.stderr
    assert hint in done.stderr
    assert "rockflex reproduce --list names all" in done.stderr
    assert done.stdout == ""


def test_files_of_a_target(tmp_path):
    out = tmp_path / "paper"
    done = invoke("figure-15", "table-1", "--out", out)
    assert done.exit_code == 0, done.stderr
    assert f"open {out / 'report.html'}" in done.stderr.replace("\n", "")
    names = {file.name for file in out.iterdir()}
    assert names == {"report.html", "report.md", "numbers.csv", "figure-15.svg", "summary.json", "kept"}
    check_page((out / "report.html").read_text("utf-8"), 1)
    summary = json.loads((out / "summary.json").read_text("utf-8"))
    assert summary["targets"] == ["table-1", "figure-15"]
    assert summary["missing"] == []
    assert summary["numbers"]["does not reproduce"] == 1
    assert summary["checks"].startswith("0 of 0 checks")


def csv_rows(out):
    return (out / "numbers.csv").read_text("utf-8")


@pytest.fixture
def computed(monkeypatch):
    """Names of the targets that are computed; Ctrl-C arrives before those in `stopped`."""
    names, stopped = [], []

    def kept(name, *given, **how):
        if name in stopped:
            raise KeyboardInterrupt
        names.append(name)
        return finish_target(name, *given, **how)

    monkeypatch.setattr(_reproduction, "finish_target", kept)
    return SimpleNamespace(names=names, stopped=stopped)


FEW = ("figure-12", "table-1", "table-2", "figure-11")


@pytest.mark.slow
def test_what_is_done_is_kept_and_not_computed_again(tmp_path, computed):
    out, whole = tmp_path / "paper", tmp_path / "whole"
    computed.stopped.append("figure-11")
    done = invoke(*FEW, "--out", out)
    assert done.exit_code == 130
    first = list(computed.names)
    assert first == ["table-1", "table-2", "figure-12"]  # the quick ones first
    assert "3 of 4 targets" in done.stderr
    assert str(out) in done.stderr.replace("\n", "")
    assert json.loads((out / "summary.json").read_text("utf-8"))["missing"] == ["figure-11"]
    check_page((out / "report.html").read_text("utf-8"), 1)
    assert "figure-11" in (out / "report.md").read_text("utf-8")
    assert not (out / "figure-11.svg").exists()
    (out / "figure-12.svg").unlink()

    computed.stopped.clear()
    assert invoke(*FEW, "--out", out).exit_code == 0
    assert computed.names == [*first, "figure-11"]
    assert invoke(*FEW, "--out", whole).exit_code == 0
    for name in ("numbers.csv", "report.md", "figure-11.svg", "figure-12.svg"):
        assert (out / name).read_bytes() == (whole / name).read_bytes(), name

    computed.names.clear()
    assert invoke(*FEW, "--out", out).exit_code == 0
    assert computed.names == []
    assert invoke("table-1", "--out", out, "--force").exit_code == 0
    assert computed.names == ["table-1"]
    assert not (out / "figure-11.svg").exists()


def test_targets_are_added_to_a_folder(tmp_path):
    out = tmp_path / "paper"
    assert invoke("table-2", "--out", out).exit_code == 0
    assert invoke("table-1", "--out", out).exit_code == 0
    assert json.loads((out / "summary.json").read_text("utf-8"))["targets"] == ["table-1", "table-2"]


def test_a_damaged_part_is_computed_again(tmp_path, computed):
    out = tmp_path / "paper"
    assert invoke("table-1", "table-2", "--out", out).exit_code == 0
    before = csv_rows(out)
    part = out / "kept" / "results" / "parts" / f"part-{TARGETS.index('table-1'):05d}.parquet"
    part.write_bytes(part.read_bytes()[:-100])
    computed.names.clear()
    assert invoke("table-1", "table-2", "--out", out).exit_code == 0
    assert computed.names == ["table-1"]
    assert csv_rows(out) == before


def test_nothing_is_kept_without_a_folder(computed):
    computed.stopped.append("table-2")
    done = invoke("table-1", "table-2")
    assert done.exit_code == 130
    assert "--out" in done.stderr
    assert "table-1: Parameters" in done.stdout  # it was printed before


def refused(*arguments):
    done = invoke(*arguments)
    assert done.exit_code == 2
    return " ".join(done.stderr.split())


def test_another_reproduction_in_the_folder_is_refused(tmp_path, at2, monkeypatch):
    out = tmp_path / "paper"
    assert invoke("table-1", "--out", out).exit_code == 0
    before = csv_rows(out)
    text = refused("table-1", "--out", out, "--seeds", 12)
    assert "seeds: 20 in the folder, 12 now" in text
    assert "--force" in text
    assert "records" in refused("table-1", "--out", out, "--records", at2)
    monkeypatch.setattr(_kept_work, "_versions", lambda: {"rockflex": "0.0.1"})
    assert "0.0.1" in refused("table-1", "--out", out)
    assert csv_rows(out) == before
    assert invoke("table-1", "--out", out, "--force").exit_code == 0
    assert invoke("table-1", "--out", out).exit_code == 0


def test_a_folder_of_other_things_is_refused(tmp_path):
    (tmp_path / "thesis.tex").write_text("x")
    assert "is not empty" in refused("table-1", "--out", tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["thesis.tex"]
    assert "is a file" in refused("table-1", "--out", tmp_path / "thesis.tex")
    assert invoke("table-1", "--out", tmp_path, "--force").exit_code == 0
    assert (tmp_path / "thesis.tex").read_text() == "x"


def test_an_unknown_target_touches_nothing(tmp_path):
    out = tmp_path / "paper"
    assert invoke("table-1", "--out", out).exit_code == 0
    before = csv_rows(out)
    assert "no target 'tabel'" in refused("tabel", "--out", out, "--force")
    assert csv_rows(out) == before


def test_a_folder_in_use_is_refused(tmp_path):
    out = tmp_path / "paper"
    with KeptWork(out, PaperRecords()):
        for more in ([], ["--force"]):
            text = refused("table-1", "--out", out, *more)
            assert "in use by process" in text


def test_jobs_are_planned_once_and_quick_targets_first():
    records = PaperRecords(seeds=10)
    jobs = planned_jobs(TARGETS, records)
    titles = [job.title for job in jobs]
    assert len(set(titles)) == len(titles) == len(TARGETS) + 2 * 10 + 10 + 6 + 2 + 6
    for target in TARGETS:
        assert all(titles.index(piece.name) < titles.index(target) for piece in target_pieces(target, records))
    targets = [job.target for job in jobs if job.piece is None]
    assert targets[0] in ("table-1", "table-2")
    assert set(targets[-2:]) == {"figure-9", "figure-13"}
    # A table that is there is no job.
    records.tables[target_pieces("figure-8", records)[0].name] = pd.DataFrame()
    assert planned_jobs(["figure-8"], records)[0].piece is None
    assert len(planned_jobs(["figure-9"], records)) == 20


def test_the_time_left_follows_the_cost_of_the_jobs(monkeypatch):
    now = iter([10.0, 40.0, 100.0])
    monkeypatch.setattr(_reproduce, "perf_counter", lambda: next(now))
    progress = _reproduce._JobProgress(100.0, lambda *_: None)
    # Nothing is told of the first job, before which processes start.
    for cost, text in (
        (10.0, "10 % done"),
        (10.0, "20 % done, about 4 min left"),
        (30.0, "50 % done, about 2 min left"),
    ):
        job = Job("figure-9", cost)
        progress.add(Done(job, 3.0))
        assert progress.line(Done(job, 3.0)) == f"figure-9: 3.0 s; {text}"


POPULATIONS = {"figure-8", "figure-9"}
PROGRAM = f"""
import sys
from pathlib import Path

import typer

from rockflex.cli import _reproduce, _reproduction
from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords

_reproduction.ENOUGH_FOR_PROCESSES = 0.0
if __name__ == "__main__":
    try:
        _reproduce._reproduce_targets({POPULATIONS}, PaperRecords(seeds=10, pairs=15), Path(sys.argv[1]))
    except typer.Exit as stop:
        sys.exit(stop.exit_code)
"""


@pytest.fixture(scope="module")
def in_one_go():
    """The table of the numbers of the same targets, computed here."""
    records = PaperRecords(seeds=10, pairs=15)
    results = [finish_target(name, records, whole=False) for name in sorted(POPULATIONS)]
    return report_numbers_to_csv(PublicationReport("", "", "", {}, {}, {}, results))


@pytest.mark.slow
@pytest.mark.parametrize("signal_name", ["SIGINT", "SIGKILL"])
def test_a_killed_reproduction_goes_on(tmp_path, signal_name, in_one_go):
    """Populations in several processes: what was done is read, not computed, and the numbers are those of one go."""
    out, program = tmp_path / "paper", tmp_path / "program.py"
    program.write_text(PROGRAM)
    with subprocess.Popen([sys.executable, program, out], stderr=subprocess.PIPE, text=True) as running:
        parts = out / "kept" / "population" / "parts"
        while len(list(parts.glob("*.parquet"))) < 2:
            assert running.poll() is None, running.stderr.read()
            time.sleep(0.02)
        running.send_signal(getattr(signal, signal_name))
        told = running.communicate(timeout=30)[1]
    if signal_name == "SIGINT":
        assert running.returncode == 130
        assert "targets are in" in told
        assert "Traceback" not in told
    before = {part.name: part.stat().st_mtime_ns for part in parts.glob("*.parquet")}
    assert 2 <= len(before) < 20
    _reproduce._reproduce_targets(POPULATIONS, PaperRecords(seeds=10, pairs=15), out)
    assert len(list(parts.glob("*.parquet"))) == 20
    assert {name: (parts / name).stat().st_mtime_ns for name in before} == before
    assert csv_rows(out) == in_one_go


@pytest.mark.parametrize("seeds", [9, 0, -3])
def test_too_few_seeds_are_refused(seeds):
    done = invoke("figure-9", "--seeds", seeds)
    assert done.exit_code == 2
    assert f"seeds must be a whole number of at least 10, but {seeds} was given" in done.stderr.replace("\n", " ")


def test_a_negative_seed_is_refused():
    done = invoke("figure-9", "--seed", -1)
    assert done.exit_code == 2
    assert "seed must be a whole number of at least 0, but -1 was given" in done.stderr.replace("\n", " ")


def test_populations_have_the_given_seeds(at2):
    records = PaperRecords(at2, 10, seed=7, pairs=3)
    pairs = _section_3_3.population_pool(records)
    for place in (0, 9):
        alone = rf.run_population(records.suite, 3, 7 + place).reset_index(drop=True)
        pd.testing.assert_frame_equal(pairs.iloc[3 * place : 3 * place + 3].reset_index(drop=True), alone)


def test_the_seed_reaches_the_records(monkeypatch):
    given = []

    def kept(*arguments, **named):
        given.append((arguments, named))
        raise rf.InputError("enough")

    monkeypatch.setattr("rockflex.papers.silva_stojadinovic_2024._inputs.PaperRecords", kept)
    assert invoke("figure-9", "--seed", 5, "--seeds", 12).exit_code == 2
    assert invoke("figure-9").exit_code == 2
    assert given == [((None, 12, 5), {}), ((None, 20, 2024), {})]


def test_checks_are_printed_and_not_counted():
    done = invoke("table-2", "figure-11")
    assert done.exit_code == 0
    assert "check of ourselves" in done.stdout
    assert done.stdout.splitlines()[-1].split() == ["all", *["0"] * 8]


def test_force_needs_a_folder():
    done = invoke("table-1", "--force")
    assert done.exit_code == 2
    assert "--force was given without --out" in done.stderr


@pytest.mark.slow
def test_records_of_ones_own(at2):
    done = invoke("figure-6", "--records", at2)
    assert done.exit_code == 0, done.stderr
    assert f"8 records of the folder {at2.name}, in place of the paper's 210" in done.stderr
    records = PaperRecords(at2)
    assert set(records.suite.names) == set(rf.load_suite("fema-p695-far-field")[:16].names[::2])
    assert records.el_centro.name == rf.load_suite("el-centro-1940")[0].name
    (drawn,) = reproduce_targets(["figure-8"], PaperRecords(at2, seeds=10, pairs=30))
    assert drawn.numbers == ()
    assert [check.holds for check in drawn.checks] == [True] * 10


def test_a_folder_without_records_is_refused(tmp_path):
    done = invoke("figure-6", "--records", tmp_path)
    assert done.exit_code == 2
    assert "holds no record" in done.stderr
    missing = invoke("figure-6", "--records", tmp_path / "none")
    assert missing.exit_code == 2
    assert "is not a directory" in missing.stderr


def test_too_few_records_name_the_target(at2, tmp_path):
    one = tmp_path / "one"
    one.mkdir()
    file = next(iter(sorted(at2.iterdir())))
    (one / file.name).write_bytes(file.read_bytes())
    with pytest.raises(rf.InputError, match=r"^figure-6: "):
        reproduce_targets(["figure-6"], PaperRecords(one))


def test_figures_are_drawn_when_asked_for_only(monkeypatch):
    drawn = []
    monkeypatch.setattr(rf, "plot_tower", lambda *_: drawn.append(1))
    (result,) = reproduce_targets(["figure-14"])
    assert drawn == []
    result.figures["figure-14"]()
    assert drawn == [1]


def test_progress_and_an_empty_list():
    done = []
    results = reproduce_targets(["figure-14", "table-1", "table-1"], progress=done.append)
    assert done == [result.name for result in results] == ["table-1", "figure-14"]
