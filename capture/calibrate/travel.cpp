// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "firmware-host/link/encoder_counts.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr double kFewestCounts = 100, kMostApart = 0.05;

double mean_length(std::span<const double> differences) {
  double sum = 0;
  for (const double difference : differences) sum += std::abs(difference);
  return sum / static_cast<double>(differences.size());
}

double scatter(std::span<const double> differences, double mean) {
  if (differences.size() < 2) return 0;
  double sum = 0;
  for (const double difference : differences) sum += std::pow(std::abs(difference) - mean, 2);
  return std::sqrt(sum / static_cast<double>(differences.size() - 1));
}

Result<void> check(std::span<const double> differences, double travel_m, double step) {
  if (!(travel_m > 0)) return schema::fail(ErrorKind::usage, "a travel must be longer than 0", "travel");
  if (differences.empty()) return schema::fail(ErrorKind::unsuitable, "it contains no travel", "travel");
  const double mean = mean_length(differences);
  for (const double difference : differences) {
    if (std::abs(difference) < kFewestCounts * step)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("{:.0f} counts are too few for a travel", difference), "travel",
                          "move from one mark to the other, and mark both");
    if (std::abs(std::abs(difference) - mean) > kMostApart * mean)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("the travels differ: {:.0f} counts, and {:.0f} in the mean",
                                      std::abs(difference), mean),
                          "travel", "move the whole distance each time");
  }
  return {};
}

}  // namespace

Result<TravelScale> scale_by_travel(std::span<const double> differences, double travel_m,
                                    double travel_uncertainty_m, double step) {
  TACTO_TRY(check(differences, travel_m, step));
  if (!(travel_uncertainty_m >= 0))
    return schema::fail(ErrorKind::usage, "an uncertainty must be 0 or more", "--travel-uncertainty");
  const auto count = static_cast<double>(differences.size());
  const double mean = mean_length(differences), spread = scatter(differences, mean) / std::sqrt(count);
  const double ends = step * std::sqrt(2.0 / 12 / count);
  TravelScale found;
  const double relative = std::hypot(std::hypot(spread, ends) / mean, travel_uncertainty_m / travel_m);
  // If the scatter is below the rounding at both ends, the rounding determines the uncertainty.
  const double freedom = spread > ends ? count - 1 : std::numeric_limits<double>::infinity();
  found.scale = {travel_m / mean, relative * travel_m / mean, freedom};
  found.direction = differences.front() > 0 ? 1 : -1;
  found.notes = {fmt::format("{} travels of {:.6g} m, {:.1f} counts each, scatter {:.2g} counts", count,
                             travel_m, mean, scatter(differences, mean)),
                 fmt::format("uncertainty: scatter (type A{}), rounding to a count at both ends, and {:.3g} "
                             "m of the travel (type B)",
                             count < 2 ? ": unknown, only one travel" : "", travel_uncertainty_m)};
  return found;
}

double travelled_counts(double from, double to) {
  return firmware_host::counts_between(static_cast<std::int32_t>(from), static_cast<std::int32_t>(to));
}

Result<std::vector<double>> count_differences(const Take& take, const std::string& channel) {
  const auto index = schema::find_channel(take.header, channel);
  if (!index)
    return schema::fail(ErrorKind::usage, index.error().what, index.error().where, index.error().remedy);
  const std::vector<double>& codes = take.codes[*index];
  const auto& marks = take.header.marks;
  if (marks.empty()) return std::vector{travelled_counts(codes.front(), codes.back())};
  if (marks.size() == 1)
    return schema::fail(ErrorKind::unsuitable, "has one mark, but a travel needs two", take.header.wav_file,
                        "mark both ends of each travel");
  std::vector<double> differences;
  const auto at = [&](const schema::Mark& mark) {
    return codes[std::min<std::size_t>(mark.frame, codes.size() - 1)];
  };
  for (std::size_t i = 1; i < marks.size(); ++i)
    differences.push_back(travelled_counts(at(marks[i - 1]), at(marks[i])));
  return differences;
}

}  // namespace tacto::capture
