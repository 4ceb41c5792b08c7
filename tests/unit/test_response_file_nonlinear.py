"""Responses of nonlinear and rigid models on disk, with their laws and their springs."""

import contextlib
import json
import pickle

import numpy as np
import pytest

from builders import make_frame
from rockflex import (
    BoucWen,
    GroundMotion,
    InputError,
    Response,
    Restitution,
    Restrained,
    Tendon,
    ViscousDamper,
    VVELComplete,
    VVELSimplified,
    YieldingDissipator,
    load_suite,
    simulate,
)
from rockflex._constants import GRAVITY
from rockflex.models import ForgottenLaw, NonlinearModel
from rockflex.study import PreparedCase

MOTION = GroundMotion(load_suite("el-centro-1940")[0].acceleration[60:210] * 2.5, 0.02, name="El Centro")
FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=7.0, damping_ratio=0.03)
SPRING = BoucWen(0.03, 0.02, 0.6, 0.4, 2.5)
RUNS = {
    "2DOF-C": {},
    "2DOF-C-SI": {},
    "MDOF-C": {},
    "3DOF-C-E": {},
    "rigid": {},
    "rigid-C": {"impact": Restitution(0.8, 1e-3)},
    "MDOF-S": {"impact": Restitution(0.6)},
    "2DOF-S": {"impact": VVELComplete(), "bouc_wen": SPRING},
    "2DOF-C-BW": {"bouc_wen": SPRING},
    "1DOF-fixed-BW": {"bouc_wen": SPRING},
}


class Mine:
    """A law that no file can hold."""

    keeps, loses = "half of the rotation", "the other half"

    def __repr__(self):
        return "Mine()"

    def after(self, properties, modal_velocity, rotation_velocity):
        return Restitution(0.5).after(properties, modal_velocity, rotation_velocity)


def same(back, run):
    assert back.peaks() == run.peaks()
    assert np.array_equal(back.history.states, run.history.states)
    for name in ("rotation", "yielding", "base_moment", "base_shear", "modal_acceleration", "rotation_acceleration"):
        assert np.array_equal(getattr(back, name), getattr(run, name)), name
    assert np.array_equal(back.impact_times, run.impact_times)
    for name in ("kinetic", "strain", "gravity", "damped", "yielded", "input", "lost"):
        assert np.array_equal(getattr(back.energy, name), getattr(run.energy, name)), name
    one, other = back.history.model, run.history.model
    assert type(one) is type(other)
    assert (one.label, one.lifts) == (other.label, other.lifts)
    if run.floors is not None:
        assert np.array_equal(back.floors.floor_acceleration, run.floors.floor_acceleration)
        assert np.array_equal(back.floor_acceleration, run.floor_acceleration)
        assert np.array_equal(back.story_shear, run.story_shear)
    if isinstance(other, NonlinearModel):
        assert (one.complete, one.bouc_wen) == (other.complete, other.bouc_wen)


@pytest.mark.parametrize("model", RUNS)
def test_what_is_saved_comes_back(tmp_path, model):
    run = simulate(FRAME, MOTION, model, **RUNS[model])
    assert run.n_impacts > 0 or "fixed" in model
    back = Response.load(run.save(tmp_path / "run"))
    same(back, run)
    assert back.history.model.law == run.history.model.law
    same(pickle.loads(pickle.dumps(run)), run)
    peaks = simulate(FRAME, MOTION, model, output="peaks", **RUNS[model])
    assert Response.load(peaks.save(tmp_path / "peaks")).peaks() == peaks.peaks()


@pytest.mark.parametrize("model", ["MDOF-S", "MDOF-C"])
def test_a_law_of_ones_own_is_forgotten(tmp_path, model):
    run = simulate(FRAME, MOTION, model, impact=Mine())
    back = Response.load(run.save(tmp_path / "run"))
    same(back, run)
    law = back.history.model.law
    assert law == ForgottenLaw("Mine()", "half of the rotation", "the other half")
    text = "The impact law Mine() was not saved with the response. Pass the law itself."
    with pytest.raises(InputError) as caught:
        simulate(FRAME, MOTION, model, impact=law)
    assert str(caught.value) == f"The impact law {law!r} failed: {text}"
    again = Response.load(back.save(tmp_path / "again"))
    same(again, run)
    assert again.history.model.law == law


def test_a_subclass_is_a_law_of_ones_own(tmp_path):
    class Stronger(VVELSimplified):
        pass

    run = simulate(FRAME, MOTION, "2DOF-C", impact=Stronger())
    law = Response.load(run.save(tmp_path / "run")).history.model.law
    assert type(law) is ForgottenLaw
    assert law.keeps == VVELSimplified.keeps


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """The arrays and the scalars of a sound file of a yielding, complete model."""
    run = simulate(FRAME, MOTION, "2DOF-C", bouc_wen=SPRING, impact=Restitution(0.5))
    path = run.save(tmp_path_factory.mktemp("sound") / "run")
    with np.load(path) as file:
        arrays = dict(file)
    return arrays, json.loads(str(arrays.pop("response")))


