"""Section 3.4: formulas of the parameters (Table 2), and uplifted frequencies and moments (Figures 10 to 12)."""

import math
from functools import lru_cache

import numpy as np

import rockflex as rf
from rockflex.foundation.arrays import Array
from rockflex.papers.silva_stojadinovic_2024 import _comparison as compare
from rockflex.papers.silva_stojadinovic_2024._inputs import BEHAVIOURS, MARK, PaperRecords, table_1_frame, tall_frame
from rockflex.report._document import PublishedNumber, ReproducedResult

TABLE_2 = "Formulas of the eight parameters of 2DOF-S"
GRAVITY = 9.81
FIGURE_10 = "Uplifted over fixed-base frequencies"
PLACE = "Section 3.4"
LOW = (1.0, 2.0)  # h*_1/B that a building can have at the least
NARROW = 1000.0
SHOWN: list[float] = np.geomspace(0.1, NARROW, 201).tolist()
MODES = {"2DOF-S": (1,), "3DOF-S": (1, 2), "MDOF-S": (1, 2)}
FEW = [(model, n) for model, modes in MODES.items() if model != "MDOF-S" for n in modes]
NOTE = (
    "15 stories of 3 m and 40 t, T_1 = 1 s, a base of 40 t: the paper does not give period or base mass. The "
    "pinned beam has uniform mass and stiffness and is not subject to gravity."
)
FIGURE_11 = "Base moment against rotation of a pinned beam and of a rocking base"
FIGURE_12 = "Zeros of the frequency equation at h*_1/B = 10"
STATEMENTS = (
    ("shear", "2DOF-S", 1, "poor", "> 50"),
    ("shear", "3DOF-S", 1, "quite close to MDOF-S", "< 1"),
    ("shear", "3DOF-S", 2, "quite inaccurate", "> 50"),
    ("flexure", "3DOF-S", 1, "essentially the same as MDOF-S", "< 5"),
    ("flexure", "3DOF-S", 2, "essentially the same as MDOF-S", "< 5"),
    ("flexure", "2DOF-S", 1, "quite good; likely satisfactory below 10", "< 20"),
)


def table_2(_: PaperRecords) -> ReproducedResult:
    """Compare the sums of the table with the parameters of structure #1, and some with those of the chimney."""
    frame = table_1_frame("#1")
    p, damping = frame.rocking(), 0.02
    omega, shape = _shear_building_first_mode(frame)
    height = frame.story_height * np.arange(1, frame.n_stories + 1)
    mass, b = np.full(frame.n_stories, frame.story_mass), p.half_width
    first, total = float(mass @ shape), float(mass @ shape**2)
    formulas = {
        "m*_1": (first**2 / total, p.effective_mass[0], "(Σ m_i φ_i1)²/Σ m_i φ_i1²"),
        "h*_1": (float(height @ (mass * shape)) / first, p.effective_height[0], "Σ h_i m_i φ_i1/Σ m_i φ_i1"),
        "Γ_1 φ_top,1": (first / total * shape[-1], p.top_ordinate[0], "Σ m_i φ_i1/Σ m_i φ_i1² times φ_N1"),
        "ω_1": (omega, p.omega[0], "det(k_s − ω² m_s) = 0"),
        "I_θ": (
            float(mass @ (height**2 + b**2)) + frame.base_mass * b**2, p.i_theta, "Σ m_i (h_i² + B²), i from 0",
        ),
        "L_0^r": (float(mass @ height), p.l0r, "Σ m_i h_i"),
        "M_r": ((float(mass.sum()) + frame.base_mass) * GRAVITY * b, p.resisting_moment, "m_tot g B"),
        "ζ": (damping, float(p.zeta[0]), "given"),
    }  # fmt: skip
    checks = [
        compare.check(
            f"#1: {name}, formula over ours, less 1", "Table 2", formula, 1e9 * abs(value / ours - 1.0), "< 1", "10⁻⁹"
        )
        for name, (value, ours, formula) in formulas.items()
    ]
    note = (
        "The table has formulas and no numbers: that our parameters follow them is a check of the library, and nothing "
        "of the paper's is reproduced by it."
    )
    return ReproducedResult("table-2", TABLE_2, note=note, checks=checks)


