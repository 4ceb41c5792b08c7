"""Every public value is equal to one made of the same, and to its copies; see `rockflex.foundation.values`."""

import copy
import dataclasses
import math
import pickle
from collections.abc import Iterator

import numpy as np
import pandas as pd
import pytest
from pydantic import BaseModel

import rockflex as rf
from builders import frame_values, make_frame
from rockflex.foundation.values import Value
from rockflex.models._impact import UnsavedLaw
from rockflex.models._rocking_model import RockingModel
from rockflex.motion import GroundMotion
from rockflex.structure._participation import MassNormalisedModes

RECORD = 2.5 * np.sin(np.arange(300) * 0.1)
ROTATION = np.where(np.arange(40) % 5, np.linspace(2e-4, 0.05, 40), 0.0)
RUNS = (np.linspace(0.1, 2.0, 40), ROTATION, (np.arange(40) > 33) & (ROTATION > 0.0))
STUDY = {
    "structures": [{"name": "one", "frame": frame_values(n_stories=2, period=0.5, aspect_ratio=6.0)}],
    "records": {"suites": ["el-centro-1940"]},
}  # fmt: skip


def frame() -> rf.Frame:
    return make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)


def tendons() -> list[rf.Tendon]:
    return [rf.Tendon(2e5, 1e6, position=x, yield_force=1e6) for x in (-0.4, 0.4)]


def motion() -> GroundMotion:
    return GroundMotion(RECORD, 0.01, "sine", rf.RecordInfo(event="none", magnitude=6.5), RECORD[::-1])


def response() -> rf.Response:
    return rf.simulate(rf.Restrained(frame(), rf.Tendon(1e5, 1e6)), motion())


def lumped() -> rf.LumpedStructure:
    return rf.LumpedStructure([1e3, 2e3], [[3e5, -1e5], [-1e5, 1e5]], [3.0, 6.0], base_mass=1e3, half_width=0.5,
                              damping_ratio=0.02)  # fmt: skip


def beam(**other: object) -> rf.Beam:
    given = {"mass": ([0.0, 4.0, 10.0], [2e3, 1e3, 1e3]), "bending_stiffness": 1e9, "rotary_inertia": 10.0}
    bodies = rf.LumpedMasses([10.0], [500.0])
    return rf.Beam(height=10.0, half_width=1.0, damping_ratio=0.02, lumped_masses=bodies, **(given | other))


def statistics() -> rf.PopulationStatistics:
    columns = ["max_top_displacement", "max_rotation", "max_base_shear", "max_base_moment", "max_second_displacement"]
    pairs = pd.DataFrame({f"{name}_{model}": np.arange(1.0, 7.0) for name in columns for model in ("mdof", "2dof")})
    known = {"status": "rocking", "nominal_overturning": False}
    pairs = pairs.assign(**{f"{name}_{model}": value for name, value in known.items() for model in ("mdof", "2dof")})
    others = ["structure_mass", "l0r_g", "sd_2", "srss_top_displacement", "srss_base_shear", "srss_base_moment"]
    facts = ["n_stories", "period", "aspect_ratio", "base_mass_ratio", "pga", "pgv"]
    pairs = pairs.assign(**dict.fromkeys(others + facts, 2.0), pair=range(6), behaviour="shear", motion="R")
    return rf.population_statistics(pairs, n_resamples=20)


def pushed() -> rf.Pushover:
    return rf.pushover(
        rf.YieldingStories(make_frame(n_stories=2, stiffness_ratio=math.inf), [1e5, 8e4], 0.05), 0.2, lifts=False
    )


def project() -> rf.Project:
    return rf.Project({"A": frame()}, motion(), "2DOF-S", head={"author": "A"})


def law_of_two() -> rf.AnnualRate:
    return rf.annual_rate(rf.HazardCurve([0.1, 1.0], [1e-2, 1e-4]), rf.LognormalFragility(0.5, 0.4))


def survey() -> rf.RecordSurvey:
    entry = rf.SurveyEntry(file="a.csv", taken=True, reason="", name="a", pga=2.5)
    return rf.RecordSurvey("folder", (entry,), (motion(),), rf.group_stations([motion()]))


def best() -> rf.BestDesign:
    search, targets, cost = (
        rf.DesignSearch([0.5, 1.0], refinements=0),
        [rf.Requirement(0.02, 0.2, 0.5)],
        rf.DesignCost(1.0),
    )
    pulses = {name: motion() for name in "ab"}
    runs = rf.search_design(frame(), pulses, search, targets, cost, scales=[0.2, 0.4, 1.0])
    return rf.best_design(runs, targets, cost, n_resamples=20)


