"""GeoNet files, written from the format that GeoNet publishes."""

import pytest

import rockflex as rf
from record_samples import SAMPLES, geonet

MM = 1e-3  # m/s²
NAMES = ("N76E", "S14E", "Up")


def write(folder, text, name="20190305_070859_MADE_20.V2A"):
    (folder / name).write_text(text)
    return folder / name


def instrument(corrected=True):
    """A file of three components, each with twice the samples of the one before."""
    return "".join(geonet(name, [each * 2**k for each in SAMPLES], corrected=corrected) for k, name in enumerate(NAMES))


@pytest.mark.parametrize("corrected", [True, False])
def test_samples_and_peak(tmp_path, corrected):
    motion = rf.read_motion(write(tmp_path, geonet(corrected=corrected)))
    assert motion.acceleration == pytest.approx([MM * each for each in SAMPLES], rel=1e-15)
    assert motion.metadata.stated_pga == pytest.approx(motion.pga, rel=1e-12)
    assert (motion.dt, motion.name) == (0.005, "20190305_070859_MADE_20")


def test_header(tmp_path):
    info = rf.read_motion(write(tmp_path, geonet())).metadata
    assert (info.event, info.year, info.magnitude, info.magnitude_type) == ("2019-03-05 07:09", 2019, 5.4, "ML")
    assert (info.network, info.station, info.location, info.epicentral_km) == ("NZ", "MADE", "20", 21.0)
    assert (info.component, info.direction, info.azimuth) == ("N76E", "horizontal", 76.0)
    assert info.start_time == "2019-03-05T07:08:59.125+00:00"
    assert (info.source, info.source_format, info.processing) == ("20190305_070859_MADE_20.V2A", "GeoNet", None)


@pytest.mark.parametrize(
    ("component", "direction", "azimuth"),
    [
        ("N", "horizontal", 0.0),
        ("S14E", "horizontal", 166.0),
        ("N 14 W", "horizontal", 346.0),
        ("Up", "vertical", None),
        ("Down", "down", None),
        ("?", None, None),
    ],
)
def test_directions(tmp_path, component, direction, azimuth):
    info = rf.read_motion(write(tmp_path, geonet(component))).metadata
    assert (info.component, info.direction, info.azimuth) == (component, direction, azimuth)


@pytest.mark.parametrize("corrected", [True, False])
def test_three_components(tmp_path, corrected):
    # The name of the file ends as that of a vertical component does.
    file = write(tmp_path, instrument(corrected), "20190305_070859_V.V2A")
    found = rf.read_components(file)
    assert [motion.name for motion in found] == [f"20190305_070859_V-{name}" for name in NAMES]
    assert [motion.pga for motion in found] == pytest.approx([MM * 12.125 * 2**k for k in range(3)])
    both = rf.read_motion(file, component="s14e", vertical=file)
    assert both.pva == pytest.approx(MM * 48.5)
    assert rf.read_motion(file, component="166").name == both.name
    with pytest.raises(rf.InputError, match=r"holds 3 components: 'N76E', 'S14E', 'Up' \(vertical\)\. Name one: "):
        rf.read_motion(file)


def test_components_of_one_direction_are_told_apart(tmp_path):
    found = rf.read_components(write(tmp_path, geonet() + "\n" + geonet(), "a.v2a"))
    assert [motion.name for motion in found] == ["a-N76E-1", "a-N76E-2"]


def test_a_folder_finds_them_by_their_first_lines(tmp_path):
    write(tmp_path, instrument())
    write(tmp_path, instrument(corrected=False).replace("MADE_20", "MADE_21"), "20190305_070859_MADE_21.V1A")
    suite = rf.read_suite(tmp_path, vertical="pair")
    assert [motion.metadata.component for motion in suite] == ["N76E", "S14E"] * 2
    assert all(motion.vertical is not None for motion in suite)
    assert [(each.name, len(each.pair)) for each in rf.group_stations(suite)] == [
        (f"NZ MADE {location} 2019-03-05 07:09", 2) for location in ("20", "21")
    ]


def test_numbers_without_blanks_between_them(tmp_path):
    samples = [-234.125, -345.25, -111.5, 0.0]
    motion = rf.read_motion(write(tmp_path, geonet(samples=samples)))
    assert motion.acceleration.tolist() == [each * MM for each in samples]
    last = list(range(10))  # the last line is full
    assert rf.read_motion(write(tmp_path, geonet(samples=last))).acceleration.size == 10


