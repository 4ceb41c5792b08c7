"""The histories of a base on its ground as columns of a table."""

from rockflex._arrays import Array
from rockflex.models import SpringModel
from rockflex.response._response import Response

UNITS_OF_GROUND = {
    "vertical_ground_acceleration": "m/s2",
    "slip": "m",
    "slip_velocity": "m/s",
    "heave": "m",
    "left_edge_uplift": "m",
    "right_edge_uplift": "m",
    "spring_force": "N",
}
"""Units of the columns; those of the springs have a number, from 1, at the end of their names."""


def ground_columns(response: Response) -> dict[str, Array]:
    """Return what the history of a run has beyond that of a base that stands on rigid ground, shapes (n_states,).

    The vertical acceleration of the ground if there is any, the slip if the base can slide, and on springs the heave,
    the rise of the edges and the force of every spring.
    """
    columns: dict[str, Array] = {}
    if response.history is None:
        return columns
    model = response.history.model
    if response.vertical_ground_acceleration.any():
        columns["vertical_ground_acceleration"] = response.vertical_ground_acceleration
    if model.layout.slip >= 0:
        columns |= {"slip": response.slip, "slip_velocity": response.slip_velocity}
    if isinstance(model, SpringModel):
        left, right = response.edge_uplift.T
        columns |= {"heave": response.heave, "left_edge_uplift": left, "right_edge_uplift": right}
        columns |= {f"spring_force_{k}": force for k, force in enumerate(response.spring_force.T, 1)}
    return columns
