"""Files that calls write: refusals of the system, links, and texts that a spreadsheet would take for formulas."""

import csv
import io
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app
from rockflex.foundation.csv import table_as_csv
from rockflex.structure.file._structure_file import read_toml_file

PULSE = rf.ricker_pulse(4.0, 0.6)


@pytest.fixture(scope="module")
def response():
    return rf.simulate(make_frame(), PULSE, "2DOF-S", output="history")


def writers(response):
    return {
        ".npz": response.save,
        ".mat": response.history.to_matlab,
        ".svg": lambda path: rf.save_figure(rf.plot_motion(PULSE), path),
        ".html": lambda path: rf.write_report(response, path),
    }


@pytest.mark.parametrize("suffix", [".npz", ".mat", ".svg", ".html"])
def test_a_refusal_of_the_system_is_an_input_error(suffix, response, tmp_path, monkeypatch):
    write = writers(response)[suffix]
    (tmp_path / "file").touch()
    (tmp_path / f"folder{suffix}").mkdir()
    (tmp_path / f"circle{suffix}").symlink_to(tmp_path / f"circle{suffix}")
    for path in (tmp_path / "file" / f"a{suffix}", tmp_path / f"folder{suffix}", tmp_path / f"circle{suffix}"):
        with pytest.raises(rf.InputError) as error:
            write(path)
        assert error.value.field == "path"

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(rf.InputError, match="No space left on device"):
        write(tmp_path / f"a{suffix}")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["file", f"folder{suffix}", f"circle{suffix}"])


@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
@pytest.mark.parametrize("suffix", [".npz", ".mat", ".svg", ".html"])
@pytest.mark.parametrize("there", [True, False])
def test_a_link_stays_and_its_file_is_replaced(suffix, there, response, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    target, link = tmp_path / "elsewhere" / f"target{suffix}", tmp_path / f"link{suffix}"
    if there:
        target.write_text("old")
    link.symlink_to(Path("elsewhere", target.name))
    writers(response)[suffix](link)
    assert link.is_symlink()
    assert target.stat().st_size > 100


WRITES = """
import os, sys, time
from pathlib import Path
from rockflex.foundation.files import writing_atomically

with writing_atomically(Path(sys.argv[1])) as temporary:
    temporary.write_text("half")
    print("at work", flush=True)
    time.sleep(600)
"""


def test_what_a_killed_process_left_goes_and_that_of_a_living_one_stays(tmp_path):
    if os.name == "nt":
        pytest.skip("whether a process runs cannot be asked there")
    target, other = tmp_path / "a[1].svg", tmp_path / "a[1].svg.svg"
    running = [
        subprocess.Popen([sys.executable, "-c", WRITES, str(path)], stdout=subprocess.PIPE, text=True)
        for path in (target, target, other)
    ]
    try:
        for each in running:
            assert each.stdout.readline() == "at work\n"
        for each in (running[0], running[2]):
            each.kill()
            each.wait()
        rf.save_figure(rf.plot_motion(PULSE), target)
        left = sorted(path.name for path in tmp_path.iterdir())
        assert len(left) == 3
        assert left[0].startswith(f".{target.name}.{running[1].pid}-")
        assert left[1].startswith(f".{other.name}.{running[2].pid}-")  # of another file
        assert left[2] == target.name
    finally:
        for each in running:
            each.kill()
            each.communicate()


@pytest.mark.parametrize("read", [rf.read_structure, rf.load_study, lambda path: read_toml_file(path, "limits")])
def test_a_null_character_in_a_path_is_an_input_error(read):
    with pytest.raises(rf.InputError, match="null"):
        read(Path("a\0.toml"))


HOSTILE = ("=1+1", "+1+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "\r=1")


@pytest.mark.parametrize("categories", [False, True])
def test_texts_that_look_like_formulas_are_guarded(categories):
    names = pd.Series([*HOSTILE, "plain", "-0.5", None])
    table = pd.DataFrame({"=name": names.astype("category") if categories else names, "value": np.arange(9.0) - 4.0})
    rows = list(csv.reader(io.StringIO(table_as_csv(table))))
    assert rows[0] == ["'=name", "value"]
    assert [row[0] for row in rows[1:]] == [*(f"'{name}".replace("\r", " ") for name in HOSTILE), "plain", "-0.5", ""]
    assert [float(row[1]) for row in rows[1:]] == [*(np.arange(9.0) - 4.0)]  # numbers are no formulas


def test_other_tables_keep_their_bytes():
    table = pd.DataFrame({"a": ["x", "y"], "b": [1.5, -2.0], "c": [1, -2], "d": [True, False]})
    table["e"] = pd.array([1, None], dtype="Int64")
    assert table_as_csv(table) == table.to_csv(index=False, lineterminator="\n")


@pytest.mark.parametrize("command", ["motion", "run"])
def test_a_record_named_like_a_formula_is_no_formula_in_files(command, tmp_path):
    record = tmp_path / "=1+1.csv"
    record.write_text("time,acceleration\n" + "".join(f"{0.01 * k},{np.sin(0.1 * k)}\n" for k in range(300)))
    structure = Path(__file__).parents[2] / "examples" / "structure_1.toml"
    arguments = [str(structure)] * (command == "run") + [str(record), "--units", "m/s2", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, [command, *arguments])
    assert done.exit_code == 0, done.output
    text = (tmp_path / "out" / {"motion": "motions.csv", "run": "results.csv"}[command]).read_text()
    cells = [cell for row in csv.reader(io.StringIO(text)) for cell in row]
    assert "'=1+1" in cells
    assert not [cell for cell in cells if cell.startswith("=")]
