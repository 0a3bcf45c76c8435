// SPDX-License-Identifier: GPL-3.0-or-later
// How likely a vibration is to be the surface's, or time's, seen from textures made at other speeds.
#pragma once

#include <span>
#include <vector>

#include "spatial/features/stroke_lines.hpp"

namespace tacto::spatial {

/// Vibration `vibration` of stroke `stroke`.
struct VibrationId {
  std::size_t stroke = 0, vibration = 0;
};

/// What speaks for one vibration's two hypotheses.
struct SpeedEvidence {
  double spatial = 1, temporal = 1;  ///< likelihood ratios to "neither"
  double best_detection = 0;         ///< highest chance of seeing it elsewhere, were it there
  double speed_ratio = 1;            ///< largest to a stroke that knows the place of one of the predictions
  /// Whether another stroke knows the place where either hypothesis puts it.
  bool spatial_tested = false, temporal_tested = false;
  bool told_apart = false;  ///< in some stroke the predictions lie a resolution apart

  double confidence_spatial() const { return spatial / (spatial + temporal + 1); }
  double confidence_temporal() const { return temporal / (spatial + temporal + 1); }
};

/// Formulas: certificate.hpp. Vibrations can be spoken for, after which they are no evidence for others.
class SpeedHypotheses {
 public:
  explicit SpeedHypotheses(std::vector<StrokeLines> strokes);

  const std::vector<StrokeLines>& strokes() const { return strokes_; }
  const Vibration& at(VibrationId id) const { return strokes_[id.stroke].vibrations[id.vibration]; }
  bool spoken_for(VibrationId id) const { return spoken_for_[id.stroke][id.vibration]; }
  void speak_for(VibrationId id) { spoken_for_[id.stroke][id.vibration] = true; }

  SpeedEvidence evidence(VibrationId id) const;
  /// The vibrations of all strokes that are this one, itself among them, if it is the surface's (or time's).
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
