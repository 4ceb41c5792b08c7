"""Files of strong-motion networks, written from the published formats, and the one that ObsPy has for its tests."""

import warnings
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf
from record_samples import COUNTS, GAL, SAMPLES, cosmos, esm, geonet, knet, load_obspy

WRITERS = {"K-NET": knet, "ESM": esm, "COSMOS": cosmos, "GeoNet": geonet}
FILES = {
    "K-NET": "MYG0020601182325.txt",
    "ESM": "IT.NRC.00.HNE.D.20161030.064018.C.ACC.ASC",
    "COSMOS": "CE13921.V2c",
    "GeoNet": "20190305_070859_MADE_20.V2A",
}
MM = 1e-3  # m/s²
NAMES = ("N76E", "S14E", "Up")  # of GeoNet's components
RAW = [3284, 3334, 3296, 3284, 3308, 3242, 3236, 3324]  # counts
NO_CODE = {"integers": {54: -999}}  # of COSMOS: the direction stands in the text only
EMPTY_ESM = dict.fromkeys(
    ("MAGNITUDE_W", "VS30_M_S", "EPICENTRAL_DISTANCE_KM", "PGA_CM_S_2", "EVENT_DATE_YYYYMMDD", "LOCATION",
     "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS"), "")  # fmt: skip
BARE_KNET = knet().replace("37.798", "      ").replace("2006/01/18 23:25:46", "unknown            ")
BARE_GEONET = geonet(integers={1: 0, 9: 0, 30: 0}, reals={36: 0.0}).replace("_20 GNS", " GNS")
FAR_GEONET = {9: 9999, 10: 12, 19: 31, 20: 23, 39: 59, 40: 60_500}  # a time after the last one that there is


@pytest.fixture
def write(tmp_path):
    def write(form, text, name=None):
        file = tmp_path / (name or FILES[form])
        file.write_text(text)
        return file

    return write


def instrument(corrected=True):
    """A GeoNet file of three components, each with twice the samples of the one before."""
    return "".join(geonet(name, [each * 2**k for each in SAMPLES], corrected=corrected) for k, name in enumerate(NAMES))


@pytest.mark.parametrize(
    ("form", "text", "unit", "dt"),
    [
        ("ESM", esm(), 0.01, 0.005),
        ("COSMOS", cosmos(), 0.01, 0.005),
        ("GeoNet", geonet(), MM, 0.005),
        ("GeoNet", geonet(corrected=False), MM, 0.005),
    ],
)
def test_samples_and_peak(write, form, text, unit, dt):
    file = write(form, text)
    motion = rf.read_motion(file)
    assert motion.acceleration == pytest.approx([unit * each for each in SAMPLES], rel=1e-15)
    assert motion.metadata.stated_pga == pytest.approx(motion.pga, rel=1e-12)
    assert (motion.dt, motion.name) == (dt, file.stem)


def test_samples_of_knet_are_counts_times_the_scale_without_their_mean(write):
    motion = rf.read_motion(write("K-NET", knet(), "MYG0020601182325.NS"))
    assert motion.acceleration == pytest.approx((np.array(COUNTS) - 8000.0) * GAL / 100.0, rel=1e-12, abs=1e-15)
    assert motion.pga == pytest.approx(motion.metadata.stated_pga, abs=5e-6)
    assert (motion.dt, motion.name) == (0.1, "MYG0020601182325-NS")
    # By the haversine formula, on a sphere of 6371 km.
    north, east, other, away = np.radians([37.798, 142.2, 38.7262, 141.5109])
    chord = np.sin((other - north) / 2) ** 2 + np.cos(north) * np.cos(other) * np.sin((away - east) / 2) ** 2
    assert motion.metadata.epicentral_km == pytest.approx(2 * 6371 * np.arcsin(np.sqrt(chord)), abs=1e-3)


def way(component, direction, azimuth, **more):
    return {"component": component, "direction": direction, "azimuth": azimuth, **more}


def scale(magnitude, kind):
    return {"magnitude": magnitude, "magnitude_type": kind}


def unknown(names):
    return dict.fromkeys(names.split())


