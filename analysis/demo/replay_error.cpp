// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/demo/replay_error.hpp"

#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

#include "data-schema/base/decibels.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {
namespace {

using Spectrum = std::vector<std::complex<double>>;

// Shifts and compares two signals through one planned transform.
class ReplayComparison {
 public:
  ReplayComparison(const schema::TimeSignal& came, const schema::TimeSignal& target,
                   const spatial::Band& band, double settle_s)
      : rate_hz_(came.sample_rate_hz),
        settle_(static_cast<std::size_t>(settle_s * rate_hz_)),
        length_(came.values.size()),
        fft_(spatial::fast_length(2 * length_)),
        came_(in_band(came.values, band)),
        target_(back(in_band(target.values, band))) {}

  double error_rms(double delay_s) {
    Spectrum shifted = came_;
    const double step = 2 * std::numbers::pi * rate_hz_ / static_cast<double>(fft_.length());
    for (std::size_t k = 0; k < shifted.size(); ++k)
      shifted[k] *= std::polar(1.0, step * static_cast<double>(k) * delay_s);
    const std::vector<double> advanced = back(shifted);
    double sum = 0;
    for (std::size_t i = settle_; i < length_ - settle_; ++i) sum += std::pow(advanced[i] - target_[i], 2);
    return root_mean(sum);
  }

  double target_rms() const {
    double sum = 0;
    for (std::size_t i = settle_; i < length_ - settle_; ++i) sum += target_[i] * target_[i];
    return root_mean(sum);
  }

 private:
  double root_mean(double sum) const { return std::sqrt(sum / static_cast<double>(length_ - 2 * settle_)); }

  Spectrum in_band(std::vector<double> values, const spatial::Band& band) {
    values.resize(fft_.length());
    Spectrum spectrum(fft_.bins());
    fft_.forward(values, spectrum);
    for (std::size_t k = 0; k < spectrum.size(); ++k)
      if (!band.contains(static_cast<double>(k) * rate_hz_ / static_cast<double>(fft_.length())))
        spectrum[k] = 0;
    return spectrum;
  }

  std::vector<double> back(const Spectrum& spectrum) {
    std::vector<double> values(fft_.length());
    fft_.inverse(spectrum, values);
    return values;
  }

  double rate_hz_;
  std::size_t settle_, length_;
  spatial::RealFft fft_;
  Spectrum came_;
  std::vector<double> target_;
};

// Coarse steps find the minimum's surroundings, golden section the minimum: the error has one minimum within
// half a period of 500 Hz.
constexpr double kStepS = 2.5e-4;
constexpr double kResolutionS = 1e-7;

double coarse_delay(ReplayComparison& comparison, double max_delay_s) {
  double best = 0, smallest = comparison.error_rms(0);
  for (double delay = -max_delay_s; delay <= max_delay_s; delay += kStepS) {
    const double error = comparison.error_rms(delay);
    if (error < smallest) best = delay, smallest = error;
  }
  return best;
}

double best_delay(ReplayComparison& comparison, double max_delay_s) {
  constexpr double kGolden = 1 / std::numbers::phi;
  const double start = coarse_delay(comparison, max_delay_s);
  double low = start - kStepS, high = start + kStepS;
  while (high - low > kResolutionS) {
    const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    const bool bottom_is_left = comparison.error_rms(left) < comparison.error_rms(right);
    (bottom_is_left ? high : low) = bottom_is_left ? right : left;
  }
  return (low + high) / 2;
}

}  // namespace

ReplayError replay_error(const schema::TimeSignal& came, const schema::TimeSignal& target,
                         const spatial::Band& band, double settle_s, double max_delay_s) {
  assert(came.values.size() == target.values.size() && came.duration_s() > 2 * settle_s);
  ReplayComparison comparison(came, target, band, settle_s);
  ReplayError found;
  found.delay_s =
      std::round(best_delay(comparison, max_delay_s) / kResolutionS) * kResolutionS + 0.0;  // no -0
  found.error_rms = comparison.error_rms(found.delay_s);
  found.target_rms = comparison.target_rms();
  found.error_db = schema::amplitude_db(found.error_rms / found.target_rms);
  return found;
}

}  // namespace tacto::analysis
