"""Directions of components by their names, and the components of one recording."""

import dataclasses
import warnings
from pathlib import Path

import pytest

import rockflex as rf
from design_case import STRUCTURE
from record_samples import at2
from rockflex.motion._record_info import component_direction
from rockflex.motion._recordings import file_names_text, pair_vertical_records
from rockflex.studies import overturning_scales

VERTICAL = (
    "RSN9_BORREGO_B-ELC-UP.AT2",
    "RSN1158_KOCAELI_DZC-UP.AT2",
    "RSN1294_CHICHI_HWA048-V.AT2",
    "RSN2734_CHICHI.04_CHY074V.AT2",
    "RSN1_HELENA.A_A-HMCDWN.AT2",
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
    "AKBMR--n.1000.BNZ.--.acc.V2c",
    "20200101_9999_ap_AAD_Acc_U.asc",
    "19990101_152309ITDPC_XXX__UPX.DAT",
    "TCGH130007210339.UD1",
)
UNKNOWN = (
    "RSN1059_NORTHR_PTH090.AT2",
    "RSN140_TABAS_FER-L1.AT2",
    "RSN160_IMPVALL.H_059V2090.AT2",
    "RSN161_IMPVALL.H_LF1360.AT2",
    "RSN182_IMPVALL.H_H-VC6000.AT2",
    "RSN187_X_UPL090.AT2",
    "RSN189_X_CUP000.AT2",
    "RSN212_LIVERMOR_A-DVD156.AT2",
    "RSN3512_CHICHI.06_TCU141E.AT2",
    "RSN4886_CHUETSU_65058NS.AT2",
    "RSN6894_DARFIELD_DFHSS17E.AT2",
    "RSN4800_CHUETSU_ANLCEAS.AT2",
    "RSN11341_10275733_N5471HNE.AT2",
    "FAIGO-90.AT2",
    "elcentro.csv",
    "mine v.csv",
    "setup.csv",
    "rev.txt",
    "motion_v1.csv",
    "uplift-1.csv",
)


@pytest.mark.parametrize("name", VERTICAL)
def test_names_of_vertical_components(name):
    assert component_direction(Path(name)) == ("down" if "DWN" in name else "vertical")


@pytest.mark.parametrize(
    "name",
    [
        *(
            "RSN1180_CHICHI_CHY002-N.AT2",
            "RSN190_X_UP1-E.AT2",
            "ELCENTRO-NS.AT2",
            "ELC-NS (1).csv",
            "a.EW2",
            "a__WEX.DAT",
        ),
        *("IT.NRC.00.HNE.D.20161030.ACC.ASC", "XX.HNZ.HN1.txt", "20200101_9999_ap_AAD_Acc_E.asc"),
    ],
)
def test_names_of_horizontal_components(name):
    assert component_direction(Path(name)) == "horizontal"


@pytest.mark.parametrize("name", UNKNOWN)
def test_names_that_say_nothing_of_it(name):
    assert component_direction(Path("UP-UP") / name) is None


@pytest.mark.parametrize(
    "component", ["UP", "up", "V", "V1", "DWN", "DOWN", "UD", "VER", "VERT", "Vertical", "HNZ", " UP "]
)
def test_components_that_a_header_calls_vertical(component):
    expected = "down" if component in ("DWN", "DOWN") else "vertical"
    assert component_direction(Path("RSN1_X_ABC.AT2"), component) == expected


def test_a_component_that_one_calls_vertical_and_another_down_is_down():
    assert component_direction(Path("RSN1_X_ABC-DWN.AT2"), "V") == "down"
    assert component_direction(Path("RSN1_X_ABC-UP.AT2"), "DOWN") == "down"


@pytest.mark.parametrize(
    "component", ["0", "90", "000", "345", "N", "E", "NS", "EW", "L", "T1", "N55W", "S 35 E", "HNE"]
)
def test_components_that_a_header_calls_horizontal(component):
    assert component_direction(Path("RSN1_X_ABC.AT2"), component) == "horizontal"
    # A station's name may end in these letters; what stands apart in the file's name counts all the same.
    assert component_direction(Path("RSN1_X_ABCUP.AT2"), component) == "horizontal"
    with pytest.raises(
        rf.InputError, match=r"about the component: horizontal \(header .*\), but vertical \(name of the"
    ):
        component_direction(Path("RSN1_X_ABC-UP.AT2"), component)


@pytest.mark.parametrize(("component", "direction"), [("UP", "vertical"), ("360", "horizontal"), ("Upland", None)])
def test_readers_tell_the_direction(tmp_path, component, direction):
    file = tmp_path / "RSN1_X_ABC.AT2"
    file.write_text(at2(component))
    assert rf.read_at2(file).metadata.direction == direction
    assert rf.read_motion(file).scaled(2.0).metadata.direction == direction
    named = tmp_path / "station-UD.csv"
    named.write_text("t,acc (g)\n0,0\n0.1,1\n0.2,0\n")
    assert rf.read_motion(named).metadata.direction == "vertical"