@pytest.mark.parametrize(
    ("form", "text", "facts"),
    [
        # The recording time of K-NET's header is 15 s late.
        ("K-NET", knet(), {
            "event": "2006-01-18 23:25", "year": 2006, "station": "MYG002", "network": "NIED", **scale(5.7, "MJMA"),
            "location": None, "start_time": "2006-01-18T23:25:31+09:00", "source": "MYG0020601182325.txt",
            "source_format": "K-NET", "processing": "mean subtracted",
        }),
        ("ESM", esm(), {
            "event": "CENTRAL_ITALY 2016-10-30 06:40", "year": 2016, "network": "IT", "station": "NRC",
            "location": "00", "vs30": 498.0, "epicentral_km": 4.6, "start_time": "2016-10-30T06:40:13.250+00:00",
            "source_format": "ESM", "processing": None, **scale(6.5, "Mw"), **way("HNE", "horizontal", 90.0),
        }),
        ("COSMOS", cosmos(), {
            "event": "Fontana, Wed Jan 15, 2014 01:35 PST", "year": 2014, "network": "CE", "station": "13921",
            "epicentral_km": 21.5, "vs30": 360.0, "start_time": "2014-01-15T09:35:12.250+00:00",
            "source_format": "COSMOS", **scale(4.4, "Mw"), **way("090", "horizontal", 90.0),
        }),
        ("GeoNet", geonet(), {
            "event": "2019-03-05 07:09", "year": 2019, "network": "NZ", "station": "MADE", "location": "20",
            "epicentral_km": 21.0, "start_time": "2019-03-05T07:08:59.125+00:00", "processing": None,
            "source": "20190305_070859_MADE_20.V2A", "source_format": "GeoNet", **scale(5.4, "ML"),
        }),
        *(
            ("K-NET", knet(code, maximum="Max Acc. (gal)"), way(*found, location=place, source_format=source))
            for codes, place, source in (
                (("N-S", "E-W", "U-D"), None, "K-NET"), ("123", "borehole", "KiK-net"), ("456", "surface", "KiK-net"),
            )
            for code, found in zip(
                codes, (("N-S", "horizontal", 0.0), ("E-W", "horizontal", 90.0), ("U-D", "vertical", None)), strict=True
            )
        ),
        ("COSMOS", cosmos(1), way("001", "horizontal", 1.0)),
        ("COSMOS", cosmos(360), way("360", "horizontal", 360.0)),
        ("COSMOS", cosmos(400), way("UP", "vertical", None)),
        ("COSMOS", cosmos(401), way("DOWN", "down", None)),
        ("COSMOS", cosmos(402), way("VERT", "vertical", None)),
        ("COSMOS", cosmos(500), way("RADL", "horizontal", None)),
        ("COSMOS", cosmos(601), way("TANG", "horizontal", None)),
        ("COSMOS", cosmos(701), way("H2", "horizontal", None)),
        ("COSMOS", cosmos(2000), way("2000", None, None)),
        ("COSMOS", cosmos(123, **NO_CODE), way("123", "horizontal", 123.0)),
        ("COSMOS", cosmos(123, **NO_CODE).replace("123 deg", "Up"), {"direction": "vertical"}),
        ("COSMOS", cosmos(123, **NO_CODE).replace("123 deg", "?"), {"direction": None}),
        ("GeoNet", geonet(), way("N76E", "horizontal", 76.0)),
        ("GeoNet", geonet("N"), way("N", "horizontal", 0.0)),
        ("GeoNet", geonet("S14E"), way("S14E", "horizontal", 166.0)),
        ("GeoNet", geonet("N 14 W"), way("N 14 W", "horizontal", 346.0)),
        ("GeoNet", geonet("Up"), way("Up", "vertical", None)),
        ("GeoNet", geonet("Down"), way("Down", "down", None)),
        ("GeoNet", geonet("?"), way("?", None, None)),
        ("GeoNet", geonet(reals={15: 5.4, 16: 5.5, 17: 5.6, 18: 5.7}), scale(5.6, "Mw")),
        ("GeoNet", geonet(reals={15: 5.4, 16: 5.5}), scale(5.4, "ML")),
        ("GeoNet", geonet(reals={15: 0.0, 16: 5.5, 18: 5.7}), scale(5.5, "Ms")),
        ("GeoNet", geonet(reals={15: 0.0, 18: 5.7}), scale(5.7, "mb")),
        ("GeoNet", geonet(reals={15: 0.0}), scale(None, None)),
        ("COSMOS", cosmos(reals={4: 760.0, 13: -999.0, 15: 4.1}), {"vs30": 760.0, **scale(4.1, "ML")}),
        ("ESM", esm(MAGNITUDE_W="", MAGNITUDE_L=""), scale(None, None)),
        ("ESM", esm(EVENT_NAME="None", **EMPTY_ESM), {
            "event": "EMSC-20161030_0000029", **scale(6.1, "ML"),
            **unknown("vs30 epicentral_km year location start_time stated_pga"),
        }),
        ("K-NET", BARE_KNET.replace("5.7", "-- "), unknown("epicentral_km start_time magnitude")),
        ("COSMOS", cosmos(reals=dict.fromkeys((4, 13, 17, 30, 64), -999.0)),
         unknown("vs30 magnitude epicentral_km start_time stated_pga")),
        ("GeoNet", BARE_GEONET,
         {"station": "MADE", **unknown("event year epicentral_km start_time stated_pga location")}),
        ("GeoNet", geonet(integers={32: 40}), unknown("start_time")),
        ("GeoNet", geonet(integers={40: -1}), unknown("start_time")),
        ("GeoNet", geonet(integers=FAR_GEONET), unknown("start_time")),
    ],
)  # fmt: skip
def test_facts_of_headers(write, form, text, facts):
    info = rf.read_motion(write(form, text)).metadata
    assert {name: getattr(info, name) for name in facts} == facts


