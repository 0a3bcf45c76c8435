// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/starting_values.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/identify/fit/three_poles.hpp"

namespace tacto::analysis {
namespace {

constexpr std::size_t kMostLookedAt = 24;
constexpr int kGridFrequencies = 24;
constexpr double kGridDampings[] = {0.005, 0.02, 0.06, 0.15, 0.5, 2};
constexpr int kGridPoles = 7;
constexpr double kHalfAnOctave = 1.41421356;
constexpr int kStepsOfAPeriod = 8;  // of a delay
constexpr std::size_t kBestOfGrid = 3;

double weight_of(const BodeData& data, std::size_t i) {
  return 1 / (data.has_noise() ? data.noise[i] * data.noise[i] : std::norm(data.response[i]));
}

// At most kMostLookedAt of the frequencies, evenly by index.
std::vector<std::size_t> looked_at(const BodeData& data) {
  const std::size_t count = std::min(kMostLookedAt, data.size());
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < count; ++i) which.push_back(i * (data.size() - 1) / (count - 1));
  return which;
}

// Uses relative errors: while the model is still far off, values with little noise must not dominate.
struct Trial {
  const ResponseModel& model;
  const BodeData& data;
  std::vector<std::size_t> which = looked_at(data);

  // Sets the best gain and returns the residual.
  double left(std::vector<double>& values) const {
    double across = 0, own = 0, whole = 0;
    for (const std::size_t i : which) {
      const auto h = data.response[i], m = model.at(values, data.frequency_hz[i]);
      const double weight = 1 / std::norm(h);
      across += weight * (h * std::conj(m)).real();
      own += weight * std::norm(m);
      whole += weight * std::norm(h);
    }
    const double scale = across / own;
    if (!(scale > 0) || !std::isfinite(scale)) return 1;
    values[kGain] *= scale;
    return 1 - scale * across / whole;
  }
  void consider(std::vector<double> values, Start& best) const {
    const double rest = left(values);
    if (rest < best.left || best.values.empty()) best = {std::move(values), rest};
  }
};

double between(double low, double high, int i, int count) {
  return low * std::pow(high / low, static_cast<double>(i) / (count - 1));
}

std::vector<double> starts_of(const ResponseModel& model) {
  std::vector<double> values;
  for (const ModelParameter& parameter : model.parameters()) values.push_back(parameter.start);
  return values;
}

void keep_within(const ResponseModel& model, Start& start) {
  for (std::size_t i = 0; i < start.values.size(); ++i) {
    const ModelParameter& p = model.parameters()[i];
    const double room = 0.01 * (p.coordinate(p.high) - p.coordinate(p.low));
    const double c =
        std::clamp(p.coordinate(start.values[i]), p.coordinate(p.low) + room, p.coordinate(p.high) - room);
    start.values[i] = p.value(c);
  }
}

// Residual of all data with their own weights.
double left_of_all(const ResponseModel& model, const BodeData& data, std::span<const double> values) {
  double rest = 0, whole = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    rest += weight_of(data, i) * std::norm(data.response[i] - model.at(values, data.frequency_hz[i]));
    whole += weight_of(data, i) * std::norm(data.response[i]);
  }
  return rest / whole;
}

}  // namespace

Start starting_values(const ResponseModel& model, const BodeData& data) {
  Start best;
  std::vector<double> values = starts_of(model);
  if (model.choice().finger) return {values, left_of_all(model, data, values)};
  const Trial trial{model, data};
  const double low_hz = data.frequency_hz.front(), high_hz = data.frequency_hz.back();
  for (int r = 0; r < kGridFrequencies; ++r)
    for (const double damping : kGridDampings)
      for (int p = 0; p < kGridPoles; ++p) {
        values[kResonance] = between(low_hz / kHalfAnOctave, high_hz * kHalfAnOctave, r, kGridFrequencies);
        values[kDamping] = damping;
        values[kPole] = between(low_hz / 4, 8 * high_hz, p, kGridPoles);
        trial.consider(values, best);
      }
  keep_within(model, best);
  best.left = left_of_all(model, data, best.values);
  return best;
}

std::vector<std::vector<double>> one_mode_starts(const ResponseModel& model, const BodeData& data) {
  std::vector<Start> starts{starting_values(model, data)};
  if (model.choice().finger) return {starts.front().values};
  Start base{starts_of(model), 1};
  base.left = Trial{model, data}.left(base.values);
  starts.push_back(base);
  if (const auto poles = poles_of_data(data)) {
    starts.push_back(base);
    std::ranges::copy(*poles, starts.back().values.begin());
  }
  std::vector<std::vector<double>> list;
  for (Start& start : starts) {
    keep_within(model, start);
    list.push_back(std::move(start.values));
  }
  return list;
}

