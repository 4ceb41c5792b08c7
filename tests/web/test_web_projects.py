"""Alternatives and projects of the page: what they hold, what opens them, and what is refused."""

import io
import json
import math
import re
import struct
import zipfile
from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.web._projects import SETTLES, state_of_project
from rockflex.web._refusal import Refusal
from rockflex.web._uploads import UploadedRecords

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)
BLOCK = rf.rigid_block(slenderness=0.2, half_diagonal=3.0, mass=5e4)
BOX = rf.Section.box(4.0, 2.5, 0.3, elastic_modulus=33e9, density=2500)
BED = rf.Ground(0.5, rf.Springs([-0.5, 0.5], 2e8, 1e6), 2e4)
BAD_SPRINGS = {"springs": {"stiffness": 5e8, "damping": -1.0}, "base_inertia": 2e4}
PULSE = rf.one_sine_pulse(amplitude=3.0, period=0.8)


def kept(name: str, structure: dict, **more) -> dict:
    return {"name": name, "structure": structure, "models": ["2DOF-S", "fixed"], **more}


@pytest.fixture
def state(client):
    """A frame, kept as it is and on springs, and the frame with a wider base at present."""
    narrow = client.state()["structure"]
    wide = narrow | {"frame": narrow["frame"] | {"aspect_ratio": 8.0}}
    ground = {"springs": {"stiffness": 5e8, "damping": 1e6}, "base_inertia": 2e4}
    law = {"impact": "restitution", "restitution": 0.9}
    elastic = {"bouc_wen": {"yield_displacement": 0.05}}  # which the model does not use
    alternatives = [kept("A", narrow, **law), kept("soft", narrow, ground=ground, **elastic)]
    head = {"title": "Two bases", "author": "A. Müller"}
    return client.state(structure=wide, scale=1.3, models=["2DOF-S"], alternatives=alternatives, head=head)


def opened(client, content: bytes) -> dict:
    status, _, body = client.request("/api/project", content, Content_Type="application/octet-stream")
    answer = json.loads(body)
    assert status == 200, answer
    return answer


@pytest.mark.slow
def test_the_table_and_the_ghosts_are_those_of_compare(client, state, el_centro) -> None:
    narrow, wide = make_frame(), make_frame(aspect_ratio=8.0)
    ground = rf.Ground(springs=rf.Springs([-1, 1] * np.array(narrow.rocking().half_width), 5e8, 1e6), base_inertia=2e4)
    found = rf.compare(
        {"A": narrow, "soft": narrow, "B": wide}, el_centro.scaled(1.3), "2DOF-S", free_vibration=5.0,
        ground={"soft": ground}, impact={"A": rf.Restitution(0.9)},
    )  # fmt: skip
    answer = client.ask("/api/alternatives", state)
    assert answer["present"] == "B"
    assert answer["heads"] == ["demand", "A", "soft", "B", "soft to A [%]", "B to A [%]"]
    values = [[cell["value"] for cell in row[1:]] for row in answer["rows"]]
    expected = np.hstack((found.demands("max"), found.differences("max")))
    assert np.array(values, float) == pytest.approx(expected, rel=1e-12, nan_ok=True)
    assert [each["name"] for each in answer["kept"]] == ["A", "soft"]
    for each, response in zip(answer["kept"], found.responses, strict=False):
        assert each["models"][0]["peaks"]["max_rotation"] == response.max_rotation
    name, report = client.download("/api/file/comparison", state)
    assert name == "comparison.html"
    assert all(part in report.decode() for part in ("Two bases", "A. Müller", "soft to A"))
    assert "Two bases" in client.download("/api/file/report", state)[1].decode()


def test_the_kept_structure_is_not_compared_with_itself(client, state) -> None:
    same = state | {key: value for key, value in state["alternatives"][0].items() if key != "name"}
    answer = client.ask("/api/alternatives", same)
    assert (answer["present"], answer["heads"]) == ("", ["demand", "A", "soft", "soft to A [%]"])
    alone = same | {"alternatives": same["alternatives"][:1]}
    assert client.ask("/api/alternatives", alone)["rows"] == []
    assert "2 to 6" in client.made("comparison", alone)["errors"]["alternatives"]
    many = [kept(letter, state["structure"] | {"name": letter}) for letter in "ABCDEF"]
    assert "Remove one" in client.refused("/api/alternatives", state | {"alternatives": many})["alternatives"]


