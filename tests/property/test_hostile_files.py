"""Whatever stands in a file, a reader gives what it holds or an error in words that names the file."""

import io
import json
import os
import platform
import re
import shutil
import time
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rockflex as rf
from builders import make_frame
from record_samples import SEARCH_RESULTS, cosmos, esm, geonet, knet
from rockflex.motion._record_table import read_record_table
from rockflex.studies.folders import _lock
from toy_study import ToyPlan, opened, run_study

FRAME = """
[frame]
n_stories = 2
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = 0.5
aspect_ratio = 10.0
damping_ratio = 0.02
"""
STUDY = """
study = "cloud"
models = ["2DOF-S"]
scales = [1.0]
[records]
suites = ["el-centro-1940"]
[[structures]]
[structures.frame]
""" + FRAME.split("[frame]")[1]
AT2 = "PEER\nEvent, 1/1/99, Station, 090\nACCELERATION IN UNITS OF G\nNPTS= 6, DT= .0100 SEC\n" + "0.1 -0.1\n" * 3
CSV = "time (s), acc (g)\n0.00, 0.1\n0.01, -0.1\n0.02, 0.05\n0.03, 0.0\n"
TEXT = "0.00 0.1\n0.01 -0.1\n0.02 0.05\n0.03 0.0\n"
MATRIX = "2e6,-1e6\n-1e6,1e6\n"
MTX = "%%MatrixMarket matrix coordinate real general\n2 2 4\n1 1 2e6\n1 2 -1e6\n2 1 -1e6\n2 2 1e6\n"
PIECES = [
    b"", b"\x00", b"\xff\xfe", b"nan", b"inf", b"-", b"1e999", b"9" * 400, b"9" * 5000, b"[" * 3000, b"]", b'"', b"'''",
    b"\n", b",", b"=", b"#", b"a." * 2000 + b"a = 1\n", b"x" * 5000, b"1979-05-27", b"{", b"}", b"[[structures]]\n",
    "½".encode(), b"\xed\xa0\x80", b"PK\x03\x04", b"-0.0", b"0x", b"1_0", b"true",
]  # fmt: skip


def stiff(path: Path) -> Any:
    return rf.from_matrices([1e4, 1e4], path, [3.0, 6.0], base_mass=1e4, half_width=1.0, damping_ratio=0.02)


def in_units(path: Path) -> Any:
    return rf.read_components(path, units="g")


def without_warnings(read: Callable[[Path], Any]) -> Callable[[Path], Any]:
    """A reader whose warnings, about peaks that damage has changed, do not count."""

    def quiet(path: Path) -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rf.RecordWarning)
            return read(path)

    return quiet


