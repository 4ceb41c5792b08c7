"""Projects: structures, records, limits, the head of reports and results in one file."""

from rockflex.project._project import SUFFIX, Project, ProjectResults, read_project

__all__ = ["SUFFIX", "Project", "ProjectResults", "read_project"]
