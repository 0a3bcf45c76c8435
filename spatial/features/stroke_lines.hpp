// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of one texture over position and over time, paired where both are the same vibration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/numbers/line_spectrum.hpp"

namespace tacto::spatial {

/// A texture against time. The speed is the valid band in Hz over the valid band in 1/m.
struct TimeCourse {
  std::vector<double> values;
  double interval_s = 0;
  double mean_speed_mps = 0;  ///< distance over duration
  double unevenness = 0;      ///< standard deviation of the speed over time, over its mean
};

/// Sampled at eight times the band's upper limit, by linear interpolation of the texture's samples. Errors:
/// unsuitable, if neither band nor mean speed is known.
schema::Result<TimeCourse> time_course(const schema::Texture& texture);

/// One vibration of a texture: a line over position, over time, or both.
struct Vibration {
  double frequency_per_m = 0, sigma_per_m = 0;
  double frequency_hz = 0, sigma_hz = 0;
  double power = 0;          ///< unit^2, the larger of both
  double prominence_db = 0;  ///< the larger of both
  double needed_db = 0;      ///< of the spectrum with the larger prominence
  std::optional<std::size_t> space_line, time_line;
};

/// The data of one texture for certify().
struct StrokeLines {
  std::string name;
  LineSpectrum space, time;
  double speed_mps = 0;
  double unevenness = 0;
  std::vector<Vibration> vibrations;
};

/// Of the part at steady speed. Errors: of time_course(); unsuitable, if that part is too short, or its band
/// too narrow, for a spectrum.
schema::Result<StrokeLines> stroke_lines(const std::string& name, const schema::Texture& texture);

}  // namespace tacto::spatial
