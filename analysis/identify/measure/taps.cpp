// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/taps.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "analysis/identify/measure/number_table.hpp"
#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

using Complex = std::complex<double>;

constexpr double kAfterPeakS = 1e-3, kRingingS = 12e-3;
constexpr std::size_t kDecimation = 4, kLeastRinging = 100;
constexpr Index kPoles = 16, kSharedPoles = 20;
constexpr double kLowestModeHz = 50;
constexpr double kSameMode = 0.03;
constexpr double kOfWeight = 0.2;   // of the strongest mode's energy
constexpr double kLoudRinging = 5;  // RMS over that of the silence before the tap
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
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto [least, most] = std::ranges::minmax(values);
  return {median, kMadToSigma * median_of_values(std::move(distances)), std::sqrt(squares / (count - 1)),
          least, most};
}

double rms_of(const VectorXd& x) {
  return schema::rms_of({x.data(), static_cast<std::size_t>(x.size())});
}

// The ringing of a tap without its baseline, at a quarter of the rate.
Result<VectorXd> ringing_of(const Tap& tap, double rate_hz) {
  const auto& y = tap.value;
  for (std::size_t i = 0; i < y.size(); ++i)
    if (!std::isfinite(y[i]))
      return fail(ErrorKind::unsuitable, "a value is not a number",
                  fmt::format("tap {}, sample {}", tap.name, i + 1));
  const auto peak = static_cast<std::size_t>(
      std::ranges::max_element(y, {}, [](double v) { return std::abs(v); }) - y.begin());
  const auto first = peak + static_cast<std::size_t>(kAfterPeakS * rate_hz);
  const auto count =
      std::min(y.size() - std::min(first, y.size()), static_cast<std::size_t>(kRingingS * rate_hz)) /
      kDecimation;
  if (count < kLeastRinging || peak < kLeastRinging)
    return fail(ErrorKind::unsuitable, "too short: it needs silence before the tap and ringing after it",
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
  return fail(ErrorKind::unsuitable, "it contains only noise, no ringing", "tap " + tap.name, "omit it");
}

// The signal poles z of y[n] = sum c z^n, shared by all ringings, by the matrix pencil of the right singular
// vectors of their stacked Hankel matrices. Growing poles are left out, because a ringing decays.
VectorXcd pencil_poles(const std::vector<VectorXd>& ringings, Index poles) {
  const Index columns = ringings.front().size() / 2;
  MatrixXd gram = MatrixXd::Zero(columns + 1, columns + 1);
  for (const VectorXd& y : ringings)
    for (Index i = 0; i + columns < y.size(); ++i)
      gram.selfadjointView<Eigen::Lower>().rankUpdate(y.segment(i, columns + 1));
  const Eigen::SelfAdjointEigenSolver<MatrixXd> vectors(gram);
  const MatrixXd v = vectors.eigenvectors().rightCols(poles);
  const MatrixXd shift = v.topRows(columns).colPivHouseholderQr().solve(v.bottomRows(columns));
  const VectorXcd all = Eigen::EigenSolver<MatrixXd>(shift).eigenvalues();
  std::vector<Complex> kept;
  for (const Complex& z : all)
    if (std::abs(z) < 1) kept.push_back(z);
  return Eigen::Map<const VectorXcd>(kept.data(), static_cast<Index>(kept.size()));
}

MatrixXcd powers_of(const VectorXcd& z, Index from, Index count) {
  MatrixXcd basis(count, z.size());
  for (Index k = 0; k < z.size(); ++k)
    for (Index n = 0; n < count; ++n) basis(n, k) = std::pow(z[k], static_cast<double>(from + n));
  return basis;
}

struct Ringing {
  std::vector<RingingMode> modes;
  double left = 0;
};

// A mode is one pole, or several with nearly the same frequency, and their contribution to the signal.
struct ModeGroup {
  RingingMode mode;
  double weight = 0;
  VectorXd part;
};

void add_to_groups(std::vector<ModeGroup>& groups, const RingingMode& mode, const VectorXd& part) {
  const double weight = part.squaredNorm();
  const auto same = std::ranges::find_if(groups, [&](const ModeGroup& group) {
    return std::abs(group.mode.frequency_hz / mode.frequency_hz - 1) < kSameMode;
  });
  if (same == groups.end()) return groups.push_back({mode, weight, part});
  const double share = weight / (weight + same->weight);
  same->mode.frequency_hz = std::lerp(same->mode.frequency_hz, mode.frequency_hz, share);
  same->mode.damping_ratio = std::lerp(same->mode.damping_ratio, mode.damping_ratio, share);
  same->weight += weight;
  same->part += part;
}

VectorXcd amplitudes_of(const VectorXcd& z, const VectorXd& y) {
  return powers_of(z, 0, y.size()).colPivHouseholderQr().solve(y.cast<Complex>());
}

Ringing modes_of(const VectorXd& y, double rate_hz) {
  const VectorXcd z = pencil_poles({y}, kPoles);
  const MatrixXcd basis = powers_of(z, 0, y.size());
  const VectorXcd c = amplitudes_of(z, y);
  std::vector<ModeGroup> groups;
  for (Index k = 0; k < z.size(); ++k) {
    const Complex s = std::log(z[k]) * rate_hz;
    if (s.imag() < 2 * std::numbers::pi * kLowestModeHz) continue;
    const RingingMode mode{std::abs(s) / (2 * std::numbers::pi), -s.real() / std::abs(s), 0};
    add_to_groups(groups, mode, 2 * (basis.col(k) * c[k]).real());
  }
  Ringing ringing;
  for (ModeGroup& group : groups) {
    group.mode.energy_part = group.part.squaredNorm() / y.squaredNorm();
    ringing.modes.push_back(group.mode);
  }
  std::ranges::sort(ringing.modes, std::greater{}, &RingingMode::energy_part);
  ringing.left = (y - (basis * c).real()).norm() / y.norm();
  return ringing;
}

// Errors of a ringing with the poles of other taps: amplitudes from its first quarter, or from the whole
// ringing.
struct Miss {
  double predicted = 0, shaped = 0;
};

Miss miss_of(const VectorXd& y, const VectorXcd& z) {
  const Index known = y.size() / 4, rest = y.size() - known;
  const VectorXd ahead = (powers_of(z, known, rest) * amplitudes_of(z, y.head(known))).real();
  const VectorXd whole = (powers_of(z, 0, y.size()) * amplitudes_of(z, y)).real();
  return {(y.tail(rest) - ahead).norm() / y.tail(rest).norm(), (y - whole).norm() / y.norm()};
}

TapsFit summed_up(std::vector<RingingTap> taps) {
  std::vector<double> frequencies, dampings, explained;
  for (const RingingTap& tap : taps) {
    explained.push_back(1 - tap.left * tap.left);
    frequencies.push_back(tap.modes.front().frequency_hz);
    dampings.push_back(tap.modes.front().damping_ratio);
  }
  return {median_of_values(std::move(explained)), std::move(taps), spread_of(frequencies),
          spread_of(dampings)};
}

// Modes of all taps, with the sum of their energies.
std::vector<RingingMode> shared_modes(const std::vector<RingingTap>& taps) {
  std::vector<RingingMode> all;
  for (const RingingTap& tap : taps)
    for (const RingingMode& mode : tap.modes) {
      const auto same = std::ranges::find_if(all, [&](const RingingMode& other) {
        return std::abs(other.frequency_hz / mode.frequency_hz - 1) < kSameMode;
      });
      if (same != all.end())
        same->energy_part += mode.energy_part;
      else
        all.push_back(mode);
    }
  return all;
}

// The band of a sensor ends at its first resonance, even if a hard tap excites a higher one more.
double first_resonance_hz(const std::vector<RingingTap>& taps) {
  std::vector<RingingMode> all = shared_modes(taps);
  const double most = std::ranges::max_element(all, {}, &RingingMode::energy_part)->energy_part;
  std::erase_if(all, [&](const RingingMode& mode) { return mode.energy_part < kOfWeight * most; });
  return std::ranges::min_element(all, {}, &RingingMode::frequency_hz)->frequency_hz;
}

}  // namespace

