// SPDX-License-Identifier: GPL-3.0-or-later
// The continuation of a record beyond its ends, which avoids ringing of a filter there.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// treated: the record is continued beyond its ends. none: the Fourier transform connects its last sample to
/// its first.
enum class Edges { treated, none };

/// The length of the continuation, and of the part of each end to which its baseline is fitted.
struct EndTreatment {
  std::size_t padding = 0;   ///< samples beyond each end, at most size - 1
  std::size_t baseline = 2;  ///< samples, 2 ... size

  /// 8 periods of the lowest frequency of padding, a baseline over 2 periods; less if the record is shorter.
  static EndTreatment for_lowest(double low_hz, double sample_rate_hz, std::size_t size);
};

/// A record that is continued beyond its ends, fed in chunks. Beyond each end the straight baseline of that
/// end continues and the record's deviation from it is mirrored. Both taper smoothly to the end's own level,
/// which is then constant, so there is neither a jump nor a kink of the drift. The level before the first
/// value is subtracted from all values. Memory: twice the length of an end's treatment.
class ExtendedRecord {
 public:
  /// As EndTreatment::for_lowest.
  ExtendedRecord(double low_hz, double sample_rate_hz);
  /// Continues the record and appends to `extended` what is ready.
  void push(std::span<const double> values, std::vector<double>& extended);
  /// Ends the record of at least 2 values and appends the rest.
  void finish(std::vector<double>& extended);
  /// Ready for the next record.
  void reset();

  /// After the first append: number of samples before the record's first, and the level there.
  std::size_t padding() const { return treatment_.padding; }
  double start_level() const { return start_level_; }
  /// After finish(): the value of all later samples.
  double final_value() const { return final_value_; }

 private:
  void begin(EndTreatment treatment, std::vector<double>& extended);
  void append_record(std::span<const double> values, std::vector<double>& extended) const;

  double low_hz_, sample_rate_hz_;
  EndTreatment most_;  // for a record that is long enough
  EndTreatment treatment_;
  std::vector<double> held_;  // the record's last values; all of them until it has begun
  bool begun_ = false;
  double start_level_ = 0, final_value_ = 0;
};

/// Mirrors the values about the points of their first and last sample, `padding` < size samples at each end,
/// as scipy.signal.sosfiltfilt does (padtype "odd").
std::vector<double> extend_odd(std::span<const double> values, std::size_t padding);

}  // namespace tacto::spatial
