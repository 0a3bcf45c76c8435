// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "capture/calibrate/uncertain.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::capture {
namespace {

// In an entry, 0 degrees of freedom mean that the uncertainty is not from scatter.
double degrees_of(const schema::CalibrationEntry& entry) {
  return entry.degrees_of_freedom > 0 ? entry.degrees_of_freedom : std::numeric_limits<double>::infinity();
}

constexpr double kFar = 10;       // times the usual distance from the local median
constexpr double kUsual = 0.99;   // the quantile that defines the usual distance
constexpr double kOtherSize = 5;  // times larger or smaller than the median around it

// The leading bits of a distance: the exponent and four bits of the mantissa, so a bin is 1/16 wide.
constexpr int kDropped = 48;
constexpr std::size_t kBins = std::size_t{1} << 15;

std::size_t bin_of(double distance) {
  return std::bit_cast<std::uint64_t>(distance) >> kDropped;
}

double upper_edge(std::size_t bin) {
  return bin == 0 ? 0 : std::bit_cast<double>((std::uint64_t{bin} + 1) << kDropped);
}

// Without branches, so that the compiler can vectorise.
double lesser(double a, double b) {
  return a < b ? a : b;
}
double greater(double a, double b) {
  return a < b ? b : a;
}

double median_of_five(const double* v) {
  const double low = greater(lesser(v[0], v[1]), lesser(v[2], v[3]));
  const double high = lesser(greater(v[0], v[1]), greater(v[2], v[3]));
  return greater(lesser(low, high), lesser(greater(low, high), v[4]));
}

bool has_other_size(double value, double median) {
  return std::abs(value) > kOtherSize * std::abs(median) || std::abs(value) * kOtherSize < std::abs(median);
}

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

// The largest magnitude of a quantity on a bench for a sliding finger, in its SI unit; infinity if there is
// no limit. The limits are wide on purpose: beyond them the unit or the scale is wrong.
double largest_plausible(std::string_view quantity) {
  const auto found = std::ranges::find(kBounds, quantity, &Bound::quantity);
  return found == std::end(kBounds) ? std::numeric_limits<double>::infinity() : found->largest;
}

}  // namespace

std::string scale_fault(const schema::CalibrationEntry& entry) {
  if (!entry.scale) return {};
  const double ratio = *entry.scale / entry.nominal_scale;
  if (!(ratio >= 1 / kMostOffOwnScale && ratio <= kMostOffOwnScale))
    return fmt::format("the scale of {} would be {:.3g} times the nominal scale of the device", entry.channel,
                       ratio);
  const double interval =
      std::abs(entry.scale_uncertainty.value_or(0) / *entry.scale) * coverage_factor_95(degrees_of(entry));
  if (interval <= kWidestInterval) return {};
  return fmt::format("the scale of {} is known only to +-{:.0f} % (95 %)", entry.channel, 100 * interval);
}

Outliers::Outliers() : histogram_(kBins) {}

// Whether the sample differs from each neighbour by more than half its distance from the median, with the
// same sign. The first and the last sample have one neighbour; in their place the two samples beside them
// must be nearly equal, so that a sine that begins at zero is not an outlier.
bool Outliers::stands_alone(std::size_t i, double distance) const {
  const std::vector<double>& v = window_;
  if (!has_other_size(v[i], v[i] - distance)) return false;
  const double half = distance / 2;
  const auto stands_out = [&](std::size_t other) {
    return distance > 0 ? v[i] - v[other] > half : v[i] - v[other] < half;
  };
  const auto calm = [&](std::size_t a, std::size_t b) {
    return std::abs(v[a] - v[b]) < std::abs(distance) / 4;
  };
  const bool first = first_ + i == 0, last = ended_ && i + 1 == v.size();
  const bool from_left = first ? calm(1, 2) : stands_out(i - 1);
  return from_left && (last ? calm(i - 1, i - 2) : stands_out(i + 1));
}

// Distances of the samples [begin, end) of the window from the medians around them.
void Outliers::prepare(std::size_t begin, std::size_t end) {
  distances_.resize(window_.size());
  const std::size_t last_middle = window_.size() - 3;
  const double* const v = window_.data();
  double* const distance = distances_.data();
  const std::size_t inner = std::clamp<std::size_t>(2, begin, end);
  const std::size_t outer = std::clamp<std::size_t>(last_middle + 1, inner, end);
  for (std::size_t i = begin; i < inner; ++i) distance[i] = v[i] - median_of_five(v);
  for (std::size_t i = inner; i < outer; ++i) distance[i] = v[i] - median_of_five(v + i - 2);
  for (std::size_t i = outer; i < end; ++i) distance[i] = v[i] - median_of_five(v + last_middle - 2);
}

void Outliers::survey_range(std::size_t begin, std::size_t end) {
  prepare(begin, end);
  for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) {
    const double step = std::abs(window_[i] - window_[i - 1]);
    finest_ = step > 0 && step < finest_ ? step : finest_;
  }
  count_ += end - begin;
  for (std::size_t i = begin; i < end; ++i) {
    const double distance = std::abs(distances_[i]);
    ++histogram_[bin_of(distance)];
    if (distance > farthest_ && stands_alone(i, distances_[i])) farthest_ = distance;
  }
}

void Outliers::find_range(std::size_t begin, std::size_t end, const Found& found) {
  prepare(begin, end);
  for (std::size_t i = begin; i < end; ++i)
    if (std::abs(distances_[i]) > far_ && stands_alone(i, distances_[i])) found(first_ + i, window_[i]);
}

// Visits all samples with two known samples after them; the first two need the first five.
template <class Visit>
void Outliers::visit(std::span<const double> values, Visit visit) {
  window_.insert(window_.end(), values.begin(), values.end());
  if (window_.size() < 5) return;
  visit(next_, window_.size() - 2);
  const auto done = static_cast<std::ptrdiff_t>(window_.size() - 5);
  window_.erase(window_.begin(), window_.begin() + done);
  first_ += static_cast<std::uint64_t>(done);
  next_ = 3;
}

// Visits the last two samples, whose medians are of the last five, and prepares for the next pass.
template <class Visit>
void Outliers::visit_rest(Visit visit) {
  ended_ = true;
  if (window_.size() >= 5) visit(next_, window_.size());
  ended_ = false;
  window_.clear();
  first_ = next_ = 0;
}

void Outliers::survey(std::span<const double> values) {
  visit(values, [this](std::size_t begin, std::size_t end) { survey_range(begin, end); });
}

void Outliers::end_survey() {
  visit_rest([this](std::size_t begin, std::size_t end) { survey_range(begin, end); });
  far_ = kFar * std::max(usual_distance(), std::isfinite(finest_) ? finest_ : 0);
}

void Outliers::find(std::span<const double> values, const Found& found) {
  visit(values, [&](std::size_t begin, std::size_t end) { find_range(begin, end, found); });
}

void Outliers::end_find(const Found& found) {
  visit_rest([&](std::size_t begin, std::size_t end) { find_range(begin, end, found); });
}

double Outliers::usual_distance() const {
  if (count_ == 0) return std::numeric_limits<double>::infinity();
  const auto rank = static_cast<std::uint64_t>(kUsual * static_cast<double>(count_ - 1));
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < histogram_.size(); ++bin) {
    below += histogram_[bin];
    if (below > rank) return upper_edge(bin);
  }
  return 0;
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
