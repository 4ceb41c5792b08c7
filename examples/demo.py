"""A five-story building on a base that can rock, under two earthquakes: structure #1 of Silva & Stojadinović (2024)."""

from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np

import rockflex as rf
from rockflex.plot import plot_history, plot_mode_shapes, plot_moment_rotation, save_figure

OUT = Path("out/demo")
MODELS = ("fixed", "2DOF-S", "3DOF-S", "MDOF-S")
REPEATS = 7

frame = rf.Frame(
    n_stories=5,
    story_height=3.0,  # m
    story_mass=40e3,  # kg
    base_mass=40e3,  # kg
    stiffness_ratio=np.inf,  # rigid beams: a shear building
    period=1.0,  # s, on a fixed base
    aspect_ratio=10.0,  # h*_1/B
    damping_ratio=0.02,
)
motions = (rf.load_suite("el-centro-1940")[0], rf.load_suite("fema-p695-far-field")["FF-2-a"])


def timed(motion: rf.GroundMotion, model: str) -> tuple[rf.Response, float]:
    """Simulate a few times; return the response and the median time of a run in ms."""
    times: list[float] = []
    for _ in range(REPEATS):
        start = perf_counter()
        response = rf.simulate(frame, motion, model, output="peaks")
        times.append(1e3 * (perf_counter() - start))
    return response, median(times)


def main() -> None:
    """Print the peaks of every run, and write the figures."""
    rf.simulate(frame, motions[0])  # so that no run below loads a module

    print(f"{'motion':18} {'model':7} {'status':10} {'θ_max':>9} {'top moves':>9} {'M_b':>8} {'V_b':>8} {'run':>8}")
    print(f"{'':18} {'':7} {'':10} {'[rad]':>9} {'[m]':>9} {'[MN m]':>8} {'[kN]':>8} {'[ms]':>8}")
    for motion in motions:
        for model in MODELS:
            r, ms = timed(motion, model)
            print(
                f"{motion.name:18} {model:7} {r.status:10} {r.max_rotation:9.5f} {r.max_total_top_displacement:9.5f} "
                f"{r.max_base_moment / 1e6:8.3f} {r.max_base_shear / 1e3:8.1f} {ms:8.2f}"
            )

    figures = {"mode-shapes": plot_mode_shapes(frame)}
    for motion in motions:
        responses = [rf.simulate(frame, motion, model) for model in MODELS]
        figures[f"history-{motion.name}"] = plot_history(responses)
        figures[f"moment-rotation-{motion.name}"] = plot_moment_rotation(responses[1:])
    print(f"\nwriting {len(figures)} figures ...", flush=True)
    for name, figure in figures.items():
        save_figure(figure, OUT / f"{name}.png")
    print(f"they are in {OUT.resolve()}")


if __name__ == "__main__":
    main()
