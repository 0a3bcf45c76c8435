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
constexpr double kPoleStep = 1e-3;  // relative step of the finite difference
constexpr double kRoughPart =
    0.5;  // then the residuals of the emulated bender (32 play operators) have the noise's size

// Behind the pole, only the mechanics cause a lag of a slow drive.
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

struct JointMeasurement {
  const BodeData& sweep;
  const SweptDrive& drive;
  const DrivenTray& loops;
};

// The operator behind the pole of a transducer, and its describing function for the sweep.
struct OperatorBehind {
  SweptOperator swept;
  LoopFit loops;
  std::vector<Complex> left;
};

Result<OperatorBehind> operator_behind(const schema::Transducer& t, const JointMeasurement& of) {
  const double pole_hz = schema::actuator_pole_hz(t);
  SweptOperator swept(of.drive, pole_hz);
  const auto charge_v = charge_of(of.loops.drive_v, pole_hz, of.loops.rate_hz);
  auto loops =
      fit_loops(charge_v, of.loops.displacement_m, of.loops.rate_hz, mechanical_delay_s(t), t.drive_limit_v,
                thresholds_finer_below(swept.largest_charge_v(), largest(charge_v)));
  TACTO_TRY(loops);
  auto left = swept.left_by(loops->hysteresis);
  return OperatorBehind{std::move(swept), std::move(*loops), std::move(left)};
}

schema::Transducer with_pole_times(schema::Transducer t, double times) {
  t.amplifier_resistance_ohm /= times;
  return t;
}

// Relative errors of the sweep after the division by the describing function.
Result<PoleDependence> dependence_on_pole(const schema::Transducer& t, const OperatorBehind& here,
                                          const JointMeasurement& of) {
  const auto there = operator_behind(with_pole_times(t, 1 + kPoleStep), of);
  TACTO_TRY(there);
  PoleDependence slope{schema::actuator_pole_hz(t), {}};
  for (std::size_t i = 0; i < here.left.size(); ++i)
    slope.log_slope.push_back(-std::log(there->left[i] / here.left[i]) / std::log1p(kPoleStep));
  return slope;
}

bool shows_hysteresis(const LoopFit& loops) {
  return loops.opening >= kLeastOpening && loops.explains_more;
}

void add_shared(const OperatorErrors& errors, OperatorBehind& behind, BodeData& data) {
  std::vector<schema::Hysteresis> changes = errors.by_noise;
  changes.insert(changes.end(), errors.by_misfit.begin(), errors.by_misfit.end());
  data.shared_errors = behind.swept.left_by(changes);
  for (auto& error : data.shared_errors)
    for (std::size_t i = 0; i < data.size(); ++i) error[i] /= behind.left[i];
}

// If the charge's peak passes the threshold of a play operator that the model lacks, the response has a kink,
// which play operators in the middle of two thresholds do not reproduce. So from one frequency to the next
// the errors differ from the last `misfits` patterns by a part of their size.
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
  joint.response.ended = fmt::format("pole and hysteresis did not converge in {} rounds", joint.rounds);
}

// If the loops are not a hysteresis of this kind, the linear part is wrong, too.
void say_unusable(JointFit& joint) {
  if (joint.loops.usable) return;
  Misfit& misfit = joint.response.misfit;
  misfit.words += fmt::format("{}the operator does not describe the loops: it leaves {:.2g} % of them",
                              misfit.found ? "; " : "", 100 * joint.loops.residual_part);
  misfit.found = true;
  joint.response.band.clear();
}

BodeData without_hysteresis(BodeData data, OperatorBehind& behind) {
  for (std::size_t i = 0; i < data.size(); ++i) {
    data.response[i] /= behind.left[i];
    if (data.has_noise()) data.noise[i] /= std::abs(behind.left[i]);
  }
  add_shared(behind.loops.errors, behind, data);
  add_rough(behind.loops.errors.by_misfit.size(), data);
  data.third_harmonic.reset();  // the operator causes a third harmonic
  return data;
}

// One round: the sweep of the linear part, on the assumption that the pole is the transducer's.
Result<BodeData> linear_sweep(const schema::Transducer& t, const JointMeasurement& of, JointFit& joint) {
  auto behind = operator_behind(t, of);
  TACTO_TRY(behind);
  joint.has_hysteresis = shows_hysteresis(behind->loops);
  BodeData linear = of.sweep;
  if (joint.has_hysteresis) {
    linear = without_hysteresis(std::move(linear), *behind);
    auto slope = dependence_on_pole(t, *behind, of);
    TACTO_TRY(slope);
    linear.by_pole = std::move(*slope);
  }
  joint.loops = std::move(behind->loops);
  return linear;
}

}  // namespace

Result<JointFit> fit_jointly(const BodeData& sweep, const SweptDrive& drive, const DrivenTray& loops,
                             const ModelChoice& choice, const schema::Transducer& base) {
  JointFit joint;
  schema::Transducer found = base;
  BodeData linear;
  while (!joint.settled && joint.rounds < kMostRounds) {
    const double pole_hz = schema::actuator_pole_hz(found);
    auto divided = linear_sweep(found, {sweep, drive, loops}, joint);
    TACTO_TRY(divided);
    linear = std::move(*divided);
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
