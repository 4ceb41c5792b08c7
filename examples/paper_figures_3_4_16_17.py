"""Figures 3, 4, 16 and 17 of Silva & Stojadinović (2024), and two spectra of rigid blocks.

Figures 3 and 4 of the paper show two tested specimens whose masses, lengths and damping it does not give. Shown here
are equivalents that meet its ratios, and what the ratios leave free as a band (docs/design/0007).
"""

from collections.abc import Callable, Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

import rockflex as rf
from rockflex.plot import (
    plot_history,
    plot_overturning_spectrum,
    plot_rocking_spectrum,
    plot_spread,
    plot_yielding,
    save_figure,
)

OUT = Path("out/paper")
MODELS = ("2DOF-C", "2DOF-C-SI", "2DOF-S", "MDOF-S")
PANELS = ("rotation", "top_displacement")

# Nominal values first. None of them is known of the specimens.
TWO_HZ = {"base_mass_ratio": (0.1, 0.0, 0.05, 0.2, 0.3), "damping_ratio": (0.01, 0.005, 0.02)}
S1 = {
    "base_mass_ratio": (0.3, 0.1, 0.6),
    "damping_ratio": (0.02, 0.005, 0.05),
    "width_ratio": (0.2, 0.15, 0.25),
    "effective_height": (1.0, 0.5, 2.0),
    "spacing": (1.5, 1.3, 1.65),
}

Make = Callable[..., rf.RockingProperties]
Run = Callable[[rf.RockingProperties, str], rf.Response]


def nominal(free: dict[str, tuple[float, ...]]) -> dict[str, float]:
    """First value of each parameter."""
    return {name: values[0] for name, values in free.items()}


def two_hz(properties: rf.RockingProperties, model: str) -> rf.Response:
    """2Hz-Long Base(14)'s equivalent under the paper's antisymmetric Ricker pulse."""
    return rf.simulate(properties, rf.ricker_pulse(0.1 * 9.81, 0.5), model, free_vibration=4.0)


def s1(properties: rf.RockingProperties, model: str) -> rf.Response:
    """S1's equivalent let go at 0.11 rad."""
    return rf.simulate(properties, rf.quiet_motion(3.0, 0.001), model, initial=rf.InitialState(rotation=0.11))


def one_at_a_time(free: dict[str, tuple[float, ...]]) -> list[dict[str, float]]:
    """The nominal case, then each parameter varied by itself."""
    varied = [nominal(free) | {name: value} for name, values in free.items() for value in values[1:]]
    return [nominal(free), *varied]


def all_together(free: dict[str, tuple[float, ...]]) -> list[dict[str, float]]:
    """Every combination."""
    return [dict(zip(free, values, strict=True)) for values in product(*free.values())]


def tabulate(title: str, cases: Sequence[dict[str, float]], make: Make, run: Run) -> None:
    """Print the peaks of every case; u_top of MDOF-S against 2DOF-S."""
    print(f"\n{title.replace('$', '')}\n")
    rows: list[dict[str, float | str]] = []
    for case in cases:
        peaks = {model: run(make(**case), model) for model in MODELS}
        row: dict[str, float | str] = dict(case)
        for model, response in peaks.items():
            row[f"θ {model}"] = f"{response.max_rotation:.4f}"
        for model, response in peaks.items():
            row[f"u {model}"] = f"{1e3 * response.max_top_displacement:.2f}"
        change = peaks["MDOF-S"].max_top_displacement / peaks["2DOF-S"].max_top_displacement - 1.0
        row["MDOF-S/2DOF-S"] = f"{100 * change:+.1f} %"
        rows.append(row)
    print(pd.DataFrame(rows).to_string(index=False))
    print("θ in rad, u_top in mm; the last column is the difference of u_top.")


def specimen(name: str, free: dict[str, tuple[float, ...]], make: Make, run: Run, title: str) -> None:
    """Write the histories of the nominal case, and its band."""
    responses = [run(make(**nominal(free)), model) for model in MODELS]
    save_figure(plot_history(responses, panels=PANELS, title=title), OUT / f"{name}.png")
    cases = [make(**case) for case in all_together(free)]
    varied = [[run(case, model) for case in cases] for model in MODELS]
    u_top = {m: np.array([r.max_top_displacement for r in group]) for m, group in zip(MODELS, varied, strict=True)}
    change = u_top["MDOF-S"] / u_top["2DOF-S"] - 1.0
    print(
        f"Over all {len(cases)} combinations u_top of MDOF-S differs from 2DOF-S's by {change.min():+.0%} to "
        f"{change.max():+.0%}, {np.median(change):+.1%} in the median."
    )
    save_figure(plot_spread(responses, varied, panels=PANELS, title=title), OUT / f"{name}-spread.png")


