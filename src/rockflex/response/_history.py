"""The time history of one run."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_finite_rows
from rockflex.foundation.errors import MissingQuantityError
from rockflex.foundation.shown import number_with_noun
from rockflex.foundation.values import Value
from rockflex.models._element_states import element_forces, element_states
from rockflex.models._named_quantities import joint_forces
from rockflex.models._reactions import spring_forces
from rockflex.models._rocking_model import RockingModel
from rockflex.models._spring_model import SpringModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.models._values_at_states import accelerations_at_states, quantities_at_states
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._energy import EnergyLedger, energy_ledger
from rockflex.response._export_files import history_variables, write_matlab, write_netcdf
from rockflex.response._floors import floor_histories, floor_motion
from rockflex.response._friction import IMPACT_WINDOW, Friction
from rockflex.response._interpolation import even_instants, instants, interpolated_states, only_of_run, settled_rotation
from rockflex.response._peaks import global_histories
from rockflex.response._sensitivity import Sensitivity, sensitivity_of_history
from rockflex.response._tables import history_to_dataframe, history_to_dataset
from rockflex.structure._ground import Springs

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from rockflex.motion._spectra import ResponseSpectrum


@dataclass(frozen=True, eq=False, repr=False)
class History(Value):
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
        where the motion was integrated; then come integrals for viscous dampers (∫ (δ'/r)² dt, on springs ∫ δ'² dt of
        each element) and the energies lost by sliding and by each spring under the base. The last columns are the
        internal variables of elements that yield or slide,
        and of the ground: what sticks and what is lifted. Stored as a copy.

    Raises
    ------
    InputError
        If `states` has another shape or a value that is not finite.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> history = rf.simulate(column, pulse, "2DOF-S", output="history",
    ...     free_vibration=5.0).history
    >>> history.uplift_times.round(3)
    array([0.342, 1.28 , 3.363, 5.313])
    >>> float(abs(history.rotation).max().round(4))
    0.0395
    """

    model: RockingModel
    states: Array

    def __post_init__(self) -> None:
        columns = HEADER + self.model.layout.size
        object.__setattr__(self, "states", checked_finite_rows("states", self.states, "SI units", columns))

    def __repr__(self) -> str:
        duration = self.time[-1] - self.time[0]
        states, uplifts = self.time.size, self.uplift_times.size
        return (
            f"History({self.model.label}, {states} states over {duration:g} s, {number_with_noun(uplifts, 'uplift')})"
        )

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
        return SampledHistory(self.model, interpolated_states(self.model, self.states, instants(times, self.time)))

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
        >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
        ...     damping_ratio=0.02)
        >>> rocking = rf.simulate(frame, rf.one_sine_pulse(amplitude=3.0, period=0.8),
        ...     "2DOF-S")
        >>> round(rocking.residual_rotation, 4), rocking.settled_rotation()
        (0.0198, 0.0)
        """
        return settled_rotation(self.model, self.states, work_limit)

    @cached_property
    def sensitivity(self) -> Sensitivity:
        """By how many per cent each peak changes for 1 % on the scale of the record, and a note where that is much.

        Found by running the record once more, at the first use. An `InputError` tells of a model that is not linear
        between events.
        """
        return sensitivity_of_history(self.model, self.states)

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
        return SampledHistory(self.model, interpolated_states(self.model, self.states, even_instants(dt, self.time)))

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
        return self._global["top_displacement"]

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
        return self._global["total_top_displacement"]

    @property
    def base_moment(self) -> Array:
        """M_b = Σ m*_n h*_n ω_n² D_n (or by Eq. 37) in N m, shape (n_states,); models with -R add the mass left out."""
        return self._global["base_moment"]

    @property
    def base_shear(self) -> Array:
        """V_b = Σ m*_n ω_n² D_n (or by Eq. 37) in N, shape (n_states,); models with -R add the mass left out."""
        return self._global["base_shear"]

    @property
    def uplift_times(self) -> Array:
        """Times of uplift in s, shape (n_uplifts,)."""
        return self.model.uplift_times(self.states)

    @property
    def impact_times(self) -> Array:
        """Times of impact, when the rotation returns to zero, in s, shape (n_impacts,)."""
        return self.model.impact_times(self.states)

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
        """Total horizontal acceleration of each floor, in m/s², shape (n_states, N_floors).

        After impacts it has the frequencies of all modes, and its peak grows with their number where masses are small.
        """
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

    @property
    def tendon_force(self) -> Array:
        """Force of each tendon in N, in the order of `RockingProperties.tendons`, shape (n_states, n_tendons)."""
        places = [k for k, each in enumerate(self.model.properties.elements) if each.prestressed]
        return self.element_force[:, places]

    @cached_property
    def element_force(self) -> Array:
        """Force of each element in N, positive if it pulls, shape (n_states, E).

        The order is that of `RockingProperties.elements`.
        """
        values = element_forces(self.model, self.states)[:, : len(self.model.properties.elements)]
        values.setflags(write=False)
        return values

    @property
    def element_elongation(self) -> Array:
        """Elongation of each element in m, shape (n_states, E).

        r |θ| under the base, in complete models 2 r sin(|θ|/2), on springs how far the base has risen there since it
        was at rest; as in `Attachment` for others.
        """
        return self.model.elongations_at(self.states)[:, : len(self.model.properties.elements)]

    @property
    def element_state(self) -> NDArray[np.int8]:
        """State of each element: 0 elastic or held, 1 as it yields or slides, 2 broken, shape (n_states, E + S).

        S stories that yield follow the elements.
        """
        return element_states(self.model, self.states)

    @property
    def vertical_ground_acceleration(self) -> Array:
        """Vertical acceleration of the ground in m/s², positive upwards, shape (n_states,)."""
        return self.states[:, RISE]

    @property
    def joint_rotation(self) -> Array:
        """Rotation of each joint above the base in rad, relative to what is below it, shape (n_states, n_joints)."""
        layout = self.model.layout
        return self.states[:, [HEADER + place for place in layout.rotations[1:]]]

    @property
    def joint_force(self) -> Array:
        """Axial force of each joint above the base in N, positive where it is pressed, shape (n_states, n_joints)."""
        return quantities_at_states(self.model, joint_forces(self.model), self.states)

    @property
    def slip(self) -> Array:
        """Displacement of the base along the ground in m, positive to the right; zero if it cannot slide."""
        return self._of_base(self.model.layout.slip)

    @property
    def slip_velocity(self) -> Array:
        """Velocity of the slip in m/s, shape (n_states,)."""
        layout = self.model.layout
        return self._of_base(layout.slip + 1 if layout.slip >= 0 else -1)

    @property
    def heave(self) -> Array:
        """Rise of the base at the axis of the masses in m, shape (n_states,).

        On springs from the level at which they are unloaded, on rigid ground the distance to the pivot times |θ|.
        """
        return self.model.heave(self.states)

    @property
    def edge_uplift(self) -> Array:
        """Rise of the left and of the right edge of the base in m, negative where it settles, shape (n_states, 2)."""
        return self.model.edge_uplift(self.states)

    @property
    def uplifted(self) -> Bools:
        """Whether the base is off the ground, on springs whether an edge has left its spring, shape (n_states,)."""
        return self.model.uplifted(self.states)

    @property
    def permanent_settlement(self) -> Array:
        """Permanent settlement of each spring in m, shape (n_states, n_springs); none on rigid ground."""
        model = self.model
        return model.permanent_settlements(self.states) if isinstance(model, SpringModel) else self.spring_force

    @property
    def spring_force(self) -> Array:
        """Upward force of each spring under the base in N, shape (n_states, n_springs); none on rigid ground."""
        return spring_forces(self.model, self.states)

    @property
    def soil_pressure(self) -> Array:
        """Pressure under the base at each spring in Pa, shape (n_states, n_springs).

        Raises
        ------
        InputError
            If the springs have no `area`.
        """
        return soil_pressure(self.spring_force, self.model.springs)

    @property
    def bearing_pressure(self) -> Array:
        """Static bearing pressure in Pa, shape (n_states,): the resultant of the springs over its effective area.

        Without dashpots, and uniform over the part 2 (B - |e|) of the base whose middle is the resultant, at the
        eccentricity e: the area of Meyerhof (1953), by which bearing capacities are given, whatever the distribution of
        stiffness. The end zones of a bed and its dashpots raise `soil_pressure` above it. Zero in flight; on one spring
        alone it is the pressure of that spring.

        Raises
        ------
        InputError
            If the springs have no `area`.
        """
        model, springs = self.model, self.model.springs
        if springs is None or springs.area is None:
            raise missing_spring_area_error()
        turn = model.turned(model.layout.of(self.states, model.layout.rotation))[:, None]
        pushes = springs.stiffness * np.maximum(springs.positions * turn - self.heave[:, None], 0.0)
        force, p = pushes.sum(axis=1), model.properties
        middle = 0.5 * (p.pivot(1).arm - p.pivot(-1).arm)
        moved = np.abs(pushes @ (springs.positions - middle)) / np.where(force > 0.0, force, 1.0)
        return force / (springs.area.sum() * (1.0 - moved / p.half_width))

    def _of_base(self, place: int) -> Array:
        return self.model.layout.of(self.states, place) if place >= 0 else np.zeros(self.states.shape[0])

    @property
    def horizontal_reaction(self) -> Array:
        """Horizontal ground reaction Σ m_i (a + x''_i) of Eq. 21, in N, shape (n_states,).

        In the simplified models, for small rotations: m_tot a + L_0^r θ'' + Σ m* D''.
        """
        return self._friction.reactions.horizontal

    @property
    def vertical_reaction(self) -> Array:
        """Vertical ground reaction Σ m_i (g + z''_i), in N, positive upwards, shape (n_states,).

        This is Eq. 22 with the sign of the weight corrected; as printed, it is smaller by 2 m_tot g. Tendon forces are
        included. In the simplified models, for small rotations: m_tot (g + s B θ'').
        """
        return self._friction.reactions.vertical

    @property
    def friction_demand(self) -> Array:
        """|ΣF_x| / ΣF_z of Eq. 20, dimensionless, shape (n_states,); infinite if the base would lose contact."""
        return self._friction.demand

    @cached_property
    def required_friction(self) -> float:
        """Largest friction demand of the run, including between states; infinite if the base would lose contact.

        Raises
        ------
        InputError
            If the model is too fast for the sampling.
        """
        return self._friction.required()

    def required_friction_excluding_impacts(self, window: float = IMPACT_WINDOW, printed: bool = False) -> float:
        """Return the largest friction demand except for the time after each impact, when it has short spikes.

        Parameters
        ----------
        window
            Seconds after each impact to exclude; with zero nothing is excluded. If no time remains, the result is zero.
        printed
            Use the magnitude of Eq. 22 as printed, Σ m_i (-g + z''_i), which has a wrong sign; for comparison.

        Raises
        ------
        InputError
            If `window` is negative or not finite, or the model is too fast for the sampling.
        """
        return self._friction_by(printed).required(window)

    def sliding_time(self, mu: float, printed: bool = False) -> float | None:
        """Return the time in s at which the friction demand first exceeds `mu` and sliding would start, or None.

        Parameters
        ----------
        mu
            Coefficient of friction, positive.
        printed
            As in `required_friction_excluding_impacts`.

        Raises
        ------
        InputError
            If `mu` is not a positive number, or the model is too fast for the sampling.
        """
        return self._friction_by(printed).sliding_time(mu)

    @cached_property
    def _friction(self) -> Friction:
        return Friction(self.model, self.states)

    def _friction_by(self, printed: bool) -> Friction:
        return self._friction.as_printed if printed else self._friction

    def floor_motion(self, floor: SupportsIndex, dt: float | None = None, *, impulses: bool = True) -> GroundMotion:
        """Return the total horizontal acceleration of a floor as a motion, for its measures and spectra.

        Parameters
        ----------
        floor
            Number of the floor; 1 is the first above the base, as in the columns of `to_frame`.
        dt
            Longest step in s between samples, which are joined linearly; the step divides the history equally. None:
            0.005 s, or a twentieth of the shortest period of the modes if that is shorter.
        impulses
            Whether to include what an impact changes in the velocity of the floor at once. The samples before and after
            it take it as an acceleration during `dt`, and likewise what a straight line between samples leaves out of a
            sudden change of the acceleration, so that the velocity of the floor is right. With False the samples are
            those of `floor_acceleration`.

        Returns
        -------
        GroundMotion
            From the first state to the last, with the free vibration.

        Raises
        ------
        InputError
            If the structure has no floors or not this one, or `dt` is not positive or too short.
        """
        return floor_motion(self.model, self.states, floor, dt, impulses=impulses)

    def floor_spectrum(
        self,
        floor: SupportsIndex,
        periods: ArrayLike,
        damping_ratio: float = 0.05,
        *,
        dt: float | None = None,
        impulses: bool = True,
    ) -> "ResponseSpectrum":
        """Return the response spectrum of the total horizontal acceleration of a floor, for light equipment on it.

        It is exact for the motion of `floor_motion`, whose error is proportional to `dt`²; at periods shorter than `dt`
        the impulses of impacts count as accelerations during `dt`.

        Parameters
        ----------
        floor, dt, impulses
            As in `floor_motion`.
        periods, damping_ratio
            As in `GroundMotion.spectrum`: periods in s, and the fraction of critical damping of the equipment.

        Raises
        ------
        InputError
            As for `floor_motion` and `GroundMotion.spectrum`.
        """
        return self.floor_motion(floor, dt, impulses=impulses).spectrum(periods, damping_ratio)

    def to_frame(self, quantities: Sequence[str] | None = None) -> "pd.DataFrame":
        """Return the history as a table, one row a state, in SI units.

        An event is two rows at the same time, the motion before and after it, so the index is not unique;
        ``history.resample(dt).to_frame()`` has every instant once.

        Parameters
        ----------
        quantities
            Names of quantities of the history, such as ``["modal_displacement", "floor_acceleration"]``. One with
            several values, as for every floor, has a column for each: ``floor_acceleration_1``, ... None: those that
            ``rockflex run --out`` writes.

        Returns
        -------
        pandas.DataFrame
            Indexed by `time` (s). By default the columns are `side`, `ground_acceleration` (m/s²), `rotation` (rad),
            `rotation_velocity` (rad/s), `top_displacement` and `total_top_displacement` (m; NaN if the height of the
            top is not known), `base_moment` (N m), `base_shear`, `horizontal_reaction` and `vertical_reaction` (N);
            `yielding` with a hysteresis; `vertical_ground_acceleration` if there is any; `slip` and `slip_velocity`
            where the base can slide; on springs `heave`, `left_edge_uplift`, `right_edge_uplift` and `spring_force_1`,
            ...

        Raises
        ------
        InputError
            If there is no such quantity, or the structure has no floors.
        """
        return history_to_dataframe(self, quantities)

    def to_xarray(self, quantities: Sequence[str] | None = None) -> "xr.Dataset":
        """Return the history as a labelled data set, in SI units; it needs the extra ``rockflex[xarray]``.

        Parameters
        ----------
        quantities
            Names of quantities of the history. None: all that the model has.

        Returns
        -------
        xarray.Dataset
            A variable for each quantity, with its unit in ``attrs["units"]``. Dimensions are `time` (s), in which an
            event occurs twice, and where there are several values `mode`, `floor`, `element`, `tendon` or `spring`,
            counted from 1, or `edge`, "left" and "right".

        Raises
        ------
        InputError
            If xarray is not installed, there is no such quantity, or the structure has no floors.
        """
        return history_to_dataset(self, quantities)

    def to_matlab(self, path: str | Path, quantities: Sequence[str] | None = None) -> Path:
        """Write the history as a file of MATLAB; see `rockflex.to_matlab`."""
        return write_matlab(path, self.model.label, history_variables(self, quantities))

    def to_netcdf(self, path: str | Path, quantities: Sequence[str] | None = None) -> Path:
        """Write the history as a NetCDF file; see `rockflex.to_netcdf`."""
        return write_netcdf(path, self.model.label, history_variables(self, quantities))

    @cached_property
    def _global(self) -> dict[str, Array]:
        return global_histories(self.model, self.states)

    @cached_property
    def _accelerations(self) -> Array:
        values = accelerations_at_states(self.model, self.states)
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
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> history = rf.simulate(column, rf.one_sine_pulse(amplitude=3.0,
    ...     period=1.0), "2DOF-S", output="history").history
    >>> history.resample(0.25).rotation.round(4)
    array([ 0.    ,  0.    , -0.0115, -0.0209, -0.007 ])
    >>> round(float(history.at(0.7).rotation[0]), 4)
    -0.0207
    """

    uplift_times = only_of_run()  # pyright: ignore[reportIncompatibleMethodOverride]
    impact_times = only_of_run()  # pyright: ignore[reportIncompatibleMethodOverride]
    energy = only_of_run()
    element_energy = only_of_run()  # pyright: ignore[reportIncompatibleMethodOverride]
    required_friction = only_of_run()
    required_friction_excluding_impacts = only_of_run()
    sliding_time = only_of_run()
    floor_motion = only_of_run()
    floor_spectrum = only_of_run()
    at = only_of_run()
    resample = only_of_run()

    def __repr__(self) -> str:
        return f"SampledHistory({self.model.label}, {self.time.size} instants, {self.time[0]:g} to {self.time[-1]:g} s)"


def soil_pressure(force: Array, springs: Springs | None) -> Array:
    """Return the pressure at each spring in Pa from its force in N, shape (n, S).

    Raises
    ------
    MissingQuantityError
        If there are no springs, or they have no `area`.
    """
    if springs is None or springs.area is None:
        raise missing_spring_area_error()
    return force / springs.area


def missing_spring_area_error() -> MissingQuantityError:
    """Return the error of a pressure without areas."""
    return MissingQuantityError(
        "The springs under the base have no area, so there is no soil pressure. Give Springs the area that each "
        "supports, in m², or use winkler_bed."
    )
