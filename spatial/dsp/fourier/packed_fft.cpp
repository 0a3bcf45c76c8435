// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier/packed_fft.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <type_traits>

#include "spatial/dsp/fourier/fft_wisdom.hpp"
#include "spatial/dsp/fourier/fftw_parts.hpp"

namespace tacto::spatial {
namespace {

template <class Real>
struct DestroyPlan {
  void operator()(typename Fftw<Real>::Plan plan) const {
    const std::lock_guard lock(planner_mutex());
    Fftw<Real>::destroy(plan);
  }
};
template <class Real>
using PackedPlan = std::unique_ptr<std::remove_pointer_t<typename Fftw<Real>::Plan>, DestroyPlan<Real>>;

// With an estimated plan in single precision, at 2e10 operations per second.
double job_s(std::size_t length, std::size_t expected) {
  const auto n = static_cast<double>(length);
  return static_cast<double>(expected) * 5 * n * std::log2(std::max(n, 2.0)) / 2e10;
}

template <class Real>
void read_wisdom_once() {
  static std::once_flag once;
  std::call_once(once, [] { read_wisdom<Real>(wisdom_path<Real>()); });
}

template <class Real>
struct Buffers {
  int length;
  typename Fftw<Real>::Complex *in, *out;
  typename Fftw<Real>::Plan plan(unsigned flags) const {
    return Fftw<Real>::plan_complex(length, in, out, flags | FFTW_PRESERVE_INPUT);
  }
};

// At the time limit FFTW continues with the best plan so far.
template <class Real>
typename Fftw<Real>::Plan measured(const Buffers<Real>& buffers, double limit_s) {
  Fftw<Real>::limit_planning(limit_s);
  const auto plan = buffers.plan(FFTW_MEASURE);
  Fftw<Real>::limit_planning(FFTW_NO_TIMELIMIT);
  write_wisdom<Real>(wisdom_path<Real>());
  return plan;
}

template <class Real>
typename Fftw<Real>::Plan planned(const Buffers<Real>& buffers, std::size_t expected) {
  const std::lock_guard lock(planner_mutex());
  read_wisdom_once<Real>();
  if (const auto known = buffers.plan(FFTW_MEASURE | FFTW_WISDOM_ONLY)) return known;
  const auto length = static_cast<std::size_t>(buffers.length);
  return measuring_saves_time(length, expected) ? measured(buffers, job_s(length, expected))
                                                : buffers.plan(FFTW_ESTIMATE);
}

}  // namespace

template <class Real>
struct PackedFft<Real>::State {
  using Complex = typename Fftw<Real>::Complex;

  State(std::size_t n, std::size_t expected)
      : length(n),
        in(aligned_buffer<Complex>(n)),
        out(aligned_buffer<Complex>(n)),
        plan(planned(Buffers<Real>{static_cast<int>(n), in.get(), out.get()}, expected)) {
    std::fill_n(&in[0][0], 2 * n, Real{0});  // planning overwrites the buffers
  }

  std::size_t length;
  AlignedBuffer<Complex> in, out;
  PackedPlan<Real> plan;
};

template <class Real>
PackedFft<Real>::PackedFft(std::size_t length, std::size_t expected)
    : state_(std::make_unique<State>(length, expected)) {}
template <class Real>
PackedFft<Real>::PackedFft(PackedFft&&) noexcept = default;
template <class Real>
PackedFft<Real>& PackedFft<Real>::operator=(PackedFft&&) noexcept = default;
template <class Real>
PackedFft<Real>::~PackedFft() = default;

template <class Real>
std::size_t PackedFft<Real>::length() const {
  return state_->length;
}

template <class Real>
std::span<std::complex<Real>> PackedFft<Real>::input() {
  return {reinterpret_cast<std::complex<Real>*>(state_->in.get()), state_->length};
}

template <class Real>
std::span<const std::complex<Real>> PackedFft<Real>::output() const {
  return {reinterpret_cast<const std::complex<Real>*>(state_->out.get()), state_->length};
}

template <class Real>
void PackedFft<Real>::transform() {
  Fftw<Real>::execute(state_->plan.get());
}

template class PackedFft<float>;
template class PackedFft<double>;

bool measuring_saves_time(std::size_t length, std::size_t expected) {
  return job_s(length, expected) > 0.05 + 16e-6 * static_cast<double>(length);
}

bool is_short_job(std::size_t length, std::size_t expected) {
  return job_s(length, expected) < 0.05;
}

}  // namespace tacto::spatial
