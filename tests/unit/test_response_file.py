"""Responses on disk: what is saved comes back, files of other versions are refused, and damage is named."""

import contextlib
import dataclasses
import gc
import json
import pickle
import warnings

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.constants import GRAVITY
from rockflex.models._impact import SidedRestitution, UnsavedLaw
from rockflex.models._rocking_model import RockingModel
from rockflex.studies import PreparedCase

MOTION = rf.GroundMotion(rf.load_suite("el-centro-1940")[0].acceleration[60:210] * 2.5, 0.02, name="El Centro, début")
FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=7.0, damping_ratio=0.03)
NO_FLOORS = dataclasses.replace(FRAME.rocking(), floors=None)
SPRING = rf.BoucWen(0.03, 0.02, 0.6, 0.4, 2.5)
ELEMENTS = [
    rf.Tendon(2e5, 1e7, 0.4, 2.2e5, 0.02, 0.9),
    rf.Tendon(1e5, 2e6, -0.2),
    rf.YieldingDissipator(2e7, 3e4, 0.1, -0.9, True, 0.5),
    rf.YieldingDissipator(2e7, 3e4),
    rf.ViscousDamper(2e4, 0.3),
]
SPRINGS = rf.Springs([-FRAME.half_width, FRAME.half_width], 3e8, 3e6)
OF_ELEMENTS = ("max_element_force", "max_element_elongation", "element_yielded", "remaining_prestress")
SIDED = SidedRestitution(rf.Restitution(0.4, 2e-3), rf.Restitution(0.55, 1e-3))


def block(elements):
    return rf.RockingProperties(
        [], [], [], [], i_theta=2.0e6, l0r=4.0e5, m_tot=1.0e5, half_width=1.0, zeta=[], elements=elements
    )


RUNS = {
    "all modes": (FRAME, "MDOF-S", {}),
    "two modes": (FRAME, "2DOF-S", {}),
    "fixed": (FRAME, "fixed", {}),
    "no floors": (NO_FLOORS, "MDOF-S", {}),
    "fixed without floors": (NO_FLOORS, "fixed", {}),
    "complete": (FRAME, "2DOF-C", {}),
    "complete, SI": (FRAME, "2DOF-C-SI", {}),
    "complete, all modes": (FRAME, "MDOF-C", {}),
    "complete, E": (FRAME, "3DOF-C-E", {}),
    "rigid": (FRAME, "rigid", {}),
    "rigid, complete": (FRAME, "rigid-C", {"impact": rf.Restitution(0.8, 1e-3)}),
    "restitution": (FRAME, "MDOF-S", {"impact": rf.Restitution(0.6)}),
    "a restitution to each side": (FRAME, "2DOF-S", {"impact": SIDED}),
    "eccentric": (rf.Eccentric(FRAME, 0.2), "rigid", {}),
    "eccentric, complete": (rf.Eccentric(FRAME, 0.2), "2DOF-C", {}),
    "tendons": (rf.Restrained(FRAME, ELEMENTS[:2]), "MDOF-S", {}),
    "slides": (FRAME, "2DOF-S", {"ground": rf.Ground(0.2)}),
    "on springs": (FRAME, "2DOF-S", {"ground": rf.Ground(springs=SPRINGS, base_inertia=60e3)}),
    "slides on springs": (FRAME, "2DOF-S", {"ground": rf.Ground(0.2, SPRINGS, 60e3)}),
    "a law and a spring": (FRAME, "2DOF-S", {"impact": rf.VVELComplete(), "bouc_wen": SPRING}),
    "complete with a spring": (FRAME, "2DOF-C-BW", {"bouc_wen": SPRING}),
    "fixed with a spring": (FRAME, "1DOF-fixed-BW", {"bouc_wen": SPRING}),
    "elements": (block(ELEMENTS), "rigid", {"impact": rf.VVELSimplified()}),
}


def known(run):
    """All scalars, without those that cannot be known, and their types."""
    return {name: (value, type(value)) for name, value in run.peaks().items() if value == value}