@pytest.fixture(scope="module")
def response(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("saved") / "run.npz"
    structure = make_frame(n_stories=2, stiffness_ratio=1.0, period=0.5, aspect_ratio=5.0)
    return rf.simulate(structure, rf.ricker_pulse(3.0, 0.5, dt=0.02), "2DOF-S").save(path).read_bytes()


READERS: dict[str, tuple[Callable[[Path], Any], bytes]] = {
    "s.toml": (lambda path: rf.read_structure(path), FRAME.encode()),
    "study.toml": (lambda path: rf.load_study(path).document(), STUDY.encode()),
    "r.at2": (lambda path: rf.read_at2(path), AT2.encode()),
    "r.csv": (lambda path: rf.read_motion(path), CSV.encode()),
    "r.txt": (in_units, TEXT.encode()),
    "r.ns": (without_warnings(rf.read_motion), knet().encode()),
    "r.asc": (without_warnings(rf.read_motion), esm().encode()),
    "r.v2c": (without_warnings(rf.read_components), (cosmos(90) + cosmos(400)).encode()),
    "r.v2a": (without_warnings(rf.read_components), (geonet() + geonet("Up")).encode()),
    "r.tsv": (in_units, b"Zeit\tNS\tEW\tUD\n" + b"0,01\t0,1\t0,2\t0,3\n" * 3),
    "_SearchResults.csv": (lambda path: read_record_table(path), SEARCH_RESULTS.encode()),
    "k.csv": (stiff, MATRIX.encode()),
    "k.mtx": (stiff, MTX.encode()),
}


def refusal(call: Callable[[], Any]) -> str | None:
    """The message with which a call is refused; None where it is not."""
    try:
        call()
    except rf.InputError as error:
        return str(error)
    return None


def judged(read: Callable[[Path], Any], path: Path, content: bytes) -> None:
    path.write_bytes(content)
    message = refusal(lambda: read(path))
    if message is not None:
        assert len(message) < 2000
        # The numbers of a matrix are checked beside those that do not come from its file.
        assert str(path.parent) in message or (
            path.stem == "k" and re.search("stiffness|degrees of freedom", message)
        ), message


def damaged(draw: st.DataObject, content: bytes) -> bytes:
    """The content with something cut out, and something else put in."""
    for _ in range(draw.draw(st.integers(1, 3))):
        begin = draw.draw(st.integers(0, len(content)))
        end = min(len(content), begin + draw.draw(st.integers(0, 40)))
        piece = draw.draw(st.one_of(st.sampled_from(PIECES), st.binary(max_size=20)))
        content = content[:begin] + piece + content[end:]
    return content


SETTINGS = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@pytest.mark.parametrize("name", READERS)
@SETTINGS
@given(draw=st.data())
def test_damaged_files(name: str, tmp_path: Path, draw: st.DataObject) -> None:
    read, content = READERS[name]
    judged(read, tmp_path / name, damaged(draw, content))


@SETTINGS
@given(draw=st.data())
def test_damaged_responses(response: bytes, tmp_path: Path, draw: st.DataObject) -> None:
    judged(rf.Response.load, tmp_path / "run.npz", damaged(draw, response))


@SETTINGS
@given(
    st.dictionaries(
        st.sampled_from(
            ["format", "status", "max_rotation", "n_impacts", "tendons", "law", "model", "lifts", "motion"]
        ),
        st.one_of(st.none(), st.integers(), st.floats(), st.text(max_size=5), st.just("x" * 9999), st.just([[[]]])),
        min_size=1,
    )
)
def test_responses_of_other_values(response: bytes, tmp_path: Path, changes: dict[str, Any]) -> None:
    with zipfile.ZipFile(io.BytesIO(response)) as archive:
        arrays = {name.removesuffix(".npy"): np.load(archive.open(name)) for name in archive.namelist()}
    arrays["response"] = np.array(json.dumps(json.loads(str(arrays["response"])) | changes))
    content = io.BytesIO()
    np.savez(content, **arrays)
    judged(rf.Response.load, tmp_path / "run.npz", content.getvalue())


PLAN = ToyPlan(n_chunks=2)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study")
    run_study(str(folder), PLAN)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("name", ["manifest.json", "spec.json", "parts/part-00000.parquet"])
@SETTINGS
@given(draw=st.data())
def test_damaged_studies(study: Path, tmp_path: Path, name: str, draw: st.DataObject) -> None:
    folder = tmp_path / "copy"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(study, folder)

    def read(_: Path) -> None:
        rf.StudyFolder.load(folder).frame()
        opened(str(folder), PLAN).close()

    content = damaged(draw, (study / name).read_bytes())
    try:
        judged(read, folder / name, content)
    finally:
        (folder / "lock").unlink(missing_ok=True)


LOCKS = st.one_of(
    st.binary(max_size=40),
    st.sampled_from([b"[" * 100_000, b"9" * 5000 + b"\n", b"null", b'"pid"', b"\xff"]),
    st.tuples(
        st.one_of(st.text(), st.integers()), st.one_of(st.just(platform.node()), st.just("h" * 9999)), st.integers()
    ).map(lambda lines: "".join(f"{line}\n" for line in lines).encode()),
)


@pytest.mark.slow
@SETTINGS
@given(content=LOCKS, age=st.sampled_from([-1e6, 1.0, 1e6]))
def test_locks_of_anything(tmp_path: Path, content: bytes, age: float) -> None:
    path = tmp_path / "lock"
    path.write_bytes(content)
    os.utime(path, (time.time() - age,) * 2)
    begin, patience = time.monotonic(), _lock.PATIENCE
    try:
        _lock.PATIENCE = 0.05
        message = refusal(lambda: _lock.locked_folder(path).release())
    finally:
        _lock.PATIENCE = patience
    assert time.monotonic() - begin < 2.0
    assert message is None or (len(message) < 2000 and "is in use by " in message)
