"""A kind of study: every record as it is and turned round."""

from typing import Literal

from pydantic import Field

from rockflex.studies import CrossPlan, StructuresStudySpec, StudyKind


class BothWaysStudy(StructuresStudySpec):
    """Every structure under every record in both directions."""

    study: Literal["both_ways"] = Field("both_ways", description='"both_ways"')
    scale: float = Field(1.0, description="a factor on the acceleration")

    def plan(self):
        return BothWaysPlan(self.matrix(), self.scale, self.runs_per_chunk)


class BothWaysPlan(CrossPlan):
    def __init__(self, matrix, factor, per_chunk):
        self.factors = factor, -factor
        super().__init__(matrix, len(self.factors), per_chunk)

    def scale(self, structure, record, level):
        return self.factors[level]


def report(study, runs, found):
    """The larger rotation of either direction."""
    both = runs.groupby(["structure", "motion"], observed=True)["max_rotation"]
    found.tables["Larger rotation of both directions"] = [
        {"structure": structure, "motion": motion, "θ_max [rad]": largest}
        for (structure, motion), largest in both.max().items()
    ]


def figures(document, runs, measure, remark):
    def draw():
        from matplotlib.figure import Figure

        figure = Figure()
        ahead, turned = (runs.loc[runs["scale"] * sign > 0.0, "max_rotation"].to_numpy() for sign in (1.0, -1.0))
        figure.add_subplot(xlabel="ahead [rad]", ylabel="turned round [rad]").plot(ahead, turned, "o")
        return figure

    yield "both_ways", draw


BOTH_WAYS = StudyKind(
    name="both_ways",
    command="both-ways",
    summary="Run every structure under every record in both directions.",
    described_by="rockflex_tank.studies.BothWaysStudy",
    report=report,
    figures=figures,
)
