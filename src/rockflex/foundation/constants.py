"""Physical constants."""

GRAVITY = 9.81
"""Acceleration of gravity in m/s², the value used throughout Silva & Stojadinović 2024."""
