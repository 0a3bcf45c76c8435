// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "data-schema/quantity.hpp"

namespace tacto::capture {
namespace {

constexpr double kFar = 10;        // times the usual distance from the local median
constexpr double kUsual = 0.99;    // the share of samples that is usual
constexpr double kOtherSize = 5;   // times larger or smaller than its neighbourhood
constexpr std::size_t kNamed = 5;  // samples that a warning names

struct Bound {
  std::string_view quantity;
  double largest;
};

// A fingertip explores at some 0.1 m/s and presses with some newtons (Wiertlewski 2011: 50 mm/s, 0.5 N); a
// hand in the air stays below 5 m/s, a force sensor for fingers below 50 N, a bench below 10 m, a piezo
// amplifier below 1 kV.
constexpr Bound kBounds[] = {
    {"tangential_force", 50}, {"tangential_force_x", 50}, {"net_force", 50},
    {"normal_force", 50},     {"position", 10},           {"speed", 5},
    {"acceleration", 1e4},    {"displacement", 0.1},      {"drive", 1000},
    {"height", 0.1},
};

double median_of_five(std::span<const double> values, std::size_t i) {
  std::array<double, 5> near{};
  const std::size_t first = std::clamp<std::size_t>(i, 2, values.size() - 3) - 2;
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), near.size(), near.begin());
  std::ranges::sort(near);
  return near[2];
}

std::vector<double> local_medians(std::span<const double> values) {
  std::vector<double> medians(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) medians[i] = median_of_five(values, i);
  return medians;
}

double usual_distance(std::span<const double> values, std::span<const double> medians) {
  std::vector<double> distances(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) distances[i] = std::abs(values[i] - medians[i]);
  const auto place = static_cast<std::size_t>(kUsual * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(distances, distances.begin() + static_cast<std::ptrdiff_t>(place));
  return distances[place];
}

// The smallest change from one sample to the next, 0 where nothing ever changes. A held or coarse channel has
// a usual distance of zero; one flicker of its last digit is no fault.
double finest_step(std::span<const double> values) {
  double finest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] != values[i - 1]) finest = std::min(finest, std::abs(values[i] - values[i - 1]));
  return std::isfinite(finest) ? finest : 0;
}

bool has_other_size(double value, double median) {
  return std::abs(value) > kOtherSize * std::abs(median) || std::abs(value) * kOtherSize < std::abs(median);
}

// Further from each neighbour than half its distance from the median, and on the same side of both. The first
// and the last sample have one neighbour: there the signal beside them must be calm, for a sine that begins
// at zero is no fault.
bool is_peak(std::span<const double> values, std::size_t i, double distance) {
  const double half = distance / 2;
  const auto stands_out = [&](std::size_t other) {
    return distance > 0 ? values[i] - values[other] > half : values[i] - values[other] < half;
  };
  const auto calm = [&](std::size_t a, std::size_t b) {
    return std::abs(values[a] - values[b]) < std::abs(distance) / 4;
  };
  const std::size_t last = values.size() - 1;
  const bool from_left = i == 0 ? calm(1, 2) : stands_out(i - 1);
  return from_left && (i == last ? calm(last - 1, last - 2) : stands_out(i + 1));
}

std::string people(double si_value, const schema::Channel& channel) {
  const auto quantity = schema::quantity_named(channel.quantity);
  return schema::for_people(si_value, quantity ? quantity->dimension : schema::Dimension::none);
}

std::string listed(const std::vector<std::size_t>& samples, const schema::Channel& channel,
                   std::span<const double> stored, const SampleName& name_of) {
  std::string list;
  for (std::size_t k = 0; k < std::min(samples.size(), kNamed); ++k) {
    const double value = stored[samples[k]];
    const std::string physical = people(value * channel.scale + channel.offset, channel);
    list += fmt::format("{}{} ({}) at {}", k == 0 ? "" : ", ", physical, value, name_of(samples[k]));
  }
  return samples.size() > kNamed ? list + ", ..." : list;
}

std::string count_of(std::size_t count, std::size_t all) {
  return fmt::format("{} of {} samples", count, all);
}

std::vector<std::size_t> beyond(double bound, const schema::Channel& channel,
                                std::span<const double> stored) {
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < stored.size(); ++i)
    if (std::abs(stored[i] * channel.scale + channel.offset) > bound) samples.push_back(i);
  return samples;
}

bool is_constant(std::span<const double> stored) {
  return stored.size() > 1 && std::ranges::adjacent_find(stored, std::not_equal_to<>()) == stored.end();
}

}  // namespace

double largest_plausible(std::string_view quantity) {
  const auto found = std::ranges::find(kBounds, quantity, &Bound::quantity);
  return found == std::end(kBounds) ? std::numeric_limits<double>::infinity() : found->largest;
}

std::vector<std::size_t> lone_samples(std::span<const double> values) {
  std::vector<std::size_t> lone;
  if (values.size() < 5) return lone;
  const auto medians = local_medians(values);
  const double far = kFar * std::max(usual_distance(values, medians), finest_step(values));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double distance = values[i] - medians[i];
    if (std::abs(distance) > far && has_other_size(values[i], medians[i]) && is_peak(values, i, distance))
      lone.push_back(i);
  }
  return lone;
}

std::vector<std::string> implausible(const schema::Channel& channel, std::span<const double> stored,
                                     const SampleName& name_of) {
  std::vector<std::string> warnings;
  if (is_constant(stored))
    return {fmt::format("{} never changes: {} throughout", channel.name,
                        people(stored[0] * channel.scale + channel.offset, channel))};
  const double bound = largest_plausible(channel.quantity);
  if (const auto samples = beyond(bound, channel, stored); !samples.empty())
    warnings.push_back(fmt::format("{}: {} beyond any plausible {} ({}): {}; check unit and scale",
                                   channel.name, count_of(samples.size(), stored.size()), channel.quantity,
                                   people(bound, channel), listed(samples, channel, stored, name_of)));
  if (const auto samples = lone_samples(stored); !samples.empty())
    warnings.push_back(fmt::format("{}: {} out of any range that their neighbours make plausible: {}",
                                   channel.name, count_of(samples.size(), stored.size()),
                                   listed(samples, channel, stored, name_of)));
  return warnings;
}

}  // namespace tacto::capture
