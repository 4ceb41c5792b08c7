"""Hypothesis' profiles: no deadline, as a first call may compile; the same examples every time in CI."""

import os

from hypothesis import settings

settings.register_profile("rockflex", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "rockflex")
