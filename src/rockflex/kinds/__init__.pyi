from ._kind import Findings as Findings
from ._kind import StudyKind as StudyKind
from ._load import load_study as load_study
from ._registry import KINDS as KINDS
from ._registry import kind_named as kind_named
from ._run import estimate_time as estimate_time
from ._run import fill_study as fill_study
from ._run import run_study as run_study