def record_set() -> rf.RecordSet:
    return rf.simulate_set(frame(), [motion()], "2DOF-S", periods=(0.2, 1.0))


VALUES = {
    rf.Adequacy: lambda: rf.adequacy(frame().rocking()),
    rf.AdequacyTolerance: lambda: rf.AdequacyTolerance(base_moment=math.inf),
    rf.AnnualRate: law_of_two,
    rf.Beam: beam,
    rf.BestDesign: best,
    rf.BootstrapBand: lambda: rf.bootstrap_band(rf.fit_cloud, RUNS[0], RUNS[0] ** 2 * (1.0 + RUNS[1]), at=[0.5], n=20),
    rf.BoucWen: lambda: rf.BoucWen(0.05),
    rf.CantileverWithTipMass: lambda: rf.CantileverWithTipMass(
        height=10.0, tip_mass=1e4, section=VALUES[rf.Section](), base_mass=1e3, half_width=1.0, damping_ratio=0.02
    ),
    rf.CloudFit: lambda: rf.fit_cloud([0.1, 0.2, 0.4], [1.0, 2.0, 3.0]),
    rf.CloudFits: lambda: rf.CloudFits("a", "2DOF-S", "pgv", rf.fit_outcomes(*RUNS), None, None, 0),
    rf.CombinedPeaks: lambda: rf.modal_combination(frame(), motion()),
    rf.Comparison: lambda: rf.compare([frame(), frame()], motion()),
    rf.DesignCost: lambda: rf.DesignCost(1.0, 2e-6),
    rf.DesignSearch: lambda: rf.DesignSearch([1.0, 2.0], [0.0, 1.0]),
    rf.Check: lambda: VALUES[rf.CheckTable]().rows[0],
    rf.CheckLimits: lambda: rf.CheckLimits(friction=0.5),
    rf.CheckTable: lambda: rf.check(response()),
    rf.RecordSet: record_set,
    rf.Eccentric: lambda: rf.Eccentric(frame(), 0.1),
    rf.Joint: lambda: rf.Joint(6.0, 1.0),
    rf.Jointed: lambda: rf.Jointed(frame(), rf.Joint(6.0, 1.0)),
    rf.Podium: lambda: rf.Podium(frame(), 3, 0.6, 4.0, 5e3),
    rf.OneSided: lambda: rf.OneSided(frame(), 0.4),
    rf.EnergyLedger: lambda: response().energy,
    rf.FishBone: lambda: rf.FishBone([3.0, 3.5], 1e3, 1e7, [1e6, math.inf], base_mass=0.0, half_width=0.5,
                                     damping_ratio=0.02),
    rf.FloorModes: lambda: frame().rocking().floors,
    rf.FloorPeaks: lambda: response().floors,
    rf.Frame: frame,
    rf.FrictionDamper: lambda: rf.FrictionDamper(1e5, 0.2),
    rf.FlagShapedBar: lambda: rf.FlagShapedBar(1e8, 2e5, 0.05, 0.8),
    rf.Steel: lambda: rf.Steel(3e8, 4e8, 0.1, 2e11),
    rf.Strand: lambda: rf.Strand(1e-4, 2e5, 1.8e5, 2e11),
    rf.GapBar: lambda: rf.GapBar(1e8, 0.01),
    rf.MultilinearBar: lambda: rf.MultilinearBar([0.01], [1e5]),
    rf.Branch: lambda: rf.Branch(1e8),
    rf.BranchEnd: lambda: rf.BranchEnd("open", 0.01, rising=True),
    rf.Ground: lambda: rf.Ground([0.3, math.inf], rf.Springs([-1.0, 2.0], 1e8, 1e6), 2e4),
    rf.GroundMotion: motion,
    rf.HazardBranches: lambda: rf.HazardBranches.lognormal(VALUES[rf.HazardCurve](), 0.5),
    rf.RateShares: lambda: rf.rate_shares(
        VALUES[rf.HazardBranches](), {("a", "M"): rf.LognormalFragility(0.5, 0.4)}
    ),
    rf.HazardCurve: lambda: rf.HazardCurve([0.1, 1.0], [1e-2, 1e-4]),
    rf.History: lambda: response().history,
    rf.RotationFragility: lambda: rf.fit_outcomes(*RUNS).curve(0.01),
    rf.SampledHistory: lambda: response().resample(0.1),
    rf.InitialState: lambda: rf.InitialState(0.01, [0.001], rotation_velocity=0.1),
    rf.Leaning: lambda: rf.Leaning(frame(), [1e3, 2e3]),
    rf.LogisticFit: lambda: rf.fit_logistic([0.1, 0.2, 0.3, 0.4, 0.5], [0, 0, 1, 0, 1]),
    rf.LognormalFragility: lambda: rf.LognormalFragility(0.5, 0.4, np.eye(2)),
    rf.LumpedMasses: lambda: rf.LumpedMasses([1.0, 2.0], [10.0, 20.0], [0.0, 1.0]),
    rf.LumpedStructure: lumped,
    rf.ModalProperties: lambda: frame().modal(),
    rf.ModalStructure: lambda: rf.from_matrices([1e3, 2e3], [[3e5, -1e5], [-1e5, 1e5]], [3.0, 6.0], base_mass=1e3,
                                                half_width=0.5, damping_ratio=0.02),
    rf.Model: lambda: rf.Model(2, complete=True, closure="SI"),
    rf.OutcomeFragility: lambda: rf.fit_outcomes(*RUNS),
    rf.OutcomeProbabilities: lambda: rf.fit_outcomes(*RUNS).probabilities([0.5, 1.5]),
    rf.OverturningScales: lambda: rf.overturning_scales(frame(), motion(), [0.01, 0.02]),
    rf.PinnedBeam: lambda: rf.pinned_beam("flexure", 0.5),
    rf.MomentRotation: lambda: rf.moment_rotation(frame(), [0.01, -0.01]),
    rf.MomentRotationOnSprings: lambda: rf.moment_rotation(
        frame(), [0.01], ground=rf.Ground(springs=rf.Springs([-0.2, 0.2], 1e9), base_inertia=1e3)
    ),
    rf.BilinearFit: lambda: pushed().fit(),
    rf.Project: lambda: project(),
    rf.ProjectResults: lambda: project().run().results,
    rf.Pushover: lambda: pushed(),
    rf.PushoverEvent: lambda: pushed().events[0],
    rf.Pivot: lambda: rf.Eccentric(frame(), 0.1).rocking().pivot(-1),
    rf.PopulationStatistics: statistics,
    rf.Progress: lambda: rf.Progress(3, 2, 1, 64),
    rf.RecordInfo: lambda: rf.RecordInfo(event="none", azimuth=90.0),
    rf.RecordSurvey: survey,
    rf.Requirement: lambda: rf.Requirement(0.02, 0.1, hazard=rf.HazardCurve([0.1, 1.0], [1e-2, 1e-4])),
    rf.Response: response,
    rf.RotatedSpectrum: lambda: rf.rotated_spectrum(motion(), motion().scaled(0.5), [0.5, 1.0]),
    rf.Restitution: lambda: rf.Restitution(0.5),
    rf.AngularMomentum: lambda: rf.AngularMomentum(0.9),
    rf.PivotImpulse: rf.PivotImpulse,
    rf.Restrained: lambda: rf.Restrained(frame(), tendons()),
    rf.RitzShapes: lambda: rf.cosine_shapes(10.0, 3),
    rf.RockingProperties: lambda: rf.Restrained(frame(), tendons()).rocking(),
    rf.Section: lambda: rf.Section.tube(1.0, 0.02, elastic_modulus=210e9, density=7850.0, stiffness_factor=0.9),
    rf.SecondMode: lambda: rf.modal_combination(frame(), motion()).second,
    rf.Selection: lambda: rf.Suite([motion()]).select(rf.ec8_spectrum(2.0, "B"), 1, (0.2, 1.0)),
    rf.Springs: lambda: rf.winkler_bed(2.0, 3.0, 4e7, n=5),
    rf.StationRecord: lambda: rf.StationRecord("A", (motion(),), motion().vertical_motion),
    rf.Suite: lambda: rf.Suite([motion(), dataclasses.replace(motion(), name="other")], "two"),
    rf.SurveyEntry: lambda: survey().entries[0],
    rf.Finding: lambda: rf.Finding("unit", "g", 'label "acc (g)"'),
    rf.TaperedTower: lambda: rf.TaperedTower(200, 8, 4, 1, 2400, 25e9, 0.02),
    rf.ConditionalSpectrum: lambda: rf.ConditionalSpectrum([0.1, 1.0], [5.0, 2.0], [0.5, 0.0], 1.0, 0.02, "site"),
    rf.TargetSpectrum: lambda: rf.TargetSpectrum([0.1, 1.0], [5.0, 2.0], 0.02, "site"),
    rf.Tendon: lambda: tendons()[0],
    rf.TendonLevel: lambda: rf.TendonLevel(0.5, 0.5),
    rf.DistributionComparison: lambda: rf.compare_distributions(RUNS[0], 1.1 * RUNS[0], n_resamples=100),
    rf.SubsetEstimate: lambda: rf.subset_simulation(lambda u: u.sum(axis=1), 2, 3.0, n=100),
    rf.Sensitivity: lambda: response().sensitivity,
    rf.Gradient: lambda: rf.gradient(frame(), motion(), parameters=["period"]),
    rf.Identification: lambda: rf.identify(frame(), motion(), response().resample(motion().dt).rotation, ["period"]),
    rf.KinematicCheck: lambda: rf.kinematic_check(rf.rigid_block(width=0.6, height=6.0, mass=7e3), rf.ec8_spectrum(2)),
    rf.Tornado: lambda: rf.tornado(frame(), motion(), parameters={"period": 0.1}),
    rf.UnanimousOutcome: lambda: rf.UnanimousOutcome(True, 4),
    rf.UpliftedModes: lambda: rf.uplifted_modes(frame().rocking()),
    rf.VVELComplete: rf.VVELComplete,
    rf.VVELSimplified: rf.VVELSimplified,
    rf.ViscousDamper: lambda: rf.ViscousDamper(1e5, -0.2),
    rf.WallFrame: lambda: rf.WallFrame(30.0, 3e5, 2.0, 1.0, 1e4, 8.0, 0.02),
    rf.YieldingStories: lambda: rf.YieldingStories(make_frame(n_stories=2, stiffness_ratio=math.inf), [1e5, 8e4], 0.05),
    rf.YieldingDissipator: lambda: rf.YieldingDissipator(1e7, 1e5, 0.02, rupture_elongation=0.1),
    # not in `rockflex` itself, but in what it returns
    UnsavedLaw: lambda: UnsavedLaw("Mine()", "this", "that"),
    MassNormalisedModes: lambda: VALUES[rf.ModalStructure]().modes,
    RockingModel: lambda: RockingModel("2DOF-C", frame().rocking(1), bouc_wen=rf.BoucWen(0.05), complete=True),
}  # fmt: skip
STUDIES = {
    rf.Case: lambda: rf.Case(**STUDY),
    rf.CloudStudy: lambda: rf.CloudStudy(**STUDY, scales=[1.0, 2.0]),
    rf.DesignStudy: lambda: rf.DesignStudy(**STUDY, half_widths=[1.0, 1.5], level=0.5),
    rf.IncrementalStudy: lambda: rf.IncrementalStudy(**STUDY),
    rf.MonteCarloStudy: lambda: rf.MonteCarloStudy(
        records=STUDY["records"],
        variables={"b": {"uniform": [0.1, 0.3]}},
        structure={"block": {"slenderness": "= b", "half_diagonal": 3.0}},
    ),
    rf.PopulationStudy: lambda: rf.PopulationStudy(records=STUDY["records"], pairs=4, seed=1),
    rf.Records: lambda: rf.Records(suites=["el-centro-1940"]),
    rf.StripeStudy: lambda: rf.StripeStudy(**STUDY, measure="pga", levels=[1.0]),
}
NO_VALUES = {rf.Attachment, rf.ElementLaw, rf.StudyFolder}  # a place on the disk, held open by a process
UNHASHABLE = {
    rf.BestDesign,
    rf.Comparison,
    rf.PopulationStatistics,
    rf.ProjectResults,
    rf.RateShares,
    rf.Sensitivity,
}  # they hold tables

