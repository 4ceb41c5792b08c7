"""Fragility models and hazard curves against OpenQuake's own readers: tables on the screen.

python validation/openquake/run.py [folder]
"""

import logging
import sys
from pathlib import Path

import numpy as np
from openquake.baselib import __version__ as version
from openquake.baselib import hdf5, writers
from openquake.hazardlib import nrml
from openquake.risklib import read_nrml, scientific
from rich.console import Console
from rich.table import Table

import rockflex as rf

OUT = Path(__file__).parents[2] / "out" / "openquake"
UNITS = {"PGV": 100.0, "PGA": 1.0 / 9.81, "SA(1.0)": 1.0 / 9.81}  # of OpenQuake in one SI unit
LEVELS = np.geomspace(0.05, 20.0, 60)
TILTED = {"tilted": 0.01, "leaning": 0.05}  # rad
LIMIT = 1e-12


def lognormal(measure: str) -> dict[str, rf.LognormalFragility]:
    """Three limit states with a common dispersion; SA with a small one, at which OpenQuake loses digits."""
    beta = 0.02 if measure == "SA(1.0)" else 0.5
    medians = {"rocking": 0.4, "tilted": 1.2, "overturning": 4.0}
    return {name: rf.LognormalFragility(median, beta) for name, median in medians.items()}


def outcomes() -> rf.OutcomeFragility:
    """Fits of a synthetic cloud of runs with all three outcomes."""
    random = np.random.default_rng(7)
    im = np.exp(random.normal(0.0, 1.0, 2000))
    falls = random.random(im.size) < 1.0 / (1.0 + np.exp(5.0 - 3.0 * np.log(im)))
    rocks = falls | (random.random(im.size) < 1.0 / (1.0 + np.exp(-3.0 - 3.0 * np.log(im))))
    rotation = np.where(rocks, 0.01 * im * np.exp(random.normal(0.0, 0.4, im.size)) + 1e-4, 0.0)
    return rf.fit_outcomes(im, np.where(falls, 0.5 * np.pi, rotation), falls)


def of_outcomes(fit: rf.OutcomeFragility, im: np.ndarray) -> dict[str, np.ndarray]:
    """The probabilities that a discrete model must hold."""
    limits = {name: fit.exceedance(im, limit) for name, limit in TILTED.items()}
    return {
        "rocking": 1.0 - fit.probabilities(im).no_rocking,
        **limits,
        "overturning": fit.overturning.probability(im),
    }


def read_back(path: Path, measure: str, name: str) -> list[scientific.FragilityFunctionContinuous]:
    """The functions of a structure, as the engine builds them."""
    model = nrml.to_python(str(path))
    return model[measure, name].build(model.limitStates)


def models(folder: Path, fit: rf.OutcomeFragility) -> list[tuple[str, str, float]]:
    """Largest differences of probabilities, by measure and format."""
    found = []
    for measure, unit in UNITS.items():
        curves = lognormal(measure)
        path = rf.write_nrml(folder / f"continuous-{measure}.xml", {"pier": curves}, measure, LEVELS[[0, -1]])
        read = zip(curves.values(), read_back(path, measure, "pier"), strict=True)
        errors = [np.abs(theirs(LEVELS * unit) - mine.probability(LEVELS)).max() for mine, theirs in read]
        found.append((measure, f"continuous, β = {curves['tilted'].beta:g}", max(errors)))
        path = rf.write_nrml(folder / f"discrete-{measure}.xml", {"pier": fit}, measure, LEVELS, rotations=TILTED)
        read = zip(of_outcomes(fit, LEVELS).values(), read_back(path, measure, "pier"), strict=True)
        errors = [np.abs(theirs(LEVELS * unit) - mine).max() for mine, theirs in read]
        found.append((measure, "discrete, three outcomes", max(errors)))
    return found


def exported(folder: Path) -> Path:
    """A hazard curve of two sites in 50 years, written by the writer of OpenQuake's exports."""
    levels = np.geomspace(0.005, 2.0, 30)
    names = ["lon", "lat", "depth", *(f"poe-{level:.7f}" for level in levels)]
    array = np.zeros(2, [(name, np.float32) for name in names])
    for row, factor in enumerate((1.0, 2.0)):
        rate = factor * 2e-4 * (levels / 0.3) ** -2.2
        array[row] = (7.59, 47.56 + row, 0.0, *-np.expm1(-50.0 * rate))
    path = folder / "hazard_curve-mean-PGA_1.csv"
    writers.write_csv(
        str(path), array, comment={"kind": "mean", "investigation_time": 50.0, "imt": "PGA"}, header=names
    )
    return path


