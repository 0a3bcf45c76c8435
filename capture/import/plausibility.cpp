// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data-schema/base/quantity.hpp"

namespace tacto::capture {
namespace {

constexpr std::size_t kNamed = 5;  // the number of samples that a warning lists

struct Bound {
  std::string_view quantity;
  double largest;
};

// A fingertip explores at about 0.1 m/s with some newtons (Wiertlewski 2011: 50 mm/s, 0.5 N). A hand in the
// air stays below 5 m/s, a force sensor for fingers below 50 N, a bench below 10 m, a piezo amplifier below 1
// kV.
constexpr Bound kBounds[] = {
    {"tangential_force", 50}, {"tangential_force_x", 50}, {"net_force", 50},
    {"normal_force", 50},     {"position", 10},           {"speed", 5},
    {"acceleration", 1e4},    {"displacement", 0.1},      {"drive", 1000},
    {"height", 0.1},
};

std::string count_of(std::uint64_t count, std::uint64_t all) {
  return fmt::format("{} of {} samples", count, all);
}

}  // namespace

double largest_plausible(std::string_view quantity) {
  const auto found = std::ranges::find(kBounds, quantity, &Bound::quantity);
  return found == std::end(kBounds) ? std::numeric_limits<double>::infinity() : found->largest;
}

Plausibility::Plausibility(const schema::Channel& channel)
    : channel_(channel), bound_(largest_plausible(channel.quantity)) {}

void Plausibility::Sightings::add(std::uint64_t sample, double value, const PlaceOf& place_of) {
  if (++count <= kNamed) first.push_back({sample, value, place_of(sample)});
}

void Plausibility::note(Sightings& sightings, std::uint64_t sample, double value, const PlaceOf& place_of) {
  sightings.add(sample, value, place_of);
  if (outlier_samples_.size() < kMostOutliers) outlier_samples_.push_back(sample);
}

bool Plausibility::is_beyond(double stored) const {
  return std::abs(physical(stored)) > bound_;
}

void Plausibility::survey(std::span<const double> stored, std::uint64_t first, const PlaceOf& place_of) {
  double low = stored[0], high = stored[0];
  for (const double value : stored) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  smallest_ = std::min(smallest_, low);
  largest_ = std::max(largest_, high);
  if (is_beyond(low) || is_beyond(high))
    for (std::size_t i = 0; i < stored.size(); ++i)
      if (is_beyond(stored[i])) note(beyond_, first + i, stored[i], place_of);
  count_ += stored.size();
  lone_.survey(stored);
}

void Plausibility::end_survey() {
  lone_.end_survey();
}

void Plausibility::find(std::span<const double> stored, const PlaceOf& place_of) {
  lone_.find(stored, [&](std::uint64_t sample, double value) { note_alone(sample, value, place_of); });
}

void Plausibility::end_find(const PlaceOf& place_of) {
  lone_.end_find([&](std::uint64_t sample, double value) { note_alone(sample, value, place_of); });
}

// A sample beyond the bound is counted already.
void Plausibility::note_alone(std::uint64_t sample, double value, const PlaceOf& place_of) {
  if (!is_beyond(value)) note(alone_, sample, value, place_of);
}

std::string Plausibility::people(double in_si) const {
  const auto quantity = schema::quantity_named(channel_.quantity);
  return schema::for_people(in_si, quantity ? quantity->dimension : schema::Dimension::none);
}

std::string Plausibility::listed(const Sightings& sightings, const TimeOf& time_of) const {
  std::string list;
  for (const Sighting& one : sightings.first)
    list += fmt::format("{}{} ({}) at {}, {}", list.empty() ? "" : ", ", people(physical(one.value)),
                        one.value, one.place, time_of(one.sample));
  return sightings.count > kNamed ? list + ", ..." : list;
}

std::vector<std::string> Plausibility::warnings(const TimeOf& time_of) const {
  if (count_ > 1 && smallest_ == largest_)
    return {fmt::format("{} is constant: {}", channel_.name, people(physical(smallest_)))};
  std::vector<std::string> warnings;
  if (beyond_.count > 0)
    warnings.push_back(fmt::format("{}: {} beyond any plausible {} ({}): {}; check unit and scale",
                                   channel_.name, count_of(beyond_.count, count_), channel_.quantity,
                                   people(bound_), listed(beyond_, time_of)));
  if (alone_.count > 0)
    warnings.push_back(fmt::format("{}: {} implausible compared with their neighbours: {}", channel_.name,
                                   count_of(alone_.count, count_), listed(alone_, time_of)));
  return warnings;
}

}  // namespace tacto::capture