@pytest.mark.parametrize(
    ("reals", "magnitude", "scale"),
    [
        ({15: 5.4, 16: 5.5, 17: 5.6, 18: 5.7}, 5.6, "Mw"),
        ({15: 5.4, 16: 5.5}, 5.4, "ML"),
        ({15: 0.0, 16: 5.5, 18: 5.7}, 5.5, "Ms"),
        ({15: 0.0, 18: 5.7}, 5.7, "mb"),
        ({15: 0.0}, None, None),
    ],
)
def test_magnitudes(tmp_path, reals, magnitude, scale):
    info = rf.read_motion(write(tmp_path, geonet(reals=reals))).metadata
    assert (info.magnitude, info.magnitude_type) == (magnitude, scale)


def test_what_a_header_leaves_empty_is_unknown(tmp_path):
    bare = geonet(integers={1: 0, 9: 0, 30: 0}, reals={36: 0.0}).replace("_20 GNS", " GNS")
    info = rf.read_motion(write(tmp_path, bare)).metadata
    assert (info.event, info.year, info.epicentral_km, info.start_time, info.stated_pga) == (None,) * 5
    assert (info.location, info.station) == (None, "MADE")
    for changed in ({32: 40}, {40: -1}, {9: 9999, 10: 12, 19: 31, 20: 23, 39: 59, 40: 60_500}):
        assert rf.read_motion(write(tmp_path, geonet(integers=changed))).metadata.start_time is None


def test_a_file_of_another_network_is_none(tmp_path):
    # Older files of CSMIP begin with the same words, and have no site in the second line.
    with pytest.raises(rf.InputError) as caught:
        rf.read_motion(write(tmp_path, geonet().replace("Site MADE", "Rcrd of")), units="g", dt=0.01)
    assert "GeoNet" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (geonet(integers={34: 0}), "line 20: the numbers of accelerations, .* in columns 4 to 6, but they are 0, 8, 8"),
        (geonet(integers={36: -1}), "line 20: the numbers of .* but they are 8, 8, -1"),
        (geonet(reals={26: 0.0}), "line 23: a positive time step in s is expected in column 6, but it is 0. Down"),
        (geonet().replace("Component N76E", "Data"), "line 13: a direction is expected, .* but found 'Data'. Down"),
        (geonet().replace("12.125  -8.000", "12.x25  -8.000"), "line 27: expected a finite number, but found '12.x25'"),
        (geonet().replace("  -8.000", ""), "line 27: 8 accelerations are expected, in columns of 8 .* found 7. The"),
        (geonet().replace("   1.250", "   1.250" * 2), "line 27: 8 accelerations are expected, .* found 9"),
        (geonet(integers={35: 11}), "truncated: 8 displacements are announced, in lines 30 to 30, but there are only"),
        (geonet(integers={34: 99_999_999}), "truncated: 99999999 accelerations are announced, in lines 27 to 10000026"),
        (geonet() + "0.0\n", "line 30: the next component is expected, .* but found '0.0'. A line is missing or too m"),
        (geonet(integers={35: 0}) + geonet(), "line 29: the next component is expected"),
        ("\n".join(geonet().splitlines()[:12]), "line 13: a direction is expected"),
        ("\n".join(geonet().splitlines()[:18]), "truncated: 40 integers of the header are announced, in lines 17"),
    ],
)
def test_refuses(tmp_path, text, message):
    with pytest.raises(rf.InputError, match=message) as caught:
        rf.read_components(write(tmp_path, text))
    assert "20190305_070859_MADE_20.V2A" in str(caught.value)


def test_every_cut_between_lines_is_noticed(tmp_path):
    """A file is never read in part: only whole components may be missing at its end."""
    lines = instrument().splitlines()
    whole = len(geonet().splitlines())
    for n in range(2, len(lines)):
        file = write(tmp_path, "\n".join(lines[:n]) + "\n")
        if n % whole == 0:
            assert len(rf.read_components(file)) == n // whole
        else:
            with pytest.raises(rf.InputError, match="MADE_20"):
                rf.read_components(file)


def test_refuses_units_and_another_peak(tmp_path):
    with pytest.raises(rf.InputError, match="a file in the GeoNet format, which states its unit, but units='g'"):
        rf.read_motion(write(tmp_path, geonet()), units="g")
    with pytest.raises(rf.InputError, match=r"states DT = 0\.005 s, but dt=0\.01 was given"):
        rf.read_motion(write(tmp_path, geonet()), dt=0.01)
    with pytest.raises(rf.InputError, match=r"header states a PGA of 0\.02 m/s², but the samples reach 0\.012125"):
        rf.read_motion(write(tmp_path, geonet(reals={36: 20.0})))
    with pytest.raises(rf.InputError, match=r"60000 mm/s2, above 5 g\..*The format states mm/s²: download"):
        rf.read_motion(write(tmp_path, geonet(samples=[0.0, 60000.0, 0.0], digits=1)))
