"""Damage parameters against Pelicun's own reader and its sampling: a table on the screen.

python validation/pelicun/run.py [folder]
"""

import sys
import warnings
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from rich.console import Console
from rich.table import Table

import rockflex as rf

with warnings.catch_warnings(action="ignore"):
    from pelicun.assessment import Assessment
    from pelicun.uq import rv_class_map

OUT = Path(__file__).parents[2] / "out" / "pelicun"
LEVELS = np.geomspace(0.05, 20.0, 60)
MEASURES = {"PGV": ("PGV-0-1", "mps"), "PGA": ("PGA-0-1", "mps2"), "SA(1.0)": ("SA_1.0-0-1", "mps2")}
SAMPLES = 20_000
LOGNORMAL, LINEAR = 1e-12, 5e-6  # Pelicun rounds piecewise linear functions to six digits


def structures() -> dict[str, dict[str, rf.LognormalFragility] | dict[str, rf.LogisticFit]]:
    """One structure of each format: lognormal curves, and logistic ones."""
    random = np.random.default_rng(7)
    im = np.exp(random.normal(0.0, 1.0, 2000))
    fails = random.random(im.size) < 1.0 / (1.0 + np.exp(-3.0 * np.log(im)))
    return {
        "tower": {"rocking": rf.LognormalFragility(0.4, 0.5), "overturning": rf.LognormalFragility(2.0, 0.5)},
        "pier": {"rocking": rf.fit_logistic(im, fails), "overturning": rf.fit_logistic(5.0 * im, fails)},
    }


def assess(path: Path, measure: str, level: float) -> Assessment:
    """An assessment with the table as its damage model, and every sample of the demand at one level."""
    demand, unit = MEASURES[measure]
    assessment = Assessment({"PrintLog": False, "Verbose": False, "Seed": 3, "LogShowMS": False})
    sample = pd.DataFrame({demand: np.full(SAMPLES, level)}, dtype=float)
    assessment.demand.load_sample(pd.concat([pd.DataFrame({demand: [unit]}, index=["Units"]), sample]))
    assessment.stories = 1
    columns = ["Units", "Location", "Direction", "Theta_0", "Family"]
    rows = [["ea", "0", "1", 1.0, np.nan] for _ in structures()]
    assessment.asset.load_cmp_model({"marginals": pd.DataFrame(rows, columns=columns, index=list(structures()))})
    assessment.asset.generate_cmp_sample(SAMPLES)
    assessment.damage.load_model_parameters([str(path)], set(structures()))
    return assessment


def parameter_error(assessment: Assessment, name: str, curves: dict[str, rf.LognormalFragility]) -> float:
    """Largest difference of probabilities between the distributions that Pelicun builds and the curves."""
    parameters, worst = assessment.damage.ds_model.damage_params.loc[name], 0.0
    for number, curve in enumerate(curves.values(), start=1):
        of = parameters[f"LS{number}"]
        theta = np.array([of["Theta_0"], of["Theta_1"]])
        if of["Family"] == "multilinear_CDF":
            theta = np.array([part.split(",") for part in of["Theta_0"].split("|")], dtype=float).T
        built = rv_class_map(of["Family"])(name="capacity", theta=theta)
        worst = max(worst, float(np.abs(built.cdf(LEVELS) - curve.probability(LEVELS)).max()))
    return worst


def sampled_error(assessment: Assessment, name: str, curves: dict[str, rf.LognormalFragility], level: float) -> float:
    """Largest difference between the share of samples in a damage state or a worse one and its probability, in σ."""
    assessment.damage.calculate()
    damage = assessment.damage.ds_model.sample[name]
    worst = 0.0
    for number, curve in enumerate(curves.values(), start=1):
        states = [column for column in damage.columns if int(column[-1]) >= number]
        p = float(curve.probability(level))
        share = float(damage[states].sum(axis=1).mean())
        worst = max(worst, abs(share - p) / np.sqrt(p * (1.0 - p) / SAMPLES))
    return worst


def main() -> None:
    """Print the table; the exit status is 1 if a difference is larger than the format explains."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    folder.mkdir(parents=True, exist_ok=True)
    console = Console(width=120)
    console.print(f"Pelicun {version('pelicun')}, rockflex {rf.__version__}\n")
    table = Table("measure", "structure", "difference of P, as read", f"of {SAMPLES} samples, in σ", title="Pelicun")
    good = True
    for measure in MEASURES:
        path = rf.write_pelicun(folder / f"fragility-{measure}.csv", structures(), measure, LEVELS)
        for name, curves in structures().items():
            level = LEVELS[30]
            assessment = assess(path, measure, level)
            read, sampled = parameter_error(assessment, name, curves), sampled_error(assessment, name, curves, level)
            table.add_row(measure, name, f"{read:.1e}", f"{sampled:.1f}")
            good &= read <= (LOGNORMAL if name == "tower" else LINEAR) and sampled < 4.0
    console.print(table)
    if not good:
        raise SystemExit("A difference is larger than the format explains.")


if __name__ == "__main__":
    main()
