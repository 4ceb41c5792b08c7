"""COSMOS files, written from the published format (version 1.20)."""

import numpy as np
import pytest

import rockflex as rf
from record_samples import SAMPLES, cosmos

THREE = {90: 1, 360: 2, 400: 3}


def write(folder, text, name="CE13921.V2c"):
    (folder / name).write_text(text)
    return folder / name


def test_one_channel(tmp_path):
    motion = rf.read_motion(write(tmp_path, cosmos()))
    assert motion.acceleration == pytest.approx([0.01 * each for each in SAMPLES], rel=1e-15)
    assert motion.pga == pytest.approx(motion.metadata.stated_pga, rel=1e-12)
    assert (motion.dt, motion.name) == (0.005, "CE13921")


def test_header(tmp_path):
    info = rf.read_motion(write(tmp_path, cosmos())).metadata
    assert (info.event, info.year, info.magnitude, info.magnitude_type) == (
        "Fontana, Wed Jan 15, 2014 01:35 PST",
        2014,
        4.4,
        "Mw",
    )
    assert (info.network, info.station, info.epicentral_km, info.vs30) == ("CE", "13921", 21.5, 360.0)
    assert (info.component, info.direction, info.azimuth) == ("090", "horizontal", 90.0)
    assert (info.start_time, info.source_format) == ("2014-01-15T09:35:12.250+00:00", "COSMOS")


@pytest.mark.parametrize(
    ("code", "component", "direction", "azimuth"),
    [
        (1, "001", "horizontal", 1.0),
        (360, "360", "horizontal", 360.0),
        (400, "UP", "vertical", None),
        (401, "DOWN", "down", None),
        (402, "VERT", "vertical", None),
        (500, "RADL", "horizontal", None),
        (601, "TANG", "horizontal", None),
        (701, "H2", "horizontal", None),
        (2000, "2000", None, None),
    ],
)
def test_directions(tmp_path, code, component, direction, azimuth):
    info = rf.read_motion(write(tmp_path, cosmos(code))).metadata
    assert (info.component, info.direction, info.azimuth) == (component, direction, azimuth)


def test_a_direction_that_only_the_text_states(tmp_path):
    info = rf.read_motion(write(tmp_path, cosmos(123, integers={54: -999}))).metadata
    assert (info.component, info.azimuth) == ("123", 123.0)
    up = cosmos(123, integers={54: -999}).replace("123 deg", "Up")
    assert rf.read_motion(write(tmp_path, up)).metadata.direction == "vertical"
    none = cosmos(123, integers={54: -999}).replace("123 deg", "?")
    assert rf.read_motion(write(tmp_path, none)).metadata.direction is None


def test_three_channels_with_velocities_between_them(tmp_path):
    text = "".join(
        cosmos(code, [each * (k + 1) for each in SAMPLES], channel=k)
        + cosmos(code, channel=k, kind="velocity", first="Velocity data", units="cm/sec(05)")
        for code, k in THREE.items()
    )
    file = write(tmp_path, text)
    found = rf.read_components(file)
    assert [motion.name for motion in found] == ["CE13921-090", "CE13921-360", "CE13921-UP"]
    assert [motion.pga for motion in found] == pytest.approx([0.2425, 0.36375, 0.485])
    assert rf.read_motion(file, component="90").name == "CE13921-090"
    assert rf.read_motion(file, component="0").name == "CE13921-360"
    assert rf.read_motion(file, component="up").metadata.is_vertical
    both = rf.read_motion(file, component="CE13921-090", vertical=file)
    assert both.pva == pytest.approx(0.485)
    with pytest.raises(
        rf.InputError, match=r"holds 3 components: '090', '360', 'UP' \(vertical\)\. Name one: .*component='090'\)"
    ) as caught:
        rf.read_motion(file)
    assert caught.value.field == "component"
    with pytest.raises(rf.InputError, match=r"holds no components named '45'\. It holds '090', '360'"):
        rf.read_motion(file, component="45")
    with pytest.raises(rf.InputError, match="component must be"):
        rf.read_motion(file, component=90)
    suite = rf.read_suite([file], vertical="pair")
    assert suite.names == ("CE13921-090", "CE13921-360")
    assert [motion.metadata.vertical_source for motion in suite] == ["CE13921-UP"] * 2
    with pytest.warns(rf.RecordWarning, match=r"Left out: 1 vertical component, CE13921-UP\.V2c"):
        rf.read_suite([file])
    assert len(rf.group_stations(found)) == 1


def test_sensors_at_several_places_of_a_structure(tmp_path):
    text = "".join(
        cosmos(code, channel=k).replace(f"(Rcrdr Chan  {k})", f"(Rcrdr Chan  {k}) Location: {place}")
        for k, (code, place) in enumerate([(90, "Base"), (360, "Base"), (90, "Roof"), (360, "Roof")], 1)
    )
    found = rf.group_stations(rf.read_components(write(tmp_path, text)))
    assert [(each.name.split()[2], len(each.pair)) for each in found] == [("Base", 2), ("Roof", 2)]


def test_a_velocity_block_without_headers_of_its_own(tmp_path):
    text = cosmos()
    series = text[text.index("       8 acceleration") :].replace("acceleration", "velocity")
    assert len(rf.read_components(write(tmp_path, text + series))) == 1


