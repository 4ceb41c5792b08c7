"""The command line: its entry, its help, its tables and its files."""

import functools
import json
import math
import os
import re
import signal
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex
from rockflex import InputError
from rockflex.cli import _console
from rockflex.cli import _output as output
from rockflex.cli._app import app
from rockflex.studies import progress


def contents(folder):
    return {path.name: path.read_text("utf-8") for path in sorted(folder.iterdir())}


def write(folder, files, *, force=False):
    with output.staged_output_folder(folder, {"versions": output.versions()}, force=force) as stage:
        for name, text in files.items():
            (stage / name).write_text(text)


def test_json_is_strict():
    @dataclass
    class Info:
        year: int

    document = {
        "nan": math.nan,
        "list": [np.float64("nan"), math.inf, -math.inf, 1.5],
        "array": np.array([[1.0, np.nan], [np.inf, 2.0]]),
        "scalars": (np.int64(3), np.bool_(True), np.float64(0.1)),
        "info": Info(1940),
        "path": Path("a"),
        1: "m²",
    }

    def refuse(token):
        pytest.fail(f"{token} is not JSON")

    text = output.to_json(document)
    assert text.isascii()
    assert json.loads(text, parse_constant=refuse) == {
        "nan": None,
        "list": [None, "inf", "-inf", 1.5],
        "array": [[1.0, None], ["inf", 2.0]],
        "scalars": [3, True, 0.1],
        "info": {"year": 1940},
        "path": "a",
        "1": "m²",
    }


def test_numbers_survive_json():
    values = np.random.default_rng(1).normal(size=100) * 10.0 ** np.arange(-50, 50)
    assert json.loads(output.to_json({"values": values}))["values"] == values.tolist()


def test_new_folder_gets_everything_and_a_summary(tmp_path):
    folder = tmp_path / "a" / "b"
    write(folder, {"x.csv": "1"})
    assert list(contents(folder)) == ["summary.json", "x.csv"]
    assert json.loads(contents(folder)["summary.json"])["files"] == ["x.csv", "summary.json"]
    assert list(folder.parent.iterdir()) == [folder]


def test_empty_folder_is_used(tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    write(folder, {"x.csv": "1"})
    assert list(contents(folder)) == ["summary.json", "x.csv"]


@pytest.mark.parametrize("exists", [False, True])
def test_nothing_is_left_of_a_failure(tmp_path, exists):
    folder = tmp_path / "out"
    if exists:
        write(folder, {"x.csv": "old"})
    before = contents(folder) if exists else None

    def fail():
        with output.staged_output_folder(folder, {}, force=True) as stage:
            (stage / "x.csv").write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert folder.exists() == exists
    assert (contents(folder) if exists else None) == before
    assert list(tmp_path.iterdir()) == ([folder] if exists else [])


def test_document_that_is_not_json_leaves_nothing(tmp_path):
    with pytest.raises(TypeError), output.staged_output_folder(tmp_path / "out", {"x": object()}, force=False) as stage:
        (stage / "x.csv").write_text("half")
    assert list(tmp_path.iterdir()) == []


def test_full_folder_is_refused_and_force_replaces_results_alone(tmp_path):
    folder = tmp_path / "out"
    write(folder, {"x.csv": "old", "y.csv": "old"})
    (folder / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match=r"The folder .*out is not empty\. Give another one, or --force to replace"):
        write(folder, {"x.csv": "new"})
    assert contents(folder)["x.csv"] == "old"
    write(folder, {"x.csv": "new"}, force=True)
    assert list(contents(folder)) == ["notes.txt", "summary.json", "x.csv"]
    assert contents(folder)["x.csv"] == "new"


@pytest.mark.parametrize(
    "summary", ["[", '{"files": ["notes.txt"]}', '{"versions": {"other": "1"}, "files": ["notes.txt"]}']
)
def test_summary_of_another_program_removes_nothing(tmp_path, summary):
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "summary.json").write_text(summary)
    write(tmp_path, {"x.csv": "new"}, force=True)
    assert list(contents(tmp_path)) == ["notes.txt", "summary.json", "x.csv"]


def test_summary_cannot_reach_out_of_its_folder(tmp_path):
    (tmp_path / "outside.csv").write_text("mine")
    folder = tmp_path / "out"
    write(folder, {"x.csv": "old"})
    document = {"versions": output.versions(), "files": ["../outside.csv", 3, "x.csv"]}
    (folder / "summary.json").write_text(json.dumps(document))
    write(folder, {"y.csv": "new"}, force=True)
    assert (tmp_path / "outside.csv").read_text() == "mine"
    assert list(contents(folder)) == ["summary.json", "y.csv"]


def test_where_results_cannot_go(tmp_path):
    file = tmp_path / "file"
    file.touch()
    with pytest.raises(InputError, match=r"--out .*file is a file\. Give a folder; it is created if it does not exist"):
        output.check_output_folder(file, force=True)
    with pytest.raises(InputError, match=r"--force was given without --out, to which it belongs\."):
        output.check_output_folder(None, force=True)
    with pytest.raises(InputError, match=r"Cannot write to .*file/out: .*\. Give a folder that can be written to\."):
        write(file / "out", {})


@pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX")
def test_new_folder_has_ordinary_permissions(tmp_path):
    plain = tmp_path / "plain"
    plain.mkdir()
    write(tmp_path / "out", {"x.csv": "1"})
    assert (tmp_path / "out").stat().st_mode == plain.stat().st_mode


def test_file_names():
    stems = output.output_file_stems(["FF-1-a", "a/b: c", "a/b? c", "A_b_c", "..", "Kōbe 1995"])
    assert stems == ["FF-1-a", "a_b_c", "a_b_c-2", "A_b_c-3", "motion", "Kōbe_1995"]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (None, "-"),
        (math.nan, "-"),
        (math.inf, "inf"),
        (0.0164760, "0.01648"),
        (-3.6108, "-3.611"),
        (31407.0, "31407"),
        (1.2e-5, "0.00001200"),
        (1.2e-6, "1.200e-06"),
        (2.0066e7, "2.007e+07"),
    ],
)
def test_numbers_in_tables(value, text):
    assert _console.number(value) == text


ROOT = Path(__file__).parents[2]
HEAVY = ("matplotlib", "numba", "numpy", "pandas", "scipy")


def python(*arguments, **variables):
    environment = {**os.environ, "COLUMNS": "80", **variables}
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, encoding="utf-8", env=environment, check=False
    )


HELPS = [
    ["--help"],
    ["run", "--help"],
    ["modes", "-h"],
    ["motion", "-h"],
    ["cloud", "-h"],
    ["figures", "-h"],
    ["reproduce", "-h"],
    ["--version"],
]


@pytest.mark.slow
@pytest.mark.parametrize("arguments", HELPS)
def test_help_imports_nothing_heavy(arguments):
    code = f"""
import sys
from rockflex.cli import main
sys.argv = ["rockflex", *{arguments!r}]
try:
    main()
except SystemExit as end:
    assert not end.code
print("\\nimported:", *[name for name in {HEAVY!r} if name in sys.modules])
"""
    done = python("-c", code)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "imported:"


def test_module_and_version():
    done = python("-m", "rockflex", "--version")
    assert done.stdout == f"rockflex {rockflex.__version__}\n"
    assert done.returncode == 0


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("sign", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
@pytest.mark.parametrize("exists", [True, False])
def test_a_command_that_is_ended_leaves_no_rubbish(tmp_path, sign, exists):
    target = tmp_path / "home" / "out"
    target.parent.mkdir()
    if exists:
        target.mkdir()
    program = (
        "import sys, time\nfrom rockflex.cli import _modes, main\n"
        "def wait(*_):\n    print('at work', flush=True)\n    time.sleep(60)\n"
        "import rockflex.plot._figures as figures\nfigures.save_figure = wait\n"
        "sys.argv = ['rockflex', 'modes', sys.argv[1], '--out', sys.argv[2]]\nmain()"
    )
    structure = str(ROOT / "examples" / "structure_1.toml")
    command = [sys.executable, "-c", program, structure, str(target)]
    heed = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # which background jobs of a shell ignore
    with subprocess.Popen(command, stdout=-1, stderr=-1, text=True, preexec_fn=heed) as process:
        assert process.stdout.readline() == "at work\n"
        process.send_signal(sign)
        stderr = process.communicate()[1]
    left = [path.name for path in target.parent.rglob(".rockflex-*")]
    if sign != signal.SIGKILL:
        assert process.returncode == 130
        assert stderr == "Stopped; nothing was written.\n"
        assert left == []
    else:
        assert len(left) == 1
    write(target, {"a.txt": "a"})  # an empty-looking folder is empty
    assert [path.name for path in target.parent.rglob(".rockflex-*")] == []
    assert sorted(contents(target)) == ["a.txt", "summary.json"]


def test_what_is_replaced_is_told(tmp_path, capsys):
    write(tmp_path, {"a.txt": "a", "b.txt": "b"})
    (tmp_path / "mine.txt").write_text("mine")
    assert capsys.readouterr().err == ""
    write(tmp_path, {"b.txt": "new", "mine.txt": "new"}, force=True)
    told = capsys.readouterr().err
    assert "Replaced the earlier results in" in told
    assert {"a.txt", "b.txt", "summary.json", "mine.txt"} <= set(re.split(r"[\s,]++", told))
    output.remove_earlier_output(tmp_path)
    assert "3 files, b.txt, mine.txt, summary.json" in capsys.readouterr().err


def test_a_file_that_is_replaced_is_told(tmp_path):
    assert output.written_remark(tmp_path / "a.html") == f"Written to {tmp_path / 'a.html'}"
    (tmp_path / "a.html").touch()
    assert "in place of an earlier file" in output.written_remark(tmp_path / "a.html")


def test_a_temporary_folder_of_a_command_at_work_stays(tmp_path):
    with output.staged_output_folder(tmp_path, {"versions": {}}, force=False):
        (at_work,) = tmp_path.iterdir()
        with pytest.raises(InputError, match="not empty"):
            write(tmp_path, {"a.txt": "a"})
        write(tmp_path, {"a.txt": "a"}, force=True)
        assert at_work.is_dir()
    other = tmp_path / ".rockflex-mine"
    other.mkdir()
    (other / "thesis.txt").touch()
    os.utime(other, (0.0, 0.0))
    write(tmp_path, {"a.txt": "a"}, force=True)
    assert (other / "thesis.txt").exists()


def test_entry_point_is_main():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert project["scripts"]["rockflex"] == "rockflex.__main__:main"


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ([], ["run", "modes", "motion", "Examples", "rockflex modes structure.toml", "Exit codes"]),
        (["run"], ["--free-vibration", "--strict", "Examples", "rockflex run structure.toml el-centro-1940"]),
        (["run"], ["--impact", "--restitution", "--yield-displacement", "(Eqs. 37-38)", "--friction 0.5"]),
        (["run"], ["2DOF-C-SI", "1DOF-fixed-BW", "rigid-C", "--initial-rotation"]),
        (["modes"], ["--modes", "--stiffness-ratio", "Examples", "rockflex modes structure.toml --modes 3 --json"]),
        (["ida"], ["--dask", "Examples", "rockflex ida study.toml --dry-run"]),
        (["motion"], ["--period", "Examples", "rockflex motion record.csv --units g --dt 0.01 --json"]),
    ],
)
def test_help_explains_and_gives_examples(command, words):
    result = CliRunner().invoke(app, [*command, "--help"], env={"COLUMNS": "100", "TERMINAL_WIDTH": "100"})
    assert result.exit_code == 0
    for word in words:
        assert word in result.stdout


