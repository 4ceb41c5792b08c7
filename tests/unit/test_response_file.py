"""Responses on disk."""

import contextlib
import gc
import json
import math
import warnings

import numpy as np
import pytest

from builders import make_frame
from rockflex import (
    Eccentric,
    GroundMotion,
    InputError,
    Response,
    Restitution,
    RockingProperties,
    load_suite,
    simulate,
)
from rockflex.models import SidedRestitution

MOTION = GroundMotion(load_suite("el-centro-1940")[0].acceleration[:150] * 3.0, 0.02, name="El Centro, début")
FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)


def bare():
    p = FRAME.rocking()
    return RockingProperties(
        p.omega,
        p.effective_mass,
        p.effective_height,
        p.top_ordinate,
        p.i_theta,
        p.l0r,
        p.m_tot,
        p.half_width,
        p.zeta,
    )


def known(run):
    """All scalars, without those that cannot be known."""
    return {name: value for name, value in run.peaks().items() if value == value}


@pytest.mark.parametrize("structure", [FRAME, bare()], ids=["floors", "no floors"])
@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-S", "fixed"])
@pytest.mark.parametrize("output", ["history", "peaks"])
def test_what_is_saved_comes_back(tmp_path, structure, model, output):
    run = simulate(structure, MOTION, model, output=output)
    path = run.save(tmp_path / "run")
    assert path == tmp_path / "run.npz"
    assert list(tmp_path.iterdir()) == [path]
    back = Response.load(str(path))
    assert known(back) == known(run)
    assert math.isnan(run.max_total_top_displacement) == (structure is not FRAME)
    assert {name: type(value) for name, value in back.peaks().items()} == {
        name: type(value) for name, value in run.peaks().items()
    }
    assert (back.history is None) == (run.history is None)
    assert (back.floors is None) == (run.floors is None)
    if run.floors is not None:
        for name in ("story_drift", "story_shear", "floor_acceleration", "total_floor_displacement"):
            assert np.array_equal(getattr(back.floors, name), getattr(run.floors, name))
    if output == "history":
        assert np.array_equal(back.history.states, run.history.states)
        for name in ("time", "rotation", "base_moment", "top_displacement", "impact_times"):
            assert np.array_equal(getattr(back, name), getattr(run, name))
        assert back.energy.closing_error == run.energy.closing_error
        assert back.history.model.label == model
        one, other = back.history.model, run.history.model
        assert np.array_equal(*(each.overturning_moment(each.start(0)) for each in (one, other)))
        assert np.array_equal(one.accelerations(one.start(0)), other.accelerations(other.start(0)))
        if run.floors is not None:
            assert np.array_equal(back.floor_acceleration, run.floor_acceleration)


def test_a_law_with_a_restitution_to_each_side_comes_back(tmp_path):
    law = SidedRestitution(Restitution(0.4, 2e-3), Restitution(0.55, 1e-3))
    run = simulate(FRAME, MOTION, "2DOF-S", impact=law)
    assert run.n_impacts > 0
    back = Response.load(run.save(tmp_path / "sided"))
    assert back.history.model.law == law
    assert back.history.model == run.history.model
    assert known(back) == known(run)


def test_the_law_of_an_eccentric_block_comes_back(tmp_path):
    block = Eccentric(FRAME, 0.2)
    run = simulate(block, MOTION, "rigid")
    assert isinstance(run.history.model.law, SidedRestitution)
    assert run.history.model.law.right != run.history.model.law.left
    back = Response.load(run.save(tmp_path / "block"))
    assert back.history.model == run.history.model
    assert back.history.model.properties.eccentricity == 0.2


def test_a_file_is_replaced_whole(tmp_path):
    path = simulate(FRAME, MOTION).save(tmp_path / "run.npz")
    assert simulate(FRAME, MOTION, "2DOF-S", output="peaks").save(str(path)) == path
    assert Response.load(path).model == "2DOF-S"
    assert list(tmp_path.iterdir()) == [path]


def test_names_with_dots_keep_them(tmp_path):
    run = simulate(FRAME, MOTION, output="peaks")
    assert run.save(tmp_path / "scale 1.5").name == "scale 1.5.npz"
    assert run.save(tmp_path / "run.NPZ").name == "run.NPZ"


