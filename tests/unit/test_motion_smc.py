"""Files in the SMC format of the U.S. Geological Survey."""

import pytest

import rockflex as rf
from record_samples import SAMPLES, smc


@pytest.fixture
def write(tmp_path):
    def write(text, name="0111a.smc"):
        file = tmp_path / name
        file.write_text(text)
        return file

    return write


def test_samples_without_blanks_between_them(write):
    assert "1.2125E+1-8.0000E+0" in smc()
    motion = rf.read_motion(write(smc()))
    assert motion.acceleration == pytest.approx([0.01 * each for each in SAMPLES], rel=1e-12)
    info = motion.metadata
    assert (motion.dt, info.stated_pga, info.processing) == (0.005, pytest.approx(0.12125), None)
    assert (info.event, info.year) == ("Loma Prieta, CA, 1989-10-18 00:04", 1989)
    assert (info.station, info.network, info.epicentral_km) == ("SAF0A", "US", 89.0)
    assert (info.magnitude, info.magnitude_type, info.source_format) == (7.1, "Mw", "SMC")
    assert [str(each) for each in info.findings][:2] == [
        'quantity: acceleration (line 1: "2 CORRECTED ACCELEROGRAM")',
        "unit: cm/s2 (format SMC)",
    ]
    down = rf.read_motion(write(smc([-each for each in SAMPLES])))
    assert down.metadata.stated_pga == pytest.approx(down.pga)
    assert rf.read_motion(write(smc(first="1 UNCORRECTED ACCELEROGRAM"))).metadata.processing == "uncorrected"


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        (smc(), ("360", "horizontal", 360.0)),
        (smc(component="UP", integers={13: 0, 14: 0}), ("UP", "vertical", None)),
        (smc(component="VERT", integers={13: -32768}), ("VERT", "vertical", None)),
        (smc(component="DOWN", integers={13: 180}), ("DOWN", "down", None)),
        (smc(component="", integers={13: 0}), ("UP", "vertical", None)),
        (smc(component="", integers={14: 45}), ("45", "horizontal", 45.0)),
        (smc(component="", integers={13: -32768}), (None, None, None)),
    ],
)
def test_components(write, text, facts):
    info = rf.read_motion(write(text)).metadata
    assert (info.component, info.direction, info.azimuth) == facts


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (smc(integers={13: 0}), r"component: horizontal \(text .*360.*\), but vertical \(integers, place 13: 0\)"),
        (smc(component="UP"), "component: vertical .*, but horizontal"),
        (smc(first="3 VELOCITY"), "an acceleration is expected, but the file begins with '3 VELOCITY'"),
        (smc(first="4 DISPLACEMENT"), "'4 DISPLACEMENT'"),
        (smc(first="5 RESPONSE SPECTRA"), "'5 RESPONSE SPECTRA'"),
        (smc(reals={2: 0.0}), "frequency in Hz .* they are 8 and 0.0"),
        (smc(integers={17: -32768}), "they are None and 200"),
        (smc(integers={17: 9}), "truncated: 9 accelerations"),
        (smc(integers={17: 7}), "line 30: 7 accelerations are expected, .* found 8"),
        (smc(integers={16: 1}), "found '|A comment'|are expected"),
        (smc([*SAMPLES, 1.0], integers={17: 8}, reals={30: 12.125}), "8 samples are announced, but more follow"),
        (smc(reals={30: 50.0}), r"states a PGA of 0\.5 m/s²"),
        (smc().replace("1.2125E+1", "1.2x25E+1"), "found '1.2x25E"),
    ],
)
def test_refuses(write, text, message):
    with pytest.raises(rf.InputError, match=message):
        rf.read_motion(write(text))


def test_every_cut_between_lines_is_noticed(write):
    lines = smc([1.0] * 20).splitlines()
    for n in range(1, len(lines)):
        with pytest.raises(rf.InputError):
            rf.read_motion(write("\n".join(lines[:n])))
