"""A frame modelled in OpenSeesPy, placed on a base that can rock.

`matrices_of` extracts mass, stiffness and degrees of freedom from any plane model with three degrees of freedom per
node; `structure_of` builds a rockflex structure from them. OpenSeesPy has its own licence and is available at
https://pypi.org/project/openseespy.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

import rockflex as rf

Float = NDArray[np.float64]

N_STORIES, STORY_HEIGHT, BAY = 5, 3.0, 4.0  # m
FLOOR_MASS, BASE_MASS, HALF_WIDTH, DAMPING_RATIO = 40e3, 40e3, 2.2, 0.02  # kg, kg, m
ELASTIC_MODULUS = 30e9  # N/m²
COLUMN, BEAM = (0.16, 0.16 * 0.4**2 / 12.0), (0.15, 0.15 * 0.5**2 / 12.0)  # area in m², second moment in m⁴


@dataclass(frozen=True)
class Freedom:
    """Degree of freedom of one equation: horizontal or vertical displacement of a node, or its rotation."""

    kind: Literal["x", "y", "turn"]
    x: float  # m from the axis of the structure
    height: float  # m above the base


def structure_of(
    mass: Float, stiffness: Float, freedoms: list[Freedom], base_mass: float, half_width: float, damping_ratio: float
) -> rf.ModalStructure:
    """Structure from matrices of the fixed-base model, in the order of `freedoms`.

    Positive rotations are counterclockwise in OpenSees, which moves points above a node against x, and clockwise in
    rockflex, so rotations change their sign. Vertical degrees of freedom must not have mass off the axis: the rotation
    of the base would lift it, which `from_matrices` cannot model. Give floors only horizontal mass, as in the paper.
    """
    if not len(freedoms) == len(mass) == len(stiffness):
        raise ValueError(f"{len(freedoms)} freedoms were given for matrices of {len(mass)} and {len(stiffness)} rows.")
    for i, freedom in enumerate(freedoms):
        if freedom.kind == "y" and freedom.x != 0.0 and np.any(mass[i]):
            raise ValueError(
                f"There is vertical mass {freedom.x:g} m off the axis, at a height of {freedom.height:g} m. Give nodes "
                "only horizontal mass: ops.mass(node, m, 0.0, 0.0)."
            )
    sign = np.array([-1.0 if freedom.kind == "turn" else 1.0 for freedom in freedoms])
    signs = np.outer(sign, sign)
    return rf.from_matrices(
        signs * mass,
        signs * stiffness,
        {i: freedom.height for i, freedom in enumerate(freedoms) if freedom.kind == "x"},
        rotations=[i for i, freedom in enumerate(freedoms) if freedom.kind == "turn"],
        base_mass=base_mass,
        half_width=half_width,
        damping_ratio=damping_ratio,
    )


def matrices_of(
    ops: Any,
    axis: float = 0.0,
    base: float = 0.0,
) -> tuple[Float, Float, list[Freedom]]:
    """Mass, stiffness and degrees of freedom of the plane model in memory.

    Its base is fixed; `axis` is the x of its axis and `base` the y of its
    base in m. OpenSees warns that the mass matrix is singular if some degrees
    of freedom have no mass: the step that makes it form the matrix cannot be
    solved, and need not be. Multi-point constraints (equalDOF, rigidLink)
    merge equations, and are refused.
    """
    ops.wipeAnalysis()
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")  # the only one that printA can print
    ops.algorithm("Linear")
    ops.integrator("GimmeMCK", 0.0, 0.0, 1.0)  # without one OpenSees warns
    ops.analysis("Transient")
    found: list[Float] = []
    # factors of mass, damping and stiffness in the printed matrix
    for factors in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)):
        ops.integrator("GimmeMCK", *factors)
        ops.analyze(1, 0.0)
        size = ops.systemSize()
        printed = np.array(ops.printA("-ret"), dtype=np.float64)
        found.append(printed.reshape(size, size))
    stiffness, mass = found
    freedoms: dict[int, Freedom] = {}
    for node in ops.getNodeTags():
        x, y = ops.nodeCoord(node)
        equations = ops.nodeDOFs(node)
        for kind, equation in zip(("x", "y", "turn"), equations, strict=True):
            if equation in freedoms:
                shares = f"Node {node} shares an equation with another"
                raise ValueError(f"{shares}: use no constraints.")
            if equation >= 0:  # fixed degrees of freedom have none
                freedoms[equation] = Freedom(kind, x - axis, y - base)
    return mass, stiffness, [freedoms[i] for i in range(len(mass))]


def build_frame(ops: Any) -> None:
    """One bay, five stories, elastic members, mass at the joints in the horizontal direction."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Linear", 1)
    members = 0
    for floor in range(N_STORIES + 1):
        left, right = 2 * floor + 1, 2 * floor + 2
        for node, x in ((left, -0.5 * BAY), (right, 0.5 * BAY)):
            ops.node(node, x, floor * STORY_HEIGHT)
            if floor == 0:
                ops.fix(node, 1, 1, 1)
                continue
            ops.mass(node, 0.5 * FLOOR_MASS, 0.0, 0.0)
            members += 1
            ops.element("elasticBeamColumn", members, node - 2, node, COLUMN[0], ELASTIC_MODULUS, COLUMN[1], 1)
        if floor > 0:
            members += 1
            ops.element("elasticBeamColumn", members, left, right, BEAM[0], ELASTIC_MODULUS, BEAM[1], 1)


def run(ops: Any) -> rf.ModalStructure:
    """Build the frame, extract its matrices, and print its modes, OpenSees' frequencies, and its response."""
    build_frame(ops)
    mass, stiffness, freedoms = matrices_of(ops)
    structure = structure_of(mass, stiffness, freedoms, BASE_MASS, HALF_WIDTH, DAMPING_RATIO)
    modes = structure.modal()
    ops.wipeAnalysis()
    squares = ops.eigen(3)
    print("Frequencies in rad/s: OpenSees' eigen, rockflex")
    for n, square in enumerate(squares):
        print(f"  {n + 1} {square**0.5:12.6f} {modes.omega[n]:12.6f}")
    motion = rf.load_suite("el-centro-1940")[0]
    for model in ("2DOF-S", "MDOF-S"):
        response = rf.simulate(structure, motion, model, output="peaks")
        print(
            f"{model}: {response.status}, θ_max {response.max_rotation:.3e} rad, "
            f"u_top {response.max_top_displacement:.4f} m, {response.n_impacts} impacts"
        )
    return structure


def main() -> None:
    """Run the example, if OpenSeesPy is installed."""
    try:
        import openseespy.opensees as ops  # pyright: ignore[reportMissingImports]
    except (ImportError, RuntimeError) as error:  # RuntimeError: linked libraries are missing
        raise SystemExit(
            "This example needs OpenSeesPy: pip install openseespy; on Debian also apt-get install libblas3 "
            f"liblapack3 ({error})."
        ) from error
    run(ops)


if __name__ == "__main__":
    main()
