"""Shared parts of all layers: errors, checks, numbers and units in text, values with arrays, files, JSON, languages."""