@pytest.mark.parametrize(
    ("form", "text", "message"),
    [
        ("K-NET", knet(scale="0(gal)/6182761", peak=1.0), r'as "3920\(gal\)/6182761", but it is .0\(gal\)/6182761'),
        ("K-NET", knet(scale="2(gal)/0", peak=1.0), r'expected as "3920\(gal\)/6182761"'),
        ("K-NET", knet(rate=0, duration=1.0), "a sampling frequency and a duration are expected .*'0Hz'"),
        ("K-NET", knet(duration=3.0), "is truncated: its header says 3 s at 10 Hz, but 10 values"),
        ("K-NET", knet(counts=[1] * 25, duration=1.0, peak=1.0), "too many values: its header says 1 s at 10 Hz"),
        ("K-NET", knet(counts=[1, 2], peak=3.2e-4), "at least 3 samples, but 2"),
        ("K-NET", knet().replace("8120", "81x0"), "line 18: expected a finite number, but found '81x0'"),
        (
            "K-NET",
            knet().replace("Dir.", "D.  ").replace("Scale Factor", "Scale fact. "),
            r"'Dir\.', 'Scale Factor' is",
        ),
        ("K-NET", knet(peak=1.0), r"PGA of 0\.01 m/s², .* reach 0\.00152165 m/s² \(mean subtracted\)"),
        ("ESM", esm(SAMPLING_INTERVAL_S="0"), "positive SAMPLING_INTERVAL_S and NDATA .* they are '0' and '8'"),
        ("ESM", esm(NDATA=""), "a positive SAMPLING_INTERVAL_S and NDATA"),
        ("ESM", esm(NDATA="9"), "is truncated: its header says NDATA = 9, but 8 values follow"),
        ("ESM", esm(NDATA="7"), "contains too many values: its header says NDATA = 7"),
        ("ESM", esm(DATA_TYPE="VELOCITY"), "an acceleration is expected, but DATA_TYPE is 'VELOCITY'"),
        ("ESM", esm(UNITS="cm/s"), r"UNITS is 'cm/s', but an acceleration is expected, such as cm/s\^2"),
        ("ESM", esm(UNITS=""), "UNITS is ''"),
        ("ESM", esm().replace("USER5: \n0.000000", "USER5: \nx"), "line 31: expected a finite number, but found 'x'"),
        ("ESM", esm().replace("USER5: \n0.000000", "USER5: \n0,5"), r"line 31: .* found '0,5'\. Write decimals with"),
        ("ESM", "\n".join(esm().splitlines()[:30]), "is truncated: .* but 0 values follow"),
        ("COSMOS", cosmos(kind="velocity"), "is a COSMOS file without a series of acceleration"),
        ("COSMOS", cosmos(integers={3: 5}), "unit of the acceleration is not known: code 5 in place 3"),
        ("COSMOS", cosmos(integers={3: -999}, units="furlongs"), "acceleration is not known: code None"),
        (
            "COSMOS",
            cosmos(samples=RAW, form=(10, "I8"), integers={3: 50}),
            r"raw counts \(line 49: .*\), which need scaling, .* \(places 22 and 42\)",
        ),
        ("COSMOS", cosmos(reals={62: -999.0}), "no positive time step is stated in place 62 of the real header"),
        ("COSMOS", cosmos(reals={62: 50.0}), "a length of 0.04 s, but 8 samples at steps of 0.05 s last 0.4 s"),
        ("COSMOS", cosmos().replace("Format=(8F10.3)", ""), "line 49: a format of numbers is expected"),
        ("COSMOS", cosmos().replace("   12.125 ", "   12.x25 "), "line 50: .* but found '12.x25'"),
        (
            "COSMOS",
            cosmos().replace("       8 acc", "       9 acc"),
            "line 51: 1 accelerations are expected, .* 10 char",
        ),
        ("COSMOS", cosmos()[:2500], "truncated: 100 values of the real-header are announced, in lines 26 to 45"),
        ("GeoNet", geonet(integers={34: 0}), "line 20: the numbers of .* columns 4 to 6, but they are 0, 8, 8"),
        ("GeoNet", geonet(integers={36: -1}), "line 20: the numbers of .* but they are 8, 8, -1"),
        ("GeoNet", geonet(reals={26: 0.0}), "line 23: a positive time step in s is expected in column 6, but it is 0"),
        ("GeoNet", geonet().replace("Component N76E", "Data"), "line 13: a direction is expected, .* found 'Data'"),
        ("GeoNet", geonet().replace("12.125  -8.000", "12.x25  -8.000"), "line 27: .* but found '12.x25'"),
        ("GeoNet", geonet().replace("  -8.000", ""), "line 27: 8 accelerations are expected, .* of 8 .* found 7"),
        ("GeoNet", geonet().replace("   1.250", "   1.250" * 2), "line 27: 8 accelerations are expected, .* found 9"),
        ("GeoNet", geonet(integers={35: 11}), "truncated: 8 displacements are announced, in lines 30 to 30"),
        ("GeoNet", geonet(integers={34: 99_999_999}), "truncated: 99999999 accelerations .* in lines 27 to 10000026"),
        ("GeoNet", geonet() + "0.0\n", "line 30: the next component is expected, .* but found '0.0'"),
        ("GeoNet", geonet(integers={35: 0}) + geonet(), "line 29: the next component is expected"),
        ("GeoNet", "\n".join(geonet().splitlines()[:12]), "line 13: a direction is expected"),
        ("GeoNet", "\n".join(geonet().splitlines()[:18]), "truncated: 40 integers of the header .* in lines 17"),
        ("GeoNet", geonet(reals={36: 20.0}), r"states a PGA of 0\.02 m/s², but the samples reach 0\.012125"),
        ("GeoNet", geonet(samples=[0.0, 60000.0, 0.0], digits=1), r"60000 mm/s2, above 5 g\..*states mm/s²: download"),
    ],
)
def test_refuses(write, form, text, message):
    with pytest.raises(rf.InputError, match=message) as caught:
        rf.read_components(write(form, text))
    assert FILES[form] in str(caught.value)


