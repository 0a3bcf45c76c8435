// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/packed_fft.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <type_traits>

#include "spatial/dsp/fft_wisdom.hpp"
#include "spatial/dsp/fftw_parts.hpp"

namespace tacto::spatial {
namespace {

struct DestroyPlan {
  void operator()(fftwf_plan plan) const {
    const std::lock_guard lock(planner_mutex());
    fftwf_destroy_plan(plan);
  }
};
using Plan = std::unique_ptr<std::remove_pointer_t<fftwf_plan>, DestroyPlan>;

// By an estimated plan, at the 2e10 operations a second that such plans reach.
double job_s(std::size_t length, std::size_t expected) {
  const auto n = static_cast<double>(length);
  return static_cast<double>(expected) * 5 * n * std::log2(std::max(n, 2.0)) / 2e10;
}

void read_wisdom_once() {
  static std::once_flag once;
  std::call_once(once, [] { read_wisdom(wisdom_path()); });
}

struct Buffers {
  int length;
  fftwf_complex *in, *out;
  fftwf_plan plan(unsigned flags) const {
    return fftwf_plan_dft_1d(length, in, out, FFTW_FORWARD, flags | FFTW_PRESERVE_INPUT);
  }
};

// Stopped at the limit, FFTW goes on with what it has.
fftwf_plan measured(const Buffers& buffers, double limit_s) {
  fftwf_set_timelimit(limit_s);
  const fftwf_plan plan = buffers.plan(FFTW_MEASURE);
  fftwf_set_timelimit(FFTW_NO_TIMELIMIT);
  write_wisdom(wisdom_path());
  return plan;
}

fftwf_plan planned(const Buffers& buffers, std::size_t expected) {
  const std::lock_guard lock(planner_mutex());
  read_wisdom_once();
  if (const fftwf_plan known = buffers.plan(FFTW_MEASURE | FFTW_WISDOM_ONLY)) return known;
  const auto length = static_cast<std::size_t>(buffers.length);
  return measuring_pays(length, expected) ? measured(buffers, job_s(length, expected))
                                          : buffers.plan(FFTW_ESTIMATE);
}

}  // namespace

struct PackedFft::State {
  State(std::size_t n, std::size_t expected)
      : length(n),
        in(aligned_buffer<fftwf_complex>(n)),
        out(aligned_buffer<fftwf_complex>(n)),
        plan(planned({static_cast<int>(n), in.get(), out.get()}, expected)) {
    std::fill_n(&in[0][0], 2 * n, 0.0F);  // planning writes on the buffers
  }

  std::size_t length;
  AlignedBuffer<fftwf_complex> in, out;
  Plan plan;
};

PackedFft::PackedFft(std::size_t length, std::size_t expected)
    : state_(std::make_unique<State>(length, expected)) {}
PackedFft::PackedFft(PackedFft&&) noexcept = default;
PackedFft& PackedFft::operator=(PackedFft&&) noexcept = default;
PackedFft::~PackedFft() = default;

std::size_t PackedFft::length() const {
  return state_->length;
}

std::span<std::complex<float>> PackedFft::input() {
  return {reinterpret_cast<std::complex<float>*>(state_->in.get()), state_->length};
}

std::span<const std::complex<float>> PackedFft::output() const {
  return {reinterpret_cast<const std::complex<float>*>(state_->out.get()), state_->length};
}

void PackedFft::transform() {
  fftwf_execute(state_->plan.get());
}

bool measuring_pays(std::size_t length, std::size_t expected) {
  return job_s(length, expected) > 0.05 + 16e-6 * static_cast<double>(length);
}

}  // namespace tacto::spatial
