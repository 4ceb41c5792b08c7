"""Small studies, computed once."""

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from design_case import LEVELS, STRUCTURE, WIDTHS
from drawn_studies import FRAMES, MODELS, SUITE
from rockflex.papers.silva_stojadinovic_2024.population import run_population
from rockflex.studies.cloud import run_cloud
from rockflex.studies.incremental import run_incremental


@pytest.fixture(scope="session")
def cloud():
    return run_cloud(FRAMES, list(SUITE)[:16], MODELS, [0.3, 1.0, 2.5])


@pytest.fixture(scope="session")
def pairs():
    return run_population(SUITE, 120, 7)


@pytest.fixture(scope="session")
def ladders():
    return run_incremental({"#1": FRAMES["#1"]}, list(SUITE)[:8], "2DOF-S", 0.2, 12.0, 1.2)


@pytest.fixture(scope="session")
def stripes():
    """Made-up outcomes: of ten runs at each level 0, 2, 5 and 9 overturn."""
    rows = [
        {"level": level, "structure": "#1", "model": "MDOF-S", "status": "overturned" if i < falls else "rocking"}
        for level, falls in ((0.5, 0), (1.0, 2), (1.5, 5), (2.5, 9))
        for i in range(10)
    ]
    table = pd.DataFrame(rows)
    table["max_rotation"] = np.where(table["status"] == "overturned", np.pi / 2, 0.01)
    return table.assign(nominal_overturning=table["status"] == "overturned")


@pytest.fixture(scope="session")
def designed():
    return rf.run_design(STRUCTURE, list(SUITE), WIDTHS, LEVELS, scales=[1.0, 2.0])


EMPTY = '<svg viewBox="0 0 1 1"></svg>'


@pytest.fixture
def undrawn(monkeypatch):
    """Reports whose figures are empty, for tests of their words and numbers: drawing takes most of the time."""
    import rockflex.plot._figures

    monkeypatch.setattr(rockflex.plot._figures, "figure_as_svg", lambda figure: EMPTY)
