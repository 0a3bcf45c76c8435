// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/bode_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kLeastSignalToNoise = 2;
// Of neighbours of white noise the mean of cos(phase step) is 0 +- 1 / sqrt(2 n); of a response near 1.
constexpr double kLeastSmoothness = 0.4;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// How alike neighbours are, amplitude and phase: 1 where all are the same.
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
  return median_of(std::move(ratios));
}

Result<void> check_values(const BodeData& data) {
  const char* const remedy =
      data.of_device ? "give another --amplitude or band, and see that the sensor looks at the tray"
                     : "leave the line out";
  for (std::size_t i = 0; i < data.size(); ++i) {
    const std::string where = fmt::format("{}, frequency {}", data.source, i + 1);
    const auto value = data.response[i];
    const bool finite = std::isfinite(value.real()) && std::isfinite(value.imag());
    if (!finite || !std::isfinite(data.frequency_hz[i]))
      return fail(ErrorKind::unsuitable, "a value is not a number", where, remedy);
    if (!(data.frequency_hz[i] > 0) || (i > 0 && !(data.frequency_hz[i] > data.frequency_hz[i - 1])))
      return fail(ErrorKind::unsuitable,
                  fmt::format("{:g} Hz does not grow from above 0", data.frequency_hz[i]), where,
                  "sort the lines by frequency, one line for each");
    if (data.has_noise() && !(data.noise[i] > 0))
      return fail(ErrorKind::unsuitable, "the noise is not above 0", where);
    if (value == 0.0) return fail(ErrorKind::unsuitable, "the amplitude is 0", where, remedy);
  }
  return {};
}

}  // namespace

Result<void> check_bode(const BodeData& data) {
  if (data.size() < kLeastFrequencies)
    return fail(ErrorKind::unsuitable,
                fmt::format("{} frequencies are too few to fit four parameters", data.size()), data.source,
                fmt::format("measure {} or more, on both sides of the resonance", kLeastFrequencies));
  if (const auto sound = check_values(data); !sound) return sound;
  const bool loud = !data.has_noise() || signal_to_noise(data) >= kLeastSignalToNoise;
  if (loud && smoothness(data) >= kLeastSmoothness) return {};
  return fail(
      ErrorKind::unsuitable, "this is noise: there is no response in it", data.source,
      data.direction == Direction::sensor
          ? "push it with more force, measure longer, and see that the reference cell is in the force's way"
          : "drive it with more, measure longer, and see that the sensor looks at the tray; slow loops "
            "take --method loop");
}

double sigma_at(const BodeData& data, std::size_t i) {
  return data.has_noise() ? data.noise[i] : std::abs(data.response[i]);
}

}  // namespace tacto::analysis
