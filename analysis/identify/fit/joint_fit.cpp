// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/joint_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

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

// What a round assumes: the fit of the round before.
struct Assumed {
  schema::Transducer transducer;
  double delay_s = 0;

  double pole_hz() const { return schema::actuator_pole_hz(transducer); }
  double filter_at(double hz) const {
    const auto& cutoff_hz = transducer.reconstruction_cutoff_hz;
    return cutoff_hz ? std::abs(schema::butterworth3_response(*cutoff_hz, hz)) : 1;
  }
  // Of a slow drive, except by the pole. A pure delay before the operator acts as one behind it.
  double slow_delay_s() const {
    const Complex rest = schema::actuator_response(transducer, kLoopHz) * Complex(1, kLoopHz / pole_hz());
    return delay_s - std::arg(rest) / (kTurn * kLoopHz);
  }
};

Assumed found_by(const ResponseFit& fit) {
  const FittedParameter* const delay = fit.find("delay_ms");
  return {fit.transducer, delay != nullptr ? 1e-3 * delay->value : 0};
}

bool settled_at(const Assumed& now, const Assumed& before) {
  const auto same = [](double a, double b) { return std::abs(a / b - 1) < kPoleSettled; };
  const auto &filter_hz = now.transducer.reconstruction_cutoff_hz,
             &filter_before_hz = before.transducer.reconstruction_cutoff_hz;
  return same(now.pole_hz(), before.pole_hz()) && filter_hz.has_value() == filter_before_hz.has_value() &&
         (!filter_hz || same(*filter_hz, *filter_before_hz));
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

Result<OperatorBehind> operator_behind(const Assumed& assumed, const JointMeasurement& of) {
  const double pole_hz = assumed.pole_hz();
  std::vector<double> filter;
  for (const double hz : of.sweep.frequency_hz) filter.push_back(assumed.filter_at(hz));
  SweptOperator swept(of.drive, pole_hz, filter);
  const auto charge_v = charge_of(of.loops.drive_v, pole_hz, of.loops.rate_hz);
  auto loops = fit_loops(charge_v, of.loops.displacement_m, of.loops.rate_hz, assumed.slow_delay_s(),
                         assumed.transducer.drive_limit_v,
                         thresholds_finer_below(swept.largest_charge_v(), largest(charge_v)));
  TACTO_TRY(loops);
  auto left = swept.left_by(loops->hysteresis);
  return OperatorBehind{std::move(swept), std::move(*loops), std::move(left)};
}

Assumed with_pole_times(Assumed assumed, double times) {
  assumed.transducer.amplifier_resistance_ohm /= times;
  return assumed;
}

// Relative errors of the sweep after the division by the describing function.
Result<PoleDependence> dependence_on_pole(const Assumed& assumed, const OperatorBehind& here,
                                          const JointMeasurement& of) {
  const auto there = operator_behind(with_pole_times(assumed, 1 + kPoleStep), of);
  TACTO_TRY(there);
  PoleDependence slope{assumed.pole_hz(), {}};
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
  joint.response.ended = fmt::format("model and hysteresis did not converge in {} rounds", joint.rounds);
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

// One round: the sweep of the linear part, on the assumption that its pole, filter and delay are these.
Result<BodeData> linear_sweep(const Assumed& assumed, const JointMeasurement& of, JointFit& joint) {
  auto behind = operator_behind(assumed, of);
  TACTO_TRY(behind);
  joint.has_hysteresis = shows_hysteresis(behind->loops);
  BodeData linear = of.sweep;
  linear.loops_measured = true;
  if (joint.has_hysteresis) {
    linear = without_hysteresis(std::move(linear), *behind);
    auto slope = dependence_on_pole(assumed, *behind, of);
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
  Assumed assumed{base, 0};
  assumed.transducer.reconstruction_cutoff_hz.reset();
  ModelChoice model = choice;  // after the first round the one that was chosen in it, until all settles
  while (!joint.settled && joint.rounds < kMostRounds) {
    const auto linear = linear_sweep(assumed, {sweep, drive, loops}, joint);
    TACTO_TRY(linear);
    joint.response = fit_response(*linear, model, base);
    model = joint.response.choice;
    const Assumed found = found_by(joint.response);
    joint.settled = ++joint.rounds > 1 && settled_at(found, assumed);
    assumed = found;
    if (!joint.settled || !choice.open) continue;
    joint.response = fit_response(*linear, choice, base);
    joint.settled = joint.response.choice == std::exchange(model, joint.response.choice);
  }
  say_unsettled(joint);
  say_unusable(joint);
  return joint;
}

}  // namespace tacto::analysis