cases = pytest.mark.parametrize("make", VALUES.values(), ids=[kind.__name__ for kind in VALUES])


def test_every_public_value_is_tested_here():
    public = {found for name in rf.__all__ if isinstance(found := getattr(rf, name), type)}
    values = {kind for kind in public if dataclasses.is_dataclass(kind) or issubclass(kind, BaseModel | tuple)}
    assert values - NO_VALUES <= VALUES.keys() | STUDIES.keys()


@pytest.mark.parametrize(("kind", "make"), (VALUES | STUDIES).items())
def test_made_of_the_same_is_the_same(kind, make):
    one, other = make(), make()
    assert type(one) is kind
    assert one is not other
    assert one == other


@pytest.mark.parametrize("kind", VALUES | STUDIES)
def test_no_field_can_be_set(kind):
    if dataclasses.is_dataclass(kind):
        assert kind.__dataclass_params__.frozen
    else:
        assert kind.model_config["frozen"]


@pytest.mark.parametrize("make", [make for kind, make in VALUES.items() if kind not in UNHASHABLE])
def test_equal_values_are_one_key(make):
    assert len({make(), make(), pickle.loads(pickle.dumps(make()))}) == 1


@pytest.mark.slow
@pytest.mark.parametrize("make", (VALUES | STUDIES).values())
@pytest.mark.parametrize("clone", [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_a_copy_is_the_same(make, clone):
    value = make()
    if hasattr(value, "modal"):
        value.modal()  # what it then keeps goes into no copy
    twin = clone(value)
    assert twin == value
    assert type(twin) is type(value)


@cases
def test_every_field_counts(make):
    value = make()
    for field in (each for each in dataclasses.fields(value) if each.compare):
        other = copy.copy(value)
        vars(other)[field.name] = object()
        assert other != value, field.name


@pytest.mark.slow
@cases
@pytest.mark.parametrize("clone", [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_arrays_stay_read_only(make, clone):
    value = make()
    for each in (value, clone(value)):
        assert not [name for name, array in arrays_in(each) if array.flags.writeable]


def arrays_in(value: object, name: str = "") -> Iterator[tuple[str, np.ndarray]]:
    if isinstance(value, np.ndarray):
        yield name, value
    elif isinstance(value, list | tuple):
        for place, each in enumerate(value):
            yield from arrays_in(each, f"{name}[{place}]")
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            yield from arrays_in(getattr(value, field.name), f"{name}.{field.name}")


def test_a_copied_structure_gives_the_same_numbers():
    for make in (VALUES[rf.TaperedTower], VALUES[rf.CantileverWithTipMass], beam, lumped, VALUES[rf.WallFrame]):
        structure = make()
        assert pickle.loads(pickle.dumps(structure)).rocking() == structure.rocking()


def test_functions_are_equal_to_themselves_alone():
    def mass(z):
        return 1e3 + 0.0 * z

    assert beam(mass=mass) == beam(mass=mass)
    assert beam(mass=mass) != beam(mass=lambda z: 1e3 + 0.0 * z)


def test_a_table_is_the_same_in_lists_and_in_arrays():
    assert beam(mass=(np.array([0.0, 4.0, 10.0]), (2e3, 1e3, 1e3))) == beam()


def test_the_users_table_cannot_change_a_beam():
    values = [2e3, 1e3]
    made = beam(mass=([0.0, 10.0], values))
    values[0] = 9e3
    assert made.mass[1][0] == 2e3


@dataclasses.dataclass(frozen=True, eq=False)
class Pair(Value):
    first: object
    second: object = None


@dataclasses.dataclass(frozen=True, eq=False)
class Other(Value):
    first: object
    second: object = None


SAME = [
    (np.array([1.0, np.nan]), np.array([1.0, -np.nan])),  # a missing number is a missing number
    (np.array([0.0]), np.array([-0.0])),
    (np.array([1, 2]), np.array([1.0, 2.0])),
    (math.nan, float("nan")),
    (np.float64("nan"), math.nan),
    (0.0, -0.0),
    (1, 1.0),
    ([1.0, (np.array([1.0]),)], [1.0, (np.array([1.0]),)]),
    ({"a": np.array([1.0])}, {"a": np.array([1.0])}),
    (np.array(["a"]), np.array(["a"])),
    (Pair(np.array([1.0])), Pair(np.array([1.0]))),
]
DIFFERENT = [
    (np.array([1.0]), np.array([1.0, 1.0])),
    (np.array([1.0]), np.array([[1.0]])),
    (np.array([1.0]), 1.0),
    (np.array([1.0, 2.0]), (1.0, 2.0)),
    (np.array([np.nan]), np.array([1.0])),
    ((1.0,), [1.0]),
    ((1.0,), (1.0, 2.0)),
    (np.array([]), None),
    ({"a": 1.0}, {"b": 1.0}),
    (math.nan, 1.0),
    (Pair(1.0), Other(1.0)),
    (pd.DataFrame({"a": [1.0]}), np.array([1.0])),
    (pd.DataFrame({"a": [1.0]}), "a"),
]


@pytest.mark.parametrize(("one", "other"), SAME)
def test_same(one, other):
    assert Pair(one) == Pair(other)
    assert hash(Pair(one)) == hash(Pair(other))


@pytest.mark.parametrize(("one", "other"), DIFFERENT)
def test_different(one, other):
    assert Pair(one) != Pair(other)
    assert Pair(other) != Pair(one)


def test_another_class_is_another_value():
    assert Pair(1.0) != Other(1.0)
    assert Pair(1.0) != (1.0, None)


def test_a_table_has_no_hash():
    table = Pair(pd.DataFrame({"a": [1.0, np.nan]}))
    assert table == Pair(pd.DataFrame({"a": [1.0, np.nan]}))
    assert table != Pair(pd.DataFrame({"a": [1.0, 2.0]}))
    with pytest.raises(TypeError, match="unhashable type: 'DataFrame'"):
        hash(table)
