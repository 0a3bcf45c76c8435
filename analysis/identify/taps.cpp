// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/taps.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using schema::fail;
using schema::Fault;
using schema::Result;
using Complex = std::complex<double>;

constexpr double kAfterPeakS = 1e-3, kRingingS = 12e-3;
constexpr std::size_t kDecimation = 4, kLeastRinging = 100;
constexpr Index kPoles = 16;
constexpr double kLowestModeHz = 50;
constexpr double kSameMode = 0.03;
constexpr double kLoudRinging = 5;  // RMS over that of the quiet before the tap
constexpr std::size_t kModesForetelling = 3;
constexpr double kMadToSigma = 1.4826;

double median_of_values(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

Spread spread_of(const std::vector<double>& values) {
  const double median = median_of_values(values);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - median));
  return {median, kMadToSigma * median_of_values(std::move(distances))};
}

double rms_of(const VectorXd& x) {
  return x.norm() / std::sqrt(static_cast<double>(x.size()));
}

// The ringing of a tap, its baseline taken off, at a quarter of the rate.
Result<VectorXd> ringing_of(const Tap& tap, double rate_hz) {
  const auto& y = tap.value;
  for (std::size_t i = 0; i < y.size(); ++i)
    if (!std::isfinite(y[i]))
      return fail(Fault::unsuitable, "a value is not a number",
                  fmt::format("tap {}, sample {}", tap.name, i + 1));
  const auto peak = static_cast<std::size_t>(
      std::ranges::max_element(y, {}, [](double v) { return std::abs(v); }) - y.begin());
  const auto first = peak + static_cast<std::size_t>(kAfterPeakS * rate_hz);
  const auto count =
      std::min(y.size() - std::min(first, y.size()), static_cast<std::size_t>(kRingingS * rate_hz)) /
      kDecimation;
  if (count < kLeastRinging || peak < kLeastRinging)
    return fail(Fault::unsuitable, "too short: it needs some quiet before and some ringing after",
                "tap " + tap.name, "record 2 ms before and 13 ms after each tap, at 35 kHz or more");
  const Eigen::Map<const VectorXd> before(y.data(), static_cast<Index>(peak * 4 / 5));
  const double baseline = before.mean();
  VectorXd ringing(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < kDecimation; ++k) sum += y[first + i * kDecimation + k] - baseline;
    ringing[static_cast<Index>(i)] = sum / kDecimation;
  }
  if (rms_of(ringing) > kLoudRinging * rms_of(before.array() - baseline)) return ringing;
  return fail(Fault::unsuitable, "there is no ringing in it: this is noise", "tap " + tap.name,
              "leave it out");
}

// The signal poles z of y[n] = sum c z^n, by the pencil of the Hankel matrix's right singular vectors.
VectorXcd pencil_poles(const VectorXd& y) {
  const Index columns = y.size() / 2, rows = y.size() - columns;
  MatrixXd hankel(rows, columns + 1);
  for (Index i = 0; i < rows; ++i) hankel.row(i) = y.segment(i, columns + 1).transpose();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> vectors(hankel.transpose() * hankel);
  const MatrixXd v = vectors.eigenvectors().rightCols(kPoles);
  const MatrixXd shift = v.topRows(columns).colPivHouseholderQr().solve(v.bottomRows(columns));
  return Eigen::EigenSolver<MatrixXd>(shift).eigenvalues();
}

MatrixXcd powers_of(const VectorXcd& z, Index from, Index count) {
  MatrixXcd basis(count, z.size());
  for (Index k = 0; k < z.size(); ++k)
    for (Index n = 0; n < count; ++n) basis(n, k) = std::pow(z[k], static_cast<double>(from + n));
  return basis;
}

// Poles that ring, with how strongly; a mode is a pair of them, or several that can't be told apart.
struct Ringing {
  std::vector<RingingMode> modes;
  double left = 0;
};

void merge(std::vector<RingingMode>& modes, RingingMode mode) {
  const auto same = std::ranges::find_if(modes, [&](const RingingMode& other) {
    return std::abs(other.frequency_hz / mode.frequency_hz - 1) < kSameMode;
  });
  if (same == modes.end()) return modes.push_back(mode);
  const double whole = same->energy_part + mode.energy_part;
  const auto mean = [&](double a, double b) {
    return (a * same->energy_part + b * mode.energy_part) / whole;
  };
  same->frequency_hz = mean(same->frequency_hz, mode.frequency_hz);
  same->damping_ratio = mean(same->damping_ratio, mode.damping_ratio);
  same->energy_part = whole;
}

Ringing modes_of(const VectorXd& y, double rate_hz) {
  const VectorXcd z = pencil_poles(y);
  const MatrixXcd basis = powers_of(z, 0, y.size());
  const VectorXcd c = basis.colPivHouseholderQr().solve(y.cast<Complex>());
  Ringing ringing;
  for (Index k = 0; k < z.size(); ++k) {
    const Complex s = std::log(z[k]) * rate_hz;
    if (s.imag() < 2 * std::numbers::pi * kLowestModeHz) continue;
    const double energy = 2 * (basis.col(k) * c[k]).squaredNorm() / y.squaredNorm();
    merge(ringing.modes, {std::abs(s) / (2 * std::numbers::pi), -s.real() / std::abs(s), energy});
  }
  std::ranges::sort(ringing.modes, std::greater{}, &RingingMode::energy_part);
  ringing.left = (y - (basis * c).real()).norm() / y.norm();
  return ringing;
}

