"""Solvers: an exact engine for the piecewise linear models."""
