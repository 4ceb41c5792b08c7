"""Model labels as in the paper: "2DOF-S", ... "MDOF-S", "2DOF-C", "3DOF-C-SI", "fixed", "rigid" and similar."""

import re
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from rockflex.foundation.checks import checked_whole_number, is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._ground import check_base_on_ground, model_on_ground
from rockflex.models._impact import ImpactLaw, Rebound, Restitution, VVELComplete, VVELSimplified, housner
from rockflex.models._jointed_model import model_on_rigid_ground
from rockflex.models._rocking_model import RockingModel
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties

_PATTERN = re.compile(
    r"(?:(?P<count>[1-9][0-9]{0,5})|(?P<all>M))DOF-(?P<kind>S|C|fixed)(?:-(?P<closure>SI|E))?(?P<yields>-BW)?(?P<missing>-R)?"
)
_EXPECTED = (
    '"2DOF-S", "3DOF-S", ... or "MDOF-S" (all modes); "2DOF-C" or "MDOF-C"; "2DOF-C-SI", "3DOF-C-E", ...; "rigid" or '
    '"rigid-C"; "fixed" or "5DOF-fixed"; with one mode also "2DOF-S-BW" and similar; and any label with modes as '
    '"2DOF-S-R", whose base shear and moment include the mass that the modes leave out'
)
_SAME = 1e-6  # relative tolerance of Σ m* h*² = Σ m_i h_i², if all modes are kept


