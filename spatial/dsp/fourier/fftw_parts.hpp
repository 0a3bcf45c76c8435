// SPDX-License-Identifier: GPL-3.0-or-later
// Common parts of the users of FFTW: its two precisions under one name, aligned buffers, and the lock of its
// planner. Internal to this folder.
#pragma once

#include <fftw3.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <string>

namespace tacto::spatial {

/// FFTW's planners (of all precisions) share global tables; only execution is thread-safe.
std::mutex& planner_mutex();

template <class Real>
struct Fftw;

template <>
struct Fftw<double> {
  using Plan = fftw_plan;
  using Complex = fftw_complex;
  static constexpr const char* kName = "fftw";
  static Plan plan_complex(int n, Complex* in, Complex* out, unsigned flags) {
    return fftw_plan_dft_1d(n, in, out, FFTW_FORWARD, flags);
  }
  static void execute(Plan plan) { fftw_execute(plan); }
  static void destroy(Plan plan) { fftw_destroy_plan(plan); }
  static void limit_planning(double seconds) { fftw_set_timelimit(seconds); }
  static bool learn(const char* wisdom) { return fftw_import_wisdom_from_string(wisdom) != 0; }
  static char* wisdom() { return fftw_export_wisdom_to_string(); }
  static void free(void* memory) { fftw_free(memory); }
};

template <>
struct Fftw<float> {
  using Plan = fftwf_plan;
  using Complex = fftwf_complex;
  static constexpr const char* kName = "fftwf";
  static Plan plan_complex(int n, Complex* in, Complex* out, unsigned flags) {
    return fftwf_plan_dft_1d(n, in, out, FFTW_FORWARD, flags);
  }
  static void execute(Plan plan) { fftwf_execute(plan); }
  static void destroy(Plan plan) { fftwf_destroy_plan(plan); }
  static void limit_planning(double seconds) { fftwf_set_timelimit(seconds); }
  static bool learn(const char* wisdom) { return fftwf_import_wisdom_from_string(wisdom) != 0; }
  static char* wisdom() { return fftwf_export_wisdom_to_string(); }
  static void free(void* memory) { fftwf_free(memory); }
};

struct FreeBuffer {
  void operator()(void* memory) const { std::free(memory); }
};
template <class T>
using AlignedBuffer = std::unique_ptr<T[], FreeBuffer>;

/// Memory for `count` elements, not initialised, aligned to a cache line, which is enough for any SIMD unit
/// that FFTW uses. Throws bad_alloc.
template <class T>
AlignedBuffer<T> aligned_buffer(std::size_t count) {
  constexpr std::size_t kAlignment = 64;
  const std::size_t bytes = (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
  void* memory = std::aligned_alloc(kAlignment, bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return AlignedBuffer<T>(static_cast<T*>(memory));
}

}  // namespace tacto::spatial
