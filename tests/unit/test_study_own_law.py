"""Studies with an impact law of the user's own: called, kept apart in folders, and sent to a cluster."""

import importlib
import math
import re
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import frame_values
from own_law import Lossy
from rockflex.foundation.schema import IMPACT

FRAME = frame_values(n_stories=2, period=0.5, aspect_ratio=6.0)  # fmt: skip
GIVEN = {"structures": [{"name": "A", "frame": FRAME}], "records": {"suites": ["el-centro-1940"]},
         "models": ["2DOF-S", "2DOF-C"], "runs_per_chunk": 1}  # fmt: skip
STUDIES = {
    "cloud": lambda **more: rf.CloudStudy(**GIVEN, **more),
    "incremental": lambda **more: rf.IncrementalStudy(**GIVEN, smallest_scale=0.9, largest_scale=1.1, **more),
    "stripes": lambda **more: rf.StripeStudy(**GIVEN, measure="pga", levels=[3.0], **more),
    "design": lambda **more: rf.DesignStudy(**GIVEN, half_widths=[0.7], level=0.3, **more),
}  # fmt: skip
cloud = STUDIES["cloud"]


class Counting(Lossy):
    calls = 0

    def after(self, *arguments):
        Counting.calls += 1
        return super().after(*arguments)


@pytest.mark.parametrize("study", STUDIES.values(), ids=STUDIES)
def test_the_law_is_called(study):
    own, plain = study(impact=Counting(0.5)), study()
    Counting.calls = 0
    runs, others = rf.run_study(own, workers=1), rf.run_study(plain, workers=1)
    assert runs["error"].isna().all()
    assert Counting.calls == runs["n_impacts"].sum() > 0
    assert (runs["max_rotation"] != others["max_rotation"]).any()


def test_a_run_is_the_single_simulation():
    runs = rf.run_study(cloud(impact=Lossy(0.5))).set_index("model")
    motion = rf.load_suite("el-centro-1940")[0]
    for model in ("2DOF-S", "2DOF-C"):
        run = rf.simulate(rf.Frame(**FRAME), motion, model, impact=Lossy(0.5))
        assert runs.loc[model, "max_rotation"] == run.max_rotation
        assert runs.loc[model, "n_impacts"] == run.n_impacts


def test_a_copy_of_a_study_takes_it_too():
    changed = cloud().model_copy(update={"impact": Lossy(0.5)})
    pd.testing.assert_frame_equal(rf.run_study(changed), rf.run_study(cloud(impact=Lossy(0.5))))


def test_laws_of_the_package_are_taken_as_objects():
    named = rf.run_study(cloud(impact="restitution", restitution=0.5))
    pd.testing.assert_frame_equal(rf.run_study(cloud(impact=rf.Restitution(0.5))), named)


EXPECTED = "Give VVELSimplified(), VVELComplete(), Restitution(e), AngularMomentum(), PivotImpulse(), or an object"


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (Lossy, f"impact must be an impact law, but the class Lossy was given. {EXPECTED}"),
        (lambda p, v, w: (v, 0.0), f"impact must be an impact law, but function was given. {EXPECTED}"),
        ("soft", f"impact must be {IMPACT.expected}, but 'soft' was given"),
        (3, f"impact must be {IMPACT.expected}, but 3 was given"),
        ({"law": "own_law.Lossy"}, f"impact must be {IMPACT.expected}, but {{'law': "),
    ],
)
def test_what_is_no_law(given, text):
    with pytest.raises(rf.InputError, match=re.escape(text)):
        cloud(impact=given)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (Lossy, "impact must be an impact law, but the class Lossy was given."),
        ("soft", f"impact must be {IMPACT.expected}, but 'soft' was given."),
    ],
)
def test_what_is_no_law_in_a_copy(given, text):
    with pytest.raises(rf.InputError, match=re.escape(text)):
        rf.run_study(cloud().model_copy(update={"impact": given}))


def test_the_coefficient_of_restitution_is_no_part_of_an_own_law():
    with pytest.raises(rf.InputError, match=r"A restitution of .* was given, but the impact law is Lossy"):
        rf.run_study(cloud(impact=Lossy(), restitution=0.5))


