"""Exact and fast seismic response of flexible structures whose base may uplift and rock."""
