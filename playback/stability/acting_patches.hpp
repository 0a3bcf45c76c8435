// SPDX-License-Identifier: GPL-3.0-or-later
// Which patches act at the same place.
#pragma once

#include <cstddef>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/scene/patch.hpp"

namespace tacto::playback {

struct ActingPatches {
  std::vector<std::size_t> patches;  ///< indices, from the topmost on
  double x_m = 0, y_m = 0;           ///< a place where they act
};

/// Each set of patches that acts somewhere on an area within the device's travel, once. The topmost patch
/// hides those below, unless it is added to them (core/scene/scene_kernel.hpp). The edges of patches and
/// travel divide the plane; each of its parts touches a crossing of two edges or a corner, and the places
/// beside these are tested: it takes time with the square of the number of patches. On a device of one axis
/// the other coordinate is 0.
std::vector<ActingPatches> acting_patches(const std::vector<schema::Patch>& patches,
                                          const schema::Device& device);

}  // namespace tacto::playback
