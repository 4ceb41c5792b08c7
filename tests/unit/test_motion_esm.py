"""ESM files, written from the published header (DYNA 1.2)."""

import pytest

import rockflex as rf
from record_samples import SAMPLES, esm


def write(folder, text, name="IT.NRC.00.HNE.D.20161030.064018.C.ACC.ASC"):
    (folder / name).write_text(text)
    return folder / name


def test_samples_and_peak(tmp_path):
    motion = rf.read_motion(write(tmp_path, esm()))
    assert motion.acceleration == pytest.approx([0.01 * each for each in SAMPLES], rel=1e-15)
    assert motion.pga == pytest.approx(motion.metadata.stated_pga, rel=1e-12)
    assert (motion.dt, motion.name) == (0.005, "IT.NRC.00.HNE.D.20161030.064018.C.ACC")


def test_header(tmp_path):
    info = rf.read_motion(write(tmp_path, esm())).metadata
    assert (info.event, info.year, info.magnitude, info.magnitude_type) == (
        "CENTRAL_ITALY 2016-10-30 06:40",
        2016,
        6.5,
        "Mw",
    )
    assert (info.network, info.station, info.location, info.vs30) == ("IT", "NRC", "00", 498.0)
    assert (info.component, info.direction, info.azimuth) == ("HNE", "horizontal", 90.0)
    assert (info.epicentral_km, info.start_time) == (4.6, "2016-10-30T06:40:13.250+00:00")
    assert (info.source_format, info.processing) == ("ESM", None)


def test_what_a_header_leaves_empty_is_unknown(tmp_path):
    empty = dict.fromkeys(
        ("MAGNITUDE_W", "VS30_M_S", "EPICENTRAL_DISTANCE_KM", "PGA_CM_S_2", "EVENT_DATE_YYYYMMDD", "LOCATION",
         "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS"), "")  # fmt: skip
    info = rf.read_motion(write(tmp_path, esm(EVENT_NAME="None", **empty))).metadata
    assert (info.magnitude, info.magnitude_type, info.event) == (6.1, "ML", "EMSC-20161030_0000029")
    assert (info.vs30, info.epicentral_km, info.year, info.location, info.start_time) == (None,) * 5
    assert info.stated_pga is None
    assert rf.read_motion(write(tmp_path, esm(MAGNITUDE_W="", MAGNITUDE_L=""))).metadata.magnitude_type is None


def test_a_station(tmp_path):
    for stream in ("HNE", "HNN", "HNZ"):
        write(tmp_path, esm(stream=stream), f"IT.NRC.00.{stream}.D.20161030.064018.C.ACC.ASC")
    suite = rf.read_suite(tmp_path, vertical="pair")
    assert [motion.metadata.azimuth for motion in suite] == [90.0, 0.0]
    assert all(motion.vertical is not None for motion in suite)
    (station,) = rf.group_stations(suite)
    assert (station.name, len(station.pair)) == ("IT NRC 00 CENTRAL_ITALY 2016-10-30 06:40", 2)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            {"SAMPLING_INTERVAL_S": "0"},
            r"a positive SAMPLING_INTERVAL_S and NDATA .* they are '0' and '8'",
        ),
        ({"NDATA": ""}, "a positive SAMPLING_INTERVAL_S and NDATA are expected"),
        ({"NDATA": "9"}, "is truncated: its header says NDATA = 9, but 8 values follow"),
        ({"NDATA": "7"}, "contains too many values: its header says NDATA = 7"),
        ({"DATA_TYPE": "VELOCITY"}, "an acceleration is expected, but DATA_TYPE is 'VELOCITY'. Use the file of the"),
        ({"UNITS": "cm/s"}, "UNITS is 'cm/s', but an acceleration is expected, such as cm/s^2"),
        ({"UNITS": ""}, "UNITS is ''"),
    ],
)
def test_refuses(tmp_path, changed, message):
    with pytest.raises(rf.InputError, match=message.replace("^", r"\^")) as caught:
        rf.read_motion(write(tmp_path, esm(**changed), "a.asc"))
    assert "a.asc" in str(caught.value)


def test_refuses_samples_and_units(tmp_path):
    with pytest.raises(rf.InputError, match="line 31: expected a finite number, but found 'x'"):
        rf.read_motion(write(tmp_path, esm().replace("USER5: \n0.000000", "USER5: \nx")))
    with pytest.raises(rf.InputError, match="a file in the ESM format, which states its unit, but units='cm/s2' was"):
        rf.read_motion(write(tmp_path, esm()), units="cm/s2")
    with pytest.raises(
        rf.InputError, match=r"line 31: expected a finite number, but found '0,5'\. Write decimals with a"
    ):
        rf.read_motion(write(tmp_path, esm().replace("USER5: \n0.000000", "USER5: \n0,5")))
    short = "\n".join(esm().splitlines()[:30])
    with pytest.raises(rf.InputError, match=r"is truncated: .* but 0 values follow"):
        rf.read_motion(write(tmp_path, short))
