"""Elements that yield and dampers in integrated models, against an independent integration by SciPy."""

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from twins import impact_laws
from twins.complete import complete_frame
from twins.complete_model import BoucWen, Structure
from twins.controlled import Bar, Dashpot
from twins.controlled_complete import simulate_controlled

FRAME = frame_values(stiffness_ratio=0.125, period=0.7, aspect_ratio=7.0)
B = rf.Frame(**FRAME).rocking().half_width
SPRING = (0.04, 0.02, 0.5, 0.5, 8.0)
ELEMENTS = {
    "fuses": [rf.YieldingDissipator(2e7, 2e5, 0.02, x) for x in (B, -B)],
    "fuses in tension": [rf.YieldingDissipator(2e7, 2e5, 0.02, x, tension_only=True) for x in (B, -B)],
    "tendon": [rf.Tendon(1.2e5, 2e7, 0.0, 2e5, 0.01)],
    "dampers": [rf.ViscousDamper(2e6, x) for x in (0.8 * B, -0.8 * B)],
    "asymmetric": [
        rf.YieldingDissipator(3e7, 1.5e5, 0.05, 1.1 * B),
        rf.YieldingDissipator(2e7, 1e5, 0.0, -0.9 * B, tension_only=True),
        rf.Tendon(1e5, 2e7, 0.1, 2e5, 0.02),
        rf.Tendon(1e5, 1e7, -0.2),
        rf.ViscousDamper(1e6, -0.5 * B),
    ],
}
MODELS = {
    # label: modes of the twin, what else the twin is told, what else the model is
    "2DOF-C": (1, {"law": impact_laws.CompleteVVEL()}, {}),
    "4DOF-C-SI": (3, {"law": impact_laws.SimplifiedVVEL()}, {}),
    "2DOF-S-BW": (
        1,
        {"law": impact_laws.SimplifiedVVEL(), "complete": False, "bouc_wen": BoucWen(*SPRING)},
        {"bouc_wen": rf.BoucWen(*SPRING)},
    ),
    "rigid-C": (0, {"law": impact_laws.Restitution(0.9)}, {"impact": rf.Restitution(0.9)}),
}
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment")
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
MOTION = rf.GroundMotion(2.5 * EL_CENTRO.acceleration[60:260], EL_CENTRO.dt)


def of_twin(element):
    """The element as the twin knows it."""
    if isinstance(element, rf.ViscousDamper):
        return Dashpot(element.coefficient, element.position)
    if isinstance(element, rf.YieldingDissipator):
        return Bar(
            element.stiffness,
            element.yield_force,
            element.post_yield_ratio,
            element.position,
            no_push=element.tension_only,
        )
    ratio, limit = element.post_yield_ratio, element.yield_force
    return Bar(
        element.stiffness,
        np.inf if ratio is None else limit,
        0.0 if ratio is None else ratio,
        element.position,
        element.initial_force / element.stiffness,
        no_push=ratio is not None,
    )


def both(model, elements, eccentricity=0.0, motion=MOTION, output="history"):
    n_modes, told, options = MODELS[model]
    given = complete_frame(**FRAME, n_modes=max(n_modes, 1))
    if n_modes == 0:
        given |= dict.fromkeys(("omega", "effective_mass", "effective_height", "top_ordinate", "zeta"), ())
    twin = simulate_controlled(
        Structure.of(**given, eccentricity=eccentricity),
        [of_twin(each) for each in elements],
        motion.acceleration,
        motion.dt,
        free=0.4,
        **told,
    )
    structure = rf.Eccentric(rf.Frame(**FRAME), eccentricity) if eccentricity else rf.Frame(**FRAME)
    run = rf.simulate(rf.Restrained(structure, elements), motion, model, output, free_vibration=0.4, **options)
    return twin, run


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("case", ELEMENTS)
def test_peaks_and_events(case, model):
    twin, run = both(model, ELEMENTS[case], 0.25 if case == "asymmetric" else 0.0)
    assert (run.n_uplifts, run.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    for name in PEAKS:
        print(name, getattr(run, name), getattr(run, name) / max(getattr(twin, name), 1e-300) - 1)
    print(twin.n_impacts, run.max_rotation)
    np.testing.assert_allclose(run.impact_times, twin.impact_times, rtol=0.0, atol=1e-7)
    for name in PEAKS:
        assert getattr(run, name) == pytest.approx(getattr(twin, name), rel=1e-7, abs=1e-14), name
