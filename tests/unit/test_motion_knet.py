"""K-NET and KiK-net files, written from the format that NIED publishes, and the one that ObsPy has for its tests."""

import warnings
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf
from record_samples import COUNTS, GAL, knet, load_obspy


def write(folder, name, text):
    (folder / name).write_text(text)
    return folder / name


def test_samples_are_counts_times_the_scale_without_their_mean(tmp_path):
    motion = rf.read_motion(write(tmp_path, "MYG0020601182325.NS", knet()))
    assert motion.acceleration == pytest.approx((np.array(COUNTS) - 8000.0) * GAL / 100.0, rel=1e-12, abs=1e-15)
    assert motion.pga == pytest.approx(motion.metadata.stated_pga, abs=5e-6)
    assert (motion.dt, motion.name) == (0.1, "MYG0020601182325-NS")


def test_header(tmp_path):
    info = rf.read_motion(write(tmp_path, "MYG0020601182325.NS", knet())).metadata
    assert (info.event, info.year, info.magnitude, info.magnitude_type) == ("2006-01-18 23:25", 2006, 5.7, "MJMA")
    assert (info.station, info.network, info.component) == ("MYG002", "NIED", "N-S")
    assert (info.direction, info.azimuth, info.location) == ("horizontal", 0.0, None)
    # The recording time of the header is 15 s late.
    assert info.start_time == "2006-01-18T23:25:31+09:00"
    assert (info.source, info.source_format, info.processing) == ("MYG0020601182325.NS", "K-NET", "mean subtracted")
    # By the haversine formula, on a sphere of 6371 km.
    north, east, other, away = np.radians([37.798, 142.2, 38.7262, 141.5109])
    chord = np.sin((other - north) / 2) ** 2 + np.cos(north) * np.cos(other) * np.sin((away - east) / 2) ** 2
    assert info.epicentral_km == pytest.approx(2 * 6371 * np.arcsin(np.sqrt(chord)), abs=1e-3)


@pytest.mark.parametrize(
    ("direction", "component", "way", "azimuth", "location"),
    [
        ("N-S", "N-S", "horizontal", 0.0, None),
        ("E-W", "E-W", "horizontal", 90.0, None),
        ("U-D", "U-D", "vertical", None, None),
        ("1", "N-S", "horizontal", 0.0, "borehole"),
        ("2", "E-W", "horizontal", 90.0, "borehole"),
        ("3", "U-D", "vertical", None, "borehole"),
        ("4", "N-S", "horizontal", 0.0, "surface"),
        ("5", "E-W", "horizontal", 90.0, "surface"),
        ("6", "U-D", "vertical", None, "surface"),
    ],
)
def test_channels(tmp_path, direction, component, way, azimuth, location):
    info = rf.read_motion(write(tmp_path, "TCGH13.dat", knet(direction, maximum="Max Acc. (gal)"))).metadata
    assert (info.component, info.direction, info.azimuth, info.location) == (component, way, azimuth, location)
    assert info.source_format == ("K-NET" if location is None else "KiK-net")
    assert info.stated_pga is not None


def test_a_station_of_three_files(tmp_path):
    for suffix, direction in (("NS", "N-S"), ("EW", "E-W"), ("UD", "U-D")):
        write(tmp_path, f"MYG0020601182325.{suffix}", knet(direction))
    with pytest.warns(rf.RecordWarning, match=r"^Left out: 1 vertical component, MYG0020601182325-UD\.UD\.$"):
        assert rf.read_suite(tmp_path).names == ("MYG0020601182325-EW", "MYG0020601182325-NS")
    suite = rf.read_suite(tmp_path, vertical="pair")
    assert all(np.array_equal(motion.vertical, motion.acceleration) for motion in suite)
    (station,) = rf.group_stations(suite)
    assert station.name == "NIED MYG002 2006-01-18 23:25"
    assert [motion.metadata.azimuth for motion in station.pair] == [90.0, 0.0]
    assert station.vertical is not None