def assert_same(back, run):
    assert known(back) == known(run)
    assert (back.history is None, back.floors is None) == (run.history is None, run.floors is None)
    for name in OF_ELEMENTS:
        one, other = getattr(back, name), getattr(run, name)
        assert np.array_equal(one, other)
        assert (one.dtype, one.flags.writeable) == (other.dtype, False)
    if run.floors is not None:
        for name in ("story_drift", "story_shear", "floor_acceleration", "total_floor_displacement"):
            assert np.array_equal(getattr(back.floors, name), getattr(run.floors, name)), name
    if run.history is None:
        return
    names = ["time", "rotation", "top_displacement", "yielding", "base_moment", "base_shear", "modal_acceleration"]
    names += ["rotation_acceleration", "impact_times", "element_force", "tendon_force", "friction_demand", "slip"]
    names += ["heave", "edge_uplift", "spring_force", "vertical_reaction"]
    for name in names + ["floor_acceleration", "story_shear"] * (run.floors is not None):
        assert np.array_equal(getattr(back, name), getattr(run, name)), name
    for name in ("kinetic", "strain", "gravity", "damped", "yielded", "elements", "input", "lost"):
        assert np.array_equal(getattr(back.energy, name), getattr(run.energy, name)), name
    one, other = back.history.model, run.history.model
    assert type(one) is type(other)
    assert (one.label, one.lifts) == (other.label, other.lifts)
    assert (one.complete, one.bouc_wen, one.integrated) == (other.complete, other.bouc_wen, other.integrated)


@pytest.mark.slow
@pytest.mark.parametrize(("structure", "model", "options"), RUNS.values(), ids=RUNS)
def test_what_is_saved_comes_back(tmp_path, structure, model, options):
    run = rf.simulate(structure, MOTION, model, **options)
    assert run.n_uplifts > 0 or "fixed" in model
    path = run.save(tmp_path / "run")
    assert list(tmp_path.iterdir()) == [path]
    back = rf.Response.load(str(path))
    assert_same(back, run)
    assert back.history == run.history
    assert back.history.model == run.history.model
    assert_same(pickle.loads(pickle.dumps(run)), run)
    peaks = rf.simulate(structure, MOTION, model, output="peaks", **options)
    assert_same(rf.Response.load(peaks.save(tmp_path / "peaks")), peaks)


class Mine:
    """A law that no file can hold."""

    keeps, loses = "half of the rotation", "the other half"

    def __repr__(self):
        return "Mine()"

    def after(self, properties, modal_velocity, rotation_velocity):
        return rf.Restitution(0.5).after(properties, modal_velocity, rotation_velocity)


@pytest.mark.parametrize("model", ["MDOF-S", "MDOF-C"])
def test_a_law_of_ones_own_is_forgotten(tmp_path, model):
    run = rf.simulate(FRAME, MOTION, model, impact=Mine())
    back = rf.Response.load(run.save(tmp_path / "run"))
    assert_same(back, run)
    law = back.history.model.law
    assert law == UnsavedLaw("Mine()", "half of the rotation", "the other half")
    with pytest.raises(rf.InputError, match=r"Mine\(\) was not saved with the response\. Pass the law itself"):
        rf.simulate(FRAME, MOTION, model, impact=law)
    again = rf.Response.load(back.save(tmp_path / "again"))
    assert_same(again, run)
    assert again.history.model.law == law


def test_a_subclass_is_a_law_of_ones_own(tmp_path):
    class Stronger(rf.VVELSimplified):
        pass

    run = rf.simulate(FRAME, MOTION, "2DOF-C", impact=Stronger())
    law = rf.Response.load(run.save(tmp_path / "run")).history.model.law
    assert type(law) is UnsavedLaw
    assert law.keeps == rf.VVELSimplified.keeps


