// SPDX-License-Identifier: GPL-3.0-or-later
// The linear model and the hysteresis of one bench, from a sweep and slow loops together.
#pragma once

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "analysis/identify/measure/swept_operator.hpp"

namespace tacto::analysis {

struct JointFit {
  ResponseFit response;        ///< of the sweep with the hysteresis divided out
  LoopFit loops;               ///< behind the electrical pole
  bool has_hysteresis = true;  ///< false: the loops show none, and `response` is that of the sweep as it is
  bool settled = false;        ///< the pole moved by less than kPoleSettled of itself in the last round
  int rounds = 0;
};

inline constexpr double kPoleSettled = 1e-6;
inline constexpr double kLeastOpening = 5e-4;  ///< of a loop: an angle of 0.03 degrees, -66 dB

/// The bender follows its charge, which lags the drive by the electrical pole. Behind that pole the loops
/// give the operator (fit_loops(), thresholds finer where the sweep swings). The sweep's charge through that
/// operator is what moves the linear rest: where the sweep is divided by the part of each frequency that the
/// operator leaves (its describing function, computed from the drive itself), a linear response is left, and
/// goes to fit_response(). How the operator may err, by noise or as it is no such hysteresis, becomes
/// BodeData::shared_errors. The pole is first the base's and then the one that was found, until it stays.
/// Errors: those of fit_loops(). Preconditions: check_bode(sweep), an actuator's; a line of `drive` for each
/// of its frequencies; loops.rate_hz above 0.
schema::Result<JointFit> fit_jointly(const BodeData& sweep, const SweptDrive& drive, const DrivenTray& loops,
                                     const ModelChoice& choice, const schema::Transducer& base);

/// The sweep without the operator of the loops.
BodeData without_hysteresis(BodeData sweep, SweptOperator& swept, const LoopFit& loops);

}  // namespace tacto::analysis