def figure_3() -> None:
    """2Hz-Long Base(14)."""
    title = "Equivalent of 2Hz-Long Base(14), not the specimen; Ricker pulse 0.1 g, 0.5 s"
    tabulate(title, one_at_a_time(TWO_HZ), rf.equivalent_2hz_long_base, two_hz)
    properties = rf.equivalent_2hz_long_base(**nominal(TWO_HZ))
    response = two_hz(properties, "2DOF-C")
    rocking = response.side != 0.0
    theta, bend = np.abs(response.rotation[rocking]), response.modal_displacement[rocking, 0] * response.side[rocking]
    weight, arm = properties.resisting_moment, properties.l0r * 9.81
    simple = weight - arm * theta
    complete = (weight - properties.effective_mass[0] * 9.81 * bend) * np.cos(theta) - arm * np.sin(theta)
    print(
        f"Nominal, 2DOF-C: simplified over complete resisting moment - 1: up to {np.max(simple / complete - 1):+.1%}, "
        f"mean {np.mean(simple / complete - 1):+.1%} (paper: about +7 %).\n"
        f"Required friction {response.required_friction:.3g}, outside 0.05 s after impacts "
        f"{response.required_friction_excluding_impacts():.3g} (paper: 0.27)."
    )
    specimen("figure-3", TWO_HZ, rf.equivalent_2hz_long_base, two_hz, title)


def figure_4() -> None:
    """S1."""
    title = "Equivalent of S1, not the specimen; released at 0.11 rad; $h^*_1$ = 1 m is assumed"
    tabulate(title, one_at_a_time(S1), rf.equivalent_s1, s1)
    print("The paper has u_top of MDOF-S about 21 % below the 2DOF models'.")
    specimen("figure-4", S1, rf.equivalent_s1, s1, title)


def figures_16_and_17() -> None:
    """Structure #1 that yields, Section 4.2."""
    frame = rf.Frame(
        n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=np.inf, period=1.0,
        aspect_ratio=10.0, damping_ratio=0.02,
    )  # fmt: skip
    motion = rf.load_suite("el-centro-1940")[0]
    elastic = rf.simulate(frame, motion, "2DOF-S")
    weak = rf.simulate(frame, motion, "2DOF-S-BW", bouc_wen=rf.BoucWen(0.035))
    strong = rf.simulate(frame, motion, "2DOF-S-BW", bouc_wen=rf.BoucWen(0.075))
    fixed = rf.simulate(frame, motion, "1DOF-fixed-BW", bouc_wen=rf.BoucWen(0.075))
    print("\nStructure #1, El Centro, Section 4.2\n")
    paper = "paper θ ≈ 0.01, u_top ≈ 0.05"
    for response, note in (
        (elastic, ""), (weak, "D_y = 0.035 m"), (strong, f"D_y = 0.075 m; {paper}"), (fixed, "D_y = 0.075 m"),
    ):  # fmt: skip
        print(
            f"{response.model:14} θ_max {response.max_rotation:.3e} rad, u_top {response.max_top_displacement:.4f} m, "
            f"|z| up to {np.max(np.abs(response.yielding)):.3f}  {note}"
        )
    names = ["2DOF-S", "2DOF-S-BW, $D_y$ = 0.035 m"]
    save_figure(plot_yielding([elastic, weak], names), OUT / "figure-16.png")
    names = ["fixed base, $D_y$ = 0.075 m", "2DOF-S-BW, $D_y$ = 0.075 m"]
    save_figure(plot_yielding([fixed, strong], names), OUT / "figure-17.png")


def spectra() -> None:
    """Rigid blocks: a record at many sizes, and two pulses at many frequencies."""
    motion = rf.load_suite("el-centro-1940")[0]
    rocking = rf.rocking_spectrum(motion, (0.15, 0.2, 0.25), np.linspace(1.0, 10.0, 181))
    save_figure(plot_rocking_spectrum(rocking, title=motion.name), OUT / "rocking-spectrum.png")
    block = rf.rigid_block(0.2, 1.5)
    grid = {"frequency_ratios": np.linspace(0.5, 8.0, 46), "relative_amplitudes": np.arange(1.0, 16.0, 0.05)}
    tables = {
        "half sine": rf.overturning_spectrum(block, lambda a, t: rf.half_sine_pulse(a, t / 2, t / 400), **grid),
        "one sine": rf.overturning_spectrum(block, lambda a, t: rf.one_sine_pulse(a, t, t / 400), **grid),
    }
    title = "Rigid block, α = 0.2 rad, Housner's impact"
    save_figure(plot_overturning_spectrum(tables, title=title), OUT / "overturning-spectrum.png")


def main() -> None:
    """Write all figures."""
    figure_3()
    figure_4()
    figures_16_and_17()
    spectra()
    print(f"\nFigures written to {OUT.resolve()}")


if __name__ == "__main__":
    main()
