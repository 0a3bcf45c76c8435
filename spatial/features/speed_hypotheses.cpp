// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/speed_hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "data-schema/base/decibels.hpp"
#include "spatial/features/steady_part.hpp"
#include "spatial/numbers/band_at.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Result;
using schema::Texture;

constexpr double kOversampling = 8;

// Seconds per metre at each breakpoint; linear between them, like the band.
struct Slowness {
  std::vector<double> position_m, s_per_m;
};

Slowness slowness_of(const Texture& texture) {
  Slowness slowness;
  const double high_hz = texture.source.high_hz;
  const auto usable = [&](const schema::BandPoint& p) {
    return std::isfinite(p.high_per_m) && p.high_per_m > 0;
  };
  if (high_hz > 0 && !texture.valid_band.empty() && std::ranges::all_of(texture.valid_band, usable)) {
    for (const auto& point : texture.valid_band) {
      slowness.position_m.push_back(point.position_m);
      slowness.s_per_m.push_back(point.high_per_m / high_hz);
    }
  } else if (texture.source.mean_speed_mps > 0) {
    slowness = {{0}, {1 / texture.source.mean_speed_mps}};
  }
  return slowness;
}

double at(const Slowness& slowness, double position_m) {
  const auto& x = slowness.position_m;
  const auto next = std::ranges::upper_bound(x, position_m);
  if (next == x.begin()) return slowness.s_per_m.front();
  if (next == x.end()) return slowness.s_per_m.back();
  const auto i = static_cast<std::size_t>(next - x.begin());
  return std::lerp(slowness.s_per_m[i - 1], slowness.s_per_m[i], (position_m - x[i - 1]) / (x[i] - x[i - 1]));
}

// Time at each sample, by the trapezoidal rule: exact for a slowness that is linear between samples.
std::vector<double> times_of(const Texture& texture, const Slowness& slowness) {
  std::vector<double> times(texture.signal.values.size(), 0.0);
  double last = at(slowness, 0);
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double now = at(slowness, static_cast<double>(i) * texture.signal.pitch_m);
    times[i] = times[i - 1] + 0.5 * (last + now) * texture.signal.pitch_m;
    last = now;
  }
  return times;
}

double unevenness_of(const std::vector<double>& times, double pitch_m, double mean_speed_mps) {
  double sum = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double duration_s = times[i] - times[i - 1];
    const double off = pitch_m / duration_s / mean_speed_mps - 1;
    sum += off * off * duration_s;
  }
  return std::sqrt(sum / times.back());
}

double highest_hz(const Texture& texture, double mean_speed_mps) {
  return texture.source.high_hz > 0 ? texture.source.high_hz : 0.25 / texture.signal.pitch_m * mean_speed_mps;
}

std::vector<double> resampled(const Texture& texture, const std::vector<double>& times, double interval_s) {
  const auto& values = texture.signal.values;
  std::vector<double> result;
  std::size_t i = 0;
  for (std::size_t n = 0; static_cast<double>(n) * interval_s <= times.back(); ++n) {
    const double time = static_cast<double>(n) * interval_s;
    while (i + 2 < times.size() && times[i + 1] < time) ++i;
    const double part = std::clamp((time - times[i]) / (times[i + 1] - times[i]), 0.0, 1.0);
    result.push_back(std::lerp(values[i], values[i + 1], part));
  }
  return result;
}

// The nearest unused line, at most `reach` away.
std::optional<std::size_t> nearest(const std::vector<SpectralLine>& lines, const std::vector<bool>& taken,
                                   double frequency, double reach) {
  std::optional<std::size_t> best;
  for (std::size_t m = 0; m < lines.size(); ++m) {
    const double distance = std::abs(lines[m].frequency - frequency);
    if (!taken[m] && distance <= reach) {
      reach = distance;
      best = m;
    }
  }
  return best;
}

Vibration spatial_only(const StrokeLines& stroke, std::size_t m, double smear_hz) {
  const SpectralLine& line = stroke.space.lines()[m];
  return {line.frequency,
          line.sigma,
          line.frequency * stroke.speed_mps,
          std::hypot(line.sigma * stroke.speed_mps, smear_hz),
          line.power,
          line.prominence_db,
          stroke.space.needed_db(),
          m,
          std::nullopt};
}

