// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "analysis/identify/measure/angles.hpp"

namespace tacto::analysis {
namespace {

constexpr double kDriveSettleS = 0.05, kMeasureS = 0.2, kSilenceS = 0.05;
constexpr double kMeasuredPeriods = 5;

double octave(const ExcitationPlan& plan, std::size_t i) {
  const double part = static_cast<double>(i) / static_cast<double>(plan.frequencies - 1);
  return plan.low_hz * std::pow(plan.high_hz / plan.low_hz, part);
}

void add_silence(std::vector<float>& drive, double rate_hz) {
  drive.insert(drive.end(), static_cast<std::size_t>(kSilenceS * rate_hz), 0.0F);
}

// The frequencies as multiples of 1 / s, without duplicates.
std::vector<std::size_t> lines_of(const ExcitationPlan& plan) {
  std::vector<std::size_t> lines;
  for (std::size_t i = 0; i < plan.frequencies; ++i)
    lines.push_back(static_cast<std::size_t>(std::max(1.0, std::round(octave(plan, i)))));
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  return lines;
}

PeriodicDrive repeated(const std::vector<double>& period, const ExcitationPlan& plan) {
  double peak = 0;
  for (const double v : period) peak = std::max(peak, std::abs(v));
  PeriodicDrive drive;
  drive.period = period.size();
  drive.periods = kPeriods;
  drive.lines = lines_of(plan);
  for (std::size_t i = 0; i < kPeriods * period.size(); ++i)
    drive.drive_v.push_back(static_cast<float>(plan.amplitude_v * period[i % period.size()] / peak));
  add_silence(drive.drive_v, plan.rate_hz);
  return drive;
}

void add_sine(std::vector<float>& drive, double amplitude_v, double frequency_hz, double rate_hz,
              double periods) {
  const auto count = static_cast<std::size_t>(std::round(periods * rate_hz / frequency_hz));
  for (std::size_t i = 0; i < count; ++i)
    drive.push_back(
        static_cast<float>(amplitude_v * std::sin(kTurn * frequency_hz * static_cast<double>(i) / rate_hz)));
}

void add_half_cosine(std::vector<float>& drive, double from_v, double to_v, double samples) {
  for (double i = 0; i < samples; ++i)
    drive.push_back(static_cast<float>(std::midpoint(from_v, to_v) +
                                       (from_v - to_v) / 2 * std::cos(std::numbers::pi * i / samples)));
}

}  // namespace

double stepped_sine_s(const ExcitationPlan& plan) {
  double sum_s = kSilenceS;
  for (std::size_t i = 0; i < plan.frequencies; ++i) {
    const double hz = octave(plan, i);
    sum_s += kDriveSettleS + 1 / hz + std::max(kMeasureS, kMeasuredPeriods / hz);
  }
  return sum_s;
}

SteppedSine stepped_sine(const ExcitationPlan& plan) {
  SteppedSine stepped;
  for (std::size_t i = 0; i < plan.frequencies; ++i) {
    const double target_hz = octave(plan, i);
    const double samples = std::round(std::max(kMeasureS, kMeasuredPeriods / target_hz) * plan.rate_hz);
    const double periods = std::round(target_hz * samples / plan.rate_hz);
    SineStep step{periods * plan.rate_hz / samples, stepped.drive_v.size(), 0, 0};
    if (!stepped.steps.empty() && step.frequency_hz <= stepped.steps.back().frequency_hz) continue;
    const double settle = std::ceil((kDriveSettleS + 1 / target_hz) * plan.rate_hz);
    add_sine(stepped.drive_v, plan.amplitude_v, step.frequency_hz, plan.rate_hz,
             (settle + samples) * step.frequency_hz / plan.rate_hz);
    step.end = stepped.drive_v.size();
    step.settled = step.end - static_cast<std::size_t>(samples);
    stepped.steps.push_back(step);
  }
  add_silence(stepped.drive_v, plan.rate_hz);
  return stepped;
}

PeriodicDrive multisine(const ExcitationPlan& plan) {
  const std::vector<std::size_t> lines = lines_of(plan);
  std::vector<double> period(static_cast<std::size_t>(plan.rate_hz), 0.0);
  const auto count = static_cast<double>(lines.size());
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const double k = static_cast<double>(n), phase = -std::numbers::pi * k * (k - 1) / count;
    const double w = kTurn * static_cast<double>(lines[n]) / static_cast<double>(period.size());
    for (std::size_t i = 0; i < period.size(); ++i) period[i] += std::cos(w * static_cast<double>(i) + phase);
  }
  return repeated(period, plan);
}

// Begins a little below and ends a little above the band, so that its ends are excited as well.
PeriodicDrive periodic_chirp(const ExcitationPlan& plan) {
  std::vector<double> period(static_cast<std::size_t>(plan.rate_hz), 0.0);
  const double from_hz = 0.7 * plan.low_hz, to_hz = 1.2 * plan.high_hz, growth = std::log(to_hz / from_hz);
  for (std::size_t i = 0; i < period.size(); ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(period.size());
    period[i] = std::sin(kTurn * from_hz * (std::exp(growth * part) - 1) / growth);
  }
  return repeated(period, plan);
}

std::vector<float> slow_loops(double rate_hz, double amplitude_v, double small_v) {
  std::vector<double> sizes_v = {amplitude_v};
  for (const double part : {1.0, 0.8, 0.6, 0.4, 0.2}) sizes_v.push_back(part * amplitude_v);
  if (small_v > 0)
    for (const double part : {1.0, 0.7, 0.4, 0.2}) sizes_v.push_back(part * small_v);
  std::ranges::sort(sizes_v, std::greater{});
  std::vector<float> drive;
  double at_v = 0;
  const auto go_to = [&](double end_v, double duration_s) {
    add_half_cosine(drive, std::exchange(at_v, end_v), end_v, duration_s * rate_hz);
  };
  go_to(sizes_v.front(), 0.25 / kLoopHz);
  for (const double size_v : sizes_v) {
    go_to(-size_v, 0.5 / kLoopHz);
    go_to(size_v, 0.5 / kLoopHz);
  }
  go_to(0, 0.25 / kLoopHz);
  add_silence(drive, rate_hz);
  return drive;
}

}  // namespace tacto::analysis