@pytest.mark.parametrize("direction", ["vertical", "down"])
def test_nothing_is_shaken_by_a_vertical_component(direction):
    motion = rf.GroundMotion([0.0, 1.0, 0.0], 0.01, "M-UP", rf.RecordInfo(direction=direction))
    for call in (
        lambda: rf.simulate(STRUCTURE, motion, "2DOF-S"),
        lambda: rf.simulate_many(STRUCTURE, [motion], "2DOF-S"),
        lambda: rf.run_cloud({"a": STRUCTURE}, [motion], "2DOF-S"),
        lambda: overturning_scales(STRUCTURE, motion, [1.0, 2.0]),
    ):
        with pytest.raises(rf.InputError, match="'M-UP' is a vertical component"):
            call()
    with pytest.raises(rf.InputError, match="'a', 'b', 'c' and 1 more are vertical components"):
        rf.simulate_many(STRUCTURE, [dataclasses.replace(motion, name=name) for name in "abcd"], "2DOF-S")
    said = dataclasses.replace(motion, metadata=rf.RecordInfo(direction="horizontal"))
    assert rf.simulate(STRUCTURE, said, "2DOF-S", output="peaks").status == "no_uplift"


def write(folder, name, component, peak=0.1, **changed):
    (folder / f"{name}.AT2").write_text(at2(component, peak, **changed))


def motion(name, **info):
    return rf.GroundMotion([0.0, 1.0, 0.0], 0.1, name, rf.RecordInfo(**info))


def pairs_of(horizontal, vertical):
    """Which vertical record, by its name, each horizontal one gets; file names as they are in one folder."""
    along = {Path(name): motion(name) for name in horizontal}
    upwards = {Path(name): motion(name, direction="vertical") for name in vertical}
    both, without, left = pair_vertical_records(along, upwards)
    found = {file.name: each.metadata.vertical_source for file, each in both.items() if each.vertical is not None}
    return found, {file.name: reason for file, reason in without.items()}, [file.name for file in left]


@pytest.mark.parametrize(
    ("horizontal", "vertical"),
    [
        (("RSN9_BORREGO_B-ELC000.AT2", "RSN9_BORREGO_B-ELC090.AT2"), "RSN9_BORREGO_B-ELC-UP.AT2"),
        (("RSN1294_CHICHI_HWA048-N.AT2", "RSN1294_CHICHI_HWA048-W.AT2"), "RSN1294_CHICHI_HWA048-V.AT2"),
        (("RSN2734_CHICHI.04_CHY074E.AT2", "RSN2734_CHICHI.04_CHY074N.AT2"), "RSN2734_CHICHI.04_CHY074V.AT2"),
        (("RSN1_HELENA.A_A-HMC180.AT2", "RSN1_HELENA.A_A-HMC270.AT2"), "RSN1_HELENA.A_A-HMCDWN.AT2"),
        (("RSN11341_10275733_N5471HNE.AT2", "RSN11341_10275733_N5471HNN.AT2"), "RSN11341_10275733_N5471HNZ.AT2"),
        (("RSN5618_IWATE_IWT010EW.AT2", "RSN5618_IWATE_IWT010NS.AT2"), "RSN5618_IWATE_IWT010UD.AT2"),
        (("RSN1633_MANJIL_ABBAR--L.AT2", "RSN1633_MANJIL_ABBAR--T.AT2"), "RSN1633_MANJIL_ABBAR--V.AT2"),
        (("SED-H1.csv", "SED-H2.csv"), "SED-V1.csv"),
        (("Kobe NS.txt", "Kobe EW.txt"), "kobe UP.txt"),
        (("record_X.csv", "record_Y.csv"), "record_Z.csv"),
        (("NS.AT2", "EW.AT2"), "UP.AT2"),
    ],
)
def test_names_that_differ_only_in_the_component(horizontal, vertical):
    found, without, left = pairs_of(horizontal, [vertical, "OTHER-UP.AT2"])
    assert found == dict.fromkeys(horizontal, vertical)
    assert (without, left) == ({}, ["OTHER-UP.AT2"])


def test_stations_whose_names_begin_alike():
    horizontal = ["G1230.AT2", "G12030.AT2", "G1-030.AT2", "G12-030.AT2"]
    found, without, _ = pairs_of(horizontal, ["G1-UP.AT2", "G12-UP.AT2"])
    assert without == {}
    assert list(found.values()) == ["G1-UP.AT2", "G12-UP.AT2"] * 2