@dataclass(frozen=True)
class Model:
    """A choice of model, not yet applied to a structure.

    Parameters
    ----------
    n_modes
        Number of modes; None for all modes of the structure, 0 for a rigid block.
    lifts
        Whether the base can lift, or is fixed (Eq. 15).
    complete
        Whether to use Eqs. 13, 14 and 16 with large rotations, or the simplified Eqs. 23 and 24.
    closure
        Default impact law of a complete model: ``"SI"`` for Eq. 25, ``"E"`` for the velocities of Eq. 25 scaled to
        satisfy Eq. 19. None for Eqs. 19 and 29 themselves, which need either one mode or all modes.
    yields
        Whether the superstructure is a Bouc-Wen model ("2DOF-S-BW").
    missing_mass
        Whether base shear and base moment include the mass that the modes leave out as if it moved with the base
        ("2DOF-S-R"): the missing-mass (residual) correction of response-history analysis. The motion is not affected.

    Raises
    ------
    InputError
        If a value has the wrong type, or the combination is not a model.

    Examples
    --------
    >>> import rockflex as rf
    >>> model = rf.Model(n_modes=1)
    >>> model.label
    '2DOF-S'
    >>> rf.Model(n_modes=2, complete=True, closure="SI").label
    '3DOF-C-SI'
    """

    n_modes: int | None = None
    lifts: bool = True
    complete: bool = False
    closure: Literal["SI", "E"] | None = None
    yields: bool = False
    missing_mass: bool = False

    def __post_init__(self) -> None:
        if self.n_modes is not None:
            object.__setattr__(self, "n_modes", checked_whole_number("n_modes", self.n_modes, 0))
        meanings = {
            "lifts": "True (the base can lift) or False (it is fixed)",
            "complete": "True (Eqs. 13 and 14) or False (Eq. 23)",
            "yields": "True (the label has -BW) or False",
            "missing_mass": "True (the label ends in -R) or False",
        }
        for name, meaning in meanings.items():
            value = getattr(self, name)
            if not isinstance(value, bool | np.bool_):
                raise InputError(f"{name} must be {meaning}, but {shown(value)} was given.")
            object.__setattr__(self, name, bool(value))
        if self.closure is not None and not is_one_of(self.closure, ("SI", "E")):
            raise InputError(f'closure must be "SI", "E" or None, but {shown(self.closure)} was given.')
        self._check_combination()

    def _check_combination(self) -> None:
        message = ""
        if self.closure is not None and not (self.complete and self.lifts and self.n_modes != 0):
            message = 'The closures "SI" and "E" belong to complete models with modes. Leave closure out.'
        elif self.complete and not self.lifts:
            message = "A fixed base has no complete model: its rotation is zero. Leave complete out."
        elif self.n_modes == 0 and not self.lifts:
            message = "A rigid block on a fixed base does not move. Keep a mode, or let the base lift."
        elif self.n_modes == 0 and self.missing_mass:
            message = "A rigid block has no base shear of its own to correct. Leave missing_mass out."
        elif self.yields and self.n_modes not in (None, 1):
            message = f"A Bouc-Wen superstructure has one mode, but {self.n_modes} were requested. Use 2DOF-S-BW."
        elif self.complete and self.closure is None and self.n_modes not in (None, 0, 1):
            k = self.n_modes + 1 if self.n_modes else 0
            message = (
                f"{k}DOF-C has no impact law of its own: Eq. 19 is one equation for {self.n_modes} velocities. "
                f"Use {k}DOF-C-SI (Eq. 25), {k}DOF-C-E (Eq. 25 scaled to satisfy Eq. 19), or MDOF-C with all modes."
            )
        if message:
            raise InputError(message)

    @property
    def label(self) -> str:
        """Label as in the paper; the degrees of freedom include the rotation if the base can lift."""
        kind = "C" if self.complete else "S"
        end = (f"-{self.closure}" if self.closure else "") + ("-BW" if self.yields else "")
        end += "-R" if self.missing_mass else ""
        if self.n_modes == 0:
            return "rigid-C" if self.complete else "rigid"
        if self.n_modes is None:
            return f"MDOF-{kind}{end}" if self.lifts else f"fixed{end}"
        return f"{self.n_modes + 1}DOF-{kind}{end}" if self.lifts else f"{self.n_modes}DOF-fixed{end}"

    def of(
        self,
        properties: RockingProperties,
        impact: ImpactLaw | None = None,
        bouc_wen: BoucWen | None = None,
        ground: Ground | None = None,
    ) -> RockingModel:
        """Return the model applied to a structure.

        Parameters
        ----------
        properties
            The parameters of the structure, with at least the modes of the model.
        impact
            An impact law in place of the model's own.
        bouc_wen
            Hysteresis of a superstructure with one mode.
        ground
            Springs under the base, or friction. Default: rigid ground on which the base cannot slide.

        Raises
        ------
        InputError
            If the structure has fewer modes than the model, or the arguments do not apply to the model.
        """
        if self.n_modes != 0 and properties.n_modes == 0:
            raise InputError(
                f'Model {self.label} needs modes, but the structure is a rigid block. Use "rigid" or "rigid-C".'
            )
        if self.n_modes is not None and self.n_modes > properties.n_modes:
            whole = replace(self, n_modes=None).label
            raise InputError(
                f"Model {self.label} needs {number_with_noun(self.n_modes, 'mode')}, but the structure has "
                f"{properties.n_modes}. Give more modes, or use {whole} for all modes."
            )
        kept = properties if self.n_modes is None else properties.truncated(self.n_modes)
        self._check_missing_mass(kept)
        self._check_leaning(kept)
        self._check_attached(kept, bouc_wen, ground)
        self._check_one_sided(kept, impact, ground)
        self._check_joints(kept, impact, bouc_wen, ground)
        self._check_columns(kept, bouc_wen, ground)
        label = self._check_yielding(kept, bouc_wen)
        if ground is not None and not ground.rigid:
            self._check_ground(label, ground, impact)
            check_base_on_ground(kept, ground)
            given = impact if impact is not None or ground.springs is not None else self._law(kept)
            return model_on_ground(
                label, kept, ground, given, self.missing_mass, complete=self.complete, bouc_wen=bouc_wen
            )
        law = impact if impact is not None else self._law(kept)
        return model_on_rigid_ground(
            label, kept, self.lifts, law, self.missing_mass, complete=self.complete, bouc_wen=bouc_wen
        )

    def _check_missing_mass(self, kept: RockingProperties) -> None:
        if self.missing_mass and kept.base_mass is None:
            raise InputError(
                f"{self.label} needs the mass above the base, but these properties give only the total mass. Give "
                "RockingProperties the base_mass, in kg."
            )

    def _check_leaning(self, kept: RockingProperties) -> None:
        if self.complete and kept.leaning_mass > 0.0:
            raise InputError(
                f"{self.label} does not take leaning mass, whose columns are hinged and lean by small rotations. Use "
                f"{replace(self, complete=False, closure=None).label}.",
                field="model",
            )

    def _check_attached(self, kept: RockingProperties, bouc_wen: BoucWen | None, ground: Ground | None) -> None:
        attached = [each for each in kept.elements if each.attached]
        what, field_ = ("elements between floors or from a height", "elements") if attached else ("", "stories")
        what = what or ("stories that yield" if kept.stories else "")
        if what and (self.complete or bouc_wen is not None):
            simple = replace(self, complete=False, closure=None, yields=False).label
            use = f"Use {simple}" + (", and leave bouc_wen out." if bouc_wen is not None else ".")
            raise InputError(f"No complete model and none with Bouc-Wen hysteresis takes {what}. {use}", field=field_)
        for each in attached:
            if each.sticks:
                raise InputError(
                    f"No model has a friction damper that acts at {each.where}, away from the base. Use a "
                    "YieldingDissipator with yield_force = F_0 and a stiffness far above that of the structure.",
                    field="elements",
                )
        if attached and ground is not None and ground.springs is not None:
            pull = [each.cosine * (each.height or 0.0) * each.force_at_rest for each in attached]
            if abs(sum(pull)) > _SAME * sum(map(abs, pull)):
                raise InputError(
                    "On springs the initial forces of ties from a height must balance one another, but together they "
                    f"turn the base with {sum(pull):.4g} N m. Give ties to both sides, or no initial force.",
                    field="elements",
                )

    def _check_one_sided(self, kept: RockingProperties, impact: ImpactLaw | None, ground: Ground | None) -> None:
        if kept.opens == "both":
            return
        if impact is not None and not isinstance(impact, Rebound):
            raise InputError(
                f"The structure opens to the {kept.opens} alone and turns back at the wall behind it, which no other "
                "impact law describes. Leave impact out, and give OneSided(structure, restitution=...).",
                field="impact",
            )
        if ground is not None and not ground.rigid:
            raise InputError(
                f"The structure opens to the {kept.opens} alone, against a wall behind it, which has no model on "
                "springs or on ground that it slides on. Leave the ground out.",
                field="ground",
            )

    def _check_joints(
        self, kept: RockingProperties, impact: ImpactLaw | None, bouc_wen: BoucWen | None, ground: Ground | None
    ) -> None:
        if not kept.joints or not self.lifts:
            return
        if self.complete or bouc_wen is not None:
            simple = replace(self, complete=False, closure=None, yields=False).label
            raise InputError(
                f"No complete model and none with Bouc-Wen hysteresis takes joints above the base. Use {simple}.",
                field="joints",
            )
        if impact is not None and not isinstance(impact, VVELSimplified):
            raise InputError(
                "Joints above the base land without rebound, as VVELSimplified says, which no other impact law "
                "describes. Leave impact out.",
                field="impact",
            )
        if kept.opens != "both":
            raise InputError("A structure that opens to one side has no joints above its base.", field="joints")
        if ground is not None and not ground.rigid:
            raise InputError(
                "Joints above the base have no model on springs or on ground that the base slides on. Leave the ground "
                "out.",
                field="ground",
            )
        if any(each.sticks for each in kept.elements):
            raise InputError(
                "No model has friction dampers under a structure with joints above its base. Use a YieldingDissipator "
                "with yield_force = F_0 and a stiffness far above that of the structure.",
                field="elements",
            )

    def _check_columns(self, kept: RockingProperties, bouc_wen: BoucWen | None, ground: Ground | None) -> None:
        if kept.columns is None or not self.lifts:
            return
        if self.complete or bouc_wen is not None or self.missing_mass or not kept.n_modes:
            raise InputError(
                f"{self.label} has no columns that rock under a building, which simplified models with modes have. Use "
                "MDOF-S, or a rocking_frame for a slab alone.",
                field="columns",
            )
        if ground is not None and not ground.rigid:
            raise InputError(
                "Columns that rock under a building have no model on springs or on ground that they slide on. Leave "
                "the ground out.",
                field="ground",
            )

    def _check_ground(self, label: str, ground: Ground, impact: ImpactLaw | None) -> None:
        what = "Springs need" if ground.springs is not None else "Friction needs"
        if not self.lifts:
            raise InputError(
                f"{what} a model whose base can lift, but {label} was given. Use {replace(self, lifts=True).label}, or "
                "leave the ground out.",
                field="ground",
            )
        if ground.springs is not None and impact is not None:
            raise InputError(
                "No impact law acts on springs: what a landing dissipates, their dashpots take. Leave impact out, and "
                "choose the damping of the springs.",
                field="impact",
            )

    def _check_yielding(self, kept: RockingProperties, bouc_wen: BoucWen | None) -> str:
        """Return the label, with -BW for a Bouc-Wen superstructure."""
        if bouc_wen is None:
            if self.yields:
                raise InputError(f"{self.label} needs its hysteresis. Give bouc_wen=BoucWen(yield_displacement=...).")
            return self.label
        if kept.n_modes != 1:
            one = ("2DOF-S" if self.lifts else "1DOF-fixed") + ("-BW" if self.yields else "")
            raise InputError(
                f"bouc_wen applies to models with one mode, but {self.label} has {kept.n_modes}. Use {one}, or leave "
                "it out."
            )
        return self.label if self.yields else replace(self, yields=True).label

    def _law(self, kept: RockingProperties) -> ImpactLaw:
        """Return the default impact law of the model."""
        if kept.opens != "both":
            return Rebound(kept.restitution or 0.0)
        if kept.columns is not None and kept.n_modes and self.lifts:
            return Restitution(kept.restitution or 0.0)
        if self.n_modes == 0 and self.lifts:
            return housner(kept) if kept.restitution is None else Restitution(kept.restitution)
        if not self.complete or self.closure == "SI":
            return VVELSimplified()
        modal_inertia = float(kept.effective_mass @ kept.effective_height**2)
        if self.closure is None and kept.n_modes > 1 and modal_inertia < (1.0 - _SAME) * kept.translational_inertia:
            raise InputError(
                f"{self.label} needs all modes, but those given have {modal_inertia / kept.translational_inertia:.2%} "
                "of Σ m_i h_i²: Eq. 19 is one equation for many velocities. Use MDOF-C-SI or MDOF-C-E."
            )
        return VVELComplete()


