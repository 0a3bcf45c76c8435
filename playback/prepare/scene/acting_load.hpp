// SPDX-License-Identifier: GPL-3.0-or-later
// The sum of the stiffnesses and dampings of layers that act at the same place.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/scene/patch.hpp"
#include "playback/stability/sampled_loop.hpp"

namespace tacto::playback {

/// A brick or a lasso, with its sliders at both ends. That of a lasso's stiffness begins at 0: slack, it does
/// not pull, and across its direction it is softer than along it.
struct ActingBody {
  std::string name;  ///< as `unknown` of ActingLoad
  CoupledBody least, most;
};

/// More bodies at one place are not computed: each one that may rest doubles the time.
inline constexpr std::size_t kMostActingBodies = 4;

/// With each slider at its upper end, of dampers and bodies at both ends.
struct ActingLoad {
  double stiffness_n_per_m = 0, least_damping_n_s_per_m = 0, most_damping_n_s_per_m = 0;
  /// Of force maps: how strongly they drive the hand away, as a negative stiffness; and of springs, what is
  /// against it at all places.
  double repelling_n_per_m = 0, holding_n_per_m = 0;
  double curl_n_per_m = 0;  ///< of force maps: energy that a turn of the hand gains, by its area
  std::vector<std::string> unknown = {};  ///< the layers whose stiffness is not computed
  std::vector<ActingBody> bodies = {};

  /// With the dampers, the stiffness of all bodies and the damping of all bodies each at its least and at its
  /// largest value; equal ones once. Without bodies one or two.
  std::vector<SampledLoad> at_ends() const;
};

/// `unknown` is its type.
ActingLoad load_of(const schema::ForceLayer& layer);
/// The sum over all layers of these patches; `unknown` are as in "mass 0 of patch 'a'", and all bodies if
/// there are more than kMostActingBodies.
ActingLoad load_of(const std::vector<schema::Patch>& patches, const std::vector<std::size_t>& acting);
/// The layers of all patches whose stiffness is not scaled by hold_stable(): those that are not computed, and
/// bodies; named in the same way.
std::vector<std::string> not_held_layers(const std::vector<schema::Patch>& patches);

}  // namespace tacto::playback
