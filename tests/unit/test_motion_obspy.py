"""What ObsPy reads: files that it writes, and those of its own tests."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf
from record_samples import load_obspy
from rockflex.motion import _obspy
from rockflex.motion._obspy import obspy_format

COUNTS = np.array([0, 100, -250, 4000, -10, 0], dtype=np.int32)


@pytest.fixture
def obspy():
    return load_obspy()


def trace(obspy, channel, data=COUNTS, start=0.0):
    header = {"network": "XX", "station": "ABC", "location": "10", "channel": channel, "delta": 0.005}
    return obspy.Trace(data.copy(), header | {"starttime": obspy.UTCDateTime(2020, 1, 2, 3, 4, 5) + start})


def write(obspy, file, *channels, form="MSEED"):
    obspy.Stream([trace(obspy, each) for each in channels]).write(str(file), format=form)
    return file


def test_miniseed(obspy, tmp_path):
    file = write(obspy, tmp_path / "a.mseed", "HNE", "HNN", "HNZ")
    found = rf.read_components(file, units="2.5e-4 cm/s2")
    assert [motion.name for motion in found] == ["a-HNE", "a-HNN", "a-HNZ"]
    assert found[0].acceleration == pytest.approx(COUNTS * 2.5e-6, rel=1e-15)
    info = found[0].metadata
    assert (info.network, info.station, info.location, info.component) == ("XX", "ABC", "10", "HNE")
    assert (info.azimuth, info.direction, info.year) == (90.0, "horizontal", 2020)
    assert (info.start_time, info.source_format) == ("2020-01-02T03:04:05+00:00", "MSEED")
    assert found[2].metadata.is_vertical
    suite = rf.read_suite(tmp_path, units={"*.mseed": "2.5e-4 cm/s2"}, vertical="pair")
    assert [motion.pva for motion in suite] == pytest.approx([0.01, 0.01])
    with pytest.raises(rf.InputError, match=r"\(MSEED\) does not state the unit of its samples, which may be counts"):
        rf.read_motion(file, component="HNE")
    with pytest.raises(rf.InputError, match=r"states DT = 0\.005 s, but dt=0\.01 was given"):
        rf.read_motion(file, units="mm/s2", dt=0.01, component="HNE")


@pytest.mark.parametrize("form", ["SAC", "GSE2", "SLIST", "TSPAIR"])
def test_other_formats(obspy, tmp_path, form):
    motion = rf.read_motion(write(obspy, tmp_path / "a.dat", "HNE", form=form), units="0.01 cm/s2")
    assert motion.acceleration == pytest.approx(COUNTS * 1e-4, rel=1e-6)
    assert (motion.dt, motion.metadata.source_format) == (0.005, form)


def test_refuses(obspy, tmp_path):
    file = write(obspy, tmp_path / "a.mseed", "HHE")
    with pytest.raises(rf.InputError, match=r"channel HHE belongs to a velocity sensor, .* accelerometer, such as HNE"):
        rf.read_motion(file, units="g")
    pieces = obspy.Stream([trace(obspy, "HNE"), trace(obspy, "HNE", start=1.0)])
    pieces.write(str(tmp_path / "gap.mseed"), format="MSEED")
    with pytest.raises(rf.InputError, match=r"channel HNE has a gap, but a record without gaps is expected\. Cut it"):
        rf.read_motion(tmp_path / "gap.mseed", units="mg")
    content = write(obspy, tmp_path / "b.sac", "HNE", form="SAC").read_bytes()
    (tmp_path / "b.sac").write_bytes(content[:-10])
    with pytest.raises(rf.InputError, match=r"b\.sac"):
        rf.read_motion(tmp_path / "b.sac", units="mg")


@pytest.mark.parametrize(("code", "quantity"), [(6, "displacement"), (7, "velocity"), (8, "acceleration"), (5, None)])
def test_the_header_of_sac_says_the_quantity(obspy, tmp_path, code, quantity):
    one = trace(obspy, "HNE")
    one.stats.sac = {"idep": code}
    one.write(str(tmp_path / "a.sac"), format="SAC")
    if quantity in ("displacement", "velocity"):
        with pytest.raises(rf.InputError, match=rf"found a {quantity} \(header field IDEP: {code}, {quantity}\)"):
            rf.read_motion(tmp_path / "a.sac", units="mm/s2")
        return
    found = rf.read_motion(tmp_path / "a.sac", units="mm/s2").metadata.findings
    assert [str(each) for each in found] == [
        f"quantity: acceleration ({'header field IDEP: 8, acceleration' if quantity else 'channel HNE'})",
        "unit: mm/s2 (units=mm/s2)",
        "time step: 0.005 s (header of SAC)",
        "component: HNE, horizontal (channel HNE)",
    ]


def test_a_channel_that_contradicts_the_name_of_its_file(obspy, tmp_path):
    file = write(obspy, tmp_path / "XX.ABC.HNE.sac", "HNZ", form="SAC")
    with pytest.raises(rf.InputError, match=r"component: vertical \(channel HNZ\), but horizontal \(name of the file"):
        rf.read_motion(file, units="mm/s2")
    several = write(obspy, tmp_path / "XX.ABC.HNE.mseed", "HNZ", "HNN")
    found = rf.read_components(several, units="mm/s2")
    assert {each.metadata.component: each.metadata.is_vertical for each in found} == {"HNZ": True, "HNN": False}


def test_pieces_that_continue_each_other_are_one(obspy, tmp_path):
    pieces = obspy.Stream([trace(obspy, "HNE"), trace(obspy, "HNE", start=0.005 * COUNTS.size)])
    pieces.write(str(tmp_path / "a.mseed"), format="MSEED")
    assert rf.read_motion(tmp_path / "a.mseed", units="mm/s2").acceleration.size == 2 * COUNTS.size


def test_no_file_is_unpickled(obspy, tmp_path):
    class Trap:
        def __reduce__(self):
            return pytest.fail, ("a file was unpickled",)

    (tmp_path / "a.dat").write_bytes(pickle.dumps(Trap()))
    with pytest.raises(rf.InputError, match=r"a\.dat is a binary file"):
        rf.read_motion(tmp_path / "a.dat", units="g")
    assert obspy_format(pickle.dumps(obspy.Stream([trace(obspy, "HNE")]))) is None


def test_an_accelerograph_states_its_calibration(obspy):
    file = Path(obspy.__file__).parent / "io" / "kinemetrics" / "tests" / "data" / "BI008_MEMA-04823.evt"
    if not file.exists():
        pytest.skip("ObsPy is installed without its test files")
    found = rf.read_components(file)
    assert [(motion.dt, motion.acceleration.size) for motion in found] == [(0.004, 5750)] * 3
    # By its header: 24 bits, 2.5 V full scale, 2.5 V a g, and peaks of -19494 and -22142 counts in the first channel.
    assert np.ptp(found[0].acceleration) == pytest.approx((22142 - 19494) / 2**23 * 9.81, rel=1e-6)
    assert abs(found[0].acceleration.mean()) < 1e-15
    assert {motion.metadata.direction for motion in found} == {None}
    with pytest.raises(rf.InputError, match=r"states its own calibration \(KINEMETRICS_EVT\), but units='g' was given"):
        rf.read_components(file, units="g")


def test_without_obspy(tmp_path, monkeypatch):
    monkeypatch.setattr(_obspy, "is_obspy_installed", lambda: False)
    (tmp_path / "a.mseed").write_bytes(b"\0\1\2" * 50)
    with pytest.raises(rf.InputError, match=r"a\.mseed is a binary file, .* ObsPy: pip install 'rockflex\[obspy\]'"):
        rf.read_motion(tmp_path / "a.mseed")
    assert obspy_format(b"") is None


def test_the_page_reads_no_foreign_formats(obspy, tmp_path):
    from rockflex.web._refusal import Refusal
    from rockflex.web._uploads import read_uploaded_record

    content = write(obspy, tmp_path / "a.mseed", "HNE").read_bytes()
    with pytest.raises(Refusal) as caught:
        read_uploaded_record("a.mseed", content, "g", None)
    assert "a.mseed is a binary file" in caught.value.errors["record.upload"]


def test_a_text_that_obspy_takes_for_its_own_but_cannot_read(obspy, tmp_path):
    (tmp_path / "a.txt").write_text("WID2 of no file\nabc\n")
    assert obspy_format((tmp_path / "a.txt").read_bytes()) is not None
    with pytest.raises(rf.InputError, match=r"a\.txt holds no numbers: a record is expected as AT2, CSV or columns"):
        rf.read_motion(tmp_path / "a.txt", units="g")