def test_other_folders_and_other_stations_are_none():
    found, without, left = pairs_of(["ABC090.AT2", "ABCD.AT2"], ["ABD-UP.AT2"])
    assert (found, without, left) == ({}, {"ABC090.AT2": "", "ABCD.AT2": ""}, ["ABD-UP.AT2"])
    both, *_ = pair_vertical_records({Path("a/X090.csv"): motion("h")}, {Path("b/X-UP.csv"): motion("v")})
    assert both[Path("a/X090.csv")].vertical is None


def test_headers_tell_what_names_do_not():
    along = {Path("a/first.csv"): motion("1", rsn=7), Path("a/second.csv"): motion("2", event="E", year=1, station="S")}
    upwards = {Path("b/up.csv"): motion("v7", rsn=7), Path("b/v.csv"): motion("vs", event="E", year=1, station="S")}
    both, without, left = pair_vertical_records(along, upwards)
    assert [each.metadata.vertical_source for each in both.values()] == ["v7", "vs"]
    assert (without, left) == ({}, [])
    nothing = pair_vertical_records({Path("c.csv"): motion("3", event="E", station="S")}, upwards)
    assert nothing[1] == {Path("c.csv"): ""}


def test_of_two_none_is_chosen():
    found, without, left = pairs_of(["ABC090.AT2"], ["ABC-UP.AT2", "ABC-V.AT2"])
    assert (found, left) == ({}, [])
    assert without == {"ABC090.AT2": "ABC-UP.AT2, ABC-V.AT2 could each belong to it"}


def test_a_record_with_both_stays_as_it_is():
    own = rf.GroundMotion([0.0, 1.0, 0.0], 0.1, "ABC090", vertical=[0.0, 2.0, 0.0])
    both, without, left = pair_vertical_records({Path("ABC090.csv"): own}, {Path("ABC-UP.csv"): motion("ABC-UP")})
    assert both[Path("ABC090.csv")] is own
    assert (without, left) == ({}, [Path("ABC-UP.csv")])


def test_many_names_are_shortened():
    assert file_names_text(Path(f"{k}.txt") for k in range(12)).endswith(", 9.txt and 2 more")


def test_folder(tmp_path):
    for component, peak in (("000", 0.1), ("090", 0.2), ("-UP", 0.3)):
        write(tmp_path, f"RSN1_X_ABC{component}", component.strip("-"), peak)
    write(tmp_path, "RSN2_X_DEF000", "0", 0.4)
    write(tmp_path, "RSN3_X_GHI-V", "V", 0.5)
    with pytest.warns(rf.RecordWarning) as caught:
        suite = rf.read_suite(tmp_path, vertical="pair")
    assert [each.message.args[0] for each in caught] == [
        "Without a vertical component: 1 of 3 records, RSN2_X_DEF000.AT2.",
        "Left out: 1 vertical component, RSN3_X_GHI-V.AT2.",
    ]
    assert {each.filename for each in caught} == {__file__}
    assert suite.names == ("RSN1_X_ABC000", "RSN1_X_ABC090", "RSN2_X_DEF000")
    assert [each.pva / 9.81 for each in suite] == pytest.approx([0.3, 0.3, float("nan")], nan_ok=True)
    (tmp_path / "RSN2_X_DEF000.AT2").unlink()
    (tmp_path / "RSN3_X_GHI-V.AT2").unlink()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(rf.read_suite(tmp_path, vertical="pair")) == 2


def test_another_step_is_a_fault(tmp_path):
    for name, component, dt in (("A000", "0", 0.1), ("A-UP", "UP", 0.1), ("B000", "0", 0.1), ("B-UP", "UP", 0.05)):
        write(tmp_path, name, component, 0.1, dt=dt)
    said = r"1 of 2 records cannot be paired with a vertical component\. B000\.AT2: B-UP\.AT2: Both components need"
    with pytest.raises(rf.InputError, match=said + r'.* on_error="skip" keeps them without it\.$') as error:
        rf.read_suite(tmp_path, vertical="pair")
    assert error.value.field == "vertical"
    with pytest.warns(rf.RecordWarning, match=said):
        suite = rf.read_suite(tmp_path, vertical="pair", on_error="skip")
    assert [each.vertical is None for each in suite] == [False, True]


def test_folders_without_pairs(tmp_path):
    write(tmp_path, "A000", "0", 0.1)
    write(tmp_path, "A090", "90", 0.1, event="Another")
    with pytest.raises(rf.InputError, match=r"No vertical component was found for any of the 2 records, such as A000"):
        rf.read_suite(tmp_path, vertical="pair")
    (tmp_path / "A090.AT2").unlink()
    with pytest.raises(rf.InputError, match=r"No vertical component was found for A000\.AT2\. It is recognised by"):
        rf.read_suite(tmp_path, vertical="pair")
    with pytest.raises(rf.InputError, match=r'vertical must be "pair" or None, but .*B\.AT2.* was given'):
        rf.read_suite(tmp_path, vertical="B.AT2")
