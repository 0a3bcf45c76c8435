// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/joint_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <set>
#include <utility>

#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/excitation.hpp"
#include "playback/model/chain.hpp"

namespace tacto::analysis {
namespace {

using schema::Result;
using Complex = std::complex<double>;

// Play operators of one input, computed together, and their sums with exp(-i w t).
class PlaysInStep {
 public:
  explicit PlaysInStep(std::span<const double> thresholds_v)
      : thresholds_v_(thresholds_v.begin(), thresholds_v.end()),
        v_(thresholds_v.size()),
        real_(thresholds_v.size()),
        imag_(thresholds_v.size()) {}

  void move(double v) {
    for (std::size_t k = 0; k < v_.size(); ++k)
      v_[k] = std::max(v - thresholds_v_[k], std::min(v + thresholds_v_[k], v_[k]));
  }
  void add(Complex turn) {
    for (std::size_t k = 0; k < v_.size(); ++k) {
      real_[k] += v_[k] * turn.real();
      imag_[k] += v_[k] * turn.imag();
    }
  }
  std::vector<Complex> sums() const {
    std::vector<Complex> list;
    for (std::size_t k = 0; k < v_.size(); ++k) list.emplace_back(real_[k], imag_[k]);
    return list;
  }

 private:
  std::vector<double> thresholds_v_, v_, real_, imag_;
};

constexpr int kMostJointRounds = 10;
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

std::vector<double> charge_of(std::span<const double> drive_v, double pole_hz, double rate_hz) {
  const double kept = playback::kept_in_a_tick(pole_hz, rate_hz);
  std::vector<double> charge_v;
  charge_v.reserve(drive_v.size());
  double charge = 0;
  for (const double v : drive_v) {
    charge_v.push_back(charge);
    charge = kept * charge + (1 - kept) * v;
  }
  return charge_v;
}

// Amplitudes of the sines in the play operators of the charge; the last one is that of the charge itself.
std::vector<Complex> SweptOperator::Line::amplitudes(std::span<const double> thresholds_v) const {
  PlaysInStep plays(thresholds_v);
  const std::span all(charge_v);
  for (const double v : all.first(settled)) plays.move(v);
  TurningFactor turn(turns_per_sample);
  Complex charge;
  for (const double v : all.subspan(settled)) {
    const Complex now = turn.next();
    plays.move(v);
    plays.add(now);
    charge += v * now;
  }
  std::vector<Complex> sums = plays.sums();
  sums.push_back(charge);
  for (Complex& sum : sums) sum *= 2.0 / static_cast<double>(all.size() - settled);
  return sums;
}

SweptOperator::Line SweptOperator::fine_line(const SweptDrive& drive, std::span<const double> charge_v,
                                             const MeasuredLine& line, double pole_hz) {
  const double fine = std::max(1.0, std::ceil(kFinePerPeriod * line.turns_per_sample));
  const auto steps = static_cast<std::size_t>(fine);
  const std::span<const double> held = std::span(drive.drive_v).subspan(line.begin, line.end() - line.begin);
  Line out;
  std::vector<double> kept;
  for (std::size_t i = 0; i < steps; ++i)
    kept.push_back(playback::kept_in_a_tick(pole_hz, drive.rate_hz * fine / static_cast<double>(i)));
  for (std::size_t n = 0; n < held.size(); ++n)
    for (const double part : kept)
      out.charge_v.push_back(held[n] + part * (charge_v[line.begin + n] - held[n]));
  out.settled = (line.first - line.begin) * steps;
  out.turns_per_sample = line.turns_per_sample / fine;
  return out;
}

SweptOperator::SweptOperator(const SweptDrive& drive, double pole_hz, std::span<const double> filter) {
  const std::vector<double> charge_v = charge_of(drive.drive_v, pole_hz, drive.rate_hz);
  for (const double v : charge_v) largest_charge_v_ = std::max(largest_charge_v_, std::abs(v));
  for (const MeasuredLine& line : drive.lines) {
    lines_.push_back(fine_line(drive, charge_v, line, pole_hz));
    if (filter.empty()) continue;
    for (double& v : lines_.back().charge_v) v *= filter[lines_.size() - 1];
  }
}

void SweptOperator::follow(std::span<const schema::Hysteresis> operators) {
  std::set<double> unknown;
  for (const auto& one : operators)
    for (std::size_t i = 0; i < one.weights.size(); ++i)
      if (one.weights[i] != 0 && !known_.contains(one.thresholds_v[i])) unknown.insert(one.thresholds_v[i]);
  if (unknown.empty()) return;
  const std::vector<double> thresholds_v(unknown.begin(), unknown.end());
  for (const Line& line : lines_) {
    const std::vector<Complex> found = line.amplitudes(thresholds_v);
    for (std::size_t i = 0; i < thresholds_v.size(); ++i)
      known_[thresholds_v[i]].push_back(found[i] / found.back());
  }
}

std::vector<Complex> SweptOperator::sum_of(const schema::Hysteresis& play_operators) const {
  std::vector<Complex> sum(lines_.size());
  for (std::size_t i = 0; i < play_operators.weights.size(); ++i) {
    if (play_operators.weights[i] == 0) continue;
    const auto& one = known_.at(play_operators.thresholds_v[i]);
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += play_operators.weights[i] * one[n];
  }
  return sum;
}

std::vector<std::vector<Complex>> SweptOperator::left_by(std::span<const schema::Hysteresis> operators) {
  follow(operators);
  std::vector<std::vector<Complex>> list;
  for (const auto& one : operators) list.push_back(sum_of(one));
  return list;
}

std::vector<Complex> SweptOperator::left_by(const schema::Hysteresis& play_operators) {
  return left_by(std::span(&play_operators, 1)).front();
}

Result<JointFit> fit_jointly(const BodeData& sweep, const SweptDrive& drive, const DrivenTray& loops,
                             const ModelChoice& choice, const schema::Transducer& base) {
  JointFit joint;
  Assumed assumed{base, 0};
  assumed.transducer.reconstruction_cutoff_hz.reset();
  ModelChoice model = choice;  // after the first round the one that was chosen in it, until all settles
  while (!joint.settled && joint.rounds < kMostJointRounds) {
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