// What the first taps' modes say of another's ringing, once they know its beginning.
double miss_of(const VectorXd& y, const std::vector<RingingMode>& modes, double rate_hz) {
  VectorXcd z(static_cast<Index>(2 * modes.size()));
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const double w = 2 * std::numbers::pi * modes[i].frequency_hz, d = modes[i].damping_ratio;
    const Complex s(-d * w, w * std::sqrt(std::max(0.0, 1 - d * d)));
    z[static_cast<Index>(2 * i)] = std::exp(s / rate_hz);
    z[static_cast<Index>(2 * i + 1)] = std::conj(z[static_cast<Index>(2 * i)]);
  }
  const Index known = y.size() / 4, rest = y.size() - known;
  const VectorXcd c = powers_of(z, 0, known).colPivHouseholderQr().solve(y.head(known).cast<Complex>());
  const VectorXd foretold = (powers_of(z, known, rest) * c).real();
  return (y.tail(rest) - foretold).norm() / y.tail(rest).norm();
}

TapsFit summed_up(std::vector<RingingTap> taps) {
  std::vector<double> frequencies, dampings;
  for (const RingingTap& tap : taps) {
    frequencies.push_back(tap.modes.front().frequency_hz);
    dampings.push_back(tap.modes.front().damping_ratio);
  }
  return {std::move(taps), spread_of(frequencies), spread_of(dampings)};
}

// Of the modes that most of the taps have, the medians.
std::vector<RingingMode> common_modes(const std::vector<RingingTap>& taps) {
  std::vector<RingingMode> common;
  for (const RingingMode& seed : taps[taps.size() / 2].modes) {
    std::vector<double> frequencies, dampings;
    for (const RingingTap& tap : taps)
      for (const RingingMode& mode : tap.modes)
        if (std::abs(mode.frequency_hz / seed.frequency_hz - 1) < kSameMode) {
          frequencies.push_back(mode.frequency_hz);
          dampings.push_back(mode.damping_ratio);
        }
    if (2 * frequencies.size() > taps.size() && common.size() < kModesForetelling)
      common.push_back({median_of_values(frequencies), median_of_values(dampings), seed.energy_part});
  }
  return common;
}

}  // namespace

// Which mode rings loudest depends on how the tap was made: all are asked for the one that is loudest in sum.
Result<TapsFit> fit_taps(const Taps& taps) {
  if (taps.taps.size() < 2)
    return fail(Fault::unsuitable, "one tap has no spread", "taps", "tap ten times or more");
  std::vector<RingingTap> list;
  for (const Tap& tap : taps.taps) {
    const auto ringing = ringing_of(tap, taps.rate_hz);
    if (!ringing) return schema::forward_error(ringing);
    Ringing found = modes_of(*ringing, taps.rate_hz / kDecimation);
    if (found.modes.empty()) return fail(Fault::unsuitable, "nothing rings in it", "tap " + tap.name);
    list.push_back({tap.name, std::move(found.modes), found.left});
  }
  std::vector<RingingMode> all;
  for (const RingingTap& tap : list)
    for (const RingingMode& mode : tap.modes) merge(all, mode);
  const double usual_hz = std::ranges::max_element(all, {}, &RingingMode::energy_part)->frequency_hz;
  for (RingingTap& tap : list) {
    const auto nearest = std::ranges::min_element(tap.modes, {}, [&](const RingingMode& mode) {
      return std::abs(std::log(mode.frequency_hz / usual_hz));
    });
    std::rotate(tap.modes.begin(), nearest, nearest + 1);
  }
  return summed_up(std::move(list));
}

Result<TapsPrediction> foretell_taps(const Taps& taps, std::size_t fitted) {
  const auto split = taps.taps.begin() + static_cast<std::ptrdiff_t>(fitted);
  const auto known = fit_taps({taps.rate_hz, {taps.taps.begin(), split}});
  if (!known) return schema::forward_error(known);
  const auto others = fit_taps({taps.rate_hz, {split, taps.taps.end()}});
  if (!others) return schema::forward_error(others);
  const std::vector<RingingMode> modes = common_modes(known->taps);
  std::vector<double> misses;
  for (auto tap = split; tap != taps.taps.end(); ++tap)
    misses.push_back(miss_of(*ringing_of(*tap, taps.rate_hz), modes, taps.rate_hz / kDecimation));
  TapsPrediction prediction;
  prediction.fitted = fitted;
  prediction.foretold = misses.size();
  prediction.resonance_error = others->resonance_hz.median / known->resonance_hz.median - 1;
  prediction.damping_error = others->damping_ratio.median / known->damping_ratio.median - 1;
  prediction.waveform_error = median_of_values(misses);
  prediction.worst_waveform_error = std::ranges::max(misses);
  return prediction;
}

}  // namespace tacto::analysis
