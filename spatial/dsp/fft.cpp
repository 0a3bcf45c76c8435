// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fft.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cassert>
#include <mutex>

#include "spatial/dsp/fftw_parts.hpp"

namespace tacto::spatial {
namespace {

struct PlanDeleter {
  void operator()(fftw_plan plan) const {
    const std::lock_guard lock(planner_mutex());
    fftw_destroy_plan(plan);
  }
};
using Plan = std::unique_ptr<std::remove_pointer_t<fftw_plan>, PlanDeleter>;

}  // namespace

std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct RealFft::State {
  explicit State(std::size_t n)
      : length(n), time(aligned_buffer<double>(n)), spectrum(aligned_buffer<fftw_complex>(n / 2 + 1)) {}

  fftw_plan plan_forward() {
    if (!to_spectrum) {
      const std::lock_guard lock(planner_mutex());
      to_spectrum.reset(
          fftw_plan_dft_r2c_1d(static_cast<int>(length), time.get(), spectrum.get(), FFTW_ESTIMATE));
    }
    return to_spectrum.get();
  }

  fftw_plan plan_inverse() {
    if (!to_time) {
      const std::lock_guard lock(planner_mutex());
      to_time.reset(
          fftw_plan_dft_c2r_1d(static_cast<int>(length), spectrum.get(), time.get(), FFTW_ESTIMATE));
    }
    return to_time.get();
  }

  std::size_t length;
  AlignedBuffer<double> time;
  AlignedBuffer<fftw_complex> spectrum;
  Plan to_spectrum, to_time;  // planned on first use: most owners go one way only
};

RealFft::RealFft(std::size_t length) : state_(std::make_unique<State>(length)) {
  assert(length >= 1);
}
RealFft::RealFft(RealFft&&) noexcept = default;
RealFft& RealFft::operator=(RealFft&&) noexcept = default;
RealFft::~RealFft() = default;

std::size_t RealFft::length() const {
  return state_->length;
}

void RealFft::forward(std::span<const double> time, std::span<std::complex<double>> spectrum) {
  assert(time.size() == length() && spectrum.size() == bins());
  const fftw_plan plan = state_->plan_forward();
  std::ranges::copy(time, state_->time.get());
  fftw_execute(plan);
  const auto* result = reinterpret_cast<const std::complex<double>*>(state_->spectrum.get());
  std::copy_n(result, bins(), spectrum.begin());
}

void RealFft::inverse(std::span<const std::complex<double>> spectrum, std::span<double> time) {
  assert(time.size() == length() && spectrum.size() == bins());
  const fftw_plan plan = state_->plan_inverse();
  std::ranges::copy(spectrum, reinterpret_cast<std::complex<double>*>(state_->spectrum.get()));
  fftw_execute(plan);
  const double scale = 1 / static_cast<double>(length());
  std::transform(state_->time.get(), state_->time.get() + length(), time.begin(),
                 [scale](double value) { return value * scale; });
}

std::size_t fast_length(std::size_t n) {
  for (std::size_t candidate = std::max<std::size_t>(n, 1);; ++candidate) {
    std::size_t rest = candidate;
    for (const std::size_t factor : {2U, 3U, 5U, 7U})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return candidate;
  }
}

}  // namespace tacto::spatial
