// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/swept_operator.hpp"

#include <algorithm>
#include <cmath>

#include "playback/model/chain.hpp"
#include "playback/model/hysteresis_inverse.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;

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

Complex SweptOperator::Line::amplitude(std::span<const double> x) const {
  return amplitude_of(x.subspan(settled), turns_per_sample);
}

Complex SweptOperator::Line::amplitude() const {
  return amplitude(charge_v);
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

SweptOperator::SweptOperator(const SweptDrive& drive, double pole_hz) {
  const std::vector<double> charge_v = charge_of(drive.drive_v, pole_hz, drive.rate_hz);
  for (const double v : charge_v) largest_charge_v_ = std::max(largest_charge_v_, std::abs(v));
  for (const MeasuredLine& line : drive.lines) lines_.push_back(fine_line(drive, charge_v, line, pole_hz));
}

const std::vector<Complex>& SweptOperator::play(double threshold_v) {
  std::vector<Complex>& left = known_[threshold_v];
  if (!left.empty()) return left;
  for (const Line& line : lines_)
    left.push_back(line.amplitude(playback::played_through({{threshold_v}, {1}}, line.charge_v)) /
                   line.amplitude());
  return left;
}

std::vector<Complex> SweptOperator::left_by(const schema::Hysteresis& play_operators) {
  std::vector<Complex> sum(lines_.size());
  for (std::size_t i = 0; i < play_operators.weights.size(); ++i) {
    if (play_operators.weights[i] == 0) continue;
    const auto& one = play(play_operators.thresholds_v[i]);
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += play_operators.weights[i] * one[n];
  }
  return sum;
}

}  // namespace tacto::analysis
