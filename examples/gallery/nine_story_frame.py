"""
Nine stories: base shear by higher modes
========================================

A braced steel frame of nine stories may lift off at its columns; beside each
stand a post-tensioned tendon and a fuse. Such frames were tested by Eatherton
and others (2014, Journal of Structural Engineering 140(11)). Rocking limits
the moment at the base, and with it the first mode. Wiebe & Christopoulos
(2009, Journal of Earthquake Engineering 13(S1)) showed that it hardly limits
the higher modes, which rule the shear and the moment further up. The frame is
simulated with its first mode and with all nine.
"""

import numpy as np
from matplotlib.figure import Figure

import rockflex as rf
from rockflex.fragility import residual_rotation_limit_state

STORIES, STORY_HEIGHT, BAY = 9, 4.0, 6.0  # m
STEEL = 200e9  # Pa
COLUMN, BRACE = 0.060, 0.014  # m² of each
heights = STORY_HEIGHT * np.arange(1, STORIES + 1)

# Columns carry the moment and braces the shear, so flexibilities add up:
# those of a cantilever, and of the stories.
flexure = STEEL * COLUMN * BAY**2 / 2.0
length = np.hypot(BAY / 2.0, STORY_HEIGHT)  # of the two braces of a story
story_stiffness = 2.0 * STEEL * BRACE / length * (BAY / 2.0 / length) ** 2
low, high = (
    np.minimum.outer(heights, heights),
    np.maximum.outer(heights, heights),
)
flexibility = low**2 * (3.0 * high - low) / (6.0 * flexure) + low / (
    STORY_HEIGHT * story_stiffness
)
bare = {
    "masses": np.full(STORIES, 120e3),
    "stiffness": np.linalg.inv(flexibility),
    "heights": heights,
    "base_mass": 60e3,
    "half_width": BAY / 2.0,
    "damping_ratio": 0.02,
}

area = 24 * 140e-6  # m², of the strands at one column
TENDON = {
    "initial_force": 0.6 * 1580e6 * area,
    "stiffness": 195e9 * area / heights[-1],
    "yield_force": 1580e6 * area,
    "post_yield_ratio": 0.02,
}
FUSE = {
    "stiffness": 8.0e6 / 0.005,
    "yield_force": 8.0e6,
    "post_yield_ratio": 0.01,
}  # yields at 5 mm: a core of 3 m
frame = rf.Restrained(
    rf.LumpedStructure(**bare),
    [
        element
        for x in (-BAY / 2.0, BAY / 2.0)
        for element in (
            rf.Tendon(**TENDON, position=x),
            rf.YieldingDissipator(**FUSE, position=x),
        )
    ],
)
drawing = rf.plot_structure(frame)
p = frame.rocking()
print("periods on a fixed base", frame.modal(3).period.round(2), "s")
print(
    "shares of the mass",
    (p.effective_mass / p.effective_mass.sum()).round(2)[:3],
)
print(
    f"λ = {p.recentring_ratio:.2f}; it lifts off at "
    f"{p.resisting_moment / 1e6:.1f} MN m"
)

# %%
# A slow cycle. To either side only the tendon and the fuse of the far column
# are stretched. Once its tendons have yielded and lost prestress, the frame
# no longer closes.
curve = rf.moment_rotation(
    frame, [0.01, -0.01, 0.02, -0.02, 0.03, -0.03, 0.0]
)
flag = rf.plot_loops(curve)
print(
    f"a tendon yields at {0.4 * 1580e6 / 195e9 * heights[-1] / BAY:.4f} rad"
)
print("residual rotations [rad]:", curve.residual_rotations.round(4))

# %%
# One record with one mode and with all: rotation and base moment nearly
# agree, and the base shear does not.
suite = rf.load_suite("fema-p695-far-field")
MODELS = ("2DOF-S", "MDOF-S")
motion = suite["FF-1-b"].scaled(3.0)
history = rf.plot_history(
    [
        rf.simulate(frame, motion, model, free_vibration=2.0)
        for model in MODELS
    ]
)


