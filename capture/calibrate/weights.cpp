// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::size_t kFewestSamples = 20;
constexpr double kMostDrift = 0.5;

struct Line {
  double zero = 0, slope = 0, u_zero = 0, u_slope = 0;
};

// Codes are large and forces small, so both are used relative to their weighted means.
Line fitted(std::span<const Weighing> weighings) {
  double w = 0, f = 0, c = 0;
  for (const Weighing& one : weighings) {
    const double weight = 1 / std::pow(one.code.uncertainty, 2);
    w += weight, f += weight * one.force_n, c += weight * one.code.value;
  }
  const double mean_n = f / w, mean_code = c / w;
  double ff = 0, fc = 0;
  for (const Weighing& one : weighings) {
    const double weight = 1 / std::pow(one.code.uncertainty, 2), away_n = one.force_n - mean_n;
    ff += weight * away_n * away_n, fc += weight * away_n * (one.code.value - mean_code);
  }
  const double slope = fc / ff;
  return {mean_code - slope * mean_n, slope, std::sqrt(1 / w + mean_n * mean_n / ff), 1 / std::sqrt(ff)};
}

double chi_square(std::span<const Weighing> weighings, const Line& line) {
  double sum = 0;
  for (const Weighing& one : weighings)
    sum += std::pow((one.code.value - line.zero - line.slope * one.force_n) / one.code.uncertainty, 2);
  return sum;
}

double largest_residual_n(std::span<const Weighing> weighings, const Line& line) {
  double largest = 0;
  for (const Weighing& one : weighings)
    largest = std::max(largest, std::abs((one.code.value - line.zero) / line.slope - one.force_n));
  return largest;
}

Result<void> check(std::span<const Weighing> weighings) {
  const auto different = [&](const Weighing& one) { return one.force_n != weighings.front().force_n; };
  if (std::ranges::none_of(weighings, different))
    return schema::fail(ErrorKind::unsuitable, "two different forces are needed", "mass",
                        "for example --mass 0g --mass 100g");
  return {};
}

tl::unexpected<schema::Error> static_force_error(const Take& take, const std::string& channel) {
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("a weight at rest cannot calibrate it: the high-pass of the piezo at {:.2g} Hz removes a "
                  "constant force within {:.0f} ms",
                  schema::sensor_pole_hz(*take.header.transducer),
                  4e3 / (6.28 * schema::sensor_pole_hz(*take.header.transducer))),
      channel,
      "calibrate net_force by weights (--channel net_force), then this channel with --reference net_force "
      "while a finger slides; without a load cell, cut the thread of a weight: --release 10g");
}

}  // namespace

Result<WeighedScale> scale_by_weights(std::span<const Weighing> weighings, double relative) {
  TACTO_TRY(check(weighings));
  const Line line = fitted(weighings);
  if (!std::isfinite(line.slope) || std::abs(line.slope) < 5 * line.u_slope)
    return schema::fail(ErrorKind::unsuitable, "the channel does not follow the forces", "mass",
                        "check that it is the right channel, and that the weights hang on it");
  const auto freedom = static_cast<double>(weighings.size()) - 2;
  const double birge = freedom > 0 ? std::max(1.0, std::sqrt(chi_square(weighings, line) / freedom)) : 1.0;
  const double scale = 1 / line.slope;
  WeighedScale found;
  const double nu = birge > 1 ? freedom : weighings.front().code.degrees_of_freedom;
  found.scale = {scale, std::abs(scale) * std::hypot(birge * line.u_slope / line.slope, relative), nu};
  found.zero = {line.zero, birge * line.u_zero, nu};
  found.largest_residual_n = largest_residual_n(weighings, line);
  found.notes = {
      fmt::format("{} forces, largest residual {:.3g} N", weighings.size(), found.largest_residual_n),
      fmt::format("uncertainty: scatter of the means about a straight line (type A, factor {:.3g}), and "
                  "{:.2g} % common to all forces (type B)",
                  birge, 100 * relative)};
  return found;
}

Result<Weighing> weighing_of(const Take& take, const std::string& name, double force_n) {
  const auto index = schema::find_channel(take.header, name);
  if (!index)
    return schema::fail(ErrorKind::usage, index.error().what, index.error().where, index.error().remedy);
  const schema::Channel& properties = take.header.channels[*index];
  if (properties.unit != "N") return schema::fail(ErrorKind::unsuitable, "is not a force channel", name);
  if (properties.quantity == "tangential_force" && take.header.transducer)
    return static_force_error(take, name);
  const std::vector<double>& codes = take.codes[*index];
  if (codes.size() < kFewestSamples) return schema::fail(ErrorKind::unsuitable, "is too short", name);
  if (drift_ratio(codes) > kMostDrift)
    return schema::fail(ErrorKind::unsuitable, fmt::format("is not constant under {:.4g} N", force_n), name,
                        "wait until the weight hangs still");
  const auto [least, most] = std::ranges::minmax(codes);
  const double low = properties.physical(least), high = properties.physical(most);
  if ((properties.range_max && std::max(low, high) >= *properties.range_max) ||
      (properties.range_min && std::min(low, high) <= *properties.range_min))
    return schema::fail(ErrorKind::unsuitable, "is at the limit of its converter's range", name,
                        "use smaller weights");
  Weighing weighing{force_n, mean_of(codes)};
  weighing.code.uncertainty = std::max(weighing.code.uncertainty, 0.29);  // of rounding: 1 / sqrt(12)
  return weighing;
}

}  // namespace tacto::capture
