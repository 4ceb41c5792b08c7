"""Files of California's CSMIP, old and new, and those that only look like them."""

import numpy as np
import pytest

import rockflex as rf
from record_samples import SAMPLES, csmip

G = 9.81
SMALL = [0.0, 0.00125, -0.0035, 0.012125, -0.008, 0.0005, 0.00025, 0.0, 0.0001]  # g
NEW_V1 = "{n} Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)"
NEW_V2 = "{n} points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.3)"
OLD_RAW = "{n} POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.  (UNITS: G)"
TIMES = [0.005 * k for k in range(len(SAMPLES))]


def v1(samples=SMALL, component="90 DEG", **changed):
    options = {"volume": 1, "data_line": OLD_RAW, "width": 9, "digits": 6, "peak": ".012 G"} | changed
    return csmip(component, samples, **options)


@pytest.fixture
def write(tmp_path):
    def write(text, name="CE36456.V2"):
        file = tmp_path / name
        file.write_text(text.replace("\n", "\r\n"))
        return file

    return write


@pytest.mark.parametrize(
    ("text", "samples", "unit", "processing"),
    [
        (csmip(), SAMPLES, 0.01, None),
        (csmip(data_line=NEW_V2).replace("CORRECTED ACCELEROGRAM  ", "Corrected accelerogram  "), SAMPLES, 0.01, None),
        (v1(), SMALL, G, "uncorrected"),
        (v1(data_line=NEW_V1), SMALL, G, "uncorrected"),
        (v1(SAMPLES[:3], data_line=OLD_RAW.replace("UNITS: G", "UNITS: G/100"), text_unit="IS IN VOLTS", peak=".03 G",
            digits=3), SAMPLES[:3], G / 100, "uncorrected"),
        (v1(SAMPLES, times=TIMES, text_unit="ARE SEC AND G/100", peak=".121 G"), SAMPLES, G / 100, "uncorrected"),
    ],
)  # fmt: skip
def test_samples_step_and_unit(write, text, samples, unit, processing):
    motion = rf.read_motion(write(text))
    assert motion.acceleration == pytest.approx(np.array(samples) * unit, rel=1e-12)
    assert (motion.dt, motion.metadata.processing) == (0.005, processing)
    assert motion.metadata.stated_pga == pytest.approx(motion.pga, rel=0.01)
    assert [each.what for each in motion.metadata.findings] == ["quantity", "unit", "time step", "component"]


def test_what_the_text_says(write):
    info = rf.read_motion(write(csmip())).metadata
    assert (info.event, info.year) == ("SOMEWHERE EARTHQUAKE, JUNE 28, 1992 08:05 PDT", 1992)
    assert (info.network, info.station, info.magnitude, info.magnitude_type) == ("CE", "23583", 6.4, "Mw")
    assert (info.component, info.direction, info.azimuth) == ("090", "horizontal", 90.0)
    found = {each.what: str(each) for each in info.findings}
    assert found["unit"].endswith('(line 46: "8 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC. (UNITS: CM/SEC/SEC)")')
    assert "CHAN 1: 90 DEG" in found["component"]
    newer = v1().replace("SOMEWHERE EARTHQUAKE\nJUNE 28", "Record of Mon Feb 13, 2012 13:06:45.0 PST   (Avol1)\nNone")
    assert rf.read_motion(write(newer, "a.V1")).metadata.event == "Mon Feb 13, 2012 13:06:45.0 PST"


@pytest.mark.parametrize(
    ("component", "facts"),
    [
        ("UP", ("UP", "vertical", None)),
        ("Up                    ", ("Up", "vertical", None)),
        ("DOWN", ("DOWN", "down", None)),
        ("0 DEG", ("000", "horizontal", 0.0)),
        ("N45E", ("N45E", "horizontal", 45.0)),
        ("NS", ("NS", "horizontal", 0.0)),
    ],
)
def test_components(write, component, facts):
    info = rf.read_motion(write(csmip(component))).metadata
    assert (info.component, info.direction, info.azimuth) == facts


