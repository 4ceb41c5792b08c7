"""Histories and tables of runs as files of MATLAB and NetCDF."""

import json
import sys

import numpy as np
import pandas as pd
import pytest
from scipy.io import loadmat
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app

FRAME = make_frame(n_stories=3, period=0.6, aspect_ratio=8.0)
PULSE = rf.ricker_pulse(4.0, 0.6)
LONG = "a demand whose name is too long for MATLAB, with blanks and a θ"
LARGE = 2**60 + 1  # which no double holds


@pytest.fixture(scope="module")
def response():
    return rf.simulate(rf.Restrained(FRAME, [rf.Tendon(1e5, 1e6)]), PULSE, "3DOF-S")


@pytest.fixture(scope="module")
def table():
    demands = {LONG + " 1": lambda run: run.max_rotation, LONG + " 2": lambda run: run.end_time, "end": lambda _: 1.0}
    runs = rf.run_cloud({"#1": FRAME}, PULSE, ["2DOF-S", "fixed"], scales=(0.1, 1.0), demands=demands)
    some = pd.array([True, None, False, True], dtype="boolean")
    return runs.assign(some=some, seed=[LARGE, 1, 2, 3], count=pd.array([1, None, 3, 4], dtype="Int64"))


def as_matlab(result, path, **options):
    """The variables of a file, in the orientation in which MATLAB has them; cell arrays as lists."""
    found = loadmat(rf.to_matlab(result, path, **options), chars_as_strings=True, squeeze_me=True)
    return {name: values for name, values in found.items() if not name.startswith("__")}


def told(found, what):
    """A struct as a dict of texts."""
    parts = {name: found[what][name].item() for name in found[what].dtype.names}
    return {name: text if isinstance(text, str) else "" for name, text in parts.items()}


def test_a_history_as_a_file_of_matlab(response, tmp_path):
    found = as_matlab(response, tmp_path / "new" / "run.mat")
    expected = response.to_frame(["rotation", "side", "uplifted"])
    np.testing.assert_array_equal(found["time"], response.time)
    for name in expected:
        np.testing.assert_array_equal(found[name], expected[name])
    np.testing.assert_array_equal(found["floor_acceleration"], response.floor_acceleration)
    assert str(found["model"]) == "3DOF-S"
    units, words = told(found, "units"), told(found, "descriptions")
    assert (units["time"], units["base_moment"], units["rotation_velocity"]) == ("s", "N m", "rad/s")
    assert words["heave"].startswith("rise of the base")
    assert set(units) == set(words) == set(found) - {"units", "descriptions", "names", "model"}
    assert all(np.size(found[name]) for name in units)


def test_equal_results_give_equal_files(response, tmp_path):
    one, other = (response.to_matlab(tmp_path / name).read_bytes() for name in ("a.mat", "b.mat"))
    assert one == other
    assert one.startswith(b"MATLAB 5.0 MAT-file")
    assert b"Created on" not in one[:116]  # the time, of which two quick runs see the same second


def test_chosen_quantities_of_instants(response, tmp_path):
    sampled = response.resample(0.05)
    found = as_matlab(sampled, tmp_path / "run.mat", quantities=["story_drift"])
    assert set(found) == {"time", "story_drift", "units", "descriptions", "names", "model"}
    np.testing.assert_array_equal(found["story_drift"], sampled.story_drift)


def check_table(table, get, valid):
    """Compare the columns of a file; `get` returns one by its name in the file."""
    for name, column in zip(valid, table, strict=True):
        values, given = get(name), table[column]
        if column == "seed" or pd.api.types.is_string_dtype(given.dtype) or given.dtype == "category":
            assert [str(each) for each in values] == ["" if pd.isna(each) else str(each) for each in given]
        else:
            np.testing.assert_array_equal(values, given.to_numpy(dtype=float, na_value=np.nan))


