"""Responses prepared for figures: checked, named, each with its own line style, and cut before overturning."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.plot._style import (
    BLACK,
    GRAY,
    GREEN,
    LINE_STYLES,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    LineStyle,
    literal_text,
    recoloured_line_styles,
)
from rockflex.response import History, Response


@dataclass(frozen=True, eq=False)
class ResponseCurve:
    """One response with its history, label and line style."""

    response: Response
    history: History
    label: str
    style: LineStyle

    @property
    def overturned(self) -> bool:
        """Whether |θ| reached π/2."""
        return self.response.status == "overturned"

    @property
    def lifts(self) -> bool:
        """Whether the base of the model can lift."""
        return self.history.model.lifts

    @property
    def order(self) -> float:
        """Drawing order: models with fewer modes on top, and dashes over solid lines, which show through the gaps."""
        modes = 2.0 + 1.0 / (1.0 + self.history.model.properties.n_modes) if self.lifts else 1.9
        return modes - 0.01 * (self.style.dashes == "-")

    @property
    def balance_rotation(self) -> float:
        """Rotation α in rad at which the static resisting moment vanishes, on the side where it is larger.

        Infinite if tendons prevent it.
        """
        return max(pivot.balance_rotation for pivot in self.history.model.properties.pivots)

    @property
    def balance(self) -> Array:
        """The same, on the side of the rotation at each state."""
        p = self.history.model.properties
        return np.where(self.history.rotation < 0.0, p.pivot(-1).balance_rotation, p.pivot(1).balance_rotation)

    @property
    def uplifts(self) -> Array:
        """Start and end of every uplift in s, shape (n_phases, 2), on either side."""
        h = self.history
        lifted = np.concatenate(([0], h.uplifted, [0]))
        starts, ends = np.flatnonzero(np.diff(lifted) > 0), np.flatnonzero(np.diff(lifted) < 0) - 1
        return np.column_stack((h.time[starts], h.time[ends]))

    @property
    def falls(self) -> bool:
        """Whether it overturned, or was beyond the rotation of balance when the run ended."""
        beyond = np.abs(self.history.rotation) > self.balance
        return bool(beyond[-1] and not beyond.all())

    @property
    def before_fall(self) -> slice:
        """Nodes until θ last passes the rotation of balance; all of them if it does not fall."""
        if not self.falls:
            return slice(None)
        inside = np.flatnonzero(np.abs(self.history.rotation) <= self.balance)
        return slice(int(inside[-1]) + 1)

    @property
    def finished_rotation(self) -> float:
        """Largest |θ| in rad, without the last phase of a structure that falls."""
        if not self.falls:
            return self.response.max_rotation
        contact = np.flatnonzero(~self.history.uplifted)
        return float(np.max(np.abs(self.history.rotation[: contact[-1] + 1]))) if contact.size else 0.0


def rotation_axis_limit(curves: list[ResponseCurve]) -> float:
    """Largest |θ| in rad on an axis, including the rotation of balance if all that rock fall."""
    finished = max(curve.finished_rotation for curve in curves)
    fallen = [curve.balance_rotation for curve in curves if curve.falls]
    standing = any(curve.finished_rotation > 0.0 for curve in curves if not curve.falls)
    return finished if standing else max(finished, *fallen, 0.0)


def time_axis_limits(curves: list[ResponseCurve]) -> tuple[float, float]:
    """First and last time of all curves in s."""
    times = [curve.history.time for curve in curves]
    return min(float(time[0]) for time in times), max(float(time[-1]) for time in times)


def response_figure_title(curves: list[ResponseCurve], title: str | None) -> str:
    """The title given, or the name of the motion if there is only one."""
    if title is not None:
        return title
    motions = {curve.response.motion for curve in curves}
    return literal_text(motions.pop()) if len(motions) == 1 else ""


def response_curves(
    responses: Response | Iterable[Response], labels: Sequence[str] | None = None
) -> list[ResponseCurve]:
    """Check the responses, and give each a label and a line style.

    Raises
    ------
    InputError
        If there are none or too many, one is not a response or has no history, or the labels do not match.
    """
    everything: list[Response] = [responses] if hasattr(responses, "history") else list(responses)  # pyright: ignore
    if not everything:
        raise InputError('There is no response to plot. Give at least one from simulate(..., output="history").')
    histories = [_history_of_response(i, response) for i, response in enumerate(everything)]
    names = _response_labels(everything, labels)
    styles = _response_line_styles(histories)
    return [ResponseCurve(*parts) for parts in zip(everything, histories, names, styles, strict=True)]


def _history_of_response(index: int, response: Response) -> History:
    if not hasattr(response, "history"):
        raise InputError(
            f"responses[{index}] must be a Response, but {type(response).__name__} was given. "
            'Give what simulate returned, or the column "response" of simulate_many(..., output="history").'
        )
    if response.history is None:
        raise InputError(
            f"responses[{index}] ({response.model} under {shown(response.motion)}) keeps peaks only, but a plot needs "
            'the history. Simulate it with output="history".'
        )
    return response.history


def _response_labels(responses: list[Response], labels: Sequence[str] | None) -> list[str]:
    if labels is None:
        models = [response.model for response in responses]
        if len(set(models)) == len(models):
            return [literal_text(model) for model in models]
        return [literal_text(f"{response.model}, {response.motion}") for response in responses]
    if isinstance(labels, str) or len(labels) != len(responses):
        given = f"the string {shown(labels)}" if isinstance(labels, str) else f"{len(labels)}"
        raise InputError(
            f"labels must be a sequence of {len(responses)} strings, one per response, but {given} was given."
        )
    return list(labels)


def _response_line_styles(histories: list[History]) -> list[LineStyle]:
    """Line styles of Silva & Stojadinović 2024, Fig. 15, for fixed base, most modes, one and two, and others."""
    max_modes = max((h.model.properties.n_modes for h in histories if h.model.lifts), default=0)
    wanted = [_usual_line_style(history, max_modes) for history in histories]
    spare, styles = [style for style in LINE_STYLES if style not in wanted], list[LineStyle]()
    for own in wanted:
        if own is None or own in styles:
            if not spare:
                raise InputError(
                    f"{len(histories)} responses are too many to distinguish in one figure. Plot fewer at a time."
                )
            own = spare.pop(0)
        styles.append(own)
    return recoloured_line_styles(styles)


def _usual_line_style(history: History, max_modes: int) -> LineStyle | None:
    model = history.model
    n = model.properties.n_modes
    if not model.lifts:
        return LineStyle(GRAY, "-", 1.4)
    if np.any(history.yielding != 0.0):
        return LineStyle(SKY, "-")
    if "-C" in model.label:
        closed = model.label.removesuffix("-R").endswith(("-SI", "-E"))
        return LineStyle(ORANGE, (0, (4, 1.5))) if closed else LineStyle(PURPLE, "-")
    if model.label.startswith("M") or n == max_modes > 2:
        return LineStyle(BLACK, "-")
    return {1: LineStyle(RED, "-."), 2: LineStyle(GREEN, "--")}.get(n)
