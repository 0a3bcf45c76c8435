// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier/packed_fft.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>
#include <type_traits>

#include "data-schema/files/files.hpp"
#include "spatial/dsp/fourier/fftw_parts.hpp"
#include "spatial/dsp/fourier/simd_clones.hpp"

namespace tacto::spatial {
namespace {

namespace fs = std::filesystem;

fs::path folder_named(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path folder = value == nullptr ? "" : value;
  return folder.is_absolute() ? folder : fs::path();
}

fs::path cache_folder() {
  if (const fs::path folder = folder_named("XDG_CACHE_HOME"); !folder.empty()) return folder;
  const fs::path home = folder_named("HOME");
  return home.empty() ? home : home / ".cache";
}

// A complex array as plain numbers, which compilers can vectorise; std::complex has the same layout.
template <class Real>
const Real* numbers(PackedSpectrum<Real> z) {
  return reinterpret_cast<const Real*>(z.data());
}

template <class Real>
TACTO_SIMD_CLONES void pack_level(const Frame& a, const Frame& b, std::span<const float> window,
                                  Real* __restrict out) {
  const float* __restrict w = window.data();
  const float* __restrict x = a.samples;
  const float* __restrict y = b.samples;
  const auto level_x = static_cast<Real>(a.level), level_y = static_cast<Real>(b.level);
  for (std::size_t n = 0; n < window.size(); ++n) {
    const Real weight = w[n];
    out[2 * n] = weight * (x[n] - level_x);
    out[2 * n + 1] = weight * (y[n] - level_y);
  }
}

template <class Real>
TACTO_SIMD_CLONES void pack_sloping(const Frame& a, const Frame& b, std::span<const float> window,
                                    Real* __restrict out) {
  const auto level_a = static_cast<Real>(a.level), level_b = static_cast<Real>(b.level);
  const auto slope_a = static_cast<Real>(a.slope), slope_b = static_cast<Real>(b.slope);
  const auto count = static_cast<int>(window.size());  // converts to a float in one instruction
  for (int n = 0; n < count; ++n) {
    const auto at = static_cast<Real>(n);
    const Real weight = window[n];
    Real* const pair = out + std::ptrdiff_t{2} * n;
    pair[0] = weight * (a.samples[n] - level_a + slope_a * at);
    pair[1] = weight * (b.samples[n] - level_b + slope_b * at);
  }
}

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
std::string wisdom_path() {
  const fs::path folder = cache_folder();
  return folder.empty() ? "" : (folder / "tactograph" / Fftw<Real>::kName).string() + ".wisdom";
}

template <class Real>
bool read_wisdom(const std::string& path) {
  const auto text = schema::read_file(path);
  return text && Fftw<Real>::learn(text->c_str());
}

template <class Real>
bool write_wisdom(const std::string& path) {
  if (path.empty()) return false;
  read_wisdom<Real>(path);  // another process may have added to it since
  const std::unique_ptr<char, void (*)(void*)> text(Fftw<Real>::wisdom(), Fftw<Real>::free);
  if (!text) return false;
  std::error_code ignored;
  fs::create_directories(fs::path(path).parent_path(), ignored);
  schema::PendingFiles files;
  return files.write(path, text.get()) && files.commit();
}

template std::string wisdom_path<float>();
template std::string wisdom_path<double>();
template bool read_wisdom<float>(const std::string&);
template bool read_wisdom<double>(const std::string&);
template bool write_wisdom<float>(const std::string&);
template bool write_wisdom<double>(const std::string&);

template <class Real>
void pack_frames(const Frame& a, const Frame& b, std::span<const float> window,
                 std::span<std::complex<Real>> packed) {
  assert(window.size() <= packed.size());
  auto* out = reinterpret_cast<Real*>(packed.data());
  if (a.slope == 0 && b.slope == 0)
    pack_level(a, b, window, out);
  else
    pack_sloping(a, b, window, out);
}

template <class Real>
TACTO_SIMD_CLONES void unpack_powers(PackedSpectrum<Real> z, std::span<float> a, std::span<float> b) {
  assert(a.size() == b.size() && a.size() <= z.size() / 2 + 1);
  if (a.empty()) return;
  const Real* __restrict up = numbers(z);
  const Real* __restrict down = up + 2 * z.size();  // Z_-k = Z_(length - k)
  float* __restrict power_a = a.data();
  float* __restrict power_b = b.data();
  power_a[0] = static_cast<float>(up[0] * up[0]);
  power_b[0] = static_cast<float>(up[1] * up[1]);
  const auto bins = static_cast<std::ptrdiff_t>(a.size());
  for (std::ptrdiff_t k = 1; k < bins; ++k) {
    const Real re = up[2 * k], im = up[2 * k + 1], twin_re = down[-2 * k], twin_im = down[-2 * k + 1];
    const Real a_re = re + twin_re, a_im = im - twin_im, b_re = im + twin_im, b_im = twin_re - re;
    power_a[k] = static_cast<float>(Real{0.25} * (a_re * a_re + a_im * a_im));
    power_b[k] = static_cast<float>(Real{0.25} * (b_re * b_re + b_im * b_im));
  }
}

template <class Real>
void unpack_spectra(PackedSpectrum<Real> z, std::span<std::complex<float>> a,
                    std::span<std::complex<float>> b) {
  assert(a.size() == b.size() && a.size() <= z.size() / 2 + 1);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::complex<Real> here = z[k], twin = std::conj(z[k == 0 ? 0 : z.size() - k]);
    a[k] = std::complex<float>(Real{0.5} * (here + twin));
    b[k] = std::complex<float>(std::complex<Real>(0, Real{-0.5}) * (here - twin));
  }
}

template void pack_frames<float>(const Frame&, const Frame&, std::span<const float>,
                                 std::span<std::complex<float>>);
template void pack_frames<double>(const Frame&, const Frame&, std::span<const float>,
                                  std::span<std::complex<double>>);
template void unpack_powers<float>(PackedSpectrum<float>, std::span<float>, std::span<float>);
template void unpack_powers<double>(PackedSpectrum<double>, std::span<float>, std::span<float>);
template void unpack_spectra<float>(PackedSpectrum<float>, std::span<std::complex<float>>,
                                    std::span<std::complex<float>>);
template void unpack_spectra<double>(PackedSpectrum<double>, std::span<std::complex<float>>,
                                     std::span<std::complex<float>>);

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
