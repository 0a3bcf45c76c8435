// SPDX-License-Identifier: GPL-3.0-or-later
// What a filter sees beyond the ends of a record, so that it does not ring from them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// treated: the record goes on beyond its ends. none: the Fourier transform joins its last sample to its
/// first.
enum class Edges { treated, none };

/// How long the record goes on, and over how much of each end its baseline is fitted.
struct EndTreatment {
  std::size_t padding = 0;   ///< samples beyond each end, at most size - 1
  std::size_t baseline = 2;  ///< samples, 2 ... size

  /// 8 periods of the lowest frequency of padding, a baseline over 2; a record that is shorter gives what it
  /// has.
  static EndTreatment for_lowest(double low_hz, double sample_rate_hz, std::size_t size);
};

/// A record that goes on beyond its ends, fed in chunks. Beyond each end the straight baseline of that end
/// goes on and what the record has above it is mirrored, both tapered smoothly to the end's own level, which
/// then stays for ever: no jump, and no kink of the drift. All of it less the level before the first value.
/// Holds twice what an end's treatment looks at.
class ExtendedRecord {
 public:
  /// As EndTreatment::for_lowest.
  ExtendedRecord(double low_hz, double sample_rate_hz);
  /// The record goes on; appends to `extended` what is known of it.
  void push(std::span<const double> values, std::vector<double>& extended);
  /// The record, of 2 values at least, has ended; appends the rest.
  void finish(std::vector<double>& extended);
  /// Ready for the next record.
  void reset();

  /// Once something was appended: samples before the record's first, and the level there.
  std::size_t padding() const { return treatment_.padding; }
  double start_level() const { return start_level_; }
  /// After finish(): what all later values are.
  double final_value() const { return final_value_; }

 private:
  void begin(EndTreatment treatment, std::vector<double>& extended);
  void append_record(std::span<const double> values, std::vector<double>& extended) const;

  double low_hz_, sample_rate_hz_;
  EndTreatment most_;  // of a record that is long enough
  EndTreatment treatment_;
  std::vector<double> held_;  // the record's last values; from its first, until it has begun
  bool begun_ = false;
  double start_level_ = 0, final_value_ = 0;
};

/// Point-mirrored about its first and last sample, `padding` < size samples at each end, as
/// scipy.signal.sosfiltfilt does (padtype "odd").
std::vector<double> extend_odd(std::span<const double> values, std::size_t padding);

}  // namespace tacto::spatial
