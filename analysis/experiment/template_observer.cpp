// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/template_observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "data-schema/base/decibels.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/strokes/session_stroke.hpp"

namespace tacto::analysis {

using schema::Result;

namespace {

constexpr double kRealNoiseDb = 4.3, kVirtualNoiseDb = 8.3;  // tuned: see the header
constexpr double kStepM = 1e-5;  // textures have at most 500 Hz / 35 mm/s = 14 /mm
constexpr double kFloorM = 1e-7, kReferenceM = 1e-6;

// The samples of a texture on the protocol's path.
std::vector<double> target_on_path_m(const schema::Texture& texture, const schema::Protocol& protocol,
                                     std::vector<double>& position_m) {
  const auto step = static_cast<std::size_t>(std::max(std::floor(kStepM / texture.signal.pitch_m), 1.0));
  std::vector<double> target_m;
  for (std::size_t i = 0; i < texture.signal.values.size(); i += step) {
    const double x = texture.signal.position_m(i);
    if (x < protocol.pace.from_m || x > protocol.pace.to_m) continue;
    position_m.push_back(x);
    target_m.push_back(protocol.gain_m_per_n * texture.signal.values[i]);
  }
  return target_m;
}

}  // namespace

std::vector<double> band_levels_db(std::span<const double> x, std::span<const double> displacement_m,
                                   double speed_mps) {
  const std::size_t n = x.size();
  const double path_m = std::abs(x[n - 1] - x[0]);
  std::vector<double> weight(n);
  double sum = 0, weights = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double way = std::abs(x[std::min(i + 1, n - 1)] - x[i == 0 ? 0 : i - 1]) / 2;
    const double window = std::pow(std::sin(std::numbers::pi * (x[i] - x[0]) / (x[n - 1] - x[0])), 2);
    weight[i] = way * window;
    sum += weight[i] * displacement_m[i], weights += weight[i], squares += way * window * window;
  }
  const double mean_m = sum / weights;
  const auto mean_square_at = [&](double frequency_per_m) {  // of one line of the spectrum, one-sided
    std::complex<double> line = 0;
    for (std::size_t i = 0; i < n; ++i)
      line += weight[i] * (displacement_m[i] - mean_m) *
              std::polar(1.0, -2 * std::numbers::pi * frequency_per_m * (x[i] - x[0]));
    return 2 * std::norm(line) / (path_m * squares);
  };
  const spatial::Band band = playback::PrepareOptions{}.band;
  const double high_per_m = band.high_hz / speed_mps, third = std::cbrt(2.0);
  std::vector<double> levels_db;
  double line = std::ceil(band.low_hz / speed_mps * path_m);  // in 1 / path
  for (double end = band.low_hz / speed_mps * third; end <= high_per_m * 1.001; end *= third) {
    double mean_square = kFloorM * kFloorM;
    for (; line / path_m < end; ++line) mean_square += mean_square_at(line / path_m);
    levels_db.push_back(schema::power_db(mean_square / (kReferenceM * kReferenceM)));
  }
  return levels_db;
}

Result<TemplateObserver> TemplateObserver::of(const Study& study) {
  TemplateObserver observer;
  observer.speed_mps_ = study.protocol.pace.speed_mps;
  for (const std::string& name : study.protocol.standards) {
    const auto& stimulus = *std::ranges::find(study.key.stimuli, name, &schema::CodedStimulus::name);
    const auto texture = schema::read_texture(study.stimulus(stimulus.code));
    TACTO_TRY(texture);
    std::vector<double> position_m;
    const std::vector<double> target_m = target_on_path_m(*texture, study.protocol, position_m);
    observer.standards_.push_back({stimulus.code, band_levels_db(position_m, target_m, observer.speed_mps_)});
  }
  return observer;
}

int TemplateObserver::answer(const Observer& observer, const std::string& place, const std::string& code,
                             const std::optional<std::string>& session) const {
  if (!session)
    return nearest(observer, place, std::ranges::find(standards_, code, &Template::code)->levels_db, true);
  const auto stroke = playback::read_session_stroke(*session, 0);
  if (!stroke) {
    const auto standards = static_cast<double>(standards_.size());
    return static_cast<int>(standards * uniform_of(observer, place, "guess")) + 1;
  }
  std::vector<double> position_m;
  for (const playback::SessionRow& row : stroke->rows) position_m.push_back(row.position_m);
  return nearest(observer, place, band_levels_db(position_m, stroke->predicted_m, speed_mps_), false);
}

int TemplateObserver::nearest(const Observer& observer, const std::string& place,
                              const std::vector<double>& levels_db, bool real) const {
  const double noise_db = observer.noise_db.value_or(real ? kRealNoiseDb : kVirtualNoiseDb);
  std::vector<double> noisy_db = levels_db;
  for (std::size_t band = 0; band < noisy_db.size(); ++band)
    noisy_db[band] += noise_db * normal_of(observer, fmt::format("{}/{}", place, band));
  const auto distance = [&](const Template& each) {
    double sum = 0;
    for (std::size_t band = 0; band < noisy_db.size(); ++band)
      sum += std::pow(noisy_db[band] - each.levels_db[band], 2);
    return sum;
  };
  return static_cast<int>(std::ranges::min_element(standards_, {}, distance) - standards_.begin()) + 1;
}

}  // namespace tacto::analysis
