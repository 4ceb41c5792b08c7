import copy
import pickle
import subprocess
import sys

import numpy as np
import pytest

import rockflex.motion as motion_layer
from rockflex._errors import InputError
from rockflex.motion import GroundMotion, RecordInfo


def test_holds_a_read_only_copy():
    samples = np.array([0.0, 1.0, -2.0])
    motion = GroundMotion(samples, 0.5, name="a")
    samples[1] = 9.0
    assert motion.acceleration.tolist() == [0.0, 1.0, -2.0]
    assert motion.acceleration.dtype == np.float64
    with pytest.raises(ValueError, match="read-only"):
        motion.acceleration[0] = 1.0
    with pytest.raises(AttributeError):
        motion.dt = 0.1
    assert motion.time.tolist() == [0.0, 0.5, 1.0]
    assert motion.duration == 1.0
    assert motion.pga == 2.0


def test_copies_through_pickle_stay_read_only():
    motion = GroundMotion([0, 1, 2], 0.5, "a", RecordInfo(year=1940))
    for twin in (pickle.loads(pickle.dumps(motion)), copy.deepcopy(motion)):
        assert not twin.acceleration.flags.writeable
        assert (twin.dt, twin.name, twin.metadata) == (motion.dt, motion.name, motion.metadata)
        assert np.array_equal(twin.acceleration, motion.acceleration)


def test_repr_says_what_it_is():
    text = repr(GroundMotion([0, 1, -3], 0.02, "quake"))
    assert text == "GroundMotion('quake', 3 samples, dt=0.02 s, duration=0.04 s, pga=3 m/s²)"


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (([], 0.1), "at least 3 samples, but 0 were given"),
        (([1, 2], 0.1), "at least 3 samples, but 2 were given"),
        (([1, 2, np.nan], 0.1), r"must be finite, but 1 of 3 values are not, the first \(nan\) at index 2"),
        (([1, 2, np.inf], 0.1), "must be finite"),
        (([[1, 2, 3]], 0.1), "must be one-dimensional"),
        (("abc", 0.1), "must be a sequence of numbers in m/s²"),
        (([1, 2, 3], 0.0), "dt must be a positive, finite number in s, but 0.0"),
        (([1, 2, 3], -0.1), "dt must be a positive"),
        (([1, 2, 3], np.nan), "dt must be a positive"),
        (([1, 2, 3], 0.1, 7), "name must be a string, but 7"),
        (([1, 2, 3], 0.1, "x", {"year": 1940}), "metadata must be a RecordInfo or None, but dict"),
    ],
)
def test_refuses(arguments, text):
    with pytest.raises(InputError, match=text):
        GroundMotion(*arguments)


def test_scaling_keeps_name_and_metadata_and_tells_the_whole_factor():
    motion = GroundMotion([0, 1, -2], 0.5, "a", RecordInfo(event="x"))
    scaled = motion.scaled(-2)
    assert scaled.acceleration.tolist() == [0, -2, 4]
    assert (scaled.name, scaled.metadata) == ("a", RecordInfo(event="x", scale=-2.0))
    assert scaled.scaled(1.5).metadata.scale == -3.0
    assert scaled.scaled(-0.5) == motion == motion.scaled(1.0)
    assert GroundMotion([0, 1, -2], 0.5).scaled(3.0).metadata == RecordInfo(scale=3.0)


@pytest.mark.parametrize(
    ("factor", "text"),
    [
        (np.inf, "factor must be a finite number, but inf was given"),
        (np.nan, "factor must be a finite number"),
        ("a", "factor must be a finite number, but 'a' was given"),
        (1e308, "acceleration must be finite"),
    ],
)
def test_scaling_stays_finite(factor, text):
    with pytest.raises(InputError, match=text):
        GroundMotion([0, 1, -2], 0.5).scaled(factor)


def test_importing_the_layer_loads_no_heavy_package():
    code = "import sys, rockflex.motion; print(sorted({'scipy', 'numba', 'pandas', 'h5py'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_exports_are_what_is_listed():
    assert all(hasattr(motion_layer, name) for name in motion_layer.__all__)
    assert sorted(motion_layer.__all__) == sorted(set(motion_layer.__all__))
