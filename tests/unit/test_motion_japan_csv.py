"""CSV files of NIED (K-NET) and of JMA."""

import pytest

import rockflex as rf

KNET = """\
#K-NET CSV
#Event
#OriginTime,Latitude,Longitude,Depth(km),Magnitude
#2020/01/01 00:00:00,31.7,131.7,31,7.1
#Station
#Code,Latitude,Longitude,Height(m)
#XXX001,33.9,133.5,25
#Record
#SamplingFrequency(Hz)
#100
#DurationTime(s)
#0.04
#Offset
#N-S(gal),E-W(gal),U-D(gal)
#0.10,1.70,16.50
#Time,RelativeTime(s),N-S(gal),E-W(gal),U-D(gal)
2020/01/01 00:01:15.00,0.00,0.10,1.70,16.50
2020/01/01 00:01:15.01,0.01,5.10,-8.30,17.50
2020/01/01 00:01:15.02,0.02,-9.90,3.70,14.50
2020/01/01 00:01:15.03,0.03,0.10,1.70,16.50
"""
JMA = """\
SITE CODE= 47000Test         ,36.0,140.0,10
 LAT.= 36.0
 LON.= 140.0
 SAMPLING RATE= 100Hz
 UNIT  = gal(cm/s/s)
 INITIAL TIME = 2020 01 01 00 00 10
 NS,EW,UD
0.000,-0.000,0.000
5.000,-10.000,1.000
-10.000,2.000,-2.000
0.000,0.000,0.000
"""
PEAKS = [0.1, 0.1, 0.02]  # m/s²


@pytest.fixture
def write(tmp_path):
    def write(text, name="station.csv"):
        file = tmp_path / name
        file.write_text(text)
        return file

    return write


@pytest.mark.parametrize(
    ("text", "names", "processing"),
    [(KNET, ("N-S", "E-W", "U-D"), "offset of the header subtracted"), (JMA, ("NS", "EW", "UD"), None)],
)
def test_three_components(write, text, names, processing):
    file = write(text)
    found = rf.read_components(file)
    assert [motion.name for motion in found] == [f"station-{name}" for name in names]
    assert [motion.pga for motion in found] == pytest.approx(PEAKS)
    assert {(motion.dt, motion.metadata.processing) for motion in found} == {(0.01, processing)}
    assert [(each.metadata.direction, each.metadata.azimuth) for each in found] == [
        ("horizontal", 0.0),
        ("horizontal", 90.0),
        ("vertical", None),
    ]
    assert all(len(each.metadata.findings) == 4 for each in found)
    with pytest.raises(rf.InputError, match=r"states DT = 0\.01 s, but dt=0\.02 was given") as caught:
        rf.read_components(file, dt=0.02)
    assert caught.value.field == "dt"
    with pytest.raises(rf.InputError, match="states its unit, but units='g'") as caught:
        rf.read_components(file, units="g", dt=0.02)
    assert caught.value.field == "units"


def test_what_the_headers_say(write):
    info = rf.read_motion(write(KNET), component="N-S").metadata
    assert (info.event, info.year, info.magnitude, info.station) == ("2020-01-01 00:00", 2020, 7.1, "XXX001")
    assert (info.start_time, info.network) == ("2020-01-01T00:01:15.00+09:00", "NIED")
    assert info.epicentral_km == pytest.approx(297.0, abs=3.0)
    info = rf.read_motion(write(JMA), component="NS").metadata
    assert (info.station, info.network, info.start_time) == ("47000", "JMA", "2020-01-01T00:00:10+09:00")
    assert [str(each) for each in info.findings][1:3] == [
        'unit: cm/s2 (line 5: "UNIT = gal(cm/s/s)")',
        'time step: 0.01 s (line 4: "SAMPLING RATE= 100Hz")',
    ]
    station = rf.read_suite([write(KNET)], vertical="pair")
    assert [motion.pva for motion in station] == pytest.approx([0.02, 0.02])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (KNET.replace("#100\n", "#50\n"), r"line 18: the time 0\.01 s does not fit the frequency in line 10, 50 Hz"),
        (KNET.replace("#100\n", "#x\n"), "a frequency in Hz is expected, but found 'x'"),
        (KNET.replace("#0.10,1.70,16.50", "#0.10,1.70"), "line 15: 3 offsets are expected, but found 2"),
        (KNET.replace("#N-S(gal)", "#NS(gal)", 1), "has no line '#N-S"),
        (KNET.replace("U-D(gal)\n2020", "U-D(volt)\n2020"), r"a component with its unit is expected, .*'U-D\(volt\)'"),
        (KNET.replace(",5.10,", ",5x10,"), "line 18: .* found '5x10'"),
        (KNET.replace(",17.50", ""), "line 18: 5 columns are expected, but found 4"),
        (KNET.replace("#0.04\n", "#9\n"), "is truncated: its header says 9 s at 100 Hz, but 4 values"),
        (KNET.partition("2020/01/01 00:01")[0], "no samples follow|truncated"),
        (JMA.replace("100Hz", "0Hz"), "a frequency in Hz is expected"),
        (JMA.replace(" UNIT", " UNITY"), "lacks UNIT"),
        (JMA.replace("gal(cm/s/s)", "kine(cm/s)"), "a component with its unit is expected"),
        (JMA.partition("0.000")[0], "no samples follow"),
        (JMA.replace("-10.000,2.000", "-10.000"), "line 10: 3 columns are expected, but found 2"),
    ],
)
def test_refuses(write, text, message):
    with pytest.raises(rf.InputError, match=message):
        rf.read_components(write(text))
