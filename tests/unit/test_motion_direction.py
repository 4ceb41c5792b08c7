"""Which components are vertical, by header and by name as PEER writes them."""

import dataclasses
from pathlib import Path

import pytest

from design_case import STRUCTURE
from rockflex import GroundMotion, InputError, RecordInfo, read_at2, read_motion, run_cloud, simulate, simulate_many
from rockflex.motion import direction_of
from rockflex.study import overturning_scales

VERTICAL = (
    "RSN9_BORREGO_B-ELC-UP.AT2",
    "RSN127_FRIULI_BUI-UP.AT2",
    "RSN148_COYOTELK_G03-UP.AT2",
    "RSN172_IMPVALL.H_H-E01-UP.AT2",
    "RSN1158_KOCAELI_DZC-UP.AT2",
    "RSN1294_CHICHI_HWA048-V.AT2",
    "RSN1485_CHICHI_TCU045-V.AT2",
    "RSN2734_CHICHI.04_CHY074V.AT2",
    "RSN1_HELENA.A_A-HMCDWN.AT2",
    "RSN100_NCALIF.AG_D-CPMDWN.AT2",
    "SED-V1.AT2",
    "RSN11341_10275733_N5471HNZ.AT2",
    "RSN5618_IWATE_IWT010UD.AT2",
    "RSN6893_DARFIELD_DFHSUP.AT2",
    "rsn1158_kocaeli_dzc-up.at2",
    "SHI-UP.txt",
    "DZC_UP.csv",
    "sta.DWN.txt",
    "station-vertical.csv",
    "record_Z.txt",
    "Kobe UP.csv",
    "RSN953_NORTHR_MUL-UP (1).AT2",
    "RSN9_BORREGO_B-ELC-DWN - Copy (2).AT2",
    "DZC_UP - Copy.csv",
)
UNKNOWN = (
    "RSN1059_NORTHR_PTH090.AT2",
    "RSN107_OROVILLE_B-OAP180.AT2",
    "RSN1180_CHICHI_CHY002-N.AT2",
    "RSN1180_CHICHI_CHY002-W.AT2",
    "RSN140_TABAS_FER-L1.AT2",
    "RSN140_TABAS_FER-T1.AT2",
    "RSN160_IMPVALL.H_059V2090.AT2",
    "RSN161_IMPVALL.H_LF1360.AT2",
    "RSN182_IMPVALL.H_H-VC6000.AT2",
    "RSN187_X_UPL090.AT2",
    "RSN188_X_UPS000.AT2",
    "RSN189_X_CUP000.AT2",
    "RSN190_X_UP1-E.AT2",
    "RSN212_LIVERMOR_A-DVD156.AT2",
    "RSN3512_CHICHI.06_TCU141E.AT2",
    "RSN3300_CHICHI.06_CHY074N.AT2",
    "RSN4886_CHUETSU_65058NS.AT2",
    "RSN4200_NIIGATA_NIG013EW.AT2",
    "RSN6894_DARFIELD_DFHSS17E.AT2",
    "RSN879_LANDERS_LCN345.AT2",
    "RSN4800_CHUETSU_ANLCEAS.AT2",
    "RSN11341_10275733_N5471HNE.AT2",
    "RSN11341_10275733_N5471HNN.AT2",
    "RSN126_GAZLI_GAZ000.AT2",
    "RSN15_KERN_TAF021.AT2",
    "FAIGO-90.AT2",
    "elcentro.csv",
    "mine v.csv",
    "setup.csv",
    "cup.txt",
    "rev.txt",
    "motion_v1.csv",
    "group.dat",
    "ELCENTRO-NS.AT2",
    "uplift-1.csv",
    "ELC-NS (1).csv",
)
HEADER = "PEER NGA STRONG MOTION DATABASE RECORD\nSome Event, 1/1/2001, Some Station, {}\nACCELERATION IN UNITS OF G\n"


@pytest.mark.parametrize("name", VERTICAL)
def test_names_of_vertical_components(name):
    assert direction_of(Path(name)) == ("down" if "DWN" in name else "vertical")


@pytest.mark.parametrize("name", UNKNOWN)
def test_names_that_say_nothing_of_it(name):
    assert direction_of(Path("UP-UP") / name) is None


@pytest.mark.parametrize(
    "component", ["UP", "up", "V", "V1", "DWN", "DOWN", "UD", "VER", "VERT", "Vertical", "HNZ", " UP "]
)
def test_components_that_a_header_calls_vertical(component):
    expected = "down" if component in ("DWN", "DOWN") else "vertical"
    assert direction_of(Path("RSN1_X_ABC.AT2"), component) == expected


@pytest.mark.parametrize(
    "component", ["0", "90", "000", "345", "N", "E", "NS", "EW", "L", "T1", "N55W", "S 35 E", "HNE"]
)
def test_components_that_a_header_calls_horizontal(component):
    assert direction_of(Path("RSN1_X_ABC.AT2"), component) == "horizontal"
    # A station's name may end in these letters; what stands apart in the file's name counts all the same.
    assert direction_of(Path("RSN1_X_ABCUP.AT2"), component) == "horizontal"
    assert direction_of(Path("RSN1_X_ABC-UP.AT2"), component) == "vertical"


@pytest.mark.parametrize(("component", "direction"), [("UP", "vertical"), ("360", "horizontal"), ("Upland", None)])
def test_readers_tell_the_direction(tmp_path, component, direction):
    file = tmp_path / "RSN1_X_ABC.AT2"
    file.write_text(HEADER.format(component) + "NPTS= 3, DT= .1\n0 .2 0\n")
    assert read_at2(file).metadata.direction == direction
    assert read_motion(file).scaled(2.0).metadata.direction == direction
    named = tmp_path / "station-UD.csv"
    named.write_text("t,acc (g)\n0,0\n1,1\n2,0\n")
    assert read_motion(named).metadata.direction == "vertical"


@pytest.mark.parametrize("direction", ["vertical", "down"])
def test_nothing_is_shaken_by_a_vertical_component(direction):
    motion = GroundMotion([0.0, 1.0, 0.0], 0.01, "M-UP", RecordInfo(direction=direction))
    for call in (
        lambda: simulate(STRUCTURE, motion, "2DOF-S"),
        lambda: simulate_many(STRUCTURE, [motion], "2DOF-S"),
        lambda: run_cloud({"a": STRUCTURE}, [motion], "2DOF-S"),
        lambda: overturning_scales(STRUCTURE, motion, [1.0, 2.0]),
    ):
        with pytest.raises(
            InputError,
            match=r"A horizontal ground motion is expected, but 'M-UP' is a vertical component.*RecordInfo\(",
        ):
            call()
    with pytest.raises(InputError, match="'a', 'b', 'c' and 1 more are vertical components"):
        simulate_many(STRUCTURE, [dataclasses.replace(motion, name=name) for name in "abcd"], "2DOF-S")
    said = dataclasses.replace(motion, metadata=RecordInfo(direction="horizontal"))
    assert simulate(STRUCTURE, said, "2DOF-S", output="peaks").status == "no_uplift"
