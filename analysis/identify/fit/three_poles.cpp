// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/three_poles.hpp"

#include <cmath>

#include "analysis/identify/fit/least_squares.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;

constexpr int kRounds = 6;      // of reweighting; the result is only the start of a fit
constexpr int kHalvings = 100;  // of an interval; reaches rounding
constexpr int kUnknowns = 4;

// 1 + a s + b s^2 + c s^3 and the numerator's factor, s = i f / scale_hz.
struct Cubic {
  double a = 0, b = 0, c = 0, numerator = 0;

  Complex at(Complex s) const { return 1.0 + s * (a + s * (b + s * c)); }
  double at(double s) const { return 1 + s * (a + s * (b + s * c)); }
};

void put(std::vector<double>& list, Complex value) {
  list.push_back(value.real());
  list.push_back(value.imag());
}

// N - H (a s + b s^2 + c s^3) = H; real and imaginary parts are separate rows.
Cubic solved_with(const Cubic& before, const BodeData& data, double scale_hz) {
  std::vector<std::vector<double>> columns(kUnknowns);
  std::vector<double> right;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const Complex s(0, data.frequency_hz[i] / scale_hz);
    const Complex h = data.response[i] / (sigma_at(data, i) * std::abs(before.at(s)));
    put(columns[0], -h * s);
    put(columns[1], -h * s * s);
    put(columns[2], -h * s * s * s);
    put(columns[3], (data.direction == Direction::actuator ? 1.0 : -s) * h / data.response[i]);
    put(right, h);
  }
  const std::vector<double> x = non_negative_least_squares(columns, right, kUnknowns);
  return {x[0], x[1], x[2], x[3]};
}

// The negative root of the cubic, which is 1 at 0. Precondition: c above 0.
double real_root(const Cubic& cubic) {
  double low = -1, high = 0;
  while (cubic.at(low) > 0) low *= 2;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (cubic.at(middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

// D = (1 + s / p) (1 + 2 damping s / r + s^2 / r^2).
std::optional<std::vector<double>> values_of_cubic(const Cubic& cubic, Direction direction, double scale_hz) {
  if (!(cubic.c > 0 && cubic.numerator > 0)) return std::nullopt;
  const double pole = -real_root(cubic), resonance = std::sqrt(1 / (cubic.c * pole)),
               damping = 0.5 * resonance * (cubic.a - 1 / pole);
  if (!(damping > 0) || !std::isfinite(resonance)) return std::nullopt;
  const double gain = direction == Direction::actuator ? cubic.numerator : cubic.numerator * pole;
  return std::vector<double>{gain, scale_hz * resonance, damping, scale_hz * pole};
}

std::vector<double> split(Direction direction, std::span<const double> values, double pole_hz, double one_hz,
                          double other_hz) {
  std::vector<double> list(values.begin(), values.end());
  list[kResonance] = std::sqrt(one_hz * other_hz);
  list[kDamping] = 0.5 * (one_hz + other_hz) / list[kResonance];
  list[kPole] = pole_hz;
  if (direction == Direction::sensor) list[kGain] *= pole_hz / values[kPole];  // the data give gain / pole
  return list;
}

}  // namespace

std::optional<std::vector<double>> poles_of_data(const BodeData& data) {
  const double scale_hz = std::sqrt(data.frequency_hz.front() * data.frequency_hz.back());
  Cubic cubic;
  for (int round = 0; round < kRounds; ++round) cubic = solved_with(cubic, data, scale_hz);
  return values_of_cubic(cubic, data.direction, scale_hz);
}

std::vector<std::vector<double>> other_splits(Direction direction, std::span<const double> values) {
  const double damping = values[kDamping], pole_hz = values[kPole];
  if (!(damping > 1)) return {};
  const double high_hz = values[kResonance] * (damping + std::sqrt(damping * damping - 1)),
               low_hz = values[kResonance] * values[kResonance] / high_hz;
  return {split(direction, values, low_hz, pole_hz, high_hz),
          split(direction, values, high_hz, pole_hz, low_hz)};
}

}  // namespace tacto::analysis
