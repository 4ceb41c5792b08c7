"""What is known of the keys that files, flags and forms share: written once, and loaded without any library."""

from rockflex._schema._assumed import IMPACT, LAWS, BoucWenKeys, ImpactKeys, InitialKeys, LawName
from rockflex._schema._frame import AspectRatio, BaseMass, Eccentricity, FrameFlags, FrameKeys, Period
from rockflex._schema._ground import BedKeys, GroundKeys
from rockflex._schema._key import NUMBER, PLAIN, WHOLE, Key, each, flag_of, keys_of

__all__ = [
    "IMPACT",
    "LAWS",
    "NUMBER",
    "PLAIN",
    "WHOLE",
    "AspectRatio",
    "BaseMass",
    "BedKeys",
    "BoucWenKeys",
    "Eccentricity",
    "FrameFlags",
    "FrameKeys",
    "GroundKeys",
    "ImpactKeys",
    "InitialKeys",
    "Key",
    "LawName",
    "Period",
    "each",
    "flag_of",
    "keys_of",
]
