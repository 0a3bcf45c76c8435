// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of one texture, over position and over time, and which of both are the same vibration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/numbers/line_spectrum.hpp"

namespace tacto::spatial {

/// A texture as it ran over time: by the speed that its valid band tells (band in Hz over band in 1/m).
struct TimeCourse {
  std::vector<double> values;
  double interval_s = 0;
  double mean_speed_mps = 0;  ///< way over time
  double unevenness = 0;      ///< standard deviation of the speed over time, over its mean
};

/// Sampled at eight times the band's upper end, straight between the texture's samples. Errors: unsuitable,
/// where neither band nor mean speed is known.
schema::Result<TimeCourse> time_course(const schema::Texture& texture);

/// One vibration of a texture: a line over position, over time, or both.
struct Vibration {
  double frequency_per_m = 0, sigma_per_m = 0;
  double frequency_hz = 0, sigma_hz = 0;
  double power = 0;          ///< unit^2, the larger of both
  double prominence_db = 0;  ///< the larger of both
  double needed_db = 0;      ///< of the spectrum in which it is the larger
  std::optional<std::size_t> space_line, time_line;
};

/// All that a certificate needs of one texture.
struct StrokeLines {
  std::string name;
  LineSpectrum space, time;
  double speed_mps = 0;
  double unevenness = 0;
  std::vector<Vibration> vibrations;
};

/// Of the part at steady speed. Errors: of time_course(); unsuitable, where that is too short or its band too
/// narrow for a spectrum.
schema::Result<StrokeLines> stroke_lines(const std::string& name, const schema::Texture& texture);

}  // namespace tacto::spatial