def test_several_channels(write):
    text = csmip() + csmip("UP", [2 * each for each in SAMPLES]) + csmip("360 DEG", [3 * each for each in SAMPLES])
    file = write(text, "CE36456-UP.V2")  # the name of a file of several channels says nothing
    found = rf.read_components(file)
    assert [motion.name for motion in found] == [f"CE36456-UP-{name}" for name in ("090", "UP", "360")]
    assert [motion.pga for motion in found] == pytest.approx([0.12125, 0.2425, 0.36375])
    assert [motion.metadata.is_vertical for motion in found] == [False, True, False]
    assert rf.read_motion(file, component="90", vertical=file).pva == pytest.approx(0.2425)


def test_a_few_printed_digits_of_a_peak_are_no_other_record(write):
    """0.012 g stands for 0.0115 to 0.0125 g."""
    motion = rf.read_motion(write(v1(), "a.RAW"))
    assert motion.metadata.stated_pga == motion.pga
    with pytest.warns(rf.RecordWarning, match=r"states a PGA of 0\.130964 m/s²"):
        rf.read_motion(write(v1(peak=".013350 G"), "a.RAW"))


SPECTRA = "RESPONSE AND FOURIER AMPLITUDE SPECTRA\nCORRECTED ACCELEROGRAM\nUNCORRECTED ACCELEROGRAM DATA\n"
UNEVEN = [*TIMES[:-1], TIMES[-1] + 0.004]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (csmip(peak="-60.0 CM/SEC/SEC"), r"states a PGA of 0\.6 m/s², but the samples reach 0\.12125"),
        (v1(peak=".12 G"), r"states a PGA of 1\.17"),
        (v1(text_unit="IS CM/SEC/SEC"), "contradicts itself about the unit: g .*line 28.*, but cm/s2 .*line 12"),
        (v1().replace("RECORD LENGTH = 0.040 SEC", "AT 100 SAMPLES/SEC"),
         r"about the time step: 0\.005 \(line 28.*, but 0\.01 \(line 11"),
        (v1(SAMPLES, times=UNEVEN, text_unit="ARE SEC AND G/100"), "times of the samples are not equally spaced"),
        (v1(data_line="{n} POINTS OF ACCEL DATA (UNITS: G)"), "no time step of the accelerations is stated"),
        (v1(data_line="{n} POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.", text_unit="IS VOLT"), "no unit of"),
        (csmip(data_line="{n} POINTS OF VELOC DATA EQUALLY SPACED AT .005 SEC. (UNITS: CM/SEC)"),
         r"an acceleration is expected, but found line 46: .*VELOC DATA"),
        (csmip(data_line="{n} NUMBERS").replace("POINTS OF", "of"), r"a line such as .* is missing"),
        (v1(data_line=OLD_RAW.replace("{n}", "20")), "line 30: 8 accelerations are expected, .* found 1|truncated"),
        (v1(data_line=OLD_RAW.replace("{n}", "8")), "line 30: 8 accelerations are announced, but more follow"),
        (csmip().replace("12.125    -8", "12.x25    -8"), r"found '12\.x25'"),
        (SPECTRA, r"holds response spectra \(line 1: "),
        (csmip("UP"), "contradicts itself about the component: vertical .*CHAN 1: UP.*, but horizontal .*name of the"),
    ],
)  # fmt: skip
def test_refuses(write, text, message):
    with pytest.raises(rf.InputError, match=message) as caught:
        rf.read_components(write(text, "CE36456.HNE.V2"))
    assert "CE36456" in str(caught.value)


def test_a_stated_unit_is_not_replaced(write):
    with pytest.raises(rf.InputError, match="in the CSMIP format, which states its unit"):
        rf.read_motion(write(csmip()), units="g")
    with pytest.raises(rf.InputError, match=r"states DT = 0\.005 s, but dt=0\.02 was given"):
        rf.read_motion(write(csmip()), dt=0.02)


def test_a_folder_takes_it_whatever_the_suffix(write, tmp_path):
    write(csmip() + csmip("UP") + csmip("360 DEG"), "CE36456.RAW")
    assert rf.read_suite(tmp_path, vertical="pair").names == ("CE36456-090", "CE36456-360")
