// SPDX-License-Identifier: GPL-3.0-or-later
// Checks for values that touch cannot cause: they are reported and not changed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/import/outliers.hpp"
#include "capture/import/source_row.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// The largest magnitude of a quantity on a bench for a sliding finger, in its SI unit; infinity if there is
/// no limit. The limits are wide on purpose: beyond them the unit or the scale is wrong.
double largest_plausible(std::string_view quantity);

/// The time of a sample for messages: "4.227 s".
using TimeOf = std::function<std::string(std::uint64_t sample)>;

/// Checks one channel for values beyond largest_plausible(), isolated samples, and a constant value. Two
/// passes over the samples, as in Outliers: survey, and a second one if second_pass_needed(). Memory as
/// there.
class Plausibility {
 public:
  /// Precondition: `channel` exists as long as this object.
  explicit Plausibility(const schema::Channel& channel);

  /// `first` is the number in the file of the first sample of `stored`.
  void survey(std::span<const double> stored, std::uint64_t first, const PlaceOf& place_of);
  void end_survey();
  bool second_pass_needed() const { return smallest_ < largest_ && lone_.any(); }
  /// `place_of` is also called for the two samples before `stored`: a sample is isolated only if those after
  /// it show it.
  void find(std::span<const double> stored, const PlaceOf& place_of);
  void end_find(const PlaceOf& place_of);

  /// The samples that warnings() lists or counts as out of range or isolated: their number, and the first
  /// kMostOutliers of them.
  std::uint64_t outliers() const { return beyond_.count + alone_.count; }
  const std::vector<std::uint64_t>& outlier_samples() const { return outlier_samples_; }
  static constexpr std::size_t kMostOutliers = 1'000'000;  // 8 MB

  /// One line per fault, with the first few samples and the number of samples.
  std::vector<std::string> warnings(const TimeOf& time_of) const;
  double smallest_stored() const { return smallest_; }
  double largest_stored() const { return largest_; }

 private:
  struct Sighting {
    std::uint64_t sample = 0;
    double value = 0;
    std::string place;
  };
  struct Sightings {
    std::uint64_t count = 0;
    std::vector<Sighting> first;
    void add(std::uint64_t sample, double value, const PlaceOf& place_of);
  };
  double physical(double stored) const { return channel_.physical(stored); }
  bool is_beyond(double stored) const;
  void note_alone(std::uint64_t sample, double value, const PlaceOf& place_of);
  void note(Sightings& sightings, std::uint64_t sample, double value, const PlaceOf& place_of);
  std::string people(double in_si) const;
  std::string listed(const Sightings& sightings, const TimeOf& time_of) const;

  const schema::Channel& channel_;
  double bound_;
  double smallest_ = std::numeric_limits<double>::infinity();
  double largest_ = -std::numeric_limits<double>::infinity();
  std::uint64_t count_ = 0;
  Sightings beyond_, alone_;
  std::vector<std::uint64_t> outlier_samples_;
  Outliers lone_;
};

}  // namespace tacto::capture