def test_channels_of_one_direction_are_told_apart(tmp_path):
    found = rf.read_components(write(tmp_path, cosmos(90, channel=1) + cosmos(90, channel=2)))
    assert [motion.name for motion in found] == ["CE13921-090-1", "CE13921-090-2"]


@pytest.mark.parametrize("form", [(8, "F10.3"), (1, "E15.6"), (5, "F15.6"), (3, "F8.3")])
def test_formats_of_numbers(tmp_path, form):
    motion = rf.read_motion(write(tmp_path, cosmos(form=form)))
    assert motion.acceleration == pytest.approx([0.01 * each for each in SAMPLES], rel=1e-12)


def test_numbers_without_blanks_between_them(tmp_path):
    samples = [-1234.125, -2345.25, -1111.5, 0.0]
    motion = rf.read_motion(write(tmp_path, cosmos(samples=samples, form=(4, "F9.3"))))
    assert motion.acceleration == pytest.approx([0.01 * each for each in samples])


@pytest.mark.parametrize(
    ("code", "factor"), [(2, 9.81), (4, 0.01), (7, 0.0254), (10, 0.01), (11, 9.81e-3), (12, 9.81e-6)]
)
def test_units(tmp_path, code, factor):
    samples = [0.0, 0.25, -0.5, 0.125]
    motion = rf.read_motion(write(tmp_path, cosmos(samples=samples, integers={3: code})))
    assert motion.acceleration == pytest.approx(np.array(samples) * factor)
    assert motion.metadata.stated_pga == pytest.approx(0.5 * factor)


def test_the_unit_of_the_line_where_the_header_has_none(tmp_path):
    assert rf.read_motion(write(tmp_path, cosmos(integers={3: -999}))).pga == pytest.approx(0.12125)


def test_raw_counts(tmp_path):
    counts = [3284, 3334, 3296, 3284, 3308, 3242, 3236, 3324]
    recorder = {"integers": {1: 0, 3: 50}, "reals": {22: 0.298023, 42: 0.627}}
    raw = cosmos(samples=counts, form=(10, "I8"), units="counts (50)", first="Raw acceleration counts", **recorder)
    motion = rf.read_motion(write(tmp_path, raw, "a.V0"))
    # microvolts a count over volts a g
    expected = (np.array(counts) - np.mean(counts)) * 0.298023e-6 / 0.627 * 9.81
    assert motion.acceleration == pytest.approx(expected, rel=1e-12)
    assert (motion.metadata.stated_pga, motion.metadata.processing) == (None, "mean subtracted")
    unknown = cosmos(samples=counts, form=(10, "I8"), integers={3: 50})
    with pytest.raises(rf.InputError, match=r"raw counts, .* one count \(places 22 and 42\)\. Download the corr"):
        rf.read_motion(write(tmp_path, unknown, "b.V0"))


def test_other_places_of_the_headers(tmp_path):
    info = rf.read_motion(write(tmp_path, cosmos(reals={4: 760.0, 13: -999.0, 15: 4.1}))).metadata
    assert (info.vs30, info.magnitude, info.magnitude_type) == (760.0, 4.1, "ML")
    bare = {4: -999.0, 13: -999.0, 17: -999.0, 30: -999.0, 64: -999.0}
    info = rf.read_motion(write(tmp_path, cosmos(reals=bare))).metadata
    assert (info.vs30, info.magnitude, info.epicentral_km, info.start_time, info.stated_pga) == (None,) * 5
    assert rf.read_motion(write(tmp_path, cosmos(reals={62: -999.0, 34: 0.005}))).dt == 0.005
    assert rf.read_motion(write(tmp_path, cosmos(reals={63: -999.0}))).dt == 0.005


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (cosmos(kind="velocity"), "is a COSMOS file without a series of acceleration"),
        (
            cosmos(integers={3: 5}),
            r"unit of the acceleration is not known: code 5 in place 3 of the int",
        ),
        (cosmos(integers={3: -999}, units="furlongs"), "unit of the acceleration is not known: code None"),
        (cosmos(reals={62: -999.0}), "no positive time step is stated in place 62 of the real header"),
        (cosmos(reals={62: 50.0}), r"states a length of 0.04 s, but 8 samples at steps of 0.05 s last 0.4 s"),
        (
            cosmos().replace("Format=(8F10.3)", ""),
            r'line 49: a format of numbers is expected, such as "Format=',
        ),
        (cosmos().replace("   12.125 ", "   12.x25 "), "line 50: expected a finite number, but found '12.x25'"),
        (
            cosmos().replace("       8 acc", "       9 acc"),
            "line 49: 9 numbers are announced, but 8 follow",
        ),
        (cosmos()[:2500], "numbers are announced, but"),
    ],
)
def test_refuses(tmp_path, text, message):
    with pytest.raises(rf.InputError, match=message) as caught:
        rf.read_motion(write(tmp_path, text))
    assert "CE13921.V2c" in str(caught.value)


def test_refuses_units(tmp_path):
    with pytest.raises(rf.InputError, match="a file in the COSMOS format, which states its unit, but units='g'"):
        rf.read_motion(write(tmp_path, cosmos()), units="g")