def test_wrong_alternatives_are_refused_with_their_name(client, state) -> None:
    first, second = state["alternatives"]
    heavy = {"frame": first["structure"]["frame"] | {"story_mass": 1e40}}
    for words, alternatives in {
        "same name": [first, second | {"name": "A"}],
        "at most 6": [first] * 8,
        "soft: ground.springs.damping": [first, kept("soft", second["structure"], ground=BAD_SPRINGS)],
        "A: structure.frame.story_mass": [first | {"structure": heavy}],
        "A: models: .*yield": [first | {"models": ["2DOF-S-BW"]}],
        "40 letters": [first | {"name": ""}],
    }.items():
        errors = client.refused("/api/state", state | {"alternatives": alternatives})
        assert all(path.startswith("alternatives") for path in errors)
        assert re.search(words, str(errors))
    assert "120 letters" in str(client.refused("/api/state", state | {"head": {"author": "x" * 200}}))
    soft = [kept("on soil", first["structure"], ground=second["ground"], impact="complete")]
    said = client.refused("/api/alternatives", state | {"alternatives": soft})["alternatives"]
    assert said.startswith("on soil: No impact law acts on springs")


def test_a_project_of_the_page_comes_back_as_it_was(client, state, tmp_path, el_centro) -> None:
    part = {"shape": "circle", "diameter": 2.0, "elastic_modulus": 3e10, "density": 2500.0}
    pier = {
        "height": 12.0,
        "tip_mass": 5e5,
        "base_mass": 1e5,
        "half_width": 1.5,
        "damping_ratio": 0.03,
        "section": part,
    }
    section = {"cantilever": pier}
    given = client.ask("/api/state", state | {"structure": section, "models": ["MDOF-S"]})
    name, content = client.download("/api/file/project", given)
    assert opened(client, content)["state"] == given  # with the section, of which the structure knows numbers only
    (tmp_path / name).write_bytes(content)
    project = rf.read_project(tmp_path / name)
    assert list(project.structures) == ["A", "soft", "B"]
    assert (project.head, project.free_vibration) == ({"title": "Two bases", "author": "A. Müller"}, 5.0)
    assert project.motions == (el_centro.scaled(1.3),)
    assert project.impact == {"A": rf.Restitution(0.9)}
    run = project.run().results.runs.set_index("structure")
    shown = client.ask("/api/alternatives", given)["rows"][0]
    assert shown[0]["text"].startswith("θ_max")
    assert run["max_rotation"].to_numpy() == pytest.approx([cell["value"] for cell in shown[1:4]], rel=1e-10)


STRUCTURES = {
    "frame": FRAME,
    "held": rf.Restrained(rf.Eccentric(FRAME, 0.1), [rf.Tendon(1e5, 5e6, yield_force=4e5), rf.GapBar(1e6, 0.01)]),
    "yielding": rf.YieldingStories(rf.Leaning(replace(FRAME, stiffness_ratio=math.inf), 1e4), [1e5, 8e4], 0.05),
    "section": rf.CantileverWithTipMass(
        height=12.0, tip_mass=5e5, base_mass=1e5, half_width=1.5, damping_ratio=0.03, section=BOX
    ),
    "beam": rf.Beam(
        height=10.0, mass=([0.0, 4.0, 10.0], [2e3, 1e3, 1e3]), bending_stiffness=1e9, half_width=1.0,
        damping_ratio=0.02, lumped_masses=rf.LumpedMasses([10.0], [500.0]),
    ),
    "bare": FRAME.rocking(),
}  # fmt: skip


def project_file(tmp_path, structures, motions, model, **options) -> bytes:
    return rf.Project(structures, motions, model, **options).save(tmp_path / "given.rockflex").read_bytes()


