"""The time history of one run."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_rows
from rockflex._shown import counted
from rockflex._values import Value
from rockflex.models import (
    GROUND,
    HEADER,
    SIDE,
    TIME,
    RockingModel,
    SpringModel,
    accelerations,
)
from rockflex.response._element_history import ElementHistory
from rockflex.response._energy import EnergyLedger, energy_ledger, is_impact
from rockflex.response._floor_motion import FloorMotions
from rockflex.response._floors import floor_histories
from rockflex.response._global import global_histories
from rockflex.response._ground_history import GroundHistory, edge_times
from rockflex.response._history_columns import TabledHistory
from rockflex.response._missing import MissingQuantityError
from rockflex.response._reaction_history import ReactionHistory
from rockflex.response._sampled import even_instants, instants, of_run, states_at
from rockflex.response._settled import settled_rotation


@dataclass(frozen=True, eq=False, repr=False)
class History(GroundHistory, ReactionHistory, ElementHistory, FloorMotions, TabledHistory, Value):
    """States at the samples of the record and before and after every event; all arrays are read-only.

    Parameters
    ----------
    model
        The model of the run.
    states
        Shape (n_states, 2N + 6); each row contains time (s), side of rocking, horizontal and vertical acceleration of
        the ground (m/s²), D (m), D' (m/s), θ (rad) and θ' (rad/s). An event is two rows at the same time. A base that
        may slide adds its slip (m) and the velocity of it, one on springs its heave and the velocity of that. Nonlinear
        models have four more columns: z of Eq. 38, and the damped, input and hysteretic energy (J), which are known
        where the motion was integrated. The last columns are the memories of elements that yield or slide, and of the
        ground: what sticks and what is lifted.
        Stored as a copy.

    Raises
    ------
    InputError
        If `states` has another shape or a value that is not finite.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> history = rf.simulate(column, pulse, "2DOF-S", output="history", free_vibration=5.0).history
    >>> history.uplift_times.round(3)
    array([0.342, 1.28 , 3.363, 5.313])
    >>> float(abs(history.rotation).max().round(4))
    0.0395
    """

    model: RockingModel
    states: Array

    def __post_init__(self) -> None:
        columns = HEADER + self.model.layout.size
        object.__setattr__(self, "states", finite_rows("states", self.states, "SI units", columns))

    def __repr__(self) -> str:
        duration = self.time[-1] - self.time[0]
        states, uplifts = self.time.size, self.uplift_times.size
        return f"History({self.model.label}, {states} states over {duration:g} s, {counted(uplifts, 'uplift')})"

    def at(self, times: ArrayLike) -> "SampledHistory":
        """Return the motion at any instants within the history, with all quantities at these instants.

        At the time of an event it is the motion after it. Linear phases, which are all phases of the simplified models
        and the contact of the others, are exact. While a complete model rocks, and with a hysteresis, the motion
        between the stored states is the polynomial of fifth degree through their displacements, velocities and
        accelerations: a mode that vibrates at ω has a relative error of (ω Δt)⁶/46080 at most, Δt being the step of the
        record, and in its velocity (ω Δt)⁵/13400; where a spring yields sharply it is larger. `GroundMotion.refined`
        reduces Δt. The energies among the `states` are interpolated linearly.

        Parameters
        ----------
        times
            Instants in s, one or many, in any order.

        Raises
        ------
        InputError
            If an instant is not a number or outside the history.
        """
        return SampledHistory(self.model, states_at(self.model, self.states, instants(times, self.time)))

    def settled_rotation(self, work_limit: float | None = 30.0) -> float:
        """Return the rotation in rad that remains once the base has come to rest, from that at rest under gravity.

        The run is continued in free vibration from its last state, with all that its elements remember. NaN if the base
        overturned or then overturns.

        Parameters
        ----------
        work_limit
            Limit of the work of the continued run in s, as of `simulate`.

        Raises
        ------
        InputError
            If the superstructure is hysteretic, or the run would exceed its work limit.
        SolverError
            If the run does not settle, or has done the work of its limit.

        Examples
        --------
        >>> import rockflex as rf
        >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
        >>> rocking = rf.simulate(frame, rf.one_sine_pulse(amplitude=3.0, period=0.8), "2DOF-S")
        >>> round(rocking.residual_rotation, 4), rocking.settled_rotation()
        (0.0198, 0.0)
        """
        return settled_rotation(self.model, self.states, work_limit)

    def resample(self, dt: float) -> "SampledHistory":
        """Return the motion at equal steps from the first state to the last, as `at` does.

        Parameters
        ----------
        dt
            Step in s. If the history is no multiple of it, the last step, to the end of the history, is shorter.

        Raises
        ------
        InputError
            If `dt` is not a positive number, or gives more than 10 million instants.
        """
        return SampledHistory(self.model, states_at(self.model, self.states, even_instants(dt, self.time)))

    @property
    def time(self) -> Array:
        """Time of the states in s, shape (n_states,); the time of an event occurs twice."""
        return self.states[:, TIME]

    @property
    def side(self) -> Array:
        """Side of rocking: +1 about the right pivot (θ > 0), -1 about the left pivot, 0 in contact."""
        return self.states[:, SIDE]

    @property
    def ground_acceleration(self) -> Array:
        """Ground acceleration in m/s², shape (n_states,)."""
        return self.states[:, GROUND]

    @property
    def modal_displacement(self) -> Array:
        """D_n in m, shape (n_states, N)."""
        return self.model.layout.displacements(self.states)

    @property
    def modal_velocity(self) -> Array:
        """D'_n in m/s, shape (n_states, N)."""
        return self.model.layout.velocities(self.states)

    @property
    def rotation(self) -> Array:
        """θ in rad, shape (n_states,)."""
        return self.model.layout.of(self.states, self.model.layout.rotation)

    @property
    def rotation_velocity(self) -> Array:
        """θ' in rad/s, shape (n_states,)."""
        return self.model.layout.of(self.states, self.model.layout.spin)

    @property
    def modal_acceleration(self) -> Array:
        """D''_n in m/s², shape (n_states, N)."""
        return self._accelerations[:, : self.model.layout.modes]

    @property
    def rotation_acceleration(self) -> Array:
        """θ'' in rad/s², shape (n_states,)."""
        return self._accelerations[:, self.model.layout.modes]

    @property
    def yielding(self) -> Array:
        """Hysteretic variable z of the Bouc-Wen model (Eq. 38), dimensionless, shape (n_states,); zero if elastic."""
        if not self.model.integrated:
            return np.zeros(self.states.shape[0])
        return self.model.layout.of(self.states, self.model.layout.hysteresis)

    @property
    def top_displacement(self) -> Array:
        """u_top = Σ Γ_n φ_top,n D_n relative to the rotating base, in m, shape (n_states,)."""
        return self._global[:, 0]

    @property
    def total_top_displacement(self) -> Array:
        """Horizontal displacement of the top relative to the ground in m, shape (n_states,).

        u_top + h_top θ; in the complete models by Eq. 3, relative to the position before uplift.
        """
        if self.model.properties.top_height is None:
            raise MissingQuantityError(
                "The height of the top is not known, so there is no total displacement. Give RockingProperties the "
                "top_height, in m above the base."
            )
        return self._global[:, 3]

    @property
    def base_moment(self) -> Array:
        """M_b = Σ m*_n h*_n ω_n² D_n (or by Eq. 37) in N m, shape (n_states,); models with -R add the mass left out."""
        return self._global[:, 1]

    @property
    def base_shear(self) -> Array:
        """V_b = Σ m*_n ω_n² D_n (or by Eq. 37) in N, shape (n_states,); models with -R add the mass left out."""
        return self._global[:, 2]

    @property
    def uplift_times(self) -> Array:
        """Times of uplift in s, shape (n_uplifts,)."""
        if isinstance(self.model, SpringModel):
            return edge_times(self.model, self.states, lifts=True)
        return self.time[1:][(self.side[:-1] == 0.0) & (self.side[1:] != 0.0)]

    @property
    def impact_times(self) -> Array:
        """Times of impact, when the rotation returns to zero, in s, shape (n_impacts,)."""
        if isinstance(self.model, SpringModel):
            return edge_times(self.model, self.states, lifts=False)
        return self.time[1:][is_impact(self.model, self.states)]

    @property
    def story_drift(self) -> Array:
        """Displacement of each floor minus the one below in m, relative to the base, (n_states, N_floors)."""
        return self._floors[0]

    @property
    def story_shear(self) -> Array:
        """Sum of the elastic forces at and above each floor, in N, shape (n_states, N_floors)."""
        return self._floors[1]

    @property
    def floor_acceleration(self) -> Array:
        """Total horizontal acceleration of each floor, in m/s², shape (n_states, N_floors)."""
        return self._floors[2]

    @property
    def total_floor_displacement(self) -> Array:
        """Horizontal displacement of each floor relative to the ground, as for the top, in m, (n_states, N_floors)."""
        return self._floors[3]

    @property
    def element_energy(self) -> Array:
        """Energy that each element dissipated during the run in J, shape (E,); for its history see `EnergyLedger`."""
        return self.energy.elements[-1]

    @cached_property
    def energy(self) -> EnergyLedger:
        """Energy balance of the run; see `EnergyLedger`.

        Raises
        ------
        InputError
            If the model is too fast for the sampling: too many quadratures would be needed.
        """
        return energy_ledger(self.model, self.states)

    @cached_property
    def _global(self) -> Array:
        return global_histories(self.model, self.states)

    @cached_property
    def _accelerations(self) -> Array:
        values = accelerations(self.model, self.states)
        values.setflags(write=False)
        return values

    @cached_property
    def _floors(self) -> tuple[Array, Array, Array, Array]:
        return floor_histories(self.model, self.states)