def _shear_building_first_mode(frame: rf.Frame) -> tuple[float, Array]:
    """Return first frequency and shape of the shear building in closed form, sin((2i − 1)…); T_1 is given."""
    n = frame.n_stories
    turn = math.pi / (2 * n + 1)
    stiffness = frame.story_mass * (math.pi / (frame.period * math.sin(0.5 * turn))) ** 2
    omega = 2.0 * math.sqrt(stiffness / frame.story_mass) * math.sin(0.5 * turn)
    return omega, np.sin(turn * np.arange(1, n + 1))


@lru_cache
def uplifted_frequency_ratio(behaviour: str, model: str, mode: int, aspect_ratio: float) -> float:
    """Return ω*_n/ω_n of 2DOF-S, 3DOF-S or MDOF-S."""
    kept = {"2DOF-S": 1, "3DOF-S": 2, "MDOF-S": None}[model]
    modes = rf.uplifted_modes(tall_frame(behaviour, aspect_ratio).rocking(), kept)
    return float(modes.ratio[mode - 1])


def frequency_ratio_error(behaviour: str, model: str, mode: int, aspect_ratio: float) -> float:
    """Return the error of this ratio relative to MDOF-S, in per cent."""
    mine, every = (uplifted_frequency_ratio(behaviour, each, mode, aspect_ratio) for each in (model, "MDOF-S"))
    return 100.0 * (mine / every - 1.0)


def figure_10(_: PaperRecords) -> ReproducedResult:
    """Compare the models at low aspect ratios, at the gray line of the figure and at its right end."""

    def figure() -> object:
        tables = {b: rf.frequency_ratios(tall_frame(b), SHOWN) for b in BEHAVIOURS}
        return rf.plot_frequency_ratios(tables, _pinned_beams(), mark=MARK)

    numbers = [number for behaviour in BEHAVIOURS for number in _numbers_of_behaviour(behaviour)]
    numbers.append(
        compare.judgement(
            "shear: error of ω*_1 of 2DOF-S, h*_1/B = 5", PLACE, "likely satisfactory below 5",
            frequency_ratio_error("shear", "2DOF-S", 1, 5.0), "< 20", "%", note="for flexure see Figure 12",
        )
    )  # fmt: skip
    numbers.append(_number_of_pinned_beam())
    return ReproducedResult("figure-10", FIGURE_10, numbers, {"figure-10": figure}, NOTE)


def _numbers_of_behaviour(behaviour: str) -> list[PublishedNumber]:
    growth = min(
        frequency_ratio_error(behaviour, *few, MARK) - frequency_ratio_error(behaviour, *few, 1.0) for few in FEW
    )
    first, second = (uplifted_frequency_ratio(behaviour, "MDOF-S", n, MARK) - 1.0 for n in (1, 2))
    return [
        *_numbers_at_low_aspect_ratios(behaviour),
        compare.statement(
            f"{behaviour}: growth of the error of 2DOF-S and 3DOF-S from h*_1/B = 1 to 10, least", PLACE,
            "degrades with the aspect ratio", growth, "> 0", "%",
        ),
        compare.statement(
            f"{behaviour}: rise of ω_1 over that of ω_2, MDOF-S, h*_1/B = {MARK:g}", PLACE,
            "uplift affects the first mode much more", first / second, "> 1",
        ),
    ]  # fmt: skip