@pytest.mark.parametrize("form", FILES)
def test_a_stated_unit_and_step_are_not_replaced(write, form):
    file = write(form, WRITERS[form]())
    with pytest.raises(rf.InputError, match=f"in the {form} format, which states its unit, but units='g'") as caught:
        rf.read_motion(file, units="g")
    assert caught.value.field == "units"
    with pytest.raises(rf.InputError, match=r"states DT = 0\.\d* s, but dt=0\.2 was given") as caught:
        rf.read_motion(file, dt=0.2)
    assert caught.value.field == "dt"
    # In a folder they are those of the other files.
    (file.parent / "lab.txt").write_text("0\n0.1\n0\n")
    assert len(rf.read_suite(file.parent, units="g", dt=0.01)) == 2


@pytest.mark.parametrize(("form", "scale"), [("COSMOS", 0.01), ("GeoNet", MM)])
def test_numbers_without_blanks_between_them(write, form, scale):
    samples = [-234.125, -345.25, -111.5, 0.0]
    file = write(form, cosmos(samples=samples, form=(4, "F8.3")) if form == "COSMOS" else geonet(samples=samples))
    assert rf.read_motion(file).acceleration == pytest.approx([scale * each for each in samples], rel=1e-15)
    last = list(range(10))  # the last line of GeoNet is full
    assert rf.read_motion(write(form, WRITERS[form](samples=last))).acceleration.size == 10


