//! Scenes as tables, for serde and in TOML files.
//!
//! ```toml
//! name = "…"                       # optional, as are source, epoch (0), span, tolerance (1e-12), method ("auto"), order, averaging ("auto"), level ("auto")
//! source = "where the figures come from"
//! epoch = 0.0                      # time of the state
//! span = [0.0, 1.0e6]              # times over which the tolerance is asked for
//! tolerance = 1e-12                # \[rad\]
//! [body]
//! moments = [0.5, 0.75, 1.0]       # about body axes 1, 2, 3; or named = "ceres"; or inertia = [[…], […], […]], a tensor about axes of your own
//! [state]
//! attitude = [0.0, 0.0, 0.0, 1.0]  # [x, y, z, w], body components → inertial ones
//! angular_velocity = [0.0, 0.1, 1.0]   # body components
//! # frame = "lvlh"                 # the state is against the orbital frame "rtn" or "lvlh" of the orbit; then
//! # elements_of = "rotating"       # or "disturbing": whose orbit it is; relative = true: the rates are those against the frame; of = 0: which of several orbits
//! # sequence = "ZYX"               # if attitude has three angles
//! # or, instead of a state, the periods of a tumbler:
//! # [periods]
//! # precession = 27.38             # P_φ
//! # rotation = 263.0               # P_ψ
//! # mode = "short-axis"            # or "long-axis"; convention = "extremal-axis", or "long-axis", "short-axis"
//! # momentum_direction = [0, 0, 1] # inertial components, or [longitude, latitude] \[rad\]; phases = [0, 0] \[turns\]
//! [orbit]                          # optional: of the disturbing body, for the gravity gradient
//! mean_motion = 1e-3               # the only element without a default
//! eccentricity = 0.1               # 0, as time_of_pericentre, inclination, node, argument_of_pericentre; mass_fraction is 1
//! node_rate = 0.0                  # 0, as pericentre_rate: secular rates; attraction = 1e-6 instead of mean_motion² × mass_fraction
//! # [[orbit]]                      # instead, once for each of several disturbing bodies; or of one by a table of positions:
//! # times = [0.0, 60.0]            # eight at least
//! # positions = [[…], […]]         # from the rotating body, inertial components
//! # gm = 4.0e14                    # G × mass of the disturbing body
//! # [[torque]]                     # once for each torque beside the gravity gradient: constant, damping (a matrix), rotor or polynomial
//! # polynomial = ["0", "-2e-3*b3", "2e-3*b2"]   # in unit vectors to sources (b1, b2, b3) and rates (w1, w2, w3), body components
//! # truncation = 0.02              # of the polynomials of a shape: what they leave out, relative to the torque
//! # [[torque.source]]
//! # name = "b"                     # with direction = [0, 0, 1], inertial, or [torque.source.orbit] as above
//! # power = 3                      # with an orbit: the factor (reference_distance/r)^power
//! # reference_distance = 7.0e6     # needed if the orbit has a semi_major_axis or is a table; else 1, in semi-major axes
//! ```
//!
//! Any other key is an error. Numbers are written so that they are read back to the same bits. `data` has the tables of bodies, states, orbits and torques by themselves.

mod data;
mod read;
mod refusal;
mod tables;
#[cfg(feature = "scene-files")]
mod toml_problem;
#[cfg(feature = "scene-files")]
mod toml_text;
mod write;