def test_boreholes_are_left_out_beneath_the_surface(tmp_path):
    for k, suffix in enumerate(("NS1", "EW1", "UD1", "NS2", "EW2", "UD2"), 1):
        write(tmp_path, f"TCGH130007210339.{suffix}", knet(str(k), station="TCGH13"))
    with pytest.warns(rf.RecordWarning) as caught:
        suite = rf.read_suite(tmp_path, vertical="pair")
    assert [each.message.args[0] for each in caught] == [
        "Left out: 3 borehole components beneath records at the surface, TCGH130007210339-EW1.EW1, "
        "TCGH130007210339-NS1.NS1, TCGH130007210339-UD1.UD1."
    ]
    assert suite.names == ("TCGH130007210339-EW2", "TCGH130007210339-NS2")
    assert [motion.metadata.vertical_source for motion in suite] == ["TCGH130007210339-UD2"] * 2
    alone = rf.read_suite([tmp_path / f"TCGH130007210339.{suffix}" for suffix in ("NS1", "EW1")])
    assert {motion.metadata.location for motion in alone} == {"borehole"}
    both = rf.group_stations(rf.read_motion(file) for file in sorted(tmp_path.iterdir()))
    assert [(each.name, len(each.horizontal)) for each in both] == [
        ("NIED TCGH13 borehole 2006-01-18 23:25", 2),
        ("NIED TCGH13 surface 2006-01-18 23:25", 2),
    ]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"scale": "0(gal)/6182761", "peak": 1.0}, r'expected as "3920\(gal\)/6182761", but it is .0\(gal\)/6182761'),
        ({"scale": "2(gal)/0", "peak": 1.0}, r'expected as "3920\(gal\)/6182761"'),
        (
            {"rate": 0, "duration": 1.0},
            r"a sampling frequency and a duration are expected .*'0Hz'",
        ),
        ({"duration": 3.0}, r"is truncated: its header says 3 s at 10 Hz, but 10 values follow\. Download"),
        ({"counts": [1] * 25, "duration": 1.0, "peak": 1.0}, "contains too many values: its header says 1 s at 10 Hz"),
        ({"counts": [1, 2], "peak": 3.2e-4}, "must have at least 3 samples, but 2"),
    ],
)
def test_refuses(tmp_path, changed, message):
    file = write(tmp_path, "X.NS", knet(**changed))
    with pytest.raises(rf.InputError, match=message) as caught:
        rf.read_motion(file)
    assert "X.NS" in str(caught.value)


def test_refuses_what_is_no_number_and_what_is_missing(tmp_path):
    with pytest.raises(rf.InputError, match="line 18: expected a finite number, but found '81x0'"):
        rf.read_motion(write(tmp_path, "a.ns", knet().replace("8120", "81x0")))
    with pytest.raises(rf.InputError, match=r"begins as a K-NET file, but 'Dir\.', 'Scale Factor' is missing among"):
        rf.read_motion(write(tmp_path, "b.ns", knet().replace("Dir.", "D.  ").replace("Scale Factor", "Scale fact. ")))
    with pytest.raises(rf.InputError, match="a file in the K-NET format, which states its unit, but units='g' was"):
        rf.read_motion(write(tmp_path, "c.ns", knet()), units="g")
    with pytest.raises(rf.InputError, match=r"states DT = 0\.1 s, but dt=0\.2 was given"):
        rf.read_motion(tmp_path / "c.ns", dt=0.2)


def test_units_for_other_files_do_not_matter(tmp_path):
    write(tmp_path, "MYG002.NS", knet())
    (tmp_path / "lab.txt").write_text("0\n0.1\n0\n")
    assert rf.read_suite(tmp_path, units="g", dt=0.01).names == ("MYG002-NS", "lab")


def test_an_unknown_place_and_time_stay_unknown(tmp_path):
    text = (
        knet().replace("37.798", "      ").replace("2006/01/18 23:25:46", "unknown            ").replace("5.7", "-- ")
    )
    info = rf.read_motion(write(tmp_path, "MYG002.NS", text)).metadata
    assert (info.epicentral_km, info.start_time, info.magnitude) == (None, None, None)


def test_the_file_of_obspy():
    obspy = load_obspy()
    source = Path(obspy.__file__).parent / "io" / "nied" / "tests" / "data" / "test.knet"
    if not source.exists():
        pytest.skip("ObsPy is installed without its test files")
    motion = rf.read_motion(source)
    assert (motion.acceleration.size, motion.dt, motion.name) == (5900, 0.01, "test")
    # The header states 4.383 gal.
    assert motion.metadata.stated_pga == pytest.approx(0.04383)
    assert motion.pga == pytest.approx(0.04383, abs=5e-6)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        trace = obspy.read(str(source))[0]
    expected = trace.data * trace.stats.calib
    assert motion.acceleration == pytest.approx(expected - expected.mean(), abs=1e-12)
    assert motion.metadata.station == "AKT013"