@pytest.mark.parametrize("name", ["run.parquet", "run.csv", "run.npz.gz", "scale 1.5.PARQUET"])
def test_another_form_of_file_is_refused(tmp_path, name):
    run = simulate(FRAME, MOTION, output="peaks")
    with pytest.raises(InputError) as caught:
        run.save(tmp_path / name)
    assert str(caught.value) == (
        f"A response is saved as .npz, but {name!r} was given. Name it {name.rpartition('.')[0] + '.npz'!r}; for a "
        'table of the history write pandas.DataFrame({"time": response.time, "rotation": response.rotation})'
        ".to_parquet(...)."
    )
    assert not list(tmp_path.iterdir())


def test_a_missing_file(tmp_path):
    with pytest.raises(InputError, match=r"No saved response at .*Give the path that Response\.save returned\."):
        Response.load(tmp_path / "none.npz")


@pytest.mark.parametrize("cut", [100, 0.5, 0.99])
def test_half_a_file(tmp_path, cut):
    path = simulate(FRAME, MOTION).save(tmp_path / "run")
    whole = path.read_bytes()
    path.write_bytes(whole[: cut if cut >= 1 else int(cut * len(whole))])
    with pytest.raises(InputError, match=r"is not a saved response \(.*\)\. Give a file that Response\.save wrote\."):
        Response.load(path)


def test_any_other_file(tmp_path):
    path = tmp_path / "other.npz"
    path.write_text("time,rotation\n0,0\n")
    with pytest.raises(InputError, match=r"other\.npz is not a saved response"):
        Response.load(path)
    np.savez(path, response=np.zeros(3), time=np.zeros(3))
    with pytest.raises(InputError, match=r"other\.npz is not a saved response"):
        Response.load(path)
    np.savez(path, time=np.zeros(3))
    with pytest.raises(InputError, match=r"other\.npz is not a saved response \(KeyError: 'response'\)\. Give a file"):
        Response.load(path)


def test_another_format(tmp_path):
    path = tmp_path / "old.npz"
    np.savez(path, response=np.array(json.dumps({"format": "rockflex-response-0"})))
    with pytest.raises(InputError, match=r"has the format 'rockflex-response-0', but 'rockflex-response-4' is exp"):
        Response.load(path)


def test_any_damage_is_named(tmp_path):
    """Whatever was done to a file, it is refused as no saved response, or is sound."""
    run = simulate(FRAME, MOTION)
    path = run.save(tmp_path / "run")
    whole = path.read_bytes()
    empty, array, list_, keys = (tmp_path / f"{name}.npz" for name in ("empty", "array", "list", "keys"))
    empty.write_bytes(b"")
    with array.open("wb") as file:
        np.save(file, np.zeros(3))
    np.savez(list_, response=np.array("[1]"))
    np.savez(keys, response=np.array(json.dumps({"format": "rockflex-response-3"})))
    for broken in (empty, array, list_, keys):
        with pytest.raises(InputError, match="is not a saved response"):
            Response.load(broken)
    rng = np.random.default_rng(0)
    for _ in range(300):
        damaged = bytearray(whole)
        damaged[rng.integers(len(whole))] ^= 1 << rng.integers(8)
        path.write_bytes(damaged)
        with contextlib.suppress(InputError):
            assert Response.load(path).peaks() == run.peaks()


def test_a_broken_file_is_closed(tmp_path):
    path = simulate(FRAME, MOTION).save(tmp_path / "run")
    path.write_bytes(path.read_bytes()[:-5])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with pytest.raises(InputError):
            Response.load(path)
        gc.collect()
    assert caught == []


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """The arrays and the scalars of a sound file."""
    path = simulate(FRAME, MOTION).save(tmp_path_factory.mktemp("sound") / "run")
    with np.load(path) as file:
        arrays = dict(file)
    return arrays, json.loads(str(arrays.pop("response")))


def rewritten(path, arrays, scalars):
    np.savez(path, response=np.array(json.dumps(scalars)), **arrays)
    return path