class SampledHistory(History):
    """The motion of a run at chosen instants; `History.at` and `History.resample` return it.

    It has all quantities of a history at its instants, but not the events between them. The times of uplift and impact,
    the energy ledger, the required friction and the floor spectra depend on these, and raise an `InputError`: take them
    from the history of the run.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> history = rf.simulate(column, rf.one_sine_pulse(amplitude=3.0, period=1.0), "2DOF-S", output="history").history
    >>> history.resample(0.25).rotation.round(4)
    array([ 0.    ,  0.    , -0.0115, -0.0209, -0.007 ])
    >>> round(float(history.at(0.7).rotation[0]), 4)
    -0.0207
    """

    uplift_times = of_run()  # pyright: ignore[reportIncompatibleMethodOverride]
    impact_times = of_run()  # pyright: ignore[reportIncompatibleMethodOverride]
    energy = of_run()
    element_energy = of_run()  # pyright: ignore[reportIncompatibleMethodOverride]
    required_friction = of_run()
    required_friction_excluding_impacts = of_run()
    sliding_time = of_run()
    floor_motion = of_run()
    floor_spectrum = of_run()
    at = of_run()
    resample = of_run()

    def __repr__(self) -> str:
        return f"SampledHistory({self.model.label}, {self.time.size} instants, {self.time[0]:g} to {self.time[-1]:g} s)"
