// SPDX-License-Identifier: GPL-3.0-or-later
// A patch in the plane: its corners, and which places it contains.
#pragma once

#include <array>

#include "data-schema/scene/patch.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::analysis {

/// Places in metres, as spatial::Point with y upwards.
class PatchFrame {
 public:
  explicit PatchFrame(const schema::Patch& patch);

  /// From the patch's axes, from its centre, to the plane.
  spatial::Point in_plane(double u_m, double v_m) const;
  bool holds(spatial::Point place_m) const;
  /// Around the patch.
  std::array<spatial::Point, 4> corners() const;

 private:
  spatial::Point centre_m_;
  double half_width_m_, half_height_m_, cosine_, sine_;
};

}  // namespace tacto::analysis