def test_a_file_written_again_is_sound(saved, tmp_path):
    arrays, scalars = saved
    assert Response.load(rewritten(tmp_path / "run.npz", arrays, scalars)).max_rotation == scalars["max_rotation"]


def test_a_file_of_an_older_version_is_read(saved, tmp_path):
    arrays, scalars = dict(saved[0]), saved[1]
    states = arrays["nodes"] = arrays.pop("states")
    assert np.array_equal(Response.load(rewritten(tmp_path / "run.npz", arrays, scalars)).history.states, states)


@pytest.mark.parametrize(
    ("name", "change", "text"),
    [
        ("states", lambda a: a[:, :-1], r"InputError: states must have the shape \(\d+, 12\), but .* \(\d+, 11\)"),
        (
            "states",
            lambda a: a[:0],
            r"InputError: states must have the shape \(1, 12\), but an array of shape \(0, 12\)",
        ),
        ("states", lambda a: a[0], r"InputError: states must have the shape \(1, 12\), but an array of shape \(12,\)"),
        ("states", lambda a: a * np.nan, r"InputError: states must be finite, but its entry \[0, 0\] is nan"),
        ("states", lambda a: a.astype(str), "InputError: states must be of type float64, but is of type <U32"),
        ("states", lambda a: a + 0j, "InputError: states must be of type float64, but is of type complex128"),
        (
            "floors.story_drift",
            lambda a: a[:2],
            r"There must be one peak of each kind per floor, but .* have the sizes \[2, 3, 3, 3\]",
        ),
        ("floors.story_shear", lambda a: a[:, None], "story_shear must be one-dimensional"),
        ("floors.floor_acceleration", None, "KeyError: 'floors.floor_acceleration'"),
        ("floor_modes.heights", None, "KeyError: 'floor_modes.heights'"),
        ("properties.omega", lambda a: a[:2], "InputError: effective_mass must contain one value per mode"),
        ("properties.omega", lambda a: -a, "InputError: omega must be positive"),
        ("properties.i_theta", None, "KeyError: 'properties.i_theta'"),
        ("properties.i_theta", lambda a: np.ones(3), "InputError: i_theta must be a number in kg m²"),
    ],
)
def test_arrays_that_do_not_fit(saved, tmp_path, name, change, text):
    arrays, scalars = saved
    arrays = {key: value for key, value in arrays.items() if key != name}
    if change:
        arrays[name] = change(saved[0][name])
    with pytest.raises(InputError, match=text) as caught:
        Response.load(rewritten(tmp_path / "run.npz", arrays, scalars))
    assert str(caught.value).startswith(f"{tmp_path / 'run.npz'} is not a saved response (")


def test_peaks_of_other_floors(saved, tmp_path):
    arrays, scalars = saved
    fewer = {name: value[:2] if name.startswith("floors.") else value for name, value in arrays.items()}
    with pytest.raises(InputError, match="There are peaks of 2 floors, but a different number of heights"):
        Response.load(rewritten(tmp_path / "run.npz", fewer, scalars))


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("max_rotation", "0.1", "InputError: max_rotation must be of type float, but is '0.1'"),
        ("max_rotation", None, "InputError: max_rotation must be of type float, but is None"),
        ("n_impacts", 2.5, r"InputError: n_impacts must be of type int, but is 2\.5"),
        ("n_impacts", True, "InputError: n_impacts must be of type int, but is True"),
        ("settled", 1, "InputError: settled must be of type bool, but is 1"),
        ("model", 3, "InputError: model must be of type str, but is 3"),
        ("lifts", "yes", "InputError: lifts must be of type bool, but is 'yes'"),
        ("end_time", ..., "KeyError: 'end_time'"),
        ("lifts", ..., "KeyError: 'lifts'"),
        ("format", ..., "KeyError: 'format'"),
    ],
)
def test_scalars_that_do_not_fit(saved, tmp_path, name, value, text):
    arrays, scalars = saved
    scalars = {**scalars, name: value}
    if value is ...:
        del scalars[name]
    with pytest.raises(InputError, match=rf"run\.npz is not a saved response \({text}"):
        Response.load(rewritten(tmp_path / "run.npz", arrays, scalars))