def _numbers_at_low_aspect_ratios(behaviour: str) -> list[PublishedNumber]:
    """Check the text on lower aspect ratios at 1 and 2, since buildings do not have lower ones."""
    rise = {
        n: [
            max(abs(uplifted_frequency_ratio(behaviour, m, n, x) - 1.0) for m, modes in MODES.items() if n in modes)
            for x in LOW
        ]
        for n in (1, 2)
    }
    miss = max(abs(frequency_ratio_error(behaviour, *few, x)) for few in FEW for x in LOW)
    at = " and ".join(f"{x:g}" for x in LOW)
    return [
        *(
            compare.judgement(
                f"{behaviour}: ω*_{n}/ω_{n} less 1, largest of all models, h*_1/B = {at}", PLACE,
                "about 1 for lower aspect ratios", max(rise[n]), "< 0.1",
                note=f"at h*_1/B = {LOW[0]:g} it is {rise[n][0]:.3f}",
            )
            for n in (1, 2)
        ),
        compare.judgement(
            f"{behaviour}: error of 2DOF-S and 3DOF-S, largest, h*_1/B = {at}", PLACE,
            "all models predict them well at lower aspect ratios", miss, "< 5", "%",
        ),
    ]  # fmt: skip


def _number_of_pinned_beam() -> PublishedNumber:
    """Check the bound by the pinned beam, which is one claim on three models and two behaviours."""
    excess = {
        (behaviour, model): max(
            uplifted_frequency_ratio(behaviour, model, n, NARROW) / float(beam.ratio[n - 1]) for n in modes
        )
        for behaviour, beam in _pinned_beams().items()
        for model, modes in MODES.items()
    }
    found = "; ".join(f"{behaviour}, {model}: {value:.3f}" for (behaviour, model), value in excess.items())
    return compare.statement(
        f"ω*_n/ω_n over the pinned beam's, largest of all models, h*_1/B = {NARROW:g}", PLACE,
        "the pinned beam bounds MDOF-S, 2DOF-S and 3DOF-S from above", max(excess.values()), "≤ 1",
        note=f"{found}. The highest mode included represents all modes above it, and is too stiff; that of masses "
        "lumped at 15 floors decreases with more floors",
    )  # fmt: skip


def _pinned_beams() -> dict[str, rf.PinnedBeam]:
    return {"shear": rf.pinned_beam("shear"), "flexure": rf.pinned_beam("flexure")}


def figure_11(_: PaperRecords) -> ReproducedResult:
    """Measure the stiffness of the rocking base in a static equilibrium of the shear building."""
    frame = tall_frame("shear")
    p = frame.rocking()
    quiet = rf.quiet_motion(0.02, 0.001)
    start = rf.InitialState(rotation=0.5 * p.resisting_moment / (p.l0r * 9.81))
    response = rf.simulate(frame, quiet, "MDOF-S", initial=start)
    # At rest with straight masses: I_θ θ'' + Σ m*h* D'' = -(M_r - L_0^r g θ), and D'' = -h* θ''.
    free = p.i_theta - float(p.effective_mass @ p.effective_height**2)
    moment = -free * float(response.rotation_acceleration[0])
    slope = (moment - p.resisting_moment) / float(response.rotation[0]) / (p.l0r * 9.81)
    checks = (
        compare.check(
            "slope of the resisting moment of MDOF-S over L_0^r g", "Section 3.4", "negative rotational stiffness",
            slope, "< 0",
            note="by construction: M = m_tot g B − L_0^r g θ has slope −1; from the first instant of a free motion",
        ),
    )  # fmt: skip
    figures = {"figure-11": lambda: rf.plot_moment_rotation_laws(frame)}
    return ReproducedResult("figure-11", FIGURE_11, figures=figures, checks=checks)


def figure_12(_: PaperRecords) -> ReproducedResult:
    """Compare the zeros with those of MDOF-S."""
    numbers = tuple(
        compare.judgement(
            f"{behaviour}: error of ω*_{mode} of {model}", "Section 3.4", words,
            frequency_ratio_error(behaviour, model, mode, MARK), criterion, "%",
        )
        for behaviour, model, mode, words, criterion in STATEMENTS
    )  # fmt: skip
    frames = {behaviour: tall_frame(behaviour) for behaviour in BEHAVIOURS}
    note = "Errors relative to MDOF-S. The text uses words, not numbers."
    return ReproducedResult(
        "figure-12", FIGURE_12, numbers, {"figure-12": lambda: rf.plot_frequency_equation(frames)}, note
    )
