// SPDX-License-Identifier: GPL-3.0-or-later
// Isolated outliers: samples in which a digit or an exponent was lost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace tacto::capture {

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

}  // namespace tacto::capture
