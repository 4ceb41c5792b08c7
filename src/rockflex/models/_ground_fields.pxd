cimport cython
from rockflex.engine.field cimport Field
from rockflex.models._fields cimport RockingField


@cython.final
cdef class GroundField(Field):
    cdef RockingField about
    cdef int n, side, branch, core, slip, heave, memory, viscous, rubbed, soil, sweeps, way
    cdef bint complete, hysteretic, turns, slides, pressed
    cdef double offset, inertia, modal_inertia, arm, modal_arm, mass_all, mass_along, modal_mass, gravity, resting, friction
    cdef double yielding, loading, gamma, beta
    cdef double[::1] mass, height, stiffness, drag, omega2
    cdef int spring_count, element_count, check_count, kinds_count
    cdef double[:, ::1] springs  # x, k, c, the friction, and 1 if it is loaded, -1 if it recedes
    cdef double[:, ::1] elements  # x, k, c, f, the factor of an internal variable, and δ at z = θ = 0
    cdef int[::1] recalled  # places of these variables, -1 if there are none
    cdef int[:, ::1] checks  # the event, the kind of its condition, a number of what it is of, and a place in the state
    cdef double[:, ::1] limits  # a factor, and two numbers of the condition
    # What `gather` computes: sine and cosine of θ, or θ and 1; g + a_v and a; Σ m u, Σ m* D' and Σ m* (D - o) D' with
    # u from the reference point; moment and force of springs and elements, and the pull of those on rigid ground.
    cdef double sine, cosine, lean, upright, weight, level, spin, square, first, flow, swirl, rotary, turning, lifting, pull
    cdef int[::1] kinds
    cdef double[:, ::1] levers

    cdef void gather(self, const double *y, double a, double a_v) noexcept nogil
    cdef double restoring(self, const double *y, double *out, bint counted) noexcept nogil
    cdef void enter_energies(self, const double *y, double a, double a_v, double *out) noexcept nogil
    cdef double push(self, const double *y, int j) noexcept nogil
    cdef double tension(self, const double *y, int e) noexcept nogil
    cdef double grip(self, const double *y) noexcept nogil
    cdef (double, double) reactions(self, const double *rates) noexcept nogil
