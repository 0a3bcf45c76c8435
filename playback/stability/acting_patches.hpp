// SPDX-License-Identifier: GPL-3.0-or-later
// Which patches act at the same place.
#pragma once

#include <cstddef>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/scene/patch.hpp"

namespace tacto::playback {

/// The patches that act at a place: indices, from the topmost on. The topmost patch hides those below, unless
/// it is added to them (core/scene/scene_kernel.hpp). Precondition: the patches outlive it.
class PatchStack {
 public:
  explicit PatchStack(const std::vector<schema::Patch>& patches);
  std::vector<std::size_t> acting_at(double x_m, double y_m) const;

 private:
  const std::vector<schema::Patch>& patches_;
  std::vector<std::size_t> topmost_first_;
};

struct ActingPatches {
  std::vector<std::size_t> patches;  ///< as PatchStack
  double x_m = 0, y_m = 0;           ///< a place where they act
};

/// Each set of patches that acts somewhere on an area within the device's travel, once. The edges of patches
/// and travel divide the plane; each of its parts touches a crossing of two edges or a corner, and the places
/// beside these are tested: it takes time with the square of the number of patches. On a device of one axis
/// the other coordinate is 0.
std::vector<ActingPatches> acting_patches(const std::vector<schema::Patch>& patches,
                                          const schema::Device& device);

}  // namespace tacto::playback