def test_a_folder_goes_on_with_the_same_law_alone(tmp_path):
    folder, seen = tmp_path / "kept", []
    whole = rf.run_study(cloud(impact=Lossy(0.5)), folder)
    spec = rf.StudyFolder.load(folder).spec
    assert spec["impact"]["law"] == "own_law.Lossy"
    assert spec["impact"]["values"] == {"share": 0.5}
    pd.testing.assert_frame_equal(rf.run_study(cloud(impact=Lossy(0.5)), folder, progress=seen.append), whole)
    assert seen[-1].runs == 0
    with pytest.raises(rf.InputError, match=r"another study.*\n  impact\.values\.share: 0\.5 in the folder, 0\.6 now"):
        rf.run_study(cloud(impact=Lossy(0.6)), folder)
    with pytest.raises(rf.InputError, match=r"\n  impact\.law: .*Lossy.* in the folder, .*Counting.* now"):
        rf.run_study(cloud(impact=Counting(0.5)), folder)
    for other in (cloud(), cloud(impact="simplified")):
        with pytest.raises(rf.InputError, match=r"another study.*\n  impact: "):
            rf.run_study(other, folder)


def test_a_law_whose_file_changed_is_another_law(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    file = tmp_path / "changing_law.py"
    source = Path(sys.modules["own_law"].__file__).read_text()
    file.write_text(source)
    law = importlib.import_module("changing_law").Lossy(0.5)
    rf.run_study(cloud(impact=law), tmp_path / "kept")
    rf.run_study(cloud(impact=law), tmp_path / "kept")
    file.write_text(source.replace("self.share *", "0.1 *"))
    text = r"impact law\. Checksums that differ:\n  impact, changing_law: .* in the folder, .* now"
    with pytest.raises(rf.InputError, match=text):
        rf.run_study(cloud(impact=law), tmp_path / "kept")


def test_a_law_that_a_folder_cannot_describe(tmp_path):
    class Holding(Lossy):
        def __init__(self, held):
            vars(self)["held"] = held

    told = cloud(impact=Holding({"a": (np.array([1.0]), np.int64(2), None, math.inf)})).document()["impact"]["values"]
    assert told == {"held": {"a": [[1.0], 2, None, "inf"]}}
    study = cloud(impact=Holding(math.sin))
    assert len(rf.run_study(study)) == 2
    with pytest.raises(rf.InputError, match=r"but .*Holding\.held is of type builtin_function_or_method\."):
        rf.run_study(study, tmp_path / "kept")


def test_a_law_that_stands_in_no_file(tmp_path):
    space = {"__name__": "nowhere", "Lossy": Lossy}
    exec("class Typed(Lossy):\n    pass", space)
    study = cloud(impact=space["Typed"](0.5))
    assert len(rf.run_study(study)) == 2
    with pytest.raises(rf.InputError, match=r"law Typed is not defined in a file, so .* Put it into a module"):
        rf.run_study(study, tmp_path / "kept")


@pytest.mark.slow
def test_on_a_cluster(cluster):
    class Local(Lossy):
        pass

    here = rf.run_study(cloud(impact=Lossy(0.5)))
    pd.testing.assert_frame_equal(rf.run_study(cloud(impact=Lossy(0.5)), dask=cluster.address), here)
    with pytest.raises(rf.InputError, match=r"cannot be sent to workers: .*Local.* top of a module"):
        rf.run_study(cloud(impact=Local(0.5)), dask=cluster.address)
    unknown = type("Unknown", (Lossy,), {"__module__": "__main__"})
    sys.modules["__main__"].Unknown = unknown
    try:
        with pytest.raises(rf.InputError, match=r"cannot load the plan .*Unknown.* modules can be imported"):
            rf.run_study(cloud(impact=unknown(0.5)), dask=cluster.address)
    finally:
        del sys.modules["__main__"].Unknown


@pytest.mark.parametrize("stop", [KeyboardInterrupt, SystemExit])
@pytest.mark.parametrize("model", ["2DOF-S", "2DOF-C"])
def test_an_interrupt_inside_a_law_ends_the_run_as_anywhere_else(model, stop):
    class Stops(Lossy):
        def after(self, *_):
            raise stop("inside the law")

    with pytest.raises(stop, match=r"^inside the law$"):
        rf.simulate(rf.Frame(**FRAME), rf.load_suite("el-centro-1940")[0], model, impact=Stops(0.5))
