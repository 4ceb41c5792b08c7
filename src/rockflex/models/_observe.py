"""Kinds of response quantities of the complete models (Silva & Stojadinović 2024, Eqs. 3-22).

In contact, and always in the simplified models, every quantity is a linear row over the motion. While a complete model
rocks, displacements are nonlinear in the rotation, and forces depend on accelerations: `RockingField.observe` then
replaces the value of the row by that of the quantity, for which it has two levers.
"""

LINEAR = 0  # the row itself
SWAY = 1  # horizontal displacement of a point at the height levers[0]; the row gives its u (Eq. 3)
LEFT_OUT = 2  # the row and the masses left out: levers[0] is Σ m_i or Σ m_i h_i, levers[1] Σ m_i h_i or Σ m_i h_i²
SWING = 3  # rate of the elongation of an element per unit distance from the pivot; the row gives θ'
HORIZONTAL = 4  # Σ F_x (Eq. 21) including the forces of elements
# By how much Σ F_z is below its value at rest (Eq. 22 with the sign of the weight corrected), including these forces.
VERTICAL = 5
