// SPDX-License-Identifier: GPL-3.0-or-later
// The stiffness and damping of layers that act together.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/scene/patch.hpp"

namespace tacto::playback {

/// With each slider at its upper end, of dampers at both ends.
struct ActingLoad {
  double stiffness_n_per_m = 0, least_damping_n_s_per_m = 0, most_damping_n_s_per_m = 0;
  double curl_n_per_m = 0;  ///< of force maps: energy that a turn of the hand gains, by its area
  std::vector<std::string> unknown = {};  ///< the layers whose stiffness is not computed
};

/// `unknown` is its type.
ActingLoad load_of(const schema::ForceLayer& layer);
/// The sum over all layers of these patches; `unknown` are as in "body 0 of patch 'a'".
ActingLoad load_of(const std::vector<schema::Patch>& patches, const std::vector<std::size_t>& acting);
/// The layers of all patches whose stiffness is not computed, named in the same way.
std::vector<std::string> unknown_layers(const std::vector<schema::Patch>& patches);

}  // namespace tacto::playback