// The strongest mode depends on the tap, so all taps use the mode nearest the common first resonance.
Result<TapsFit> fit_taps(const Taps& taps) {
  if (taps.taps.size() < 2)
    return fail(ErrorKind::unsuitable, "one tap has no spread", "taps", "tap ten times or more");
  std::vector<RingingTap> list;
  for (const Tap& tap : taps.taps) {
    const auto ringing = ringing_of(tap, taps.rate_hz);
    TACTO_TRY(ringing);
    Ringing found = modes_of(*ringing, taps.rate_hz / kDecimation);
    if (found.modes.empty()) return fail(ErrorKind::unsuitable, "it contains no ringing", "tap " + tap.name);
    list.push_back({tap.name, std::move(found.modes), found.left});
  }
  const double usual_hz = first_resonance_hz(list);
  for (RingingTap& tap : list) {
    const auto nearest = std::ranges::min_element(tap.modes, {}, [&](const RingingMode& mode) {
      return std::abs(std::log(mode.frequency_hz / usual_hz));
    });
    std::rotate(tap.modes.begin(), nearest, nearest + 1);
  }
  return summed_up(std::move(list));
}

Result<TapsPrediction> predict_taps(const Taps& taps, std::size_t fitted) {
  const auto split = taps.taps.begin() + static_cast<std::ptrdiff_t>(fitted);
  const auto known = fit_taps({taps.rate_hz, {taps.taps.begin(), split}});
  TACTO_TRY(known);
  const auto others = fit_taps({taps.rate_hz, {split, taps.taps.end()}});
  TACTO_TRY(others);
  std::vector<VectorXd> ringings;
  for (auto tap = taps.taps.begin(); tap != split; ++tap) ringings.push_back(*ringing_of(*tap, taps.rate_hz));
  const auto same_length = [&](const VectorXd& y) { return y.size() == ringings.front().size(); };
  if (!std::ranges::all_of(ringings, same_length))
    return fail(ErrorKind::unsuitable, "the taps are not equally long", "taps",
                "cut them to the same length");
  const VectorXcd poles = pencil_poles(ringings, kSharedPoles);
  std::vector<double> predicted, shaped;
  for (auto tap = split; tap != taps.taps.end(); ++tap) {
    const Miss miss = miss_of(*ringing_of(*tap, taps.rate_hz), poles);
    predicted.push_back(miss.predicted);
    shaped.push_back(miss.shaped);
  }
  TapsPrediction prediction;
  prediction.fitted = fitted;
  prediction.predicted = predicted.size();
  prediction.resonance_error = others->resonance_hz.median / known->resonance_hz.median - 1;
  prediction.damping_error = others->damping_ratio.median / known->damping_ratio.median - 1;
  prediction.worst_waveform_error = std::ranges::max(predicted);
  prediction.waveform_error = median_of_values(std::move(predicted));
  prediction.shape_error = median_of_values(std::move(shaped));
  return prediction;
}

schema::Result<Taps> read_taps(const std::string& path, double rate_hz) {
  const auto table = read_numbers(path);
  TACTO_TRY(table);
  if (table->names.size() < 2)
    return schema::fail(schema::ErrorKind::malformed,
                        "it has one column: taps need a column of tap numbers and one of values", path);
  Taps taps{rate_hz, {}};
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const std::string name = fmt::format("{:g}", table->at(row, 0));
    if (taps.taps.empty() || taps.taps.back().name != name) taps.taps.push_back({name, {}});
    taps.taps.back().value.push_back(table->at(row, table->names.size() - 1));
  }
  return taps;
}

}  // namespace tacto::analysis