@pytest.mark.slow
def test_input_error_is_one_paragraph_without_traceback():
    done = python("-m", "rockflex", "modes", "nowhere.toml")
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("Error: The structure file nowhere.toml does not exist (working directory: ")
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.slow
def test_piped_output_has_no_escape_codes_and_no_bar(tmp_path):
    done = python("-m", "rockflex", "run", str(ROOT / "examples/structure_1.toml"), "el-centro-1940")
    assert done.returncode == 0
    assert "\x1b" not in done.stdout + done.stderr
    assert all(line.startswith("Warning: ") for line in done.stderr.splitlines())
    assert "\r" not in done.stderr
    assert max(map(len, done.stdout.splitlines())) <= 80


@pytest.mark.slow
def test_terminal_without_greek_letters():
    done = python("-m", "rockflex", "modes", str(ROOT / "examples/structure_1.toml"), PYTHONIOENCODING="ascii")
    assert done.returncode == 0
    assert "Total mass with the base" in done.stdout
    assert done.stdout.isascii()


STUDY = """
study = "cloud"
name = "towers"
models = ["2DOF-S"]
scales = [0.5, 1.0]
runs_per_chunk = 4
records = {suites = ["fema-p695-far-field"], include = ["FF-1*"]}

[[structures]]
[structures.frame]
n_stories = 5
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = 1.0
aspect_ratio = 10
damping_ratio = 0.02
"""
LINE = re.compile(r"^(.*): (\d+) of (\d+) \(\d+ %\), [\d.]+ s elapsed(?:, about [\d.]+ s left)?(?:, [\d.]+ rows/s)?$")


@pytest.fixture
def study(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(STUDY, "utf-8")
    return file


@pytest.fixture
def impatient(monkeypatch):
    """Lines that wait for a tenth more, but not for half a minute."""
    monkeypatch.setattr(progress, "MIN_INTERVAL", 0.0)


def lines_of(*arguments: object) -> list[re.Match[str]]:
    """The lines of progress that a command writes to stderr."""
    done = CliRunner().invoke(app, [str(each) for each in arguments])
    assert done.exit_code == 0, done.output
    assert "\x1b" not in done.stderr
    assert not any(map(LINE.match, done.stdout.splitlines()))
    return list(filter(None, map(LINE.match, done.stderr.splitlines())))


def test_a_study_writes_a_line_for_each_tenth(study, tmp_path, impatient):
    lines = lines_of("cloud", study, "--out", tmp_path / "out")
    done = [int(line[2]) for line in lines]
    assert {line[1] for line in lines} == {"towers"}
    assert {int(line[3]) for line in lines} == {11}
    assert done == sorted(set(done))
    assert len(done) <= 11
    assert all(later - sooner > 1 for sooner, later in pairwise(done))
    assert "left" in lines[0][0]
    assert "rows/s" in lines[0][0]


def test_a_share_of_a_study_does_so_too(study, tmp_path, impatient):
    assert {int(line[3]) for line in lines_of("cloud", study, "--out", tmp_path / "out", "--share", "1/2")} == {6}


@pytest.mark.slow
def test_many_runs_do_so_too(impatient):
    lines = lines_of("run", ROOT / "examples" / "wall.toml", "fema-p695-far-field", "--model", "2DOF-S,MDOF-S")
    assert {(line[1], int(line[3])) for line in lines} == {("Simulating", 88)}


def test_what_is_short_writes_none(study, tmp_path):
    assert lines_of("cloud", study, "--out", tmp_path / "out") == []
