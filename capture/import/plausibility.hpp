// SPDX-License-Identifier: GPL-3.0-or-later
// What no touch can have given: reported, never changed.
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
#include "capture/import/place_of.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// The largest magnitude that a quantity has at a bench where a finger slides, in its SI unit; infinity where
/// there is none. Wide on purpose: beyond it the unit or the scale is wrong.
double largest_plausible(std::string_view quantity);

/// Says of a sample when it was: "4.227 s".
using TimeOf = std::function<std::string(std::uint64_t sample)>;

/// One channel looked at for values beyond largest_plausible(), lone samples, and no change at all. Twice
/// through its samples, as LoneSamples: survey, and where second_pass_needed() once more. Memory as there.
class Plausibility {
 public:
  /// Precondition: `channel` outlives this.
  explicit Plausibility(const schema::Channel& channel);

  /// `first` is the number of the first of `stored`, as in the file.
  void survey(std::span<const double> stored, std::uint64_t first, const PlaceOf& place_of);
  void end_survey();
  bool second_pass_needed() const { return smallest_ < largest_ && lone_.any(); }
  /// `place_of` is also asked for the two samples before `stored`: a lone sample is known by its followers.
  void find(std::span<const double> stored, const PlaceOf& place_of);
  void end_find(const PlaceOf& place_of);

  /// Of the samples named or counted in warnings() as beyond or alone: all that there are, and the first
  /// kMostOutliers of them.
  std::uint64_t outliers() const { return beyond_.count + alone_.count; }
  const std::vector<std::uint64_t>& outlier_samples() const { return outlier_samples_; }
  static constexpr std::size_t kMostOutliers = 1'000'000;  // 8 MB

  /// One line for each thing to warn of, with the first few samples by name, and how many there are.
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
  double physical(double stored) const { return stored * channel_.scale + channel_.offset; }
  bool is_beyond(double stored) const;
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
