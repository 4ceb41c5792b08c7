"""A structure on bases of a few widths, for tests of designs."""

import rockflex as rf
from builders import frame_values

FRAME = frame_values(n_stories=3, base_mass=50e3, period=0.6, aspect_ratio=8.0)
STRUCTURE = rf.Frame(**FRAME)
PROPERTIES = STRUCTURE.rocking()
HEIGHT = PROPERTIES.effective_height[0]
SUITE = rf.load_suite("fema-p695-far-field")
WIDTHS = [0.8, 1.6, 2.4]
LEVELS = [rf.TendonLevel(), rf.TendonLevel(0.3, 0.6, 0.9, name="held")]
HAZARD = rf.HazardCurve([0.05, 0.1, 0.2, 0.4, 0.8, 1.6], [0.1, 0.03, 8e-3, 1.5e-3, 2e-4, 2e-5])
CONTENT = {
    "structures": [{"name": "A", "frame": FRAME}],
    "records": {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-2-*"]},
    "half_widths": {"smallest": 0.8, "largest": 2.4, "count": 3},
    "tendons": [{"name": "none"}, {"prestress_ratio": 0.3, "stiffness_ratio": 0.6}],
    "scales": [1.0, 2.0],
    "level": 0.6,
    "runs_per_chunk": 7,
}
