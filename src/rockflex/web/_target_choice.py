"""The part of the page's state about a target spectrum and the records that are chosen for it."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from rockflex.motion import Combination
from rockflex.structure.file import Table

TEXT = 20_000  # letters of a table
MOST = 60  # records that can be chosen
Source = Annotated[str, StringConstraints(max_length=120, pattern=r"^[^\x00-\x1f\x7f-\x9f]*$")]
Pasted = Annotated[str, StringConstraints(max_length=TEXT, pattern=r"^[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f]*$")]
InG = Annotated[float, Field(ge=0.001, le=5.0)]
Seconds = Annotated[float, Field(ge=0.01, le=100.0)]


class TargetChoice(Table):
    """A target spectrum, and how records are chosen for it. Accelerations are in g, as codes and maps give them."""

    shown: bool = Field(False, description="true or false")
    kind: Literal["ec8", "ec8_second", "asce7", "asce7_site", "table"] = Field(
        "ec8", description='"ec8", "ec8_second", "asce7", "asce7_site" or "table"'
    )
    ag: InG = Field(0.25, description="a_gR in g, from 0.001 to 5")
    ground: Literal["A", "B", "C", "D", "E"] = Field("C", description="a ground type from A to E")
    type: Literal["1", "2"] = Field("1", description='"1" or "2"')
    importance: float = Field(1.0, ge=0.1, le=5.0, description="the importance factor, from 0.1 to 5")
    damping: float = Field(0.05, ge=0.005, le=0.5, description="a damping ratio from 0.005 to 0.5")
    s_alpha: InG = Field(0.5, description="S_α,RP in g, from 0.001 to 5")
    s_beta: InG = Field(0.15, description="S_β,RP in g, from 0.001 to 5")
    category: Literal["A", "B", "C", "D"] = Field("B", description="a site category from A to D")
    sds: InG = Field(1.0, description="S_DS in g, from 0.001 to 5")
    sd1: InG = Field(0.6, description="S_D1 in g, from 0.001 to 5")
    ss: InG = Field(1.5, description="S_S in g, from 0.001 to 5")
    s1: InG = Field(0.6, description="S_1 in g, from 0.001 to 5")
    site: Literal["A", "B", "C", "D", "default", "E"] = Field("C", description='a site class from A to E, or "default"')
    tl: Seconds = Field(8.0, description="T_L in s, from 0.01 to 100")
    mce: bool = Field(False, description="true or false")
    table: Pasted = Field("", description=f"a table of at most {TEXT} letters")
    units: Literal["", "g", "m/s2", "cm/s2"] = Field("", description='"g", "m/s2", "cm/s2", or nothing')

    source: Source = Field("fema-p695-far-field", description='the name of a suite, or "given"')
    count: int = Field(7, ge=1, le=MOST, description=f"how many records, from 1 to {MOST}")
    shortest: Seconds = Field(0.2, description="a period in s, from 0.01 to 100")
    longest: Seconds = Field(2.0, description="a period in s, from 0.01 to 100")
    measure: Combination = Field("component", description='"component", "geometric mean", "rotd50" or "rotd100"')
    smallest: float = Field(0.25, ge=0.01, le=1e3, description="the smallest factor, from 0.01 to 1000")
    largest: float = Field(4.0, ge=0.01, le=1e3, description="the largest factor, from 0.01 to 1000")
    per_event: int | None = Field(None, ge=1, le=MOST, description=f"how many records, from 1 to {MOST}, or nothing")
    per_station: int | None = Field(None, ge=1, le=MOST, description=f"how many records, from 1 to {MOST}, or nothing")
    record_weight: float = Field(0.0, ge=0.0, le=1.0, description="a weight from 0 to 1")
    least_ratio: float | None = Field(None, ge=0.1, le=2.0, description="a ratio from 0.1 to 2, or nothing")
