// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/numbers/line_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>

#include "data-schema/base/decibels.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/numbers/parabolic_peak.hpp"
#include "spatial/numbers/robust_statistics.hpp"

namespace tacto::spatial {
namespace {

constexpr double kNoiseBandwidth = 1.7268;  // bins, of a Blackman window (Harris 1978, table 1)
constexpr double kIndependent = 0.4;  // of a window: Blackman windows that far apart are almost uncorrelated
constexpr double kGuard = 3.5, kReach = 16;  // unpadded bins
constexpr std::size_t kFewestCells = 8;
constexpr double kOneIn10000 = 3.719;  // quantile of the normal distribution
constexpr double kLeakage_db = 55;     // Blackman's highest side lobe is 58 dB down

double blackman_at(double part) {
  const double phase = 2 * std::numbers::pi * part;
  return 0.42 - 0.5 * std::cos(phase) + 0.08 * std::cos(2 * phase);
}

// Quantile of a sum of n exponential variables over its mean (Wilson and Hilferty 1931, with 2 n degrees of
// freedom).
double gamma_quantile(double looks, double normal_quantile) {
  return std::pow(1 - 1 / (9 * looks) + normal_quantile / (3 * std::sqrt(looks)), 3);
}

double level_of(double power) {
  return schema::power_db(power);
}

// Mean of the periodograms of Blackman windows, one-sided density.
class MeanSpectrum {
 public:
  MeanSpectrum(std::span<const double> values, double pitch, std::size_t window, std::size_t hop)
      : weights_(window), fft_(fast_length(2 * window)), frame_(fft_.length(), 0.0), spectrum_(fft_.bins()) {
    for (std::size_t n = 0; n < window; ++n)
      weights_[n] = blackman_at(static_cast<double>(n) / static_cast<double>(window));
    mean_.assign(fft_.bins(), 0);
    std::size_t count = 0;
    for (std::size_t from = 0; from + window <= values.size(); from += hop, ++count)
      add(values.subspan(from, window));
    const double power = std::inner_product(weights_.begin(), weights_.end(), weights_.begin(), 0.0);
    for (double& value : mean_) value *= 2 * pitch / (power * static_cast<double>(count));
    step_ = 1 / (static_cast<double>(fft_.length()) * pitch);
  }
  std::vector<double> mean_;
  double step_ = 0;

 private:
  void add(std::span<const double> part) {
    const double middle = std::accumulate(part.begin(), part.end(), 0.0) / static_cast<double>(part.size());
    for (std::size_t n = 0; n < part.size(); ++n) frame_[n] = weights_[n] * (part[n] - middle);
    fft_.forward(frame_, spectrum_);
    for (std::size_t k = 0; k < mean_.size(); ++k) mean_[k] += std::norm(spectrum_[k]);
  }

  std::vector<double> weights_;
  RealFft fft_;
  std::vector<double> frame_;
  std::vector<std::complex<double>> spectrum_;
};

// The exponent a of f^a, fitted to the bins first to last at equidistant places of log f.
double exponent_of(const std::vector<double>& mean, std::size_t first, std::size_t last) {
  constexpr int kPlaces = 64;
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < kPlaces; ++i) {
    const double part = static_cast<double>(i) / (kPlaces - 1);
    const auto bin = static_cast<std::size_t>(std::lround(
        static_cast<double>(first) * std::pow(static_cast<double>(last) / static_cast<double>(first), part)));
    if (!(mean[bin] > 0)) continue;
    x.push_back(std::log(static_cast<double>(bin)));
    y.push_back(std::log(mean[bin]));
  }
  return robust_slope(x, y);
}

}  // namespace

LineSpectrum::LineSpectrum(std::span<const double> values, double pitch, double low, double high) {
  const std::size_t window = values.size() / 2;
  const MeanSpectrum spectrum(values, pitch, window, std::max<std::size_t>(1, window / 8));
  step_ = spectrum.step_;
  window_ = static_cast<double>(window) * pitch;
  resolution_ = kNoiseBandwidth / window_;
  looks_ = 1 + (static_cast<double>(values.size()) * pitch - window_) / (kIndependent * window_);
  needed_db_ = level_of(gamma_quantile(looks_, kOneIn10000));
  low_ = std::max(low + resolution_, 3 / window_);
  high_ = std::min(high - resolution_, step_ * static_cast<double>(spectrum.mean_.size() - 3));
  first_bin_ = static_cast<std::size_t>(std::ceil(low_ / step_));
  if (!(low_ + 8 * resolution_ < high_)) return;
  find_background(spectrum.mean_, step_);
  find_lines(spectrum.mean_, step_);
}

