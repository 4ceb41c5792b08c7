"""The report of the Response tab on one page."""

from rockflex.models import SpringModel
from rockflex.motion import GroundMotion
from rockflex.report.run import report_html
from rockflex.response import Response
from rockflex.web._records import motion_of
from rockflex.web._refusal import Refusal, refusing
from rockflex.web._response import check_energy, responses
from rockflex.web._state import State
from rockflex.web._uploads import Uploads


def run_report(state: State, uploads: Uploads) -> tuple[str, str]:
    """Return the name and the text of the report of the runs of a state.

    Energies and friction that would keep a visitor waiting are left out, and the page says so.

    Raises
    ------
    Refusal
        If a run cannot be made, or takes too long.
    """
    built, acting, found = responses(state, uploads)
    motion = motion_of(state.record, uploads)
    times = "" if state.scale == 1.0 else f" × {state.scale:g}"
    name = state.structure.name or "Structure"
    with refusing("models"):
        text = report_html(
            found,
            structure=built.structure,
            motion=motion,
            title=f"{name} under {motion.name or 'a ground motion'}{times}",
            omitted=[response.model for response in found if _is_long(response, acting, state)],
        )
    return "report.html", text


def _is_long(response: Response, motion: GroundMotion, state: State) -> bool:
    """Whether energies and friction would take too long here, as they do on many stiff springs."""
    assert response.history is not None  # asked for in `responses`
    if isinstance(response.history.model, SpringModel):
        return True
    try:
        check_energy(response, motion, state)
    except Refusal:
        return True
    return False