def shipped() -> list[Path]:
    """The exports that OpenQuake ships for its own tests."""
    root = Path(read_nrml.__file__).parents[1] / "qa_tests_data"
    return sorted(root.rglob("hazard_curve-mean*.csv"))


def curve_error(path: Path) -> float | None:
    """Largest relative difference of annual rates over the sites of a file; None without a curve in it."""
    wrapper = hdf5.read_csv(str(path), {"custom_site_id": str, None: float})
    levels = [name for name in wrapper.dtype.names if name.startswith("poe-")]
    if "lon" not in wrapper.dtype.names or not levels:
        return None
    unit = UNITS.get(wrapper.imt, 1.0 if wrapper.imt == "IA" else UNITS["PGA"])
    im = np.array([float(name.removeprefix("poe-")) for name in levels]) / unit
    worst = 0.0
    for row in wrapper.array:
        poe = np.array([row[name] for name in levels])
        if np.unique(poe[(poe > 0.0) & (poe < 1.0)]).size < 2:
            continue
        named = "custom_site_id" in wrapper.dtype.names
        site = str(row["custom_site_id"]) if named else (float(row["lon"]), float(row["lat"]))
        mine = rf.HazardCurve.from_openquake_csv(path, site=site)
        rates = -np.log1p(-poe[np.isin(im.round(12), mine.im.round(12))]) / wrapper.investigation_time
        worst = max(worst, float(np.abs(rates / mine.rate - 1.0).max()))
    return worst


def damage(folder: Path, hazard: Path) -> list[tuple[int, float]]:
    """Probability of overturning in 50 years by OpenQuake's classical damage, over rockflex's, by its refinement."""
    mine = rf.HazardCurve.from_openquake_csv(hazard, site=(7.59, 47.56))
    curves, found = lognormal("PGA"), []
    expected = rf.annual_rate(mine, curves["overturning"]).probability_in(50.0)
    for steps in (20, 200, 2000):
        levels = np.geomspace(mine.im[0], mine.im[-1], steps)
        path = rf.write_nrml(folder / "damage.xml", {"pier": curves}, "PGA", levels[[0, -1]])
        poe = -np.expm1(-50.0 * mine.rate_at(levels))
        functions = read_back(path, "PGA", "pier")
        states = scientific.classical_damage(functions, levels * UNITS["PGA"], poe, 50.0, 50.0)
        found.append((steps, float(states[-1]) / expected))
    return found


def main() -> None:
    """Print every table; the exit status is 1 if a difference is larger than the digits of the file allow."""
    logging.disable(logging.WARNING)
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    folder.mkdir(parents=True, exist_ok=True)
    console = Console(width=120)
    console.print(f"OpenQuake {version}, rockflex {rf.__version__}\n")
    table = Table("measure", "function", "largest difference of P", title="fragility models, read by OpenQuake")
    written = models(folder, outcomes())
    for measure, kind, error in written:
        table.add_row(measure, kind, f"{error:.1e}")
    console.print(table)

    hazard = exported(folder)
    errors = {path: error for path in [hazard, *shipped()] if (error := _error(console, path)) is not None}
    console.print(
        f"annual rates of {len(errors)} exported hazard curves, read by both: largest relative difference "
        f"{max(errors.values()):.1e}\n"
    )
    table = Table("levels", "OpenQuake / rockflex", title="probability of overturning in 50 years, by classical damage")
    ratios = damage(folder, hazard)
    for steps, ratio in ratios:
        table.add_row(str(steps), f"{ratio:.6f}")
    console.print(table)
    allowed = [LIMIT / 0.02**2 if "0.02" in kind else LIMIT for _, kind, _ in written]
    good = all(error <= limit for (*_, error), limit in zip(written, allowed, strict=True))
    if not (good and max(errors.values()) <= LIMIT and abs(ratios[-1][1] - 1.0) <= 1e-4):
        raise SystemExit("A difference is larger than the formats explain.")


def _error(console: Console, path: Path) -> float | None:
    try:
        return curve_error(path)
    except rf.InputError as error:
        console.print(f"{path.name} is refused: {str(error).removeprefix(str(path)).strip()}")
        return None


if __name__ == "__main__":
    main()
