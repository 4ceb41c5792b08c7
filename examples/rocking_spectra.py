"""Rigid blocks: a record at many sizes, and two pulses at many frequencies."""

from pathlib import Path

import numpy as np

import rockflex as rf

OUT = Path("out/spectra")


def main() -> None:
    """Write both figures."""
    motion = rf.load_suite("el-centro-1940")[0]
    rocking = rf.rocking_spectrum(motion, (0.15, 0.2, 0.25), np.linspace(1.0, 10.0, 181))
    rf.save_figure(rf.plot_rocking_spectrum(rocking, title=motion.name), OUT / "rocking-spectrum.png")
    block = rf.rigid_block(0.2, 1.5)
    grid = {"frequency_ratios": np.linspace(0.5, 8.0, 31), "relative_amplitudes": np.arange(1.0, 16.0, 0.1)}
    tables = {
        "half sine": rf.overturning_spectrum(block, lambda a, t: rf.half_sine_pulse(a, t / 2, t / 400), **grid),
        "one sine": rf.overturning_spectrum(block, lambda a, t: rf.one_sine_pulse(a, t, t / 400), **grid),
    }
    title = "Rigid block, α = 0.2 rad, Housner's impact"
    rf.save_figure(rf.plot_overturning_spectrum(tables, title=title), OUT / "overturning-spectrum.png")
    print(f"2 figures written to {OUT.resolve()}")


if __name__ == "__main__":
    main()
