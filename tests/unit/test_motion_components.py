"""What says that a component is vertical, and that a record is no acceleration, in files of networks."""

import pytest

import rockflex as rf
from record_samples import cosmos, esm, geonet, knet

TADAS = (
    esm()
    .replace("EVENT_NAME: C", "AAD_Filtered_TADAS_FILE\nAAD_FILTER_ORDER: 1\nEVENT_NAME: C")
    .replace("20161030\nE", "2016/10/30\nE")
    .replace("064018\n", "06:40:18.0\n")
    .replace("20161030_064013.250", "2016/10/30 06:40:13.25")
    .replace("DATA_TYPE: ACCELERATION", "DATA_TYPE: Acceleration")
)
ITACA = esm().replace("STREAM: HNE", "COMPONENT: WE").replace("HEADER_FORMAT: DYNA 1.2\n", "")
ITACA = ITACA.replace("DATA_TYPE: ACC", "DATA_TYPE: PROCESSED ACC")
OTHER = {"integers": {54: 0}}  # as files whose channel is "Other" have it
SCNL = "| Sensor: FBA"


@pytest.fixture
def write(tmp_path):
    def write(text, name="record.txt"):
        file = tmp_path / name
        file.write_text(text)
        return file

    return write


def other(channel=None):
    text = cosmos(**OTHER).replace("90 deg (", "Other   (")
    return text if channel is None else text.replace(SCNL, f"|<SCNL>BMR.{channel}.AK.--    <AUTH> 2019/02/01")


@pytest.mark.parametrize(
    ("text", "name", "facts"),
    [
        (TADAS, "9999_ap_AAD_Acc_E.asc", ("HNE", "horizontal", 90.0)),
        (TADAS.replace("STREAM: HNE", "STREAM: HNZ"), "9999_ap_AAD_Acc_U.asc", ("HNZ", "vertical", None)),
        (TADAS.replace("STREAM: HNE", "STREAM: U"), "a.asc", ("U", "vertical", None)),
        (TADAS.replace("STREAM: HNE", "STREAM: N"), "a.asc", ("N", "horizontal", 0.0)),
        (ITACA, "19990101ITDPC_XXX__WEX.DAT", ("WE", "horizontal", 90.0)),
        (ITACA.replace(": WE", ": UP"), "19990101ITDPC_XXX__UPX.DAT", ("UP", "vertical", None)),
        (geonet("Up    Vertical Accelerometer Axis"), "a.V2A", ("Up", "vertical", None)),
        (geonet("N28W  Longitudinal Accelerometer Axis"), "a.V2A", ("N28W", "horizontal", 332.0)),
        (geonet("?     Vertical Accelerometer Axis"), "a.V2A", ("?", "vertical", None)),
        (other("BNZ"), "a.V2c", ("BNZ", "vertical", None)),
        (other("HNE"), "a.V2c", ("HNE", "horizontal", 90.0)),
        (other(), "AKBMR--n.1000.BNZ.--.acc.V2c", (None, "vertical", None)),
        (other(), "a.V2c", (None, None, None)),
        (cosmos(54).replace(": 54 deg", ":  54 deg"), "a.V2c", ("054", "horizontal", 54.0)),
        (knet("U-D"), "MYG0020601182325.UD", ("U-D", "vertical", None)),
    ],
)
def test_components(write, text, name, facts):
    info = rf.read_motion(write(text, name)).metadata
    assert (info.component, info.direction, info.azimuth) == facts
    said = [str(each) for each in info.findings if each.what == "component"]
    assert len(said) == (facts[:2] != (None, None))


