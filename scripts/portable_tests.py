"""Repeat the numerically sensitive tests as on another processor, where BLAS and the engine round differently."""

import os
import platform
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
CORE = "Nehalem"
SETTING = {
    "OPENBLAS_CORETYPE": CORE,
    "ROCKFLEX_SIMD": "baseline" if platform.machine().lower() in ("x86_64", "amd64") else "",
}
# Tests of modes, of the closed-form engine, of the forces, and of the twins that they are compared with.
SENSITIVE = (
    "tests/engine/test_*.py",
    "tests/unit/test_computable.py",
    "tests/unit/test_elements_on_springs.py",
    "tests/unit/test_equivalents.py",
    "tests/unit/test_friction.py",
    "tests/unit/test_ground_answers.py",
    "tests/unit/test_grounded_models.py",
    "tests/unit/test_modal_*.py",
    "tests/unit/test_motion_selection.py",
    "tests/unit/test_motion_spectra.py",
    "tests/unit/test_response_*.py",
    "tests/unit/test_solve_*.py",
    "tests/unit/test_structure_*.py",
    "tests/unit/test_tendons.py",
    "tests/unit/test_twins_agree.py",
    "tests/property/test_engine_*.py",
    "tests/property/test_modal_laws.py",
    "tests/validation/test_closed_form_beams.py",
    "tests/validation/test_ground_*.py",
    "tests/validation/test_engine_runs.py",
    "tests/validation/test_opensees.py",
    "tests/validation/test_reference_cases.py",
    "tests/validation/test_table*.py",
    "tests/validation/test_uplifted_*.py",
)
LOADED = """
import numpy, scipy.linalg, threadpoolctl
print(*sorted({each.get("architecture", "") for each in threadpoolctl.threadpool_info() if each["user_api"] == "blas"}))
"""


def main(arguments: list[str]) -> int:
    environment = {**os.environ, **SETTING}
    asked = subprocess.run([sys.executable, "-c", LOADED], env=environment, check=True, capture_output=True, text=True)
    found = asked.stdout.split()
    if found != [CORE]:
        names = ", ".join(found) or "none by name"
        print(f"OPENBLAS_CORETYPE={CORE} has no effect here; the cores of the loaded BLAS are: {names}.", flush=True)
        other = platform.machine().lower() not in ("x86_64", "amd64")
        print("No test is repeated." if other else "NumPy and SciPy with OpenBLAS are expected.", flush=True)
        return 0 if other else 1
    files = sorted(str(path) for pattern in SENSITIVE for path in ROOT.glob(pattern))
    command = [sys.executable, "-m", "pytest", "-m", "not slow and not web", *arguments, *files]
    return subprocess.run(command, env=environment, cwd=ROOT, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
