"""
A pier on soil that gives
=========================

A bridge pier whose footing can rock, on rigid ground and on a bed of springs,
with and without sliding, and shaken upwards as well. On rigid ground an
impact law says what each landing takes; on soil the dashpots of the bed take
it.
"""

import numpy as np

import rockflex as rf

pier = rf.CantileverWithTipMass(
    height=12.0,
    tip_mass=500e3,
    mass_per_length=10e3,
    bending_stiffness=4.0e10,
    base_mass=200e3,
    half_width=2.0,
    damping_ratio=0.03,
    n_modes=3,
)
p = pier.rocking()
weight = p.m_tot * 9.81
bed = rf.winkler_bed(
    half_width=2.0, breadth=6.0, subgrade_modulus=80e6, n=16
).damped(0.3, p.m_tot)
footing = 200e3 * 4.0**2 / 12.0  # kg m²: rotary inertia of a rigid mat
drawing = rf.plot_structure(
    pier, rf.Ground(friction=0.25, springs=bed, base_inertia=footing)
)
print(
    f"The pier settles by {1e3 * weight / bed.total_stiffness:.1f} mm under "
    f"{weight / 1e6:.1f} MN,"
)
print(
    f"a mean pressure of {weight / 24.0 / 1e3:.0f} kPa under its footing of "
    "4 m by 6 m."
)
print(
    "Slowly pushed, it lifts at a ground acceleration of "
    f"{p.resisting_moment / p.l0r:.2f} m/s² on rigid ground."
)

# %%
# Rigid ground, soil, and soil on which the footing may slide as well, under
# one record. On soil the pier rocks with a longer period, and without the
# peaks of base shear that impacts cause.
GROUNDS = {
    "rigid": None,
    "rigid, μ = 0.25": rf.Ground(friction=0.25),
    "soil": rf.Ground(springs=bed, base_inertia=footing),
    "soil, μ = 0.25": rf.Ground(
        friction=0.25, springs=bed, base_inertia=footing
    ),
}
motion = rf.load_suite("fema-p695-far-field")["FF-2-a"].scaled(1.5)


def run(record: rf.GroundMotion) -> dict[str, rf.Response]:
    """Simulate the pier on every ground, and print its peaks."""
    found = {
        name: rf.simulate(pier, record, "MDOF-S", ground=ground)
        for name, ground in GROUNDS.items()
    }
    print(
        "                  θ_max   u_top    V_b    N_min    slip  at end     "
        "edge up  down"
    )
    print(
        "                  [rad]     [m]   [MN]     [MN]    [mm]    [mm]     "
        "   [mm]  [mm]"
    )
    for name, each in found.items():
        print(
            f"{name:15s} {each.max_rotation:8.4f} "
            f"{each.max_total_top_displacement:7.3f} "
            f"{each.max_base_shear / 1e6:6.2f} "
            f"{each.min_vertical_reaction / 1e6:8.2f} "
            f"{1e3 * each.max_slip:7.1f} "
            f"{1e3 * each.residual_slip:7.1f} "
            f"{1e3 * each.max_edge_uplift:11.1f} "
            f"{1e3 * each.max_edge_settlement:5.1f}"
        )
    return found


across = run(motion)
history = rf.plot_history(
    [across["rigid"], across["soil"]], labels=["rigid", "soil"]
)

# %%
# The footing over time: its edges, the pressure under it, and how much of it
# is in contact. While the pier rocks, its whole weight is on a narrow strip
# near one edge; the greatest pressure there is many times the mean one. This
# is what the soil must bear, or it yields, which springs that stay elastic do
# not show.
soil = rf.plot_footing(across["soil"])
for name in ("soil", "soil, μ = 0.25"):
    response = across[name]
    contact = (response.spring_force > 0.0).mean(axis=1).min()
    print(
        f"{name}: pressure up to {response.soil_pressure.max() / 1e3:.0f} "
        f"kPa, contact down to {contact:.0%}"
    )

# %%
# Now with a vertical component. The records in the package have none, so this
# one is **synthetic**: noise from 5 to 15 Hz under the envelope of the
# horizontal record, with two thirds of its peak. For a project, use the
# component of the same station: ``read_motion(path, vertical=...)``.
rng = np.random.default_rng(1)
frequency = np.fft.rfftfreq(motion.acceleration.size, motion.dt)
noise = np.fft.rfft(rng.normal(size=motion.acceleration.size)) * (
    (frequency > 5.0) & (frequency < 15.0)
)
smooth = np.hanning(round(1.0 / motion.dt))
envelope = np.sqrt(
    np.convolve(motion.acceleration**2, smooth / smooth.sum(), mode="same")
)
upwards = np.fft.irfft(noise, motion.acceleration.size) * envelope
both = rf.GroundMotion(
    motion.acceleration,
    motion.dt,
    "FF-2-a + synthetic",
    vertical=upwards * (2.0 / 3.0) * motion.pga / np.abs(upwards).max(),
)
shaken = run(both)

# %%
# On rigid ground the least vertical force is negative: the model pulls the
# footing down where it would hop, and its base shear has the spikes of
# impacts that last no time. On soil neither occurs, and springs cannot pull.
print(shaken["rigid"].warnings[0])
print(f"on soil: {len(shaken['soil'].warnings)} warnings")

# %%
# The vertical motion changes the pressure under the footing and the normal
# force that friction depends on, and hardly the rotation: its period is far
# shorter than that of rocking.
hopping = rf.plot_history(
    [shaken["rigid, μ = 0.25"], shaken["soil, μ = 0.25"]],
    labels=["rigid, μ = 0.25", "soil, μ = 0.25"],
)
for name in GROUNDS:
    ratio = shaken[name].max_rotation / across[name].max_rotation
    print(
        f"{name}: θ_max with the vertical component is {ratio:.2f} times "
        "that without"
    )

# %%
# Where the energy goes. On rigid ground every impact makes the pier ring, and
# its flexure takes more energy than the impacts themselves. On soil it hardly
# rings, and the dashpots of the bed take nearly all: the base shear is a
# quarter.
on_rigid = rf.plot_energy(shaken["rigid, μ = 0.25"])
on_soil = rf.plot_energy(shaken["soil, μ = 0.25"])
