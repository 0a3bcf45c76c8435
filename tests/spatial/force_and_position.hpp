// SPDX-License-Identifier: GPL-3.0-or-later
// A touch with values from a test: tangential force and position, no normal force.
#pragma once

#include "spatial/strokes/touch_source.hpp"

namespace tacto::spatial::samples {

/// Derived classes implement only read_stored().
class ForceAndPosition : public TouchSource {
 public:
  ForceAndPosition() {
    position_.name = position_.quantity = "position";
    force_.name = force_.quantity = "tangential_force";
    position_.unit = "m";
    force_.unit = "N";
  }
  const schema::Channel* channel(Track track) const override {
    if (track == Track::position) return &position_;
    return track == Track::value ? &force_ : nullptr;
  }

 private:
  schema::Channel position_, force_;
};

}  // namespace tacto::spatial::samples
