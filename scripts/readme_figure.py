"""Draw the figure of the README and the moving picture of the home page: a frame on a fixed and on a rocking base."""

import math
from pathlib import Path

import rockflex as rf

FOLDER = Path(__file__).parents[1] / "docs" / "_static"


def main() -> None:
    frame = rf.Frame(
        n_stories=5,
        story_height=3.0,
        story_mass=40e3,
        base_mass=40e3,
        stiffness_ratio=math.inf,
        period=1.0,
        aspect_ratio=10.0,
        damping_ratio=0.02,
    )
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    responses = [rf.simulate(frame, motion, model) for model in ("fixed", "MDOF-S")]
    figure = rf.plot_history(
        responses,
        labels=["fixed base", "base that rocks (MDOF-S)"],
        panels=("rotation", "base_moment"),
        title="Five-story frame under El Centro 1940 × 1.5",
    )
    print(f"written to {rf.save_figure(figure, FOLDER / 'rocking-and-fixed.png')}")
    moving = rf.animate(
        responses,
        FOLDER / "rocking.gif",
        labels=["base held down", "base that rocks"],
        panels=["base_moment", "ground_acceleration"],
        start=1.0,
        stop=9.0,
        frames_per_second=10,
        width=600,
    )
    print(f"written to {moving}, {moving.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