def test_a_table_as_a_file_of_matlab(table, tmp_path):
    found = as_matlab(table, tmp_path / "runs.mat")
    names, units, words = (told(found, what) for what in ("names", "units", "descriptions"))
    assert list(names.values()) == list(table)
    assert all(len(name) <= 63 and name.isascii() and name.isidentifier() for name in names)
    assert "end" not in names

    def get(name):
        texts = found[name].dtype == object
        return [each if isinstance(each, str) else "" for each in found[name]] if texts else found[name]

    check_table(table, get, names)
    assert (units["pga"], units["max_rotation"], units["structure"], units["max_top_displacement"]) == (
        "m/s2", "rad", "", "m"
    )  # fmt: skip
    assert words["pgv"] == "peak ground velocity"
    assert words["max_base_moment"].startswith("largest base moment")


def test_a_table_as_netcdf(table, tmp_path):
    xr = pytest.importorskip("xarray")
    with xr.open_dataset(rf.to_netcdf(table, tmp_path / "runs.nc")) as found:
        assert found.sizes["run"] == len(table)
        names = {values.attrs["column"]: name for name, values in found.items()}
        check_table(table, lambda name: found[name].values, [names[column] for column in table])
        assert found["max_rotation"].attrs["units"] == "rad"
        assert found["nominal_overturning"].dtype == bool


def test_a_history_as_netcdf(response, tmp_path):
    xr = pytest.importorskip("xarray")
    expected = response.to_xarray()
    with xr.open_dataset(response.to_netcdf(tmp_path / "run.nc")) as found:
        assert found.attrs["model"] == "3DOF-S"
        assert dict(found.sizes) == dict(expected.sizes)
        for name, values in expected.items():
            np.testing.assert_array_equal(found[name], values)
            assert found[name].attrs.get("units", "") == values.attrs.get("units", "")
            assert found[name].attrs["long_name"]
        np.testing.assert_array_equal(found["time"], response.time)
        assert list(found["edge"].values) == ["left", "right"]


def test_an_empty_table(table, tmp_path):
    assert as_matlab(table.iloc[:0], tmp_path / "runs.mat")["pga"].size == 0
    xr = pytest.importorskip("xarray")
    with xr.open_dataset(rf.to_netcdf(table.iloc[:0], tmp_path / "runs.nc")) as found:
        assert found.sizes["run"] == 0


def test_what_cannot_be_written_is_refused(response, table, tmp_path):
    with pytest.raises(rf.InputError, match=r"end in \.mat") as caught:
        rf.to_matlab(response, tmp_path / "run.csv")
    assert caught.value.field == "path"
    with pytest.raises(rf.InputError, match="int was given") as caught:
        rf.to_matlab(1, tmp_path / "run.mat")
    assert caught.value.field == "result"
    with pytest.raises(rf.InputError, match="keeps peaks only"):
        rf.to_matlab(rf.simulate(FRAME, PULSE, output="peaks"), tmp_path / "run.mat")
    for result in (response, table):
        with pytest.raises(rf.InputError, match="'angle' was given") as caught:
            rf.to_matlab(result, tmp_path / "run.mat", ["angle"])
        assert caught.value.field == "quantities"
    assert list(tmp_path.iterdir()) == []


def test_without_xarray_it_says_what_to_install(response, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(rf.InputError, match=r"to_netcdf needs xarray, .* or use to_matlab"):
        response.to_netcdf(tmp_path / "run.nc")


@pytest.mark.slow
@pytest.mark.parametrize("form", ["mat", "nc"])
def test_histories_of_the_command_line(form, tmp_path):
    if form == "nc":
        pytest.importorskip("xarray")
    table = {"n_stories": 2, "story_height": 3.0, "story_mass": 4e4, "base_mass": 4e4, "stiffness_ratio": 1.0}
    table |= {"period": 0.5, "aspect_ratio": 8.0, "damping_ratio": 0.02}
    file = tmp_path / "structure.toml"
    file.write_text("[frame]\n" + "".join(f"{name} = {value}\n" for name, value in table.items()))
    out = tmp_path / "out"
    asked = ["run", str(file), "el-centro-1940", "--model", "2DOF-S,fixed", "--out", str(out), "--format", form]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    written = sorted(path.name for path in out.glob(f"*.{form}"))
    assert len(written) == 2
    assert all(name.endswith((f"-2DOF-S.{form}", f"-fixed.{form}")) for name in written)
    assert json.loads((out / "summary.json").read_text())["units"]["max_top_displacement"] == "m"
    assert not list(out.glob("history*.csv"))
