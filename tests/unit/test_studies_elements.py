"""Structures held by fuses, dampers and tendons that yield, in tables and studies, here and on a cluster."""

import pickle
from typing import TYPE_CHECKING

import pytest

import rockflex as rf
from builders import make_frame
from rockflex.studies._run_plan import run_plan

if TYPE_CHECKING:
    from dask_cluster import Cluster

SUITE = rf.Suite(list(rf.load_suite("fema-p695-far-field"))[:3])
MODELS = ["2DOF-S", "MDOF-S"]
FRAME = make_frame(n_stories=3, period=0.5, aspect_ratio=6.0)
WEIGHT = FRAME.rocking().m_tot * 9.81
FUSE = {"stiffness": 60.0 * WEIGHT, "yield_force": 0.2 * WEIGHT, "post_yield_ratio": 0.02}
TENDON = {"initial_force": 0.4 * WEIGHT, "stiffness": 3.0 * WEIGHT, "yield_force": 0.5 * WEIGHT}
HELD = {
    "fuse": rf.Restrained(FRAME, rf.YieldingDissipator(**FUSE)),
    "tendon and damper": rf.Restrained(
        FRAME, [rf.Tendon(**TENDON, post_yield_ratio=0.05), rf.ViscousDamper(0.1 * WEIGHT, 0.3)]
    ),
    "free": FRAME,
}
FILE = {
    "name": "fuse",
    "frame": {name: getattr(FRAME, name) for name in ("n_stories", "story_height", "story_mass", "base_mass")}
    | {"stiffness_ratio": FRAME.stiffness_ratio, "period": 0.5, "aspect_ratio": 6.0, "damping_ratio": 0.02},
    "elements": [{"kind": "yielding_dissipator", **FUSE}],
}
RECORDS = {"suites": ["fema-p695-far-field"], "include": [motion.name for motion in SUITE]}


def test_a_table_has_the_runs_of_every_structure():
    table = rf.simulate_many(HELD, SUITE, MODELS, scales=(1.0, 2.5), free_vibration="settle")
    assert table["error"].isna().all()
    for row in table.itertuples():
        alone = rf.simulate(
            HELD[row.structure], SUITE[row.motion].scaled(row.scale), row.model, "peaks", free_vibration="settle"
        )
        assert (row.status, row.max_rotation, row.n_impacts) == (alone.status, alone.max_rotation, alone.n_impacts)
    free, fused = (table[table["structure"] == name]["max_rotation"].to_numpy() for name in ("free", "fuse"))
    assert (free != fused).any()
    one = rf.simulate_many(HELD, SUITE, MODELS, scales=(1.0, 2.5), free_vibration="settle", workers=1)
    assert one.equals(table)


@pytest.mark.parametrize("name", HELD)
def test_structures_travel(name):
    again = pickle.loads(pickle.dumps(HELD[name]))
    assert again == HELD[name]
    assert again.rocking() == HELD[name].rocking()
    assert again.rocking().recentring_ratio == HELD[name].rocking().recentring_ratio


STUDIES = {
    "cloud": rf.CloudStudy(structures=[FILE], records=RECORDS, models=MODELS, scales=[1.0, 2.0]),
    "stripes": rf.StripeStudy(structures=[FILE], records=RECORDS, models=["2DOF-S"], measure="pgv", levels=[0.3, 0.6]),
    "incremental": rf.IncrementalStudy(
        structures=[FILE], records=RECORDS, models=["2DOF-S"], smallest_scale=1.0, largest_scale=8.0, growth=2.0,
        tolerance=0.2,
    ),
    "monte_carlo": rf.MonteCarloStudy(
        count=6, variables={"share": {"uniform": [0.1, 0.3]}}, records=RECORDS, models=["2DOF-S"],
        structure=FILE | {"elements": [FILE["elements"][0] | {"yield_force": "= share * weight"}]}, runs_per_chunk=6,
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", STUDIES)
def test_every_study_takes_elements(kind):
    table = run_plan(STUDIES[kind].plan())
    assert table["error"].isna().all()
    assert (table["status"] == "rocking").any()
    row = next(table.itertuples())
    p = HELD["fuse"].rocking() if kind != "monte_carlo" else STUDIES[kind].structure_of(0)
    free = "settle" if kind == "incremental" else 0.0
    alone = rf.simulate(p, SUITE[row.motion].scaled(row.scale), row.model, "peaks", free_vibration=free)
    assert (row.status, row.max_rotation) == (alone.status, pytest.approx(alone.max_rotation, rel=1e-12))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["cloud", "monte_carlo"])
def test_a_cluster_computes_the_same(kind, cluster: "Cluster"):
    study = STUDIES[kind]
    assert rf.run_study(study, dask=cluster.address).equals(rf.run_study(study))
