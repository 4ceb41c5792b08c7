"""A structure of a few numbers at a site: the whole structure that they make, and the records that suit it."""

import math
from typing import Any

import numpy as np

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.json import as_json_value
from rockflex.web._earthquake import chosen_motion
from rockflex.web._forms import MATERIALS
from rockflex.web._record_sets import LEAST_PERIOD, periods_view
from rockflex.web._refusal import Refusal
from rockflex.web._selection import MAX_SCALE, MIN_SCALE, target_spectrum_of_choice
from rockflex.web._state import PageState, RecordChoice, SiteChoice, parse_page_state
from rockflex.web._structure import build_page_structure
from rockflex.web._uploads import UploadedRecords

FOOTING = 0.15  # of the weight of a pier
COLUMN = 0.35  # width of a square column over that of its footing
MOST_OF_COLUMN = 0.4  # of the weight, beyond which the column is narrower
STEEL_WALL = 1.0 / 40.0  # of a steel column, over its width
STORY = 3.0  # m, about
CRACKED = ("concrete", "masonry")  # of which half of the stiffness counts (EN 1998-1:2004, 4.3.1)
PERIODS = {"steel": 0.085, "concrete": 0.075}  # C_t of EN 1998-1:2004, 4.3.3.2.2; 0.05 of others
FRAMES = ("steel", "concrete")  # buildings of others have walls, which bend
DAMPING, STEEL_DAMPING = 0.05, 0.02
OF_BLOCKS = (0.1, 2.0)  # s: least range of periods of a block, which has none of its own
RECORDS = 7  # of which EN 1998-1 takes the mean
NAMES = {"pier": "Pier", "building": "Building", "block": "Block"}


def site_view(state: PageState, uploads: UploadedRecords) -> dict[str, Any]:
    """Return the structure of the site, and the choice of seven records for its target and the periods that matter."""
    structure = structure_of_site(state.site)
    rigid = state.site.kind == "block"
    models = ["rigid"] if rigid else ["MDOF-S", "2DOF-S", "fixed"]
    own: dict[str, Any] = {"structure": structure, "models": models, "units": state.units, "language": state.language}
    target = state.target.model_copy(update={"shown": False, "kind": "ec8", "count": RECORDS})
    plain = parse_page_state(own).model_copy(update={"target": target, "record": RecordChoice.model_validate({})})
    plain = plain.model_copy(update={"scale": _scale_to_target(plain, uploads)})
    return as_json_value(
        {"structure": structure, "target": {"kind": "ec8", "count": RECORDS, **_range(plain, uploads)}}
    )


def _range(state: PageState, uploads: UploadedRecords) -> dict[str, float]:
    """Return the range of periods in s: up to that of rocking, and at least 0.2 T_1 to 2 T_1, or that of a block."""
    p, found = build_page_structure(state.structure).properties, periods_view(state, uploads)
    least = 4.0 * math.pi / float(p.omega[0]) if p.n_modes else OF_BLOCKS[1]
    last = float(target_spectrum_of_choice(state.target).periods[-1])
    longest = _rounded(min(max(found["longest"], least), last))
    return {"shortest": found["shortest"] if p.n_modes else OF_BLOCKS[0], "longest": longest}


def _scale_to_target(state: PageState, uploads: UploadedRecords) -> float:
    """Return the factor of the record of the page at the first period of the target, or at its peak for a block."""
    p = build_page_structure(state.structure).properties
    target, motion = target_spectrum_of_choice(state.target), chosen_motion(state.record, uploads)
    period = min(2.0 * math.pi / float(p.omega[0]), float(target.periods[-1])) if p.n_modes else LEAST_PERIOD
    has = motion.sa(period, target.damping_ratio)
    return float(np.clip(float(target.at([period])[0]) / has, MIN_SCALE, MAX_SCALE))


def structure_of_site(site: SiteChoice) -> dict[str, Any]:
    """Return the structure of a site as a table of the page's forms."""
    mass = site.weight / GRAVITY
    made = {"pier": _pier, "building": _building, "block": _block}[site.kind](site, mass)
    return {"name": NAMES[site.kind], **made}


def _material(site: SiteChoice) -> dict[str, Any]:
    return next(each for each in MATERIALS if each["title"] == site.material)


def _pier(site: SiteChoice, mass: float) -> dict[str, Any]:
    """A square column on a footing, or a box of steel, with the rest of the weight on its top."""
    cut = _material(site)
    steel = site.material == "steel"
    solid = 4.0 * STEEL_WALL * (1.0 - STEEL_WALL) if steel else 1.0
    most = math.sqrt(MOST_OF_COLUMN * mass / (cut["density"] * site.height * solid))
    side = min(COLUMN * site.width, most)
    shape: dict[str, Any] = {"shape": "rectangle", "width": _rounded(side), "depth": _rounded(side)}
    if steel:
        shape |= {"shape": "box", "wall": _rounded(STEEL_WALL * side)}
    values = {name: cut[name] for name in ("elastic_modulus", "density")}
    cracked = {"stiffness_factor": 0.5} if site.material in CRACKED else {}
    column = cut["density"] * solid * side**2 * site.height
    pier = {
        "height": site.height,
        "tip_mass": _rounded((1.0 - FOOTING) * mass - column, 4),
        "section": {**shape, **values, **cracked},
        "base_mass": _rounded(FOOTING * mass, 4),
        "half_width": 0.5 * site.width,
        "damping_ratio": STEEL_DAMPING if steel else DAMPING,
        "n_modes": 4,
    }
    return {"cantilever": pier}


def _building(site: SiteChoice, mass: float) -> dict[str, Any]:
    """Stories of equal height and mass, and a base like one of them; a frame, or a wall that bends."""
    n = max(1, round(site.height / STORY))
    frame: dict[str, Any] = {
        "n_stories": n,
        "story_height": _rounded(site.height / n, 6),
        "story_mass": _rounded(mass / (n + 1), 6),
        "base_mass": _rounded(mass / (n + 1), 6),
        "stiffness_ratio": "inf" if site.material in FRAMES else 0.0,
        "period": _rounded(PERIODS.get(site.material, 0.05) * site.height**0.75),
        "aspect_ratio": 1.0,
        "damping_ratio": STEEL_DAMPING if site.material == "steel" else DAMPING,
    }
    tall = parse_page_state({"structure": {"frame": frame}}).structure
    arm = float(build_page_structure(tall).properties.effective_height[0])
    return {"frame": frame | {"aspect_ratio": _rounded(arm / (0.5 * site.width), 6)}}


def _block(site: SiteChoice, mass: float) -> dict[str, Any]:
    if site.width >= site.height:
        message = "it must be narrower than it is high: such a block slides, and does not rock."
        raise Refusal({"site.width": message})
    return {"block": {"width": site.width, "height": site.height, "mass": _rounded(mass, 6)}}


def _rounded(value: float, digits: int = 3) -> float:
    return float(f"{value:.{digits}g}")
