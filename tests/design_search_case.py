"""A search whose probabilities are known in closed form: rotations follow a power law of the shaking and the design."""

import math

import numpy as np
from scipy.stats import norm

import rockflex as rf
from builders import frame_values
from rockflex.studies._run_matrix import StudyMatrix

FRAME = frame_values(n_stories=3, base_mass=50e3, period=0.6, aspect_ratio=8.0)
BARE = rf.Frame(**FRAME)
PROPERTIES = BARE.rocking()
B, WEIGHT = PROPERTIES.half_width, PROPERTIES.m_tot * 9.81
ELEMENTS = (
    rf.Tendon(0.2 * WEIGHT, 2e6, yield_force=0.8 * WEIGHT, post_yield_ratio=0.02),
    rf.YieldingDissipator(50.0 * WEIGHT, 0.05 * WEIGHT, 0.02, -B),
    rf.YieldingDissipator(50.0 * WEIGHT, 0.05 * WEIGHT, 0.02, B),
)
STRUCTURE = rf.Restrained(BARE, ELEMENTS)
SUITE = list(rf.load_suite("fema-p695-far-field"))[:30]
SCALES = [0.5, 1.0, 2.0]
COST = rf.DesignCost(half_width=1.0, prestress=1.1 / WEIGHT, dissipator_force=2.5 / WEIGHT)
SEARCH = rf.DesignSearch([1.0, 1.5, 2.0, 2.5], [0.0, 1.0, 2.0], [0.0, 1.0, 2.0], refinements=4)
EXPONENT, SPREAD = 1.4, 0.35
SLOW, STRONG = rf.Requirement(0.015, 0.1, at=0.4), rf.Requirement(0.05, 0.02, at=0.7)


def log_reduction(half_width, prestress, dissipator_force):
    """By how much a design lowers log θ; concave, so that a mixture of all three is the cheapest."""
    return (
        1.6 * np.log(half_width)
        + 0.9 * np.sqrt(0.05 + prestress / WEIGHT)
        + 1.4 * np.sqrt(0.02 + dissipator_force / WEIGHT)
    )


def log_rotation(half_width, prestress, dissipator_force, im):
    return math.log(0.05) + EXPONENT * np.log(im) - log_reduction(half_width, prestress, dissipator_force)


class Law:
    """What replaces a run: every record has one residual, the same for all designs and scales."""

    def __init__(self):
        self.residuals = SPREAD * np.random.default_rng(3).standard_normal(len(SUITE))
        self.runs = []

    def results(self, matrix, runs):
        rows = [self.run(matrix, *run) for run in runs]
        return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}

    def run(self, matrix, structure, record, model, scale):
        p = matrix.structures[structure]
        forces = sum(each.yield_force for each in p.elements if isinstance(each, rf.YieldingDissipator))
        im = matrix.motions[record].pgv * scale
        self.runs.append(p)
        rotation = math.exp(log_rotation(p.half_width, p.prestress, forces, im) + self.residuals[record])
        return {
            "structure": structure,
            "motion": record,
            "group": matrix.facts[record]["group"],
            "model": model,
            "scale": scale,
            "pgv": im,
            "status": "rocking",
            "max_rotation": rotation,
            "max_base_moment": 1.1 * p.resisting_moment,
            "nominal_limit": p.nominal_overturning_rotation,
        }

    def margin(self, requirement, half_width, prestress, dissipator_force):
        """How far log θ at the target is above the limit, by least squares over all runs; zero where it is just met."""
        x = np.log([motion.pgv * scale for motion in SUITE for scale in SCALES])
        y = EXPONENT * x + np.repeat(self.residuals, len(SCALES))
        slope, level = np.polyfit(x, y, 1)
        spread = math.sqrt(((y - slope * x - level) ** 2).sum() / (x.size - 2))
        median = math.log(0.05) + level + slope * math.log(requirement.at)
        median -= log_reduction(half_width, prestress, dissipator_force)
        return median + spread * norm.isf(requirement.target) - math.log(requirement.limit)

    def optimum(self, search, requirements, cost=COST):
        """The cheapest design of the finest grid: values of the variables, cost, and the closest requirement."""
        points = np.stack(np.meshgrid(*search.grid(search.refinements), indexing="ij"), axis=-1).reshape(-1, 3)
        b, tendon, dissipator = search.at(points).T
        forces = 0.2 * WEIGHT * tendon, 0.1 * WEIGHT * dissipator
        margins = np.array([self.margin(each, b, *forces) for each in requirements])
        price = cost.of(b, *forces)
        place = int(np.where((margins <= 0.0).all(axis=0), price, np.inf).argmin())
        return search.at(points)[place], float(price[place]), int(margins[:, place].argmax())


def replaced(monkeypatch):
    """Put the law in the place of the simulation."""
    law = Law()
    monkeypatch.setattr(StudyMatrix, "results", lambda matrix, runs: law.results(matrix, runs))
    return law
