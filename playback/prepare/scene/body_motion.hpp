// SPDX-License-Identifier: GPL-3.0-or-later
// How bodies move in a tick, and how stiff their coupling may be.
#pragma once

#include <string>

#include "data-schema/scene/scene.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::playback {

/// The exact discretisation of mass and damping under a force that is held for a tick; the damping of a lasso
/// is that of its mass, of a body 0.
core::BodyTable body_table(double mass_kg, double damping_n_s_per_m, double tick_s);

/// The stiffness below which a coupling that is computed once a tick T is stable with the hand at rest, with
/// the sliders at their worse ends.
/// Body, with the sampled damper B of the coupling and the mass m: z^2 - (2 - B T / m - K T^2 / 2 m) z + 1 -
/// B T / m + K T^2 / 2 m has its zeros in the unit circle for K < 2 B / T and B < 2 m / T; 0 if B is larger.
/// Lasso, with the damping of its mass: free_stiffness_limit(); slack it is never stiffer.
/// Infinity for other layers.
double stiffest_coupling_n_per_m(const schema::ForceLayer& layer, double tick_s);

/// Errors: unsuitable, by JSON pointer: a coupling that is too stiff for the rate, with the stiffest that
/// fits; more than core::kMostSceneBodies bodies and lassos. `where` is the scene's file.
schema::Result<void> check_bodies(const schema::Scene& scene, const std::string& where, double rate_hz);

}  // namespace tacto::playback
