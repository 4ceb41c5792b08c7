"""The report of a run: one page for an appendix, with all of its models side by side."""