# %%
# Eleven records at three scales: the largest shear of each story and the
# largest moment at each level, medians of the records. Dashed lines are the
# first mode alone.
def envelopes(model: str, scale: float) -> dict[str, np.ndarray]:
    """Peaks of each record: rotation, shear by story, moment by level."""
    rotation, shear, moment = [], [], []
    for record in suite[::4]:
        response = rf.simulate(frame, record.scaled(scale), model)
        above = (
            np.cumsum(response.story_shear[:, ::-1], axis=1)[:, ::-1]
            * STORY_HEIGHT
        )
        rotation.append(response.max_rotation)
        shear.append(np.abs(response.story_shear).max(axis=0))
        moment.append(np.abs(above).max(axis=0))
    return {
        "rotation": np.array(rotation),
        "shear": np.array(shear),
        "moment": np.array(moment),
    }


SCALES = (1.0, 2.0, 4.0)
peaks = {
    (model, scale): envelopes(model, scale)
    for scale in SCALES
    for model in MODELS
}
profiles = Figure(figsize=(7.0, 3.4), layout="constrained")
left, right = profiles.subplots(1, 2, sharey=True)
for (model, scale), found in peaks.items():
    style = {
        "color": f"C{SCALES.index(scale)}",
        "linestyle": "-" if model == "MDOF-S" else "--",
    }
    left.stairs(
        np.median(found["shear"], axis=0) / 1e6,
        [0.0, *heights],
        orientation="horizontal",
        **style,
    )
    levels = [*np.median(found["moment"], axis=0) / 1e6, 0.0]
    right.plot(
        levels, [0.0, *heights], label=f"{model}, scale {scale:g}", **style
    )
left.set(xlabel="story shear [MN]", ylabel="height [m]")
right.set(xlabel="moment [MN m]")
right.legend(fontsize=7)
for scale in SCALES:
    one, every = (
        {
            name: np.median(of, axis=0)
            for name, of in peaks[model, scale].items()
        }
        for model in MODELS
    )
    print(
        f"scale {scale:g}, all modes over the first: rotation "
        f"{every['rotation'] / one['rotation']:.2f}, base moment "
        f"{every['moment'][0] / one['moment'][0]:.2f}, base shear "
        f"{every['shear'][0] / one['shear'][0]:.2f}, "
        f"moment at 16 m {every['moment'][4] / one['moment'][4]:.2f}"
    )

# %%
# What depends on the rotation may be found with the first mode: the
# probability that a tendon yields, and that the base then stays open, because
# the tendons lost prestress. Every record is scaled to five levels of PGV.
study = rf.StripeStudy(
    structures=[
        {
            "name": "nine stories",
            "lumped": {
                key: np.asarray(value).tolist() for key, value in bare.items()
            },
            "elements": [
                {"kind": kind, "position": x, **values}
                for x in (-BAY / 2.0, BAY / 2.0)
                for kind, values in (
                    ("tendon", TENDON),
                    ("yielding_dissipator", FUSE),
                )
            ],
        }
    ],
    records={"suites": ["fema-p695-far-field"]},
    models=list(MODELS),
    levels=[0.5, 1.0, 1.5, 2.0, 2.5],
    free_vibration="settle",
)
runs = rf.run_study(study)
yielding = rf.plot_stripes(runs, "tendon_yield", "pgv")

# %%
# A residual rotation of 0.0001 rad is a gap of 0.6 mm under the far column.
opened = rf.plot_stripes(runs, residual_rotation_limit_state(1e-4), "pgv")
left_open = runs[runs["residual_rotation"] != 0.0]
print(
    f"{len(left_open)} of {len(runs)} runs leave the base open; a tendon "
    f"yielded in {left_open['tendon_yield'].sum()}."
)
print(
    "residual rotation at most "
    f"{left_open['residual_rotation'].abs().max():.5f} rad"
)

# %%
# What depends on the higher modes may not: the median base shear at each
# level.
print(
    runs.pivot_table(
        index="level",
        columns="model",
        values="max_base_shear",
        aggfunc="median",
    )
    .div(1e6)
    .round(1)
)
