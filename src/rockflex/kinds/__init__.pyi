from ._kinds import KINDS as KINDS
from ._kinds import Findings as Findings
from ._kinds import StudyKind as StudyKind
from ._kinds import kind_named as kind_named
from ._run import estimate_time as estimate_time
from ._run import fill_study as fill_study
from ._run import load_study as load_study
from ._run import run_study as run_study
