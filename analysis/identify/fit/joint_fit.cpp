// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/joint_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/excitation.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;
using schema::Result;

constexpr int kMostRounds = 10;
constexpr double kRoughPart =
    0.5;  // on the emulated bender, of 32 plays, the residuals are then of the noise's size

// Behind the pole only the mechanics lag a slow drive.
double mechanical_delay_s(const schema::Transducer& t) {
  const Complex behind =
      schema::actuator_response(t, kLoopHz) * Complex(1, kLoopHz / schema::actuator_pole_hz(t));
  return -std::arg(behind) / (kTurn * kLoopHz);
}

double largest(std::span<const double> v) {
  double most = 0;
  for (const double value : v) most = std::max(most, std::abs(value));
  return most;
}

Result<LoopFit> loops_behind(const schema::Transducer& t, const DrivenTray& loops, double sweep_v) {
  const auto charge_v = charge_of(loops.drive_v, schema::actuator_pole_hz(t), loops.rate_hz);
  return fit_loops(charge_v, loops.displacement_m, loops.rate_hz, mechanical_delay_s(t), t.drive_limit_v,
                   thresholds_finer_below(sweep_v, largest(charge_v)));
}

bool shows_hysteresis(const LoopFit& loops) {
  return loops.opening >= kLeastOpening && loops.explains_more;
}

void add_shared(const std::vector<schema::Hysteresis>& changes, SweptOperator& swept,
                std::span<const Complex> made, BodeData& data) {
  for (const auto& change : changes) {
    data.shared_errors.push_back(swept.left_by(change));
    for (std::size_t i = 0; i < data.size(); ++i) data.shared_errors.back()[i] /= made[i];
  }
}

// Where the charge's peak passes a play that the operator lacks its answer has a kink, which plays in the
// middle of two thresholds do not follow: from one frequency to the next the errors of the last `misfits`
// patterns differ by a part of themselves.
void add_rough(std::size_t misfits, BodeData& data) {
  if (misfits == 0 || !data.has_noise()) return;
  const std::span patterns = std::span(data.shared_errors).last(misfits);
  for (std::size_t i = 0; i < data.size(); ++i) {
    double power = 0;
    for (const auto& pattern : patterns) power += std::norm(pattern[i]) / 2;
    data.noise[i] = std::hypot(data.noise[i], kRoughPart * std::sqrt(power) * std::abs(data.response[i]));
  }
  data.noise_is_a_bound = true;
}

void say_unsettled(JointFit& joint) {
  if (joint.settled) return;
  joint.response.converged = false;
  joint.response.ended = fmt::format("pole and hysteresis did not settle in {} rounds", joint.rounds);
}

// What is no hysteresis of this kind makes the linear part wrong, too.
void say_unusable(JointFit& joint) {
  if (joint.loops.usable) return;
  Misfit& misfit = joint.response.misfit;
  misfit.words += fmt::format("{}the loops are no such hysteresis: the operator leaves {:.2g} % of them",
                              misfit.found ? "; " : "", 100 * joint.loops.residual_part);
  misfit.found = true;
  joint.response.band.clear();
}

}  // namespace

BodeData without_hysteresis(BodeData data, SweptOperator& swept, const LoopFit& loops) {
  const std::vector<Complex> made = swept.left_by(loops.hysteresis);
  for (std::size_t i = 0; i < data.size(); ++i) {
    data.response[i] /= made[i];
    if (data.has_noise()) data.noise[i] /= std::abs(made[i]);
  }
  add_shared(loops.errors.by_noise, swept, made, data);
  add_shared(loops.errors.by_misfit, swept, made, data);
  add_rough(loops.errors.by_misfit.size(), data);
  data.third_harmonic.reset();  // the operator makes one
  return data;
}

Result<JointFit> fit_jointly(const BodeData& sweep, const SweptDrive& drive, const DrivenTray& loops,
                             const ModelChoice& choice, const schema::Transducer& base) {
  JointFit joint;
  schema::Transducer found = base;
  BodeData linear;
  while (!joint.settled && joint.rounds < kMostRounds) {
    const double pole_hz = schema::actuator_pole_hz(found);
    SweptOperator swept(drive, pole_hz);
    auto operator_found = loops_behind(found, loops, swept.largest_charge_v());
    TACTO_TRY(operator_found);
    joint.loops = std::move(*operator_found);
    joint.has_hysteresis = shows_hysteresis(joint.loops);
    linear = joint.has_hysteresis ? without_hysteresis(sweep, swept, joint.loops) : sweep;
    found = fit_values(linear, choice, base).transducer;
    joint.settled =
        ++joint.rounds > 1 && std::abs(schema::actuator_pole_hz(found) / pole_hz - 1) < kPoleSettled;
  }
  joint.response = fit_response(linear, choice, base);
  say_unsettled(joint);
  say_unusable(joint);
  return joint;
}

}  // namespace tacto::analysis