def test_a_file_is_replaced_whole(tmp_path):
    path = rf.simulate(FRAME, MOTION).save(tmp_path / "run.npz")
    assert rf.simulate(FRAME, MOTION, "2DOF-S", output="peaks").save(str(path)) == path
    assert rf.Response.load(path).model == "2DOF-S"
    assert list(tmp_path.iterdir()) == [path]


def test_names_with_dots_keep_them(tmp_path):
    run = rf.simulate(FRAME, MOTION, output="peaks")
    assert run.save(tmp_path / "scale 1.5").name == "scale 1.5.npz"
    assert run.save(tmp_path / "run.NPZ").name == "run.NPZ"


@pytest.mark.parametrize("name", ["run.parquet", "run.csv", "run.npz.gz", "scale 1.5.PARQUET"])
def test_another_form_of_file_is_refused(tmp_path, name):
    run = rf.simulate(FRAME, MOTION, output="peaks")
    with pytest.raises(rf.InputError, match=rf"saved as \.npz, but {name!r} .*{name.rpartition('.')[0]}\.npz"):
        run.save(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_a_missing_file(tmp_path):
    with pytest.raises(rf.InputError, match="No saved response at"):
        rf.Response.load(tmp_path / "none.npz")


@pytest.mark.slow
@pytest.mark.parametrize("cut", [100, 0.5, 0.99])
def test_half_a_file(tmp_path, cut):
    path = rf.simulate(FRAME, MOTION).save(tmp_path / "run")
    whole = path.read_bytes()
    path.write_bytes(whole[: cut if cut >= 1 else int(cut * len(whole))])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with pytest.raises(rf.InputError, match="is not a saved response"):
            rf.Response.load(path)
        gc.collect()
    assert caught == []  # the file is closed


def test_any_other_file(tmp_path):
    text, array = tmp_path / "text.npz", tmp_path / "array.npz"
    text.write_text("time,rotation\n0,0\n")
    with array.open("wb") as file:
        np.save(file, np.zeros(3))
    (tmp_path / "empty.npz").write_bytes(b"")
    np.savez(tmp_path / "numbers.npz", response=np.zeros(3), time=np.zeros(3))
    np.savez(tmp_path / "time.npz", time=np.zeros(3))
    np.savez(tmp_path / "list.npz", response=np.array("[1]"))
    np.savez(tmp_path / "keys.npz", response=np.array(json.dumps({"format": "rockflex-response-4"})))
    for path in tmp_path.iterdir():
        with pytest.raises(rf.InputError, match=rf"{path.name} is not a saved response"):
            rf.Response.load(path)
    np.savez(text, response=np.array(json.dumps({"format": "rockflex-response-0"})))
    with pytest.raises(rf.InputError, match="has the format 'rockflex-response-0', but 'rockflex-response-4' is exp"):
        rf.Response.load(text)


SOUND = {"simplified": ("MDOF-S", {}), "complete": ("2DOF-C", {"bouc_wen": SPRING, "impact": rf.Restitution(0.5)})}


@pytest.mark.slow
@pytest.mark.parametrize("kind", SOUND)
def test_any_damage_is_named(tmp_path, kind):
    """Whatever was done to a file, it is refused as no saved response, or is sound."""
    model, options = SOUND[kind]
    run = rf.simulate(FRAME, MOTION, model, **options)
    path = run.save(tmp_path / "run")
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    sound = 0
    for _ in range(200):
        damaged = bytearray(whole)
        damaged[rng.integers(len(whole))] ^= 1 << rng.integers(8)
        path.write_bytes(damaged)
        with contextlib.suppress(rf.InputError):
            assert rf.Response.load(path).peaks() == run.peaks()
            sound += 1
    assert sound < 140


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """The arrays and the scalars of sound files: two of a frame, and some with elements or on other grounds."""
    made = {}
    cases = {kind: (FRAME, *rest) for kind, rest in SOUND.items()}
    cases |= {kind: RUNS[kind] for kind in ("elements", "slides", "slides on springs")} | {"held": HELD}
    for kind, (structure, model, options) in cases.items():
        path = rf.simulate(structure, MOTION, model, **options).save(tmp_path_factory.mktemp("sound") / "run")
        with np.load(path) as file:
            arrays = dict(file)
        made[kind] = arrays, json.loads(str(arrays.pop("response")))
    return made


HELD = rf.Restrained(FRAME, [rf.FrictionDamper(2e4, 0.3)]), "MDOF-S", {}


def rewritten(path, arrays, scalars):
    np.savez(path / "run.npz", response=np.array(json.dumps(scalars)), **arrays)
    return path / "run.npz"


def changed(values, name, value):
    """A copy with another value of one name; ... takes the name out."""
    rest = {key: item for key, item in values.items() if key != name}
    return rest if value is ... else rest | {name: value}


@pytest.mark.parametrize("kind", ["simplified", "complete", "elements"])
def test_a_file_written_again_is_sound(saved, tmp_path, kind):
    arrays, scalars = saved[kind]
    assert rf.Response.load(rewritten(tmp_path, arrays, scalars)).max_rotation == scalars["max_rotation"]


def test_what_a_file_says(saved):
    _, scalars = saved["complete"]
    assert scalars["law"] == {"law": "Restitution", "e": 0.5, "shortest_excursion": 1e-4}
    assert scalars["bouc_wen"] == dataclasses.asdict(SPRING)
    assert (scalars["complete"], scalars["model"]) == (True, "2DOF-C-BW")


@pytest.mark.parametrize(
    ("kind", "name", "change", "text"),
    [
        ("simplified", "states", lambda a: a[:, :-1], r"states must have the shape \(\d+, 12\), but .* \(\d+, 11\)"),
        ("simplified", "states", lambda a: a[:0], r"states must have the shape \(1, 12\), but .* \(0, 12\)"),
        ("simplified", "states", lambda a: a[0], r"states must have the shape \(1, 12\), but .* \(12,\)"),
        ("simplified", "states", lambda a: a * np.nan, r"states must be finite, but its entry \[0, 0\] is nan"),
        ("simplified", "states", lambda a: a.astype(str), "states must be of type float64, but is of type <U32"),
        ("simplified", "states", lambda a: a + 0j, "states must be of type float64, but is of type complex128"),
        ("simplified", "floors.story_drift", lambda a: a[:2], r"one peak of each kind per floor, .* \[2, 3, 3, 3\]"),
        ("simplified", "floors.story_shear", lambda a: a[:, None], "story_shear must be one-dimensional"),
        ("simplified", "floors.floor_acceleration", None, "KeyError: 'floors.floor_acceleration'"),
        ("simplified", "floor_modes.heights", None, "KeyError: 'floor_modes.heights'"),
        ("simplified", "properties.omega", lambda a: a[:2], "effective_mass must contain one value per mode"),
        ("simplified", "properties.omega", lambda a: -a, "omega must be positive"),
        ("simplified", "properties.i_theta", None, "KeyError: 'properties.i_theta'"),
        ("simplified", "properties.i_theta", lambda _: np.ones(3), "i_theta must be a number in kg m²"),
        ("complete", "states", lambda a: a[:, :-4], r"states must have the shape \(\d+, 12\), but .* \(\d+, 8\)"),
        ("complete", "states", lambda a: np.where(a == a[-1, -1], np.inf, a), "states must be finite, but its entry"),
        ("elements", "elements.max_element_force", lambda a: a[:3], r"must have the shape \(5,\), but .* \(3,\)"),
        ("elements", "elements.remaining_prestress", lambda a: a[None], r"shape \(2,\), but .* \(1, 2\)"),
        ("elements", "elements.element_yielded", lambda a: a != 0.0, "element_yielded must be of type float64, but"),
        ("elements", "elements.max_element_elongation", None, r"KeyError: 'elements\.max_element_elongation'"),
    ],
)
def test_arrays_that_do_not_fit(saved, tmp_path, kind, name, change, text):
    arrays, scalars = saved[kind]
    path = rewritten(tmp_path, changed(arrays, name, change(arrays[name]) if change else ...), scalars)
    with pytest.raises(rf.InputError, match=text) as caught:
        rf.Response.load(path)
    assert str(caught.value).startswith(f"{path} is not a saved response (")


TIME, SIDE, LAST = 0, 1, -1


@pytest.mark.parametrize("kind", ["simplified", "complete", "elements", "held", "slides", "slides on springs"])
@pytest.mark.parametrize(
    ("column", "value", "text"),
    [
        (SIDE, 7.0, "the side 7"),
        (SIDE, 0.5, r"the side 0\.5"),
        (SIDE, 2.0**70, r"the side 1\.18"),
        (TIME, 1e300, r"the value 1e\+300, but at most 1e\+100"),
        (TIME, 1e20, r"the time 1e\+20, but times must lie from 0"),
        (TIME, -1.0, "the time -1, but times must lie from 0"),
        (TIME, 0.0, "the time 0, but times must not decrease"),
        *((column, -1e300, r"the value 1e\+300, but at most 1e\+100") for column in range(2, 9)),
    ],
)
def test_states_that_cannot_be(saved, tmp_path, kind, column, value, text):
    arrays, scalars = saved[kind]
    states = arrays["states"].copy()
    row = len(states) // 2
    states[row, min(column, states.shape[1] - 1)] = value
    with pytest.raises(
        rf.InputError, match=rf"run\.npz is not a saved response \(InputError: states\[{row}\] has {text}"
    ):
        rf.Response.load(rewritten(tmp_path, arrays | {"states": states}, scalars))


@pytest.mark.parametrize(
    ("kind", "value", "text"),
    [
        ("held", 3.0, "branch of element 0 3, but 0 or 1 or -1"),
        ("slides", 0.5, r"slip 0\.5, but -2 or -1 or 0 or 1 or 2"),
        ("slides", 1e30, r"slip 1e\+30"),
        ("slides on springs", 1e30, r"number of branches 1e\+30, but a whole number"),
        ("slides on springs", 0.5, r"number of branches 0\.5, but a whole number"),
        ("slides on springs", -3.0, "number of branches -3, but a whole number"),
        ("slides on springs", 0.0, "branch -1, but 0 or 1 or 2"),
    ],
)
def test_branches_that_cannot_be(saved, tmp_path, kind, value, text):
    arrays, scalars = saved[kind]
    states = arrays["states"].copy()
    states[5, LAST] = value
    with pytest.raises(rf.InputError, match=rf"states\[5\] has the {text}"):
        rf.Response.load(rewritten(tmp_path, arrays | {"states": states}, scalars))


def test_states_in_another_order(saved, tmp_path):
    arrays, scalars = saved["simplified"]
    with pytest.raises(rf.InputError, match=r"states\[1\] has the time .*, but times must not decrease"):
        rf.Response.load(rewritten(tmp_path, arrays | {"states": arrays["states"][::-1]}, scalars))


def test_what_could_not_be_read_again_is_not_written(tmp_path):
    run = rf.simulate(FRAME, MOTION.scaled(1e150), "fixed")
    with pytest.raises(rf.InputError, match=r"at most 1e\+100"):
        run.save(tmp_path / "run")
    assert not list(tmp_path.iterdir())


def test_a_law_without_a_name_of_its_own_is_remembered_by_that_of_its_class(tmp_path):
    class Lossy:
        keeps, loses = "half of the rotation", "the other half"

        def after(self, properties, modal_velocity, rotation_velocity):
            return rf.Restitution(0.5).after(properties, modal_velocity, rotation_velocity)

    back = rf.Response.load(rf.simulate(FRAME, MOTION, impact=Lossy()).save(tmp_path / "run"))
    assert back.history.model.law.description == "Lossy"


def test_peaks_of_other_floors(saved, tmp_path):
    arrays, scalars = saved["simplified"]
    fewer = {name: value[:2] if name.startswith("floors.") else value for name, value in arrays.items()}
    with pytest.raises(rf.InputError, match="There are peaks of 2 floors, but a different number of heights"):
        rf.Response.load(rewritten(tmp_path, fewer, scalars))


@pytest.mark.parametrize(
    ("kind", "name", "value", "text"),
    [
        ("simplified", "max_rotation", "0.1", "InputError: max_rotation must be of type float, but is '0.1'"),
        ("simplified", "max_rotation", None, "InputError: max_rotation must be of type float, but is None"),
        ("simplified", "n_impacts", 2.5, r"InputError: n_impacts must be of type int, but is 2\.5"),
        ("simplified", "n_impacts", True, "InputError: n_impacts must be of type int, but is True"),
        ("simplified", "settled", 1, "InputError: settled must be of type bool, but is 1"),
        ("simplified", "model", 3, "InputError: model must be of type str, but is 3"),
        ("simplified", "lifts", "yes", "InputError: lifts must be of type bool, but is 'yes'"),
        ("simplified", "end_time", ..., "KeyError: 'end_time'"),
        ("simplified", "lifts", ..., "KeyError: 'lifts'"),
        ("simplified", "format", ..., "KeyError: 'format'"),
        ("complete", "law", ..., "KeyError: 'law'"),
        ("complete", "law", "Restitution", "InputError: law must be of type dict, but is 'Restitution'"),
        ("complete", "law", {}, "KeyError: 'law'"),
        ("complete", "law", {"law": "Unknown"}, "KeyError: 'Unknown'"),
        ("complete", "law", {"law": "Restitution", "e": 2.0}, "InputError: e must lie in "),
        ("complete", "law", {"law": "Restitution"}, "TypeError: .*missing 1 required positional argument: 'e'"),
        ("complete", "law", {"law": "VVELComplete", "e": 1.0}, "TypeError: "),
        ("complete", "complete", "yes", "InputError: complete must be of type bool, but is 'yes'"),
        ("complete", "complete", ..., "InputError: states must have the shape"),
        ("complete", "bouc_wen", ..., "KeyError: 'bouc_wen'"),
        ("complete", "bouc_wen", {"yield_displacement": -1.0}, "InputError: yield_displacement must be a positive"),
        ("complete", "bouc_wen", {"yield": 1.0}, "TypeError: "),
        ("complete", "bouc_wen", 3, "TypeError: "),
    ],
)
def test_scalars_that_do_not_fit(saved, tmp_path, kind, name, value, text):
    arrays, scalars = saved[kind]
    with pytest.raises(rf.InputError, match=rf"run\.npz is not a saved response \({text}"):
        rf.Response.load(rewritten(tmp_path, arrays, changed(scalars, name, value)))


@pytest.mark.parametrize("more", [[], [rf.ViscousDamper(2e5, 0.5)], [rf.YieldingDissipator(2e7, 1e5, 0.05, 0.0)]])
def test_a_run_of_elements_that_balanced_the_weight_is_read_as_it_was_written(tmp_path, more):
    """Once such simplified models were integrated, and their states hold energies, too."""
    p = FRAME.rocking()
    held = rf.Restrained(FRAME, [rf.Tendon(1e5, p.l0r * GRAVITY / p.half_width**2, yield_force=1e9), *more]).rocking()
    model = RockingModel("MDOF-S", held, stepwise=True)
    run = PreparedCase(model, history=True, floors=True).run(MOTION)
    back = rf.Response.load(run.save(tmp_path / "run"))
    assert_same(back, run)
    assert back.history.model.integrated
    assert back.n_impacts > 3
    assert back.energy.closing_error < 1e-9
    assert back.settled_rotation() == pytest.approx(run.settled_rotation(), abs=1e-12)
    # Ten digits in a step, which the impacts multiply.
    assert back.max_rotation == pytest.approx(rf.simulate(held, MOTION, "MDOF-S").max_rotation, rel=1e-6)
