// SPDX-License-Identifier: GPL-3.0-or-later
// The likelihood that a vibration is spatial (the surface) or temporal, from textures made at other speeds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/numbers/line_spectrum.hpp"

namespace tacto::spatial {

/// Vibration `vibration` of stroke `stroke`.
struct VibrationId {
  std::size_t stroke = 0, vibration = 0;
};

/// The evidence for the two hypotheses about one vibration.
struct SpeedEvidence {
  double spatial = 1, temporal = 1;  ///< likelihood ratios to "neither"
  double best_detection = 0;         ///< highest probability of detection in another stroke
  double speed_ratio = 1;            ///< largest to a stroke whose valid band contains a prediction
  /// Whether the prediction of each hypothesis is in the valid band of another stroke.
  bool spatial_tested = false, temporal_tested = false;
  bool resolved = false;  ///< in some stroke the predictions are at least a resolution apart

  double confidence_spatial() const { return spatial / (spatial + temporal + 1); }
  double confidence_temporal() const { return temporal / (spatial + temporal + 1); }
};

/// A texture against time. The speed is the valid band in Hz over the valid band in 1/m.
struct TimeCourse {
  std::vector<double> values;
  double interval_s = 0;
  double mean_speed_mps = 0;  ///< distance over duration
  double unevenness = 0;      ///< standard deviation of the speed over time, over its mean
};

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

/// Formulas: certificate.hpp. A vibration that was marked with mark_used() is no longer evidence for others.
class SpeedHypotheses {
 public:
  explicit SpeedHypotheses(std::vector<StrokeLines> strokes);

  const std::vector<StrokeLines>& strokes() const { return strokes_; }
  const Vibration& at(VibrationId id) const { return strokes_[id.stroke].vibrations[id.vibration]; }
  bool is_used(VibrationId id) const { return spoken_for_[id.stroke][id.vibration]; }
  void mark_used(VibrationId id) { spoken_for_[id.stroke][id.vibration] = true; }

  SpeedEvidence evidence(VibrationId id) const;
  /// The matching vibrations of all strokes, `id` included, under the spatial (or temporal) hypothesis.
  std::vector<VibrationId> same(VibrationId id, bool spatial) const;

 private:
  struct Prediction;
  double likelihood(std::size_t stroke, const Prediction& prediction) const;
  Prediction predicted(VibrationId id, bool spatial) const;
  const LineSpectrum& spectrum(std::size_t stroke, bool spatial) const;
  /// The vibration that a line belongs to.
  VibrationId owner(std::size_t stroke, bool spatial, std::size_t line) const;

  std::vector<StrokeLines> strokes_;
  std::vector<std::vector<bool>> spoken_for_;
};

}  // namespace tacto::spatial
