from ._document import ReproducedResult as ReproducedResult
from ._read_case import read_case as read_case
from .project import Project as Project
from .project import ProjectResults as ProjectResults
from .project import read_project as read_project
from .run._report_page import write_report as write_report
