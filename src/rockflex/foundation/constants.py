"""Physical constants, and limits of size."""

GRAVITY = 9.81
"""Acceleration of gravity in m/s², the value used throughout Silva & Stojadinović 2024."""

MOST_STORIES, MOST_MODES = 1000, 200
"""Limits of stories of a frame and modes of a continuous structure: these take seconds and about 100 MB."""
