// SPDX-License-Identifier: GPL-3.0-or-later
// What a hysteresis behind the electrical pole leaves of each frequency of a drive.
#pragma once

#include <complex>
#include <map>
#include <span>
#include <vector>

#include "analysis/identify/measure/response_estimate.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// A drive as the device put it out, and the samples that each frequency was measured on.
struct SweptDrive {
  double rate_hz = 0;
  std::vector<double> drive_v;
  std::vector<MeasuredLine> lines;
};

/// A drive that is held for each sample, behind the electrical pole: the charge at the samples' beginnings,
/// V.
std::vector<double> charge_of(std::span<const double> drive_v, double pole_hz, double rate_hz);

/// The describing function of an operator on each line of a drive: the sine at the line's frequency in the
/// operator's answer to the charge, over that in the charge. Computed from the drive itself, so that peaks
/// which fall between two samples and ticks held to a limit are in it; at kFinePerPeriod points a period or
/// more, between which the charge is exact. Plays follow the charge from the line's own beginning on, where
/// it settles.
class SweptOperator {
 public:
  SweptOperator(const SweptDrive& drive, double pole_hz);
  std::vector<std::complex<double>> left_by(const schema::Hysteresis& play_operators);
  double largest_charge_v() const { return largest_charge_v_; }

  static constexpr double kFinePerPeriod = 128;  ///< a kink's harmonics fall by n^2: what folds is below 1e-5

 private:
  struct Line {
    std::vector<double> charge_v;
    std::size_t settled = 0;
    double turns_per_sample = 0;
    std::complex<double> amplitude() const;
    std::complex<double> amplitude(std::span<const double> x) const;
  };
  static Line fine_line(const SweptDrive& drive, std::span<const double> charge_v, const MeasuredLine& line,
                        double pole_hz);
  const std::vector<std::complex<double>>& play(double threshold_v);

  std::vector<Line> lines_;
  double largest_charge_v_ = 0;
  std::map<double, std::vector<std::complex<double>>> known_;
};

}  // namespace tacto::analysis
