from ._kinds import KINDS as KINDS
from ._kinds import StudyFindings as StudyFindings
from ._kinds import StudyKind as StudyKind
from ._kinds import study_kind_named as study_kind_named
from ._run import estimate_time as estimate_time
from ._run import fill_study as fill_study
from ._run import load_study as load_study
from ._run import run_study as run_study