def rewritten(path, arrays, scalars):
    np.savez(path, response=np.array(json.dumps(scalars)), **arrays)
    return path


def test_what_a_file_says(saved):
    _, scalars = saved
    assert scalars["law"] == {"law": "Restitution", "e": 0.5, "shortest_excursion": 1e-4}
    assert scalars["bouc_wen"] == {
        "yield_displacement": 0.03, "post_yield_ratio": 0.02, "gamma": 0.6, "beta": 0.4, "exponent": 2.5,
    }  # fmt: skip
    assert scalars["complete"] is True
    assert scalars["model"] == "2DOF-C-BW"


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("law", ..., "KeyError: 'law'"),
        ("law", "Restitution", "InputError: law must be of type dict, but is 'Restitution'"),
        ("law", {}, "KeyError: 'law'"),
        ("law", {"law": "Unknown"}, "KeyError: 'Unknown'"),
        ("law", {"law": "Restitution", "e": 2.0}, r"InputError: The restitution e must lie from 0 to 1, but 2\.0"),
        ("law", {"law": "Restitution"}, "TypeError: .*missing 1 required positional argument: 'e'"),
        ("law", {"law": "VVELComplete", "e": 1.0}, "TypeError: "),
        ("complete", "yes", "InputError: complete must be of type bool, but is 'yes'"),
        ("complete", ..., "InputError: states must have the shape"),
        ("bouc_wen", ..., "KeyError: 'bouc_wen'"),
        ("bouc_wen", {"yield_displacement": -1.0}, "InputError: yield_displacement must be a positive, finite number"),
        ("bouc_wen", {"yield": 1.0}, "TypeError: "),
        ("bouc_wen", 3, "TypeError: "),
    ],
)
def test_scalars_that_do_not_fit(saved, tmp_path, name, value, text):
    arrays, scalars = saved
    scalars = {**scalars, name: value}
    if value is ...:
        del scalars[name]
    with pytest.raises(InputError, match=rf"run\.npz is not a saved response \({text}"):
        Response.load(rewritten(tmp_path / "run.npz", arrays, scalars))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda a: a[:, :-4], r"InputError: states must have the shape \(\d+, 12\), but .* \(\d+, 8\)"),
        (lambda a: np.where(a == a[-1, -1], np.inf, a), "InputError: states must be finite, but its entry"),
    ],
)
def test_nodes_that_do_not_fit(saved, tmp_path, change, text):
    arrays, scalars = saved
    with pytest.raises(InputError, match=text):
        Response.load(rewritten(tmp_path / "run.npz", {**arrays, "states": change(arrays["states"])}, scalars))


def test_a_file_written_again_is_sound(saved, tmp_path):
    arrays, scalars = saved
    assert Response.load(rewritten(tmp_path / "run.npz", arrays, scalars)).max_rotation == scalars["max_rotation"]


def test_any_damage_is_named(tmp_path):
    run = simulate(FRAME, MOTION, "2DOF-C", bouc_wen=SPRING, impact=Restitution(0.5))
    path = run.save(tmp_path / "run")
    whole = path.read_bytes()
    rng = np.random.default_rng(1)
    sound = 0
    for _ in range(150):
        damaged = bytearray(whole)
        damaged[rng.integers(len(whole))] ^= 1 << rng.integers(8)
        path.write_bytes(damaged)
        with contextlib.suppress(InputError):
            assert Response.load(path).peaks() == run.peaks()
            sound += 1
    assert sound < 100


@pytest.mark.parametrize("more", [[], [ViscousDamper(2e5, 0.5)], [YieldingDissipator(2e7, 1e5, 0.05, 0.0)]])
def test_a_run_of_elements_that_balanced_the_weight_is_read_as_it_was_written(tmp_path, more):
    """Once such simplified models were integrated, and their states hold energies, too."""
    p = FRAME.rocking()
    held = Restrained(FRAME, [Tendon(1e5, p.l0r * GRAVITY / p.half_width**2, yield_force=1e9), *more]).rocking()
    model = NonlinearModel("MDOF-S", held, complete=False)
    run = PreparedCase(model, history=True, floors=True).run(MOTION)
    back = Response.load(run.save(tmp_path / "run"))
    same(back, run)
    assert isinstance(back.history.model, NonlinearModel)
    assert back.n_impacts > 3
    assert back.energy.closing_error < 1e-9
    assert back.settled_rotation() == pytest.approx(run.settled_rotation(), abs=1e-12)
    # Ten digits in a step, which the impacts multiply.
    assert back.max_rotation == pytest.approx(simulate(held, MOTION, "MDOF-S").max_rotation, rel=1e-6)
