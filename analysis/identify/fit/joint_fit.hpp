// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the linear model and the hysteresis of one bench to a sweep and slow loops together.
#pragma once

#include <complex>
#include <map>
#include <span>
#include <vector>

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "analysis/identify/measure/response_estimate.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

struct JointFit {
  ResponseFit response;        ///< of the sweep without the hysteresis
  LoopFit loops;               ///< behind the electrical pole
  bool has_hysteresis = true;  ///< false: the loops have none, and `response` is that of the unchanged sweep
  bool settled = false;  ///< in the last round the model stayed, and pole and filter changed by less than
                         ///< kPoleSettled, relative
  int rounds = 0;
};

inline constexpr double kPoleSettled = 1e-6;
inline constexpr double kLeastOpening = 5e-4;  ///< of a loop; equivalent to a lag of 0.03 degrees, -66 dB

/// The actual drive of the device, and the samples in which each frequency was measured.
struct SweptDrive {
  double rate_hz = 0;
  std::vector<double> drive_v;
  std::vector<MeasuredLine> lines;
};

/// Charge of a bender behind the electrical pole, V, at the beginning of each sample of a held drive.
std::vector<double> charge_of(std::span<const double> drive_v, double pole_hz, double rate_hz);

/// The describing function of an operator for each line of a drive: the sine at the line's frequency in the
/// operator's response to the charge, over the sine in the charge. It is computed from the drive itself, and
/// so includes peaks between two samples and ticks at a limit; with at least kFinePerPeriod points per
/// period, at which the charge is exact. Play operators follow the charge from the line's beginning on, so
/// that they settle before the measurement.
class SweptOperator {
 public:
  /// `filter` is the amplitude of a filter in front of the bender at each line, 1 if it is empty: of a sine,
  /// play operators depend on the amplitude only.
  SweptOperator(const SweptDrive& drive, double pole_hz, std::span<const double> filter = {});
  std::vector<std::complex<double>> left_by(const schema::Hysteresis& play_operators);
  /// One result for each operator. The play operators that are not cached are computed in one pass over the
  /// drive.
  std::vector<std::vector<std::complex<double>>> left_by(std::span<const schema::Hysteresis> operators);
  double largest_charge_v() const { return largest_charge_v_; }

  static constexpr double kFinePerPeriod = 128;  ///< a kink's harmonics fall with n^2: aliasing is below 1e-5

 private:
  struct Line {
    std::vector<double> charge_v;
    std::size_t settled = 0;
    double turns_per_sample = 0;
    std::vector<std::complex<double>> amplitudes(std::span<const double> thresholds_v) const;
  };
  static Line fine_line(const SweptDrive& drive, std::span<const double> charge_v, const MeasuredLine& line,
                        double pole_hz);
  void follow(std::span<const schema::Hysteresis> operators);
  std::vector<std::complex<double>> sum_of(const schema::Hysteresis& play_operators) const;

  std::vector<Line> lines_;
  double largest_charge_v_ = 0;
  std::map<double, std::vector<std::complex<double>>>
      known_;  // by threshold of a play operator: one value for each line
};

/// The hysteresis of the bender acts on its charge, which lags the drive by the electrical pole. From the
/// charge, the loops give the operator (fit_loops(), with finer thresholds in the range of the sweep). The
/// output of that operator for the sweep's charge drives the linear part. So the sweep, divided at each
/// frequency by the operator's describing function (computed from the drive itself), is a linear response,
/// which is fitted by fit_response(). The errors of the operator, by noise and by misfit, become
/// BodeData::shared_errors. The first pole is the base's without a filter, then pole, filter and delay are
/// the fitted ones, until they do not change. Errors: those of fit_loops(). Preconditions: check_bode(sweep),
/// an actuator's; `drive` has a line for each of its frequencies; loops.rate_hz above 0.
schema::Result<JointFit> fit_jointly(const BodeData& sweep, const SweptDrive& drive, const DrivenTray& loops,
                                     const ModelChoice& choice, const schema::Transducer& base);

}  // namespace tacto::analysis