namespace {

// The two largest local maxima of |H| f: two resonances of similar size, to which one mode cannot be fitted.
std::vector<std::size_t> peaks_of(const BodeData& data) {
  const auto size = [&](std::size_t i) { return std::abs(data.response[i]) * data.frequency_hz[i]; };
  std::vector<std::size_t> peaks;
  for (std::size_t i = 1; i + 1 < data.size(); ++i)
    if (size(i) > size(i - 1) && size(i) > size(i + 1)) peaks.push_back(i);
  std::ranges::sort(peaks, std::greater{}, size);
  if (peaks.size() > 2) peaks.erase(peaks.begin() + 2, peaks.end());
  std::ranges::sort(peaks);
  return peaks;
}

void add_peaks(const ResponseModel& model, const BodeData& data, std::vector<Start>& kinds) {
  const std::vector<std::size_t> peaks = peaks_of(data);
  if (peaks.size() < 2) return;
  const auto first = data.response.begin() + static_cast<std::ptrdiff_t>(peaks[0]);
  const auto last = data.response.begin() + static_cast<std::ptrdiff_t>(peaks[1]);
  const auto between_them = std::ranges::min_element(first, last, {}, [](auto h) { return std::abs(h); });
  std::vector<double> values = starts_of(model);
  values[kGain] = std::abs(data.response.front());
  values[kResonance] = data.frequency_hz[peaks[0]];
  values[kSecondMode] = data.frequency_hz[peaks[1]];
  values[kSecondMode + 2] = data.frequency_hz[static_cast<std::size_t>(between_them - data.response.begin())];
  values[kDamping] = values[kSecondMode + 1] = values[kSecondMode + 3] = 0.05;
  kinds.push_back({values, left_of_all(model, data, values)});
}

std::vector<Start> second_mode_starts(const ResponseModel& model, const BodeData& data,
                                      std::vector<double> values) {
  std::vector<Start> kinds(4);
  const double low_hz = data.frequency_hz.front(), high_hz = data.frequency_hz.back();
  for (int r = 0; r < kGridFrequencies; ++r)
    for (const double damping : {0.02, 0.1})
      for (const double apart : {0.7, 0.9, 1.1, 1.3}) {
        values[kSecondMode] = between(low_hz * kHalfAnOctave, high_hz, r, kGridFrequencies);
        values[kSecondMode + 2] = apart * values[kSecondMode];
        values[kSecondMode + 1] = values[kSecondMode + 3] = damping;
        Start& best = kinds[(values[kSecondMode] > values[kResonance] ? 2U : 0U) + (apart > 1 ? 1U : 0U)];
        const double rest = left_of_all(model, data, values);
        if (rest < best.left || best.values.empty()) best = {values, rest};
      }
  std::erase_if(kinds, [](const Start& start) { return start.values.empty(); });
  add_peaks(model, data, kinds);
  return kinds;
}

// The response without what the model has beyond one mode.
BodeData without_extensions(const ResponseModel& model, BodeData data, std::span<const double> values) {
  const ResponseModel one_mode({.direction = data.direction}, model.base(), data);
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double hz = data.frequency_hz[i];
    const auto factor = model.at(values, hz) / one_mode.at(values.first(kSecondMode), hz);
    data.response[i] /= factor;
    if (data.has_noise()) data.noise[i] /= std::abs(factor);
  }
  return data;
}

std::vector<double> grid_of(const ModelParameter& parameter, const BodeData& data) {
  constexpr int kCutoffs = 16, kDelays = kMostDelayPeriods * kStepsOfAPeriod;
  std::vector<double> grid;
  if (parameter.name == "delay_ms")
    for (int i = 1 - kDelays; i < kDelays; ++i) grid.push_back(parameter.high * i / kDelays);
  else if (parameter.name == "lag_rad")
    grid = {-0.3, -0.1, 0, 0.1, 0.3};
  else
    for (int i = 0; i < kCutoffs; ++i)
      grid.push_back(
          between(data.frequency_hz.front() * kHalfAnOctave, parameter.high / kHalfAnOctave, i, kCutoffs));
  return grid;
}

std::vector<Start> grid_starts(const ResponseModel& model, const BodeData& data, std::size_t place,
                               std::vector<double> values) {
  std::vector<Start> starts;
  const auto consider = [&](const std::vector<double>& at) {
    starts.push_back({at, left_of_all(model, data, at)});
  };
  for (const double value : grid_of(model.parameters()[place], data)) {
    values[place] = value;
    consider(values);
    if (model.choice().second_mode) continue;
    if (const auto poles = poles_of_data(without_extensions(model, data, values))) {
      std::vector<double> by_poles = values;
      std::ranges::copy(*poles, by_poles.begin());
      consider(by_poles);
    }
  }
  std::ranges::sort(starts, {}, &Start::left);
  starts.resize(std::min(starts.size(), kBestOfGrid));
  return starts;
}

}  // namespace

std::vector<Start> extended_starts(const ResponseModel& model, const BodeData& data, const Extension& added,
                                   const ResponseModel& known, std::span<const double> values) {
  std::vector<double> carried = starts_of(model);
  for (std::size_t i = 0; i < values.size(); ++i)
    carried[model.place_of(known.parameters()[i].name)] = values[i];
  std::vector<Start> starts =
      added.has == &ModelChoice::second_mode
          ? second_mode_starts(model, data, std::move(carried))
          : grid_starts(model, data, model.place_of(added.parameter), std::move(carried));
  for (Start& start : starts) keep_within(model, start);
  return starts;
}

}  // namespace tacto::analysis
