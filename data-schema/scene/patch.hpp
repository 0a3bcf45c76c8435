// SPDX-License-Identifier: GPL-3.0-or-later
// A patch: a rectangle in the plane with force layers that act on a hand inside it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/scene/force_layer.hpp"

namespace tacto::schema {

/// Where patches overlap: only the topmost patch acts, or this one acts as well.
enum class PatchCombine { topmost, add };

struct Patch {
  std::string name;         ///< different for each patch of a scene
  double x_m = 0, y_m = 0;  ///< its centre
  double width_m = 0;       ///< along its own x axis
  double height_m = 0;      ///< along its own y axis
  double angle_deg = 0;     ///< from the plane's x axis towards its y axis
  double order = 0;         ///< a larger one is above; of equal ones the later patch
  PatchCombine combine = PatchCombine::topmost;
  std::vector<ForceLayer> layers;  ///< at least one; their forces add up
  std::string extra_json;          ///< members of a newer version, also within place and size
};

/// "topmost", "add".
std::string_view to_string(PatchCombine combine);

}  // namespace tacto::schema
