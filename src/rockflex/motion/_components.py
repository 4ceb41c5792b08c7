"""Choice of a component of a file that holds several."""

from pathlib import Path

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._direction import is_vertical
from rockflex.motion._ground_motion import GroundMotion


def chosen(file: Path, found: list[GroundMotion], component: str | None, *, upright: bool) -> GroundMotion:
    """Return the component with a name; without one, the only horizontal or, if `upright`, the only vertical one.

    Raises
    ------
    InputError
        If there is no such component, or more than one.
    """
    if component is not None:
        named = [motion for motion in found if _called(motion, component)]
        if len(named) == 1:
            return named[0]
        raise InputError(
            f"{file} holds {len(named) or 'no'} components named {shown(component)}. It holds {_listed(found)}.",
            field="component",
        )
    fitting = [motion for motion in found if is_vertical(motion) == upright] or found
    if len(fitting) == 1:
        return fitting[0]
    raise InputError(
        f"{file} holds {len(found)} components: {_listed(found)}. Name one: "
        f"read_motion(path, component={_name(fitting[0])!r}); read_components reads all, and so does read_suite.",
        field="component",
    )


def _called(motion: GroundMotion, component: str) -> bool:
    azimuth = None if motion.metadata is None else motion.metadata.azimuth
    wanted = component.strip().casefold()
    if azimuth is not None and wanted.isdecimal() and wanted.isascii() and len(wanted) <= 3:
        return float(wanted) % 360.0 == azimuth % 360.0
    return wanted in (_name(motion).casefold(), motion.name.casefold())


def _name(motion: GroundMotion) -> str:
    stated = None if motion.metadata is None else motion.metadata.component
    return stated or motion.name


def _listed(found: list[GroundMotion]) -> str:
    return ", ".join(f"{shown(_name(motion))}{' (vertical)' * is_vertical(motion)}" for motion in found)
