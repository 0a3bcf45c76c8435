// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that stand alone among their neighbours: a digit or an exponent lost on the way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace tacto::capture {

/// Finds samples that stand alone: far from both neighbours, on the same side of both, and five times larger
/// or smaller than the median of the five samples around. Far is ten times what 99 % of the samples are from
/// their own median of five (known to 1/16), and ten times the finest step. Real transients, steps and noise
/// have neighbours that follow, and pass. Channels of less than five samples are not judged.
///
/// Twice through the samples, in pieces of any size: survey() all of them, then end(); where any() says so,
/// find() all of them again, and end(). Memory: 256 KB and one piece, whatever the length.
class Outliers {
 public:
  using Found = std::function<void(std::uint64_t sample, double value)>;

  Outliers();
  void survey(std::span<const double> values);
  void end_survey();
  /// After the survey: some sample stands alone.
  bool any() const { return farthest_ > far_; }
  /// Calls `found` for each, in order.
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

  std::vector<double> window_;     // samples not yet done with, and three before them
  std::vector<double> distances_;  // of window_ from the medians around
  std::uint64_t first_ = 0;        // the number of window_'s first sample
  std::size_t next_ = 0;           // the first in window_ that was not visited
  bool ended_ = false;
  std::vector<std::uint64_t> histogram_;  // of distances, by their leading bits
  std::uint64_t count_ = 0;
  double finest_ = std::numeric_limits<double>::infinity();
  double farthest_ = 0;  // of the samples that stand alone but for the measure of far
  double far_ = 0;
};

}  // namespace tacto::capture
