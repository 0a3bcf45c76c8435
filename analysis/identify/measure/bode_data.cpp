// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/bode_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kLeastSignalToNoise = 2;
// For white noise the mean of cos(phase step) between neighbours is 0 +- 1 / sqrt(2 n), for a response near
// 1.
constexpr double kLeastSmoothness = 0.4;

// Similarity of neighbours in amplitude and phase: 1 if all are equal.
double smoothness(const BodeData& data) {
  double sum = 0;
  for (std::size_t i = 1; i < data.size(); ++i) {
    const auto a = data.response[i - 1], b = data.response[i];
    sum += (a * std::conj(b)).real() / std::max(std::norm(a), std::norm(b));
  }
  return sum / static_cast<double>(data.size() - 1);
}

double signal_to_noise(const BodeData& data) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < data.size(); ++i) ratios.push_back(std::abs(data.response[i]) / data.noise[i]);
  return schema::upper_median(std::span(ratios));
}

Result<void> check_values(const BodeData& data) {
  const char* const remedy =
      data.of_device ? "give another --amplitude or band, and check that the sensor measures the tray"
                     : "remove the line";
  for (std::size_t i = 0; i < data.size(); ++i) {
    const std::string where = fmt::format("{}, frequency {}", data.source, i + 1);
    const auto value = data.response[i];
    const bool finite = std::isfinite(value.real()) && std::isfinite(value.imag());
    if (!finite || !std::isfinite(data.frequency_hz[i]))
      return fail(ErrorKind::unsuitable, "a value is not a number", where, remedy);
    if (!(data.frequency_hz[i] > 0) || (i > 0 && !(data.frequency_hz[i] > data.frequency_hz[i - 1])))
      return fail(
          ErrorKind::unsuitable,
          fmt::format("{:g} Hz is not above 0, or not above the frequency before it", data.frequency_hz[i]),
          where, "sort the lines by frequency, one line for each");
    if (data.has_noise() && !(data.noise[i] > 0))
      return fail(ErrorKind::unsuitable, "the noise is not above 0", where);
    if (value == 0.0) return fail(ErrorKind::unsuitable, "the amplitude is 0", where, remedy);
  }
  return {};
}

}  // namespace

Complex PoleDependence::factor(std::size_t i, double at_pole_hz) const {
  return std::exp(log_slope[i] * std::log(at_pole_hz / pole_hz));
}

Result<void> check_bode(const BodeData& data) {
  if (data.size() < kLeastFrequencies)
    return fail(ErrorKind::unsuitable,
                fmt::format("{} frequencies are too few to fit four parameters", data.size()), data.source,
                fmt::format("measure {} or more, on both sides of the resonance", kLeastFrequencies));
  if (const auto sound = check_values(data); !sound) return sound;
  const bool loud = !data.has_noise() || signal_to_noise(data) >= kLeastSignalToNoise;
  if (loud && smoothness(data) >= kLeastSmoothness) return {};
  return fail(
      ErrorKind::unsuitable, "it contains only noise, no response", data.source,
      data.direction == Direction::sensor
          ? "use a larger force, measure longer, and check that the force passes through the reference cell"
          : "use a larger drive, measure longer, and check that the sensor measures the tray; slow loops "
            "need --method loop");
}

BodeData part_of(const BodeData& data, std::span<const std::size_t> which) {
  const auto part = [&](const auto& whole) {
    std::remove_cvref_t<decltype(whole)> list;
    for (const std::size_t i : which) list.push_back(whole[i]);
    return list;
  };
  BodeData some = data;
  some.frequency_hz = part(data.frequency_hz);
  some.response = part(data.response);
  if (data.has_noise()) some.noise = part(data.noise);
  for (auto& error : some.shared_errors) error = part(error);
  if (some.by_pole) some.by_pole->log_slope = part(data.by_pole->log_slope);
  return some;
}

double sigma_at(const BodeData& data, std::size_t i) {
  return data.has_noise() ? data.noise[i] : std::abs(data.response[i]);
}

}  // namespace tacto::analysis