@pytest.mark.parametrize(
    ("form", "text", "names"),
    [
        ("COSMOS", cosmos(90, channel=1) + cosmos(90, channel=2), ["090-1", "090-2"]),
        ("GeoNet", geonet() + "\n" + geonet(), ["N76E-1", "N76E-2"]),
    ],
)
def test_components_of_one_direction_are_told_apart(write, form, text, names):
    assert [motion.name for motion in rf.read_components(write(form, text, "a.v2"))] == [f"a-{name}" for name in names]


def test_stations_of_knet(write, tmp_path):
    for suffix, direction in (("NS", "N-S"), ("EW", "E-W"), ("UD", "U-D")):
        write("K-NET", knet(direction), f"MYG0020601182325.{suffix}")
    with pytest.warns(rf.RecordWarning, match=r"^Left out: 1 vertical component, MYG0020601182325-UD\.UD\.$"):
        assert rf.read_suite(tmp_path).names == ("MYG0020601182325-EW", "MYG0020601182325-NS")
    suite = rf.read_suite(tmp_path, vertical="pair")
    assert all(np.array_equal(motion.vertical, motion.acceleration) for motion in suite)
    (station,) = rf.group_stations(suite)
    assert station.name == "NIED MYG002 2006-01-18 23:25"
    assert [motion.metadata.azimuth for motion in station.pair] == [90.0, 0.0]
    assert station.vertical is not None


def test_boreholes_are_left_out_beneath_the_surface(write, tmp_path):
    for k, suffix in enumerate(("NS1", "EW1", "UD1", "NS2", "EW2", "UD2"), 1):
        write("K-NET", knet(str(k), station="TCGH13"), f"TCGH130007210339.{suffix}")
    with pytest.warns(
        rf.RecordWarning, match=r"^Left out: 3 borehole components .*, TCGH130007210339-EW1.EW1, "
    ) as told:
        suite = rf.read_suite(tmp_path, vertical="pair")
    assert len(told) == 1
    assert suite.names == ("TCGH130007210339-EW2", "TCGH130007210339-NS2")
    assert [motion.metadata.vertical_source for motion in suite] == ["TCGH130007210339-UD2"] * 2
    alone = rf.read_suite([tmp_path / f"TCGH130007210339.{suffix}" for suffix in ("NS1", "EW1")])
    assert {motion.metadata.location for motion in alone} == {"borehole"}
    both = rf.group_stations(rf.read_motion(file) for file in sorted(tmp_path.iterdir()))
    assert [(each.name, len(each.horizontal)) for each in both] == [
        (f"NIED TCGH13 {place} 2006-01-18 23:25", 2) for place in ("borehole", "surface")
    ]


