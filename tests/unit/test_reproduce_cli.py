"""``rockflex reproduce``: targets, records of one's own, files and refusals."""

import json

import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from page import check_page
from rockflex.cli import app
from rockflex.papers.silva_stojadinovic_2024 import TARGETS, PaperRecords, _section_3_3, reproduce_targets


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


def test_targets_alone_in_the_order_of_the_paper():
    done = invoke("figure-15", "table-3")
    assert done.exit_code == 0
    assert done.stdout.index("table-3: Modes") < done.stdout.index("figure-15: Chimney")
    assert "figure-3" not in done.stdout
    assert "141.6332" in done.stdout
    last = done.stdout.splitlines()[-1].split()
    assert last == ["all", "38", "0", "0", "0", "0", "8"]
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
    assert names == {"report.html", "report.md", "numbers.csv", "figure-15.svg", "summary.json"}
    check_page((out / "report.html").read_text("utf-8"), 1)
    summary = json.loads((out / "summary.json").read_text("utf-8"))
    assert summary["targets"] == ["table-1", "figure-15"]
    assert summary["numbers"]["does not reproduce"] == 1
    assert summary["checks"].startswith("0 of 0 checks")
    again = invoke("table-1", "--out", out)
    assert again.exit_code == 2
    assert "is not empty" in again.stderr
    assert invoke("table-1", "--out", out, "--force").exit_code == 0
    assert not (out / "figure-15.svg").exists()


@pytest.mark.parametrize("seeds", [9, 0, -3])
def test_too_few_seeds_are_refused(seeds):
    done = invoke("figure-9", "--seeds", seeds)
    assert done.exit_code == 2
    assert f"seeds must be a whole number of at least 10, but {seeds} was given" in done.stderr.replace("\n", " ")


def test_a_negative_seed_is_refused():
    done = invoke("figure-9", "--seed", -1)
    assert done.exit_code == 2
    assert "seed must be a whole number of at least 0, but -1 was given" in done.stderr.replace("\n", " ")


def test_populations_have_the_given_seeds(at2, monkeypatch):
    monkeypatch.setattr(_section_3_3, "PAIRS", 3)
    records = PaperRecords(at2, 10, seed=7)
    pairs = _section_3_3.population_pool(records)
    for place in (0, 9):
        alone = rf.run_population(records.suite, 3, 7 + place).reset_index(drop=True)
        pd.testing.assert_frame_equal(pairs.iloc[3 * place : 3 * place + 3].reset_index(drop=True), alone)


def test_the_seed_reaches_the_records(monkeypatch):
    given = []

    def kept(*arguments, **named):
        given.append((arguments, named))
        raise rf.InputError("enough")

    monkeypatch.setattr("rockflex.papers.silva_stojadinovic_2024.PaperRecords", kept)
    assert invoke("figure-9", "--seed", 5, "--seeds", 12).exit_code == 2
    assert invoke("figure-9").exit_code == 2
    assert given == [((None,), {"seeds": 12, "seed": 5}), ((None,), {})]


def test_checks_are_printed_and_not_counted():
    done = invoke("table-2", "figure-11")
    assert done.exit_code == 0
    assert "check of ourselves" in done.stdout
    assert done.stdout.splitlines()[-1].split() == ["all", "0", "0", "0", "0", "0", "0"]


def test_force_needs_a_folder():
    done = invoke("table-1", "--force")
    assert done.exit_code == 2
    assert "--force was given without --out" in done.stderr


def test_records_of_ones_own(at2, monkeypatch):
    monkeypatch.setattr(_section_3_3, "PAIRS", 30)
    done = invoke("figure-6", "--records", at2)
    assert done.exit_code == 0, done.stderr
    assert f"8 records of the folder {at2.name}, in place of the paper's 210" in done.stderr
    records = PaperRecords(at2)
    assert set(records.suite.names) == set(rf.load_suite("fema-p695-far-field")[:16].names[::2])
    assert records.el_centro.name == rf.load_suite("el-centro-1940")[0].name
    (drawn,) = reproduce_targets(["figure-8"], PaperRecords(at2, seeds=10))
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
