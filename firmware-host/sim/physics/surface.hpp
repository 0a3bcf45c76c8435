// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of the emulated device: the five samples of the paper's Table II, and plain gratings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "firmware-host/sim/physics/height_profile.hpp"

namespace tacto::firmware_host {

struct SurfaceChoice {
  std::string name = "C";   ///< one of surface_names(), or profile:NAME, a texture of heights
  double length_m = 0.040;  ///< of the samples in Wiertlewski 2011, section IV-A5; a profile has its own
  std::optional<double> period_m;  ///< of sine, triangle and square
  std::optional<double> depth_m;   ///< peak to valley, of the same
  std::uint64_t seed = 1;
};

struct Surface {
  HeightProfile profile;
  std::string description;  ///< "C: grating of 3 mm period, 0.1 mm deep"
};

/// "A, B, C, D, E, flat, sine, triangle, square".
std::string surface_names();

/// The surface on a grid of 2 um; the same seed gives the same heights. Errors: usage: a name that does not
/// exist (with those that do), a period or depth for a surface with its own, a period under 50 um, a length
/// that is not 10 mm ... 1 m; unsuitable: a profile that is not of heights, coarser than 0.1 mm, over 1 mm
/// tall, or not 10 mm ... 1 m long; as read_texture().
schema::Result<Surface> make_surface(const SurfaceChoice& choice);

}  // namespace tacto::firmware_host