void join_time(Vibration& vibration, const StrokeLines& stroke, std::size_t m) {
  const SpectralLine& line = stroke.time.lines()[m];
  vibration.frequency_hz = line.frequency;
  vibration.sigma_hz = line.sigma;
  vibration.time_line = m;
  if (line.prominence_db <= vibration.prominence_db && vibration.space_line) return;
  vibration.power = line.power;
  vibration.prominence_db = line.prominence_db;
  vibration.needed_db = stroke.time.needed_db();
}

// Strongest first, so that a strong line is paired before a weak line can use its counterpart.
std::vector<std::size_t> by_strength(const std::vector<SpectralLine>& lines) {
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, std::greater(), [&](std::size_t m) { return lines[m].prominence_db; });
  return order;
}

void join_lines(StrokeLines& stroke) {
  const auto& times = stroke.time.lines();
  std::vector<bool> taken(times.size(), false);
  for (const std::size_t m : by_strength(stroke.space.lines())) {
    const double hz = stroke.space.lines()[m].frequency * stroke.speed_mps;
    const double smear_hz = hz * stroke.unevenness + 0.3 * stroke.time.resolution();
    Vibration vibration = spatial_only(stroke, m, smear_hz);
    if (const auto line = nearest(times, taken, hz, 2 * smear_hz)) {
      taken[*line] = true;
      join_time(vibration, stroke, *line);
    }
    stroke.vibrations.push_back(vibration);
  }
  for (std::size_t m = 0; m < times.size(); ++m) {
    if (taken[m]) continue;
    Vibration vibration;
    join_time(vibration, stroke, m);
    vibration.frequency_per_m = vibration.frequency_hz / stroke.speed_mps;
    vibration.sigma_per_m = vibration.frequency_per_m * stroke.unevenness + 0.3 * stroke.space.resolution();
    stroke.vibrations.push_back(vibration);
  }
}

// In Hz: the pass band of the filter.
schema::BandPoint band_hz(const Texture& texture, double mean_speed_mps) {
  return {0, texture.source.low_hz, highest_hz(texture, mean_speed_mps)};
}

schema::BandPoint band_per_m(const Texture& texture) {
  if (texture.valid_band.empty()) return {0, 0, 0.25 / texture.signal.pitch_m};
  return band_throughout(texture.valid_band);
}

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

// Sampled at eight times the band's upper limit, by linear interpolation of the texture's samples. Errors:
// unsuitable, if neither band nor mean speed is known.
Result<TimeCourse> time_course(const Texture& texture) {
  const Slowness slowness = slowness_of(texture);
  if (slowness.s_per_m.empty())
    return schema::fail(ErrorKind::unsuitable, "it does not contain the speed at which it was recorded",
                        "texture", "make it from a recording with 'tactograph spatial'");
  const auto times = times_of(texture, slowness);
  TimeCourse course;
  course.mean_speed_mps = texture.signal.length_m() / times.back();
  course.unevenness = unevenness_of(times, texture.signal.pitch_m, course.mean_speed_mps);
  const double finest_s = texture.signal.pitch_m / course.mean_speed_mps;
  course.interval_s = std::max(finest_s, 1 / (kOversampling * highest_hz(texture, course.mean_speed_mps)));
  course.values = resampled(texture, times, course.interval_s);
  return course;
}

}  // namespace

Result<StrokeLines> stroke_lines(const std::string& name, const Texture& whole) {
  if (whole.signal.values.empty()) return schema::fail(ErrorKind::unsuitable, "has no samples", name);
  const Texture texture = steady_part(whole).texture;
  const auto& values = texture.signal.values;
  if (values.size() < 4 * LineSpectrum::kFewestValues)
    return schema::fail(ErrorKind::unsuitable, "is too short for a spectrum", name);
  const auto course = time_course(texture);
  if (!course) {
    schema::Error error = course.error();
    error.where = name;
    return tl::unexpected(error);
  }
  if (course->values.size() < LineSpectrum::kFewestValues)
    return schema::fail(ErrorKind::unsuitable, "lasts too short for a spectrum", name);
  const auto in_space = band_per_m(texture), in_time = band_hz(texture, course->mean_speed_mps);
  StrokeLines stroke{name,
                     LineSpectrum(values, texture.signal.pitch_m, in_space.low_per_m, in_space.high_per_m),
                     LineSpectrum(course->values, course->interval_s, in_time.low_per_m, in_time.high_per_m),
                     course->mean_speed_mps,
                     course->unevenness,
                     {}};
  join_lines(stroke);
  return stroke;
}

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
