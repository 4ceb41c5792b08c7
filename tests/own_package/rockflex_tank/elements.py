"""A bar with a flag-shaped loop, written with the public laws alone."""

from dataclasses import dataclass, field

import numpy as np

import rockflex as rf


@dataclass(frozen=True)
class Flag(rf.ElementLaw):
    """F = k δ to F_y, a plateau with the stiffness α k, and back along one that is lower by β F_y."""

    stiffness: float = field(metadata={"description": "the elastic stiffness", "unit": "N/m"})
    yield_force: float = field(metadata={"description": "the force at which the plateau begins", "unit": "N"})
    ratio: float = 0.05
    depth: float = 0.8
    position: float = 0.0

    @property
    def ends(self):
        upper = self.yield_force / self.stiffness
        return upper, upper * (1.0 - self.depth / (1.0 - self.ratio))

    def branches(self):
        k, a, (upper, lower) = self.stiffness, self.ratio, self.ends
        to_loading = rf.BranchEnd("loading", upper, rising=True, internal=1.0)
        return {
            "elastic": rf.Branch(k, internal=-(1.0 - a) * k, ends=[to_loading]),
            "loading": rf.Branch(a * k, (1.0 - a) * k * upper, yields=1, offset=upper, turns_to="unloading"),
            "unloading": rf.Branch(
                k,
                internal=-(1.0 - a) * k,
                ends=[to_loading, rf.BranchEnd("recovery", lower, rising=False, internal=1.0)],
            ),
            "recovery": rf.Branch(
                a * k,
                (1.0 - a) * k * lower,
                ends=[rf.BranchEnd("elastic", lower, rising=False)],
                yields=-1,
                offset=lower,
                turns_to="unloading",
            ),
        }

    def stored_energy(self, elongation, internal):
        k, a, (upper, lower) = self.stiffness, self.ratio, self.ends
        elastic = 0.5 * k * (elongation - (1.0 - a) * internal) ** 2
        return elastic + (1.0 - a) * k * (0.5 * a * internal**2 + 0.5 * (upper + lower) * np.abs(internal))
