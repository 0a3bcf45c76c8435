// SPDX-License-Identifier: GPL-3.0-or-later
// The force of a patch, or of one of its layers, at a place: in double precision, and as the kernel gives it.
#pragma once

#include <string>

#include "analysis/scene/scene_figure.hpp"

namespace tacto::analysis {

/// Before the limits of the device, on a hand at rest.
struct SceneSample {
  double x_m = 0, y_m = 0;                ///< of the nearest counts of the encoders
  double force_x_n = 0, force_y_n = 0;    ///< playback::ExactScene
  double kernel_x_n = 0, kernel_y_n = 0;  ///< core::SceneKernel, in single precision
};

/// `what`: the name of a patch, or NAME.INDEX of one of its layers; other patches are left out. Precondition:
/// the picture has a device. Errors: not_found: no such patch or layer; unsuitable: the place is not in it.
schema::Result<SceneSample> sample_scene(const ScenePicture& picture, const std::string& what, double x_m,
                                         double y_m);

/// The value of Perlin's improved noise at a place in cells.
struct NoiseValue {
  double exact = 0, kernel = 0;
};
NoiseValue sample_noise(double x, double y, double z);

}  // namespace tacto::analysis