def test_a_project_of_python_opens_with_the_same_responses(client, tmp_path) -> None:
    models = dict.fromkeys(STRUCTURES, "2DOF-S")
    project = rf.Project(
        STRUCTURES, PULSE, models, ground={"frame": BED},
        impact={"held": rf.VVELComplete()}, limits=rf.CheckLimits(friction=0.4), head={"author": "B", "date": "2024"},
        free_vibration="settle",
    )  # fmt: skip
    answer = opened(client, project.save(tmp_path / "a").read_bytes())
    state = answer["state"]
    assert answer["left"] == [SETTLES]  # which the page cannot keep
    assert answer["state"]["limits"]["friction"] == 0.4
    assert (state["head"], state["free_vibration"]) == ({"author": "B"}, 60.0)
    assert [each["name"] for each in state["alternatives"]] == list(STRUCTURES)
    for each in state["alternatives"]:
        name = each.pop("name")
        shown = client.ask("/api/response", {"record": state["record"], "free_vibration": 2.0, **each})["models"][0]
        run = rf.simulate(
            project.structures[name], PULSE, models[name], free_vibration=2.0, ground=project.ground.get(name),
            impact=project.impact.get(name),
        )  # fmt: skip
        # Sections and wrappers give the same numbers by another order of sums.
        assert shown["peaks"]["max_rotation"] == pytest.approx(run.max_rotation, rel=1e-9), name


def test_several_records_open_as_a_folder_and_blocks_as_blocks(client, tmp_path) -> None:
    records = {"one": PULSE, "two/2": PULSE.scaled(0.8)}
    state = opened(client, project_file(tmp_path, {"block": BLOCK}, records, "rigid"))["state"]
    sides = {"width": 6.0 * math.sin(0.2), "height": 6.0 * math.cos(0.2), "mass": 5e4}
    assert state["structure"]["block"] == pytest.approx(sides)
    assert (state["record"]["source"], state["record"]["given"], state["scale"]) == ("folder", "one", 1.0)
    report = json.loads(client.request(f"/api/folder/{state['record']['folder']}")[2])
    assert [each["name"] for each in report["entries"]] == ["one", "two_2"]
    shown = client.ask("/api/response", state)["models"][0]["peaks"]["max_rotation"]
    assert shown == pytest.approx(rf.simulate(BLOCK, PULSE, "rigid").max_rotation, rel=1e-9)


def repacked(content: bytes, changed: dict[str, bytes | str]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as new:
        for name, each in ({name: old.read(name) for name in old.namelist()} | changed).items():
            new.writestr(name, each)
    return packed.getvalue()


def test_a_file_of_a_stranger_takes_no_memory_and_no_time(client, tmp_path) -> None:
    good = project_file(tmp_path, {"a": FRAME}, PULSE, "MDOF-S")
    frame = "structures/001_a.toml"
    with zipfile.ZipFile(io.BytesIO(good)) as archive:
        record = next(name for name in archive.namelist() if name.startswith("records/"))
        text = archive.read(frame).decode()
    bomb = repacked(good, {record: b"0" * 4_900_000})
    lying = bomb.replace(struct.pack("<L", 4_900_000), struct.pack("<L", 10))
    for content, words in {
        b"": "not a project file",
        good[:-30]: "not a project file",
        repacked(good, {record: b"0" * 6_000_000}): "more than 5 MB",
        repacked(good, {frame: b"# " + b"0" * 2_000_000}): "TOML",
        repacked(good, {f"records/{n}.csv": b"0" * 4_900_000 for n in range(20)}): "80 MB",
        repacked(good, {f"records/{n}.csv": b"" for n in range(600)}): "more than 500",
        lying: "damaged",
        bomb: "CSV",
        repacked(good, {frame: text.replace("n_stories = 2", "n_stories = 1000000000")}): "n_stories",
        repacked(good, {frame: text.replace("Frame", "Path")}): "Path",
        repacked(good, {frame: "class = 'Eccentric'\n" + ".".join(["structure"] * 4_000) + " = 1\n"}): "project",
        repacked(good, {"page.json": "[" * 100_000}): "JSON",
        repacked(good, {"page.json": json.dumps({"structure": {"frame": {"n_stories": 10**9}}})}): "n_stories",
    }.items():
        with pytest.raises(Refusal, match=words) as caught:
            state_of_project(content, UploadedRecords())
        assert list(caught.value.errors) == ["project"]
    status, _, body = client.request("/api/project", b"0" * 21_000_000, Content_Type="application/octet-stream")
    assert (status, "20 MB" in body.decode()) == (413, True)


def test_results_are_not_read(tmp_path) -> None:
    done = rf.Project({"a": FRAME}, PULSE).run().save(tmp_path / "a").read_bytes()
    answer = state_of_project(repacked(done, {"results/runs.parquet": b"PAR1"}), UploadedRecords())
    assert "results" in answer["left"]
