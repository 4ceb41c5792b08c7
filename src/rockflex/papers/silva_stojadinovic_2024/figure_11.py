"""Figure 11: base moment against rotation of a pinned beam and of a rocking base."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import check
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import tall_frame
from rockflex.report import Result

TITLE = "Base moment against rotation of a pinned beam and of a rocking base"


def reproduce(_: Records) -> Result:
    """Measure the stiffness of the rocking base in a static equilibrium of the shear building."""
    frame = tall_frame("shear")
    p = frame.rocking()
    quiet = rf.quiet_motion(0.02, 0.001)
    start = rf.InitialState(rotation=0.5 * p.resisting_moment / (p.l0r * 9.81))
    response = rf.simulate(frame, quiet, "MDOF-S", initial=start)
    # At rest with straight masses: I_θ θ'' + Σ m*h* D'' = -(M_r - L_0^r g θ), and D'' = -h* θ''.
    free = p.i_theta - float(p.effective_mass @ p.effective_height**2)
    moment = -free * float(response.rotation_acceleration[0])
    slope = (moment - p.resisting_moment) / float(response.rotation[0]) / (p.l0r * 9.81)
    checks = (
        check(
            "slope of the resisting moment of MDOF-S over L_0^r g", "Section 3.4", "negative rotational stiffness",
            slope, "< 0",
            note="by construction: M = m_tot g B − L_0^r g θ has slope −1; from the first instant of a free motion",
        ),
    )  # fmt: skip
    figures = {"figure-11": lambda: rf.plot_moment_rotation_laws(frame)}
    return Result("figure-11", TITLE, figures=figures, checks=checks)