@pytest.mark.parametrize(
    ("text", "name", "said", "contradicts"),
    [
        (TADAS, "9999_ap_AAD_Acc_U.asc", "STREAM: HNE", "9999_ap_AAD_Acc_U.asc"),
        (esm(stream="HNZ"), "IT.NRC.00.HNE.D.ACC.ASC", "STREAM: HNZ", "IT.NRC.00.HNE.D.ACC.ASC"),
        (cosmos(), "AKBMR--n.1000.BNZ.--.acc.V2c", "place 54: 90", "AKBMR--n.1000.BNZ.--.acc.V2c"),
        (cosmos().replace(SCNL, "|<SCNL>BMR.HNZ.AK.--"), "a.V2c", "place 54: 90", "<SCNL>BMR.HNZ.AK.--"),
        (cosmos(**OTHER).replace("90 deg (", "Up (  "), "a.V2c", "place 54: 0", "Sta Chan 1: Up"),
        (geonet("Up    Longitudinal Accelerometer Axis"), "a.V2A", "vertical (line 13", "horizontal (line 13"),
        (knet("N-S"), "MYG0020601182325.UD", "Dir. N-S", "MYG0020601182325.UD"),
    ],
)
def test_what_contradicts_itself_is_refused_with_both_lines(write, text, name, said, contradicts):
    with pytest.raises(rf.InputError, match="contradicts itself about the component") as caught:
        rf.read_components(write(text, name))
    first, _, second = str(caught.value).partition(" about the component: ")[2].partition(", but ")
    assert said in first
    assert contradicts in second


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (esm(DATA_TYPE="DISPLACEMENT"), r"DATA_TYPE is 'DISPLACEMENT' \(line \d+: \"DATA_TYPE: DISPLACEMENT\"\)"),
        (esm(DATA_TYPE="ACCELERATION RESPONSE SPECTRUM"), "DATA_TYPE is 'ACCELERATION RESPONSE SPECTRUM'"),
        (ITACA.replace("PROCESSED ACC", "PROCESSED VEL").replace("VELELERATION", "VELOCITY"), "PROCESSED VELOCITY"),
        (cosmos(kind="raw veloc."), r"without a series of acceleration: it holds line 49: \"8 raw veloc\. pts"),
        (cosmos(integers={3: 2}), r"contradicts itself about the unit: g \(integer .*: 2\), but cm/s2 \(line 49: "),
    ],
)
def test_what_is_no_acceleration_is_refused(write, text, message):
    with pytest.raises(rf.InputError, match=message):
        rf.read_motion(write(text))


def test_raw_accelerations_of_cosmos(write):
    """Counts of 0.298023 µV each, over 1.2553 V a g."""
    recorder = {"integers": {1: 0, 3: 50}, "reals": {22: 0.298023, 42: 1.2553}}
    raw = cosmos(samples=[100, 500, -300, 100], form=(1, "I8"), kind="raw accel.  ", units=" counts(50)", **recorder)
    motion = rf.read_motion(write(raw, "a.V0c"))
    assert motion.pga == pytest.approx(400 * 0.298023e-6 / 1.2553 * 9.81)
    assert motion.metadata.processing == "uncorrected; mean subtracted"
    with pytest.raises(rf.InputError, match=r"raw counts \(line 49: .*\), which need scaling, "):
        rf.read_motion(write(raw.replace("1.255300", "-999.0  "), "a.V0c"))


@pytest.mark.parametrize(
    ("text", "source_format", "processing"),
    [
        (TADAS, "TADAS", None),
        (TADAS.replace("AAD_Filtered", "AAD_Raw"), "TADAS", "uncorrected"),
        (ITACA, "ITACA", None),
        (ITACA.replace("PROCESSED", "UNPROCESSED"), "ITACA", "uncorrected"),
        (esm(), "ESM", None),
        (esm().replace("USER5:", "BASELINE_CORRECTION: BASELINE NOT REMOVED\nUSER5:"), "ESM", "uncorrected"),
        (cosmos(integers={1: 1}), "COSMOS", "uncorrected"),
        (geonet(corrected=False), "GeoNet", "uncorrected"),
    ],
)
def test_uncorrected_records_say_so(write, text, source_format, processing):
    info = rf.read_motion(write(text)).metadata
    assert (info.source_format, info.processing) == (source_format, processing)
    assert [each.what for each in info.findings] == ["quantity", "unit", "time step", "component"]


def test_facts_of_tadas_are_those_of_esm(write):
    info, known = (rf.read_motion(write(text)).metadata for text in (TADAS, esm()))
    for fact in ("event", "year", "magnitude", "station", "network", "epicentral_km", "stated_pga"):
        assert getattr(info, fact) == getattr(known, fact)
    assert info.start_time == "2016-10-30T06:40:13.25+00:00"