def test_the_file_of_obspy():
    obspy = load_obspy()
    source = Path(obspy.__file__).parent / "io" / "nied" / "tests" / "data" / "test.knet"
    if not source.exists():
        pytest.skip("ObsPy is installed without its test files")
    motion = rf.read_motion(source)
    assert (motion.acceleration.size, motion.dt, motion.metadata.station) == (5900, 0.01, "AKT013")
    assert motion.metadata.stated_pga == pytest.approx(0.04383)  # 4.383 gal
    assert motion.pga == pytest.approx(0.04383, abs=5e-6)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        trace = obspy.read(str(source))[0]
    expected = trace.data * trace.stats.calib
    assert motion.acceleration == pytest.approx(expected - expected.mean(), abs=1e-12)


def test_stations_of_esm(write, tmp_path):
    for stream in ("HNE", "HNN", "HNZ"):
        write("ESM", esm(stream=stream), f"IT.NRC.00.{stream}.D.20161030.064018.C.ACC.ASC")
    suite = rf.read_suite(tmp_path, vertical="pair")
    assert [motion.metadata.azimuth for motion in suite] == [90.0, 0.0]
    assert all(motion.vertical is not None for motion in suite)
    (station,) = rf.group_stations(suite)
    assert (station.name, len(station.pair)) == ("IT NRC 00 CENTRAL_ITALY 2016-10-30 06:40", 2)


def test_channels_of_cosmos_with_velocities_between_them(write):
    text = "".join(
        cosmos(code, [each * (k + 1) for each in SAMPLES], channel=k)
        + cosmos(code, channel=k, kind="velocity", first="Velocity data", units="cm/sec(05)")
        for code, k in {90: 1, 360: 2, 400: 3}.items()
    )
    file = write("COSMOS", text)
    found = rf.read_components(file)
    assert [motion.name for motion in found] == ["CE13921-090", "CE13921-360", "CE13921-UP"]
    assert [motion.pga for motion in found] == pytest.approx([0.2425, 0.36375, 0.485])
    assert rf.read_motion(file, component="90").name == "CE13921-090"
    assert rf.read_motion(file, component="0").name == "CE13921-360"
    assert rf.read_motion(file, component="up").metadata.is_vertical
    assert rf.read_motion(file, component="CE13921-090", vertical=file).pva == pytest.approx(0.485)
    for component, message in (
        (None, r"holds 3 components: '090', '360', 'UP' \(vertical\)\. Name one: .*component='090'\)"),
        ("45", r"holds no components named '45'\. It holds '090', '360'"),
        (90, "component must be"),
    ):
        with pytest.raises(rf.InputError, match=message) as caught:
            rf.read_motion(file, component=component)
        assert caught.value.field == "component"
    suite = rf.read_suite([file], vertical="pair")
    assert suite.names == ("CE13921-090", "CE13921-360")
    assert [motion.metadata.vertical_source for motion in suite] == ["CE13921-UP"] * 2
    with pytest.warns(rf.RecordWarning, match=r"Left out: 1 vertical component, CE13921-UP\.V2c"):
        rf.read_suite([file])
    assert len(rf.group_stations(found)) == 1
    series = cosmos()[cosmos().index("       8 acceleration") :].replace("acceleration", "velocity")
    assert len(rf.read_components(write("COSMOS", cosmos() + series))) == 1  # without headers of its own


def test_sensors_of_cosmos_at_several_places_of_a_structure(write):
    text = "".join(
        cosmos(code, channel=k).replace(f"(Rcrdr Chan  {k})", f"(Rcrdr Chan  {k}) Location: {place}")
        for k, (code, place) in enumerate([(90, "Base"), (360, "Base"), (90, "Roof"), (360, "Roof")], 1)
    )
    found = rf.group_stations(rf.read_components(write("COSMOS", text)))
    assert [(each.name.split()[2], len(each.pair)) for each in found] == [("Base", 2), ("Roof", 2)]


@pytest.mark.parametrize("form", [(8, "F10.3"), (1, "E15.6"), (5, "F15.6"), (3, "F8.3")])
def test_formats_of_numbers_in_cosmos(write, form):
    motion = rf.read_motion(write("COSMOS", cosmos(form=form)))
    assert motion.acceleration == pytest.approx([0.01 * each for each in SAMPLES], rel=1e-12)