def parse_model(model: str | Model) -> Model:
    """Return the model with a label; a `Model` is returned unchanged.

    Raises
    ------
    InputError
        If the label is unknown.
    """
    if isinstance(model, Model):
        return model
    if not isinstance(model, str):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"Unknown model {shown(model)}. Expected {_EXPECTED}, or a Model.")
    return _labelled(model)


@lru_cache(maxsize=256)
def _labelled(label: str) -> Model:
    named = {
        "fixed": Model(lifts=False),
        "fixed-BW": Model(lifts=False, yields=True),
        "fixed-R": Model(lifts=False, missing_mass=True),
        "fixed-BW-R": Model(lifts=False, yields=True, missing_mass=True),
        "rigid": Model(0),
        "rigid-C": Model(0, complete=True),
    }
    found = _PATTERN.fullmatch(label)
    if found is None:
        if label in named:
            return named[label]
        raise InputError(f"Unknown model {shown(label)}. Expected {_EXPECTED}, or a Model.")
    lifts, complete = found["kind"] != "fixed", found["kind"] == "C"
    closures: dict[str | None, Literal["SI", "E"] | None] = {"SI": "SI", "E": "E"}
    closure = closures.get(found["closure"])
    n_modes = None if found["all"] else int(found["count"]) - lifts
    odd = (found["all"] and not lifts) or n_modes == 0 or (closure is not None and not complete)
    if odd:
        raise InputError(f"Unknown model {shown(label)}. Expected {_EXPECTED}, or a Model.")
    return Model(
        n_modes, lifts, complete, closure, yields=found["yields"] is not None, missing_mass=found["missing"] is not None
    )
