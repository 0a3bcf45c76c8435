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

#include "capture/import/source_row.hpp"
#include "data-schema/calibration/calibration.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

// Checks whether a measured scale is plausible for its device.

/// The largest factor between the scale and the nominal scale, in either direction, and the largest width of
/// the 95 % interval as a fraction of the scale. Our choice: nominal gains are known to some ten per cent. So
/// beyond a factor of two a unit or a weight is wrong, and beyond a fifth the nominal scale is the better
/// one.
inline constexpr double kMostOffOwnScale = 2, kWidestInterval = 0.2;

/// The reason why the entry's scale is implausible: its ratio to the nominal scale (also a negative one), or
/// its interval. Empty if it is plausible, or if the entry has no scale.
std::string scale_fault(const schema::CalibrationEntry& entry);

/// The time of a sample for messages: "4.227 s".
using TimeOf = std::function<std::string(std::uint64_t sample)>;

/// Finds isolated samples: far from both neighbours, in the same direction, and five times larger or smaller
/// than the median of the five samples around. "Far" is ten times the distance that 99 % of the samples have
/// from their own median of five (known to 1/16), and at least ten times the finest step. In real transients,
/// steps and noise the neighbours change too, so they are not reported. Channels of fewer than five samples
/// are not examined.
///
/// Two passes over the samples, in pieces of any size: survey() for all, then end_survey(); if any() is true,
/// find() for all again, then end_find(). Memory: 256 KB and one piece, for any length.
class Outliers {
 public:
  using Found = std::function<void(std::uint64_t sample, double value)>;

  Outliers();
  void survey(std::span<const double> values);
  void end_survey();
  /// After the survey: at least one sample is isolated.
  bool any() const { return farthest_ > far_; }
  /// Calls `found` for each isolated sample, in order.
  void find(std::span<const double> values, const Found& found);
  void end_find(const Found& found);

 private:
  template <class Visit>
  void visit(std::span<const double> values, Visit visit);
  template <class Visit>
  void visit_rest(Visit visit);
  void prepare(std::size_t begin, std::size_t end);
  void survey_range(std::size_t begin, std::size_t end);
  void find_range(std::size_t begin, std::size_t end, const Found& found);
  bool stands_alone(std::size_t i, double distance) const;
  double usual_distance() const;

  std::vector<double> window_;     // samples that are still needed, and three before them
  std::vector<double> distances_;  // of window_ from the medians around
  std::uint64_t first_ = 0;        // the number of window_'s first sample
  std::size_t next_ = 0;           // the first in window_ that has not been visited
  bool ended_ = false;
  std::vector<std::uint64_t> histogram_;  // of distances, by their leading bits
  std::uint64_t count_ = 0;
  double finest_ = std::numeric_limits<double>::infinity();
  double farthest_ = 0;  // of the isolated samples, before the comparison with far_
  double far_ = 0;
};

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
