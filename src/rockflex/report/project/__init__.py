"""Projects: structures, records, limits, the head of reports and results in one file."""

from rockflex.report.project._project import Project, ProjectResults, read_project

__all__ = [
    "Project",
    "ProjectResults",
    "read_project",
]
