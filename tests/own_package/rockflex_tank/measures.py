"""An intensity measure."""

import math

from rockflex.motion import IntensityMeasure

PGA_PGV = IntensityMeasure(
    name="pga_pgv",
    label="√(PGA PGV)",
    unit="m/s^1.5",
    words="geometric mean of peak acceleration and velocity",
    of=lambda shaking: math.sqrt(shaking.motion.pga * shaking.motion.pgv),
)
