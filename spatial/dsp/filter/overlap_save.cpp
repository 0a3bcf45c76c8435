// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/overlap_save.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace tacto::spatial {

KernelSpectrum kernel_spectrum(std::span<const double> taps, std::size_t length) {
  assert(!taps.empty() && 2 * (taps.size() - 1) < length);
  std::vector<double> circle(length, 0.0);
  for (std::size_t k = 0; k < taps.size(); ++k) circle[k] = circle[(length - k) % length] = taps[k];
  RealFft fft(length);
  KernelSpectrum kernel{std::vector<std::complex<double>>(fft.bins()), length, taps.size() - 1};
  fft.forward(circle, kernel.bins);
  return kernel;
}

OverlapSave::OverlapSave(KernelSpectrum kernel)
    : kernel_(std::move(kernel)),
      fft_(kernel_.length),
      block_(kernel_.length),
      result_(kernel_.length),
      spectrum_(kernel_.bins.size()) {
  reset();
}

// A block begins `reach` before the first value of its output.
void OverlapSave::reset() {
  std::ranges::fill(block_, 0.0);
  filled_ = kernel_.reach;
  given_ = 0;
}

void OverlapSave::run_block(std::size_t target, const Sink& sink) {
  fft_.forward(block_, spectrum_);
  for (std::size_t k = 0; k < spectrum_.size(); ++k) spectrum_[k] *= kernel_.bins[k];
  fft_.inverse(spectrum_, result_);
  given_ += target;
  sink(std::span(result_).subspan(kernel_.reach, target));
  std::copy(block_.begin() + static_cast<std::ptrdiff_t>(hop()), block_.end(), block_.begin());
  filled_ = 2 * kernel_.reach;
}

void OverlapSave::push(std::span<const double> values, const Sink& sink) {
  while (!values.empty()) {
    const std::size_t size = std::min(values.size(), kernel_.length - filled_);
    std::ranges::copy(values.first(size), block_.begin() + static_cast<std::ptrdiff_t>(filled_));
    filled_ += size;
    values = values.subspan(size);
    if (filled_ == kernel_.length) run_block(hop(), sink);
  }
}

void OverlapSave::finish(double level, std::size_t count, const Sink& sink) {
  while (given_ < count) {
    std::fill(block_.begin() + static_cast<std::ptrdiff_t>(filled_), block_.end(), level);
    run_block(std::min(hop(), count - given_), sink);
  }
  reset();
}

}  // namespace tacto::spatial