@pytest.mark.parametrize(
    ("code", "units", "factor"),
    [
        (2, "g", 9.81),
        (4, "cm/sec2", 0.01),
        (7, "in/sec2", 0.0254),
        (10, "gal", 0.01),
        (11, "mg", 9.81e-3),
        (12, "micro g", 9.81e-6),  # which the line need not say in words that are known
        (-999, "cm/sec2", 0.01),  # only the line of the series states it
    ],
)
def test_units_of_cosmos(write, code, units, factor):
    samples = [0.0, 0.25, -0.5, 0.125]
    motion = rf.read_motion(write("COSMOS", cosmos(samples=samples, integers={3: code}, units=f"{units}({code:02d})")))
    assert motion.acceleration == pytest.approx(np.array(samples) * factor)
    assert motion.metadata.stated_pga == pytest.approx(0.5 * factor)


def test_raw_counts_of_cosmos(write):
    recorder = {"integers": {1: 0, 3: 50}, "reals": {22: 0.298023, 42: 0.627}}
    raw = cosmos(samples=RAW, form=(10, "I8"), units="counts (50)", first="Raw acceleration counts", **recorder)
    motion = rf.read_motion(write("COSMOS", raw))
    # microvolts a count over volts a g
    expected = (np.array(RAW) - np.mean(RAW)) * 0.298023e-6 / 0.627 * 9.81
    assert motion.acceleration == pytest.approx(expected, rel=1e-12)
    assert (motion.metadata.stated_pga, motion.metadata.processing) == (None, "uncorrected; mean subtracted")


@pytest.mark.parametrize("reals", [{62: -999.0, 34: 0.005}, {63: -999.0}])
def test_other_places_of_the_step_in_cosmos(write, reals):
    assert rf.read_motion(write("COSMOS", cosmos(reals=reals))).dt == 0.005


@pytest.mark.parametrize("corrected", [True, False])
def test_components_of_geonet(write, corrected):
    # The name of the file ends as that of a vertical component does.
    file = write("GeoNet", instrument(corrected), "20190305_070859_V.V2A")
    found = rf.read_components(file)
    assert [motion.name for motion in found] == [f"20190305_070859_V-{name}" for name in NAMES]
    assert [motion.pga for motion in found] == pytest.approx([MM * 12.125 * 2**k for k in range(3)])
    both = rf.read_motion(file, component="s14e", vertical=file)
    assert both.pva == pytest.approx(MM * 48.5)
    assert rf.read_motion(file, component="166").name == both.name
    with pytest.raises(rf.InputError, match=r"holds 3 components: 'N76E', 'S14E', 'Up' \(vertical\)\. Name one: "):
        rf.read_motion(file)


def test_a_folder_of_geonet_is_known_by_first_lines(write, tmp_path):
    write("GeoNet", instrument())
    other = instrument(corrected=False).replace("MADE_20", "MADE_21")
    write("GeoNet", other, "20190305_070859_MADE_21.V1A")
    suite = rf.read_suite(tmp_path, vertical="pair")
    assert [motion.metadata.component for motion in suite] == ["N76E", "S14E"] * 2
    assert all(motion.vertical is not None for motion in suite)
    assert [(each.name, len(each.pair)) for each in rf.group_stations(suite)] == [
        (f"NZ MADE {location} 2019-03-05 07:09", 2) for location in ("20", "21")
    ]


def test_a_file_of_another_network_is_not_of_geonet(write):
    # Older files of CSMIP begin with the same words, and have no site in the second line.
    with pytest.raises(rf.InputError) as caught:
        rf.read_motion(write("GeoNet", geonet().replace("Site MADE", "Rcrd of")), units="g", dt=0.01)
    assert "GeoNet" not in str(caught.value)


def test_every_cut_between_lines_of_geonet_is_noticed(write):
    """A file is never read in part: only whole components may be missing at its end."""
    lines, whole = instrument().splitlines(), len(geonet().splitlines())
    for n in range(2, len(lines)):
        file = write("GeoNet", "\n".join(lines[:n]) + "\n")
        if n % whole == 0:
            assert len(rf.read_components(file)) == n // whole
        else:
            with pytest.raises(rf.InputError, match="MADE_20"):
                rf.read_components(file)
