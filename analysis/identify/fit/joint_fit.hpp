// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the linear model and the hysteresis of one bench to a sweep and slow loops together.
#pragma once

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "analysis/identify/measure/swept_operator.hpp"

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
