// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/response_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/identify/measure/angles.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;

constexpr int kHarmonics = 5;
// Square of an amplitude over the variance of each of its parts: noise exceeds it in 5 of 10,000 sweeps of 60
// frequencies, exp(-kSurely / 2) each.
constexpr double kSurely = 23.4;
constexpr std::ptrdiff_t kNeighbours = 4;  // to each side
static_assert(kFewestNeighbours == kNeighbours + 1, "at the ends of the band");

double power_of(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.0) / static_cast<double>(x.size());
}

// The harmonics of a step's answer, and the remaining noise without mean and harmonics.
struct StepAnswer {
  Complex fundamental;
  double third = 0;  // 0 if it is not beyond the noise
  double noise_power = 0, freedom = 0;
};

StepAnswer answer_of(std::span<const double> x, double turns_per_sample) {
  StepAnswer answer;
  const auto n = static_cast<double>(x.size());
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  double rest = power_of(x) - mean * mean, lost = 1;
  for (int h = 1; h <= kHarmonics && h * turns_per_sample < 0.5; ++h, lost += 2) {
    const Complex a = amplitude_of(x, h * turns_per_sample);
    rest -= std::norm(a) / 2;
    if (h == 1) answer.fundamental = a;
    if (h == 3) answer.third = std::abs(a);
  }
  answer.freedom = n - lost;
  answer.noise_power = std::max(rest, 0.0) * n / answer.freedom;
  if (answer.third * answer.third < kSurely * 2 * answer.noise_power / n) answer.third = 0;
  return answer;
}

}  // namespace

TurningFactor::TurningFactor(double turns_per_sample)
    : turns_per_sample_(turns_per_sample), step_(std::polar(1.0, -kTurn * turns_per_sample)) {}

Complex TurningFactor::next() {
  if (samples_ % 256 == 0)
    turn_ = std::polar(1.0, -kTurn * std::fmod(turns_per_sample_ * static_cast<double>(samples_), 1.0));
  ++samples_;
  const Complex now = turn_;
  turn_ = {now.real() * step_.real() - now.imag() * step_.imag(),
           now.real() * step_.imag() + now.imag() * step_.real()};
  return now;
}

std::complex<double> amplitude_of(std::span<const double> x, double turns_per_sample) {
  TurningFactor turn(turns_per_sample);
  Complex sum = 0;
  for (const double value : x) sum += value * turn.next();
  return 2.0 * sum / static_cast<double>(x.size());
}

std::vector<MeasuredLine> lines_of(const SteppedSine& plan, double rate_hz) {
  std::vector<MeasuredLine> lines;
  for (const SineStep& step : plan.steps)
    lines.push_back({step.first, step.settled, step.end - step.settled, step.frequency_hz / rate_hz});
  return lines;
}

std::vector<MeasuredLine> lines_of(const PeriodicDrive& plan) {
  std::vector<MeasuredLine> lines;
  for (const std::size_t line : plan.lines)
    lines.push_back(
        {0, plan.period, plan.period, static_cast<double>(line) / static_cast<double>(plan.period)});
  return lines;
}

double noise_no_less(double noise, Complex response) {
  return std::max(noise, 1e-9 * std::abs(response));
}

std::vector<double> mean_of_neighbours(const std::vector<double>& squares) {
  std::vector<double> smooth;
  const auto count = static_cast<std::ptrdiff_t>(squares.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto from = std::max<std::ptrdiff_t>(0, i - kNeighbours), to = std::min(count, i + kNeighbours + 1);
    const double sum = std::accumulate(squares.begin() + from, squares.begin() + to, 0.0);
    smooth.push_back(sum / static_cast<double>(to - from));
  }
  return smooth;
}

BodeData response_of_steps(const DrivenTray& tray, const SteppedSine& plan) {
  BodeData data;
  data.held_rate_hz = tray.rate_hz;
  data.limited = tray.limited;
  for (const SineStep& step : plan.steps) {
    const std::size_t count = step.end - step.settled;
    const double turns = step.frequency_hz / tray.rate_hz;
    const Complex drive = amplitude_of(std::span(tray.drive_v).subspan(step.settled, count), turns);
    const StepAnswer answer = answer_of(std::span(tray.displacement_m).subspan(step.settled, count), turns);
    data.frequency_hz.push_back(step.frequency_hz);
    data.response.push_back(answer.fundamental / drive);
    const double noise = std::sqrt(2 * answer.noise_power / static_cast<double>(count)) / std::abs(drive);
    data.noise.push_back(noise_no_less(noise, data.response.back()));
    data.noise_freedom =
        data.noise_freedom > 0 ? std::min(data.noise_freedom, answer.freedom) : answer.freedom;
    data.third_harmonic =
        std::max(data.third_harmonic.value_or(0), answer.third / std::abs(answer.fundamental));
  }
  return data;
}

BodeData response_of_periods(const DrivenTray& tray, const PeriodicDrive& plan) {
  BodeData data;
  data.held_rate_hz = tray.rate_hz;
  data.limited = tray.limited;
  const auto periods = static_cast<double>(plan.periods - 1);
  std::vector<double> squares, drives;
  for (const std::size_t line : plan.lines) {
    const double turns = static_cast<double>(line) / static_cast<double>(plan.period);
    const Complex drive = amplitude_of(std::span(tray.drive_v).subspan(plan.period, plan.period), turns);
    Complex sum = 0;
    double power = 0;
    for (std::size_t p = 1; p < plan.periods; ++p) {
      const Complex x =
          amplitude_of(std::span(tray.displacement_m).subspan(p * plan.period, plan.period), turns);
      sum += x;
      power += std::norm(x);
    }
    // Variance of the mean, for each of its two parts.
    squares.push_back((power - std::norm(sum) / periods) / (2 * (periods - 1) * periods));
    drives.push_back(std::abs(drive));
    data.frequency_hz.push_back(turns * tray.rate_hz);
    data.response.push_back(sum / periods / drive);
  }
  squares = mean_of_neighbours(squares);
  data.noise_freedom = 2 * (periods - 1) * kFewestNeighbours;
  for (std::size_t i = 0; i < data.size(); ++i)
    data.noise.push_back(noise_no_less(std::sqrt(std::max(squares[i], 0.0)) / drives[i], data.response[i]));
  return data;
}

}  // namespace tacto::analysis
