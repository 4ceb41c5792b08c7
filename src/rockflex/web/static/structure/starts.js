// Default values of a form where no preset has the kind, and of tables and elements added to a structure.

export const KINDS = {
  fish_bone: {
    story_heights: [4, 3, 3], masses: 4e4, column_stiffness: 2e8, beam_stiffness: "inf",
    base_mass: 4e4, half_width: 1, damping_ratio: 0.02,
  },
  beam: {
    height: 20, mass: 5000, bending_stiffness: 2e10, half_width: 1.5, damping_ratio: 0.02, base_mass: 5e4,
  },
  matrices: {
    mass: [4e4, 4e4], stiffness: [[2e7, -1e7], [-1e7, 1e7]], heights: [3, 6],
    base_mass: 4e4, half_width: 0.8, damping_ratio: 0.02,
  },
  modes: {
    omega: [9.771976, 25.583366], shapes: [[0.6180339887, -1.6180339887], [1, 1]], mass: [4e4, 4e4], heights: [3, 6],
    base_mass: 4e4, half_width: 0.8, damping_ratio: 0.02,
  },
  properties: {
    omega: [6.2832], effective_mass: [175906], effective_height: [10.54], top_ordinate: [1.2517],
    i_theta: 20066620, l0r: 1800000, m_tot: 240000, half_width: 1.054, zeta: 0.02,
  },
  block: { slenderness: 0.2, half_diagonal: 3 },
};

export const ELEMENTS = {
  tendon: { position: 0, initial_force: 1e5, stiffness: 1e6 },
  yielding_dissipator: { position: 0, stiffness: 5e7, yield_force: 1e5 },
  viscous_damper: { position: 0, coefficient: 5e5 },
  friction_damper: { position: 0, force: 5e4 },
};

// Tables nested in that of a structure, by name.
export const INNER = {
  lumped_masses: (beam) => ({ heights: [beam.height], masses: [1e4] }),
};