void LineSpectrum::find_background(const std::vector<double>& mean, double step) {
  const auto last = static_cast<std::size_t>(high_ / step);
  const double exponent = exponent_of(mean, first_bin_, last);
  const auto trend = [&](std::size_t bin) { return std::pow(static_cast<double>(bin), exponent); };
  const auto bins = [&](double unpadded) {
    return static_cast<std::size_t>(std::lround(unpadded / (window_ * step)));
  };
  const std::size_t guard = bins(kGuard), reach = bins(kReach);
  std::vector<double> cells;
  for (std::size_t bin = first_bin_; bin <= last; ++bin) {
    cells.clear();
    for (std::size_t b = std::max(first_bin_, bin > reach ? bin - reach : 0);
         b <= std::min(last, bin + reach); ++b)
      if ((b > bin ? b - bin : bin - b) >= guard) cells.push_back(mean[b] / trend(b));
    const bool enough = cells.size() >= kFewestCells;
    background_.push_back(enough ? median_of(cells) * trend(bin) / gamma_quantile(looks_, 0)
                                 : std::numeric_limits<double>::quiet_NaN());
  }
}

double LineSpectrum::background_at(double frequency) const {
  const double bin = frequency / step_ - static_cast<double>(first_bin_);
  if (background_.empty() || !(bin > -0.5) || bin > static_cast<double>(background_.size()) - 0.5)
    return std::numeric_limits<double>::quiet_NaN();
  return background_[std::min(background_.size() - 1,
                              static_cast<std::size_t>(std::lround(std::max(bin, 0.0))))];
}

// Among neighbours within a main lobe (3 unpadded bins) only the largest counts.
void LineSpectrum::find_lines(const std::vector<double>& mean, double step) {
  const auto lobe = static_cast<std::size_t>(std::lround(2 / (window_ * step)));
  const double strongest = level_of(*std::ranges::max_element(mean));
  for (std::size_t i = 1; i + 1 < background_.size(); ++i) {
    const std::size_t bin = first_bin_ + i;
    const auto from = mean.begin() + static_cast<std::ptrdiff_t>(bin - std::min(lobe, bin));
    const auto to = mean.begin() + static_cast<std::ptrdiff_t>(std::min(mean.size(), bin + lobe + 1));
    if (!(mean[bin] > 0) || std::max_element(from, to) != mean.begin() + static_cast<std::ptrdiff_t>(bin))
      continue;
    const auto [offset, top] =
        parabolic_peak(level_of(mean[bin - 1]), level_of(mean[bin]), level_of(mean[bin + 1]));
    const double prominence = top - level_of(background_[i]);
    if (!(prominence >= needed_db_) || top < strongest - kLeakage_db) continue;
    const double ratio = schema::power_of_db(prominence) * looks_;
    const double sigma = std::max(1.8 * 0.39 / (window_ * std::sqrt(ratio)), 0.03 * resolution_);
    lines_.push_back({(static_cast<double>(bin) + offset) * step, sigma,
                      schema::power_of_db(top) * resolution_, prominence});
  }
}

double LineSpectrum::prominence_db(double power, double frequency) const {
  const double background = background_at(frequency);
  return background > 0 ? level_of(power / (resolution_ * background))
                        : -std::numeric_limits<double>::infinity();
}

double LineSpectrum::clutter(double frequency) const {
  const double from = std::max(low_, frequency / 2), to = std::min(high_, frequency * 2);
  double count = 1;
  for (const SpectralLine& line : lines_) count += line.frequency >= from && line.frequency <= to ? 1 : 0;
  return count / std::max(to - from, resolution_);
}

}  // namespace tacto::spatial
