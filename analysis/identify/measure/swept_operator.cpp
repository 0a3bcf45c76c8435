// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/swept_operator.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "playback/model/chain.hpp"

namespace tacto::analysis {
namespace {

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

}  // namespace tacto::analysis
