// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/response_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/identify/angles.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;
using schema::fail;
using schema::Fault;
using schema::Result;

constexpr int kHarmonics = 5;
constexpr std::ptrdiff_t kNeighbours = 4;  // on either side
constexpr std::size_t kMostFrequencies = 80;
constexpr double kLeastCoherence = 0.5;
constexpr std::size_t kFewestSamples = 1024;

// (2 / n) sum x exp(-i w t), the amplitude of a sine of `turns` in the window; the turning factor by
// recurrence, set right every 256 samples: exact to 1e-13.
Complex amplitude_of(std::span<const double> x, double turns_per_sample) {
  const Complex step = std::polar(1.0, -kTurn * turns_per_sample);
  Complex sum = 0, turn = 1;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % 256 == 0)
      turn = std::polar(1.0, -kTurn * std::fmod(turns_per_sample * static_cast<double>(i), 1.0));
    sum += x[i] * turn;
    turn = {turn.real() * step.real() - turn.imag() * step.imag(),
            turn.real() * step.imag() + turn.imag() * step.real()};
  }
  return 2.0 * sum / static_cast<double>(x.size());
}

double power_of(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.0) / static_cast<double>(x.size());
}

// What a step's answer holds beside its mean and its harmonics.
struct StepAnswer {
  Complex fundamental;
  double third = 0;
  double noise_power = 0;
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
  answer.noise_power = std::max(rest, 0.0) * n / (n - lost);
  return answer;
}

// Noise of no power (an answer without any) still has the rounding of doubles.
double no_less(double noise, Complex response) {
  return std::max(noise, 1e-9 * std::abs(response));
}

std::vector<double> smoothed(const std::vector<double>& squares) {
  std::vector<double> smooth;
  const auto count = static_cast<std::ptrdiff_t>(squares.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto from = std::max<std::ptrdiff_t>(0, i - kNeighbours), to = std::min(count, i + kNeighbours + 1);
    const double sum = std::accumulate(squares.begin() + from, squares.begin() + to, 0.0);
    smooth.push_back(sum / static_cast<double>(to - from));
  }
  return smooth;
}

}  // namespace

BodeData response_of_steps(const DrivenTray& tray, const SteppedSine& plan) {
  BodeData data;
  data.held_rate_hz = tray.rate_hz;
  for (const SineStep& step : plan.steps) {
    const std::size_t count = step.end - step.settled;
    const double turns = step.frequency_hz / tray.rate_hz;
    const Complex drive = amplitude_of(std::span(tray.drive_v).subspan(step.settled, count), turns);
    const StepAnswer answer = answer_of(std::span(tray.displacement_m).subspan(step.settled, count), turns);
    data.frequency_hz.push_back(step.frequency_hz);
    data.response.push_back(answer.fundamental / drive);
    const double noise = std::sqrt(2 * answer.noise_power / static_cast<double>(count)) / std::abs(drive);
    data.noise.push_back(no_less(noise, data.response.back()));
    data.third_harmonic = std::max(data.third_harmonic, answer.third / std::abs(answer.fundamental));
  }
  return data;
}

BodeData response_of_periods(const DrivenTray& tray, const PeriodicDrive& plan) {
  BodeData data;
  data.held_rate_hz = tray.rate_hz;
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
    // Scatter of the mean, of each of its two parts.
    squares.push_back((power - std::norm(sum) / periods) / (2 * (periods - 1) * periods));
    drives.push_back(std::abs(drive));
    data.frequency_hz.push_back(turns * tray.rate_hz);
    data.response.push_back(sum / periods / drive);
  }
  squares = smoothed(squares);
  for (std::size_t i = 0; i < data.size(); ++i)
    data.noise.push_back(no_less(std::sqrt(std::max(squares[i], 0.0)) / drives[i], data.response[i]));
  return data;
}

namespace {

struct Spectra {
  Complex cross;
  double input = 0, output = 0;
};

std::vector<double> windowed(std::span<const double> x) {
  const auto n = static_cast<double>(x.size());
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  std::vector<double> out;
  for (std::size_t i = 0; i < x.size(); ++i)
    out.push_back((x[i] - mean) * (0.5 - 0.5 * std::cos(kTurn * static_cast<double>(i) / n)));
  return out;
}

// Multiples of 1 / window in the band, evenly by octaves.
std::vector<double> turns_in(std::size_t window, double rate_hz, double low_hz, double high_hz) {
  std::vector<double> list;
  const double n = static_cast<double>(window);
  for (std::size_t i = 0; i < kMostFrequencies; ++i) {
    const double part = static_cast<double>(i) / (kMostFrequencies - 1);
    const double line = std::max(2.0, std::round(low_hz * std::pow(high_hz / low_hz, part) * n / rate_hz));
    if (line < n / 2 && (list.empty() || line / n > list.back())) list.push_back(line / n);
  }
  return list;
}

}  // namespace

Result<BodeData> response_of_record(std::span<const double> input, std::span<const double> output,
                                    double rate_hz, double low_hz, double high_hz,
                                    const std::string& source) {
  if (input.size() < kFewestSamples)
    return fail(Fault::unsuitable, "the recording is too short for a frequency response", source);
  const std::size_t window = std::min(input.size() / 8, static_cast<std::size_t>(rate_hz));
  const std::vector<double> turns = turns_in(window, rate_hz, low_hz, high_hz);
  std::vector<Spectra> spectra(turns.size());
  double count = 0;
  for (std::size_t at = 0; at + window <= input.size(); at += window / 2, ++count) {
    const auto in = windowed(input.subspan(at, window)), out = windowed(output.subspan(at, window));
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const Complex u = amplitude_of(in, turns[i]), x = amplitude_of(out, turns[i]);
      spectra[i].cross += x * std::conj(u);
      spectra[i].input += std::norm(u);
      spectra[i].output += std::norm(x);
    }
  }
  BodeData data;
  data.source = source;
  const double averages = 0.95 * count;  // Hann, half overlap: Welch 1967
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double coherence = std::norm(spectra[i].cross) / (spectra[i].input * spectra[i].output);
    if (!(coherence >= kLeastCoherence)) continue;
    data.frequency_hz.push_back(turns[i] * rate_hz);
    data.response.push_back(spectra[i].cross / spectra[i].input);
    const double part = std::sqrt((1 - std::min(coherence, 1.0)) / (2 * coherence * averages));
    data.noise.push_back(no_less(part * std::abs(data.response.back()), data.response.back()));
  }
  if (!data.frequency_hz.empty()) return data;
  return fail(Fault::unsuitable, "output and input have nothing to do with each other (coherence below 0.5)",
              source, "name the channels with --input and --output");
}

}  // namespace tacto::analysis
