from ._run_study import estimate_time as estimate_time
from ._run_study import fill_study as fill_study
from ._run_study import load_study as load_study
from ._run_study import run_study as run_study
from ._study_kinds import KINDS as KINDS
from ._study_kinds import StudyFindings as StudyFindings
from ._study_kinds import StudyKind as StudyKind
from ._study_kinds import study_kind_named as study_kind_named
