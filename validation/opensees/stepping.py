"""Static and dynamic analysis of the model in OpenSees' memory, and its records."""

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from frames import FLOORS, HEIGHTS, LEFT, N_STORIES, RIGHT, STORY_HEIGHT, Prototype, eigenvalues, modes
from numpy.typing import NDArray

import rockflex as rf

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Scheme:
    """Integration scheme of OpenSees."""

    dt: float  # s
    integrator: tuple[str | float, ...] = ("Newmark", 0.5, 0.25)
    algorithm: str = "Newton"


AVERAGE = ("Newmark", 0.5, 0.25)  # average acceleration: no numerical damping


@dataclass(frozen=True)
class Run:
    """Records of OpenSees with rockflex's signs; one row per step."""

    time: Float  # s
    rotation: Float  # θ in rad
    lift: Float  # of the left and right corner, m; (n, 2)
    top_displacement: Float  # relative to the rotated base, for small rotations, in m
    story_drift: Float  # relative to the rotated base, m; (n, 5)
    story_shear: Float  # of the columns, N; (n, 5)
    seconds: float  # spent in analyze

    @property
    def base_shear(self) -> Float:
        """V_b in N."""
        return self.story_shear[:, 0]

    @property
    def base_moment(self) -> Float:
        """M_b = Σ V_i L_i in N m."""
        return self.story_shear.sum(axis=1) * STORY_HEIGHT


def analysis(ops: Any, kind: str, integrator: tuple[str | float, ...], algorithm: str) -> None:
    """Define OpenSees' analysis from scratch.

    Plain constraints: in OpenSees 3.7.1 Transformation loses the displacements of tied nodes from the static analysis,
    so that corners sink.
    """
    ops.wipeAnalysis()
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")  # modal damping fills the matrix
    ops.test("NormDispIncr", 1e-11, 60)
    ops.algorithm(algorithm)
    ops.integrator(*integrator)
    ops.analysis(kind)


def settle(ops: Any) -> None:
    """Apply the dead loads, and start the clock at zero."""
    analysis(ops, "Static", ("LoadControl", 1.0), "Newton")
    _succeed(ops.analyze(1), "The dead loads")
    ops.loadConst("-time", 0.0)


def damp(ops: Any, prototype: Prototype, kind: str, ratio: float) -> None:
    """Damp by "modal" (`modalDamping`, five modes) or "stiffness" (of the columns, `ratio` in the first mode)."""
    if kind == "modal":
        eigenvalues(ops)
        ops.modalDamping(ratio)
    elif kind == "stiffness":
        factor = 2.0 * ratio / float(modes(prototype).omega[0])
        ops.region(1, "-ele", *FLOORS, "-rayleigh", 0.0, 0.0, factor, 0.0)


def march(
    ops: Any, motion: rf.GroundMotion, duration: float, scheme: Scheme, width: float = 0.0, *, corners: bool = False
) -> Run:
    """Shake for `duration` seconds. With `corners` the model has nodes at its corners; otherwise their lift is θ B.

    Raises
    ------
    RuntimeError
        If a step does not converge.
    """
    ops.timeSeries("Path", 2, "-dt", motion.dt, "-values", *motion.acceleration.tolist())
    ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
    analysis(ops, "Transient", scheme.integrator, scheme.algorithm)
    with tempfile.TemporaryDirectory() as folder:
        files = [str(Path(folder) / name) for name in ("base", "floors", "members", "corners")]
        common = ("-precision", 16, "-time")
        ops.recorder("Node", "-file", files[0], *common, "-node", 0, "-dof", 2, 3, "disp")
        ops.recorder("Node", "-file", files[1], *common, "-node", *FLOORS, "-dof", 1, "disp")
        ops.recorder("Element", "-file", files[2], *common, "-ele", *FLOORS, "localForce")
        if corners:
            ops.recorder("Node", "-file", files[3], *common, "-node", LEFT, RIGHT, "-dof", 2, "disp")
        started = time.perf_counter()
        failed = ops.analyze(round(duration / scheme.dt), scheme.dt)
        seconds = time.perf_counter() - started
        reached = ops.getTime()
        ops.wipe()  # which also flushes the recorders
        _succeed(failed, f"The analysis at t = {reached:g} s")
        base, floors, members = (np.loadtxt(file) for file in files[:3])
        lift = np.loadtxt(files[3])[:, 1:] if corners else base[:, 1:2] + np.outer(base[:, 2], [-width, width])
    rotation = -base[:, 2]
    bent = floors[:, 1:] - np.outer(rotation, HEIGHTS)
    drift = np.diff(bent, axis=1, prepend=0.0)
    # The force at the upper end of a column pushes the floor back; its local y points against x.
    shear = members[:, 1:].reshape(-1, N_STORIES, 6)[:, :, 1]
    return Run(base[:, 0], rotation, lift, bent[:, -1], drift, shear, seconds)


def _succeed(code: int, what: str) -> None:
    if code != 0:
        raise RuntimeError(
            f"{what} did not converge in OpenSees (code {code}). Use a smaller step or a softer contact."
        )
