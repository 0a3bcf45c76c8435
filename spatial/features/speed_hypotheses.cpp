// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/speed_hypotheses.hpp"

#include "data-schema/base/decibels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::spatial {
namespace {

constexpr double kScaleOfPositions = 1e-3;  // of k: encoders and rulers
constexpr double kScaleOfSpeeds = 3e-3;    // of f: the band's breakpoints give the speed to 1 % at each place
constexpr double kAmplitudeSpread_db = 6;  // from stroke to stroke: load, place, contact
constexpr double kMaxDetection = 0.95;     // a line may be absent for reasons outside the model
constexpr double kNear = 3;                // standard deviations within which a line matches the prediction
constexpr double kLobe = 1.2;              // resolutions within which a line hides a weaker one
constexpr double kMaxUnevennessEvidence = 3;  // nats
constexpr double kSharpness_db = 3;           // standard deviation of a line's gain in prominence

double normal_density(double distance, double sigma) {
  const double z = distance / sigma;
  return std::exp(-0.5 * z * z) / (sigma * std::sqrt(2 * std::numbers::pi));
}

double normal_share(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

// Log likelihood ratio of spatial over temporal, from the vibration's prominence over position and over time.
double unevenness_evidence(const StrokeLines& stroke, const Vibration& vibration) {
  const auto cost_db = [&](double smear, double resolution) {
    return schema::power_db(std::hypot(1, smear / resolution));
  };
  const double in_space = 2 * vibration.frequency_per_m * stroke.unevenness;
  const double in_time = 2 * vibration.frequency_hz * stroke.unevenness;
  if (!stroke.space.knows(vibration.frequency_per_m) || !stroke.time.knows(vibration.frequency_hz)) return 0;
  const double if_spatial_db = cost_db(in_time, stroke.time.resolution());
  const double if_temporal_db = -cost_db(in_space, stroke.space.resolution());
  const auto prominence = [](const LineSpectrum& spectrum, const std::optional<std::size_t>& line) {
    return line ? spectrum.lines()[*line].prominence_db : spectrum.needed_db();
  };
  const double sharper_db =
      prominence(stroke.space, vibration.space_line) - prominence(stroke.time, vibration.time_line);
  const double off_temporal = sharper_db - if_temporal_db, off_spatial = sharper_db - if_spatial_db;
  const double nats =
      (off_temporal * off_temporal - off_spatial * off_spatial) / (2 * kSharpness_db * kSharpness_db);
  return std::clamp(nats, -kMaxUnevennessEvidence, kMaxUnevennessEvidence);
}

}  // namespace

struct SpeedHypotheses::Prediction {
  bool spatial = false;
  double frequency = 0, sigma = 0, power = 0;
  double off(const SpectralLine& line) const { return std::abs(line.frequency - frequency); }
  double sigma_to(const SpectralLine& line) const { return std::hypot(sigma, line.sigma); }
  bool meets(const SpectralLine& line) const { return off(line) <= kNear * sigma_to(line); }
};

SpeedHypotheses::SpeedHypotheses(std::vector<StrokeLines> strokes) : strokes_(std::move(strokes)) {
  for (const StrokeLines& stroke : strokes_) spoken_for_.emplace_back(stroke.vibrations.size(), false);
}

const LineSpectrum& SpeedHypotheses::spectrum(std::size_t stroke, bool spatial) const {
  return spatial ? strokes_[stroke].space : strokes_[stroke].time;
}

SpeedHypotheses::Prediction SpeedHypotheses::predicted(VibrationId id, bool spatial) const {
  const Vibration& v = at(id);
  if (spatial)
    return {true, v.frequency_per_m, std::hypot(v.sigma_per_m, kScaleOfPositions * v.frequency_per_m),
            v.power};
  return {false, v.frequency_hz, std::hypot(v.sigma_hz, kScaleOfSpeeds * v.frequency_hz), v.power};
}

VibrationId SpeedHypotheses::owner(std::size_t stroke, bool spatial, std::size_t line) const {
  const auto& vibrations = strokes_[stroke].vibrations;
  const auto found = std::ranges::find_if(vibrations, [&](const Vibration& v) {
    const auto& own = spatial ? v.space_line : v.time_line;
    return own && *own == line;
  });
  return {stroke, static_cast<std::size_t>(found - vibrations.begin())};
}

namespace {

double detection(const LineSpectrum& spectrum, double power, double frequency) {
  const double over_db = spectrum.prominence_db(power, frequency) - spectrum.needed_db();
  return kMaxDetection * normal_share(over_db / kAmplitudeSpread_db);
}

}  // namespace

double SpeedHypotheses::likelihood(std::size_t stroke, const Prediction& prediction) const {
  const LineSpectrum& there = spectrum(stroke, prediction.spatial);
  if (!there.knows(prediction.frequency)) return 1;
  const double clutter = there.clutter(prediction.frequency);
  double matches = 0;
  for (std::size_t m = 0; m < there.lines().size(); ++m) {
    const SpectralLine& line = there.lines()[m];
    const bool hides = prediction.off(line) < kLobe * there.resolution() && line.power > prediction.power / 4;
    if (prediction.meets(line) ? is_used(owner(stroke, prediction.spatial, m)) : hides) return 1;
    matches += normal_density(prediction.off(line), prediction.sigma_to(line)) / clutter;
  }
  const double seen = detection(there, prediction.power, prediction.frequency);
  return 1 - seen + seen * matches;
}

SpeedEvidence SpeedHypotheses::evidence(VibrationId id) const {
  const StrokeLines& own = strokes_[id.stroke];
  const Prediction in_space = predicted(id, true), in_time = predicted(id, false);
  SpeedEvidence evidence;
  for (std::size_t j = 0; j < strokes_.size(); ++j) {
    if (j == id.stroke) continue;
    const StrokeLines& other = strokes_[j];
    evidence.spatial *= likelihood(j, in_space);
    evidence.temporal *= likelihood(j, in_time);
    const bool k_known = other.space.knows(in_space.frequency), f_known = other.time.knows(in_time.frequency);
    if (!k_known && !f_known) continue;
    evidence.spatial_tested |= k_known;
    evidence.temporal_tested |= f_known;
    const double ratio = other.speed_mps / own.speed_mps;
    evidence.speed_ratio = std::max({evidence.speed_ratio, ratio, 1 / ratio});
    const double apart_per_m = std::abs(in_space.frequency - in_time.frequency / other.speed_mps);
    evidence.resolved |= apart_per_m >= other.space.resolution();
    if (k_known)
      evidence.best_detection =
          std::max(evidence.best_detection, detection(other.space, in_space.power, in_space.frequency));
    if (f_known)
      evidence.best_detection =
          std::max(evidence.best_detection, detection(other.time, in_time.power, in_time.frequency));
  }
  const double nats = unevenness_evidence(own, at(id));
  (nats > 0 ? evidence.spatial : evidence.temporal) *= std::exp(std::abs(nats));
  return evidence;
}

std::vector<VibrationId> SpeedHypotheses::same(VibrationId id, bool spatial) const {
  const Prediction prediction = predicted(id, spatial);
  std::vector<VibrationId> members{id};
  for (std::size_t j = 0; j < strokes_.size(); ++j) {
    if (j == id.stroke) continue;
    const auto& lines = spectrum(j, spatial).lines();
    const auto nearest =
        std::ranges::min_element(lines, {}, [&](const SpectralLine& l) { return prediction.off(l); });
    if (nearest == lines.end() || !prediction.meets(*nearest)) continue;
    const VibrationId other = owner(j, spatial, static_cast<std::size_t>(nearest - lines.begin()));
    if (!is_used(other)) members.push_back(other);
  }
  return members;
}

}  // namespace tacto::spatial
