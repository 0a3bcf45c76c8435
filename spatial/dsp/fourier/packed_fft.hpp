// SPDX-License-Identifier: GPL-3.0-or-later
// Complex Fourier transforms of one length, for two real frames at a time. Offline use.
#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace tacto::spatial {

// FFTW's wisdom (its measured plans for this machine), kept between runs in the user's cache folder. There
// are no errors: without a folder that can be read or written, nothing is kept.

/// The file fftwf.wisdom for Real = float, fftw.wisdom for double, in $XDG_CACHE_HOME/tactograph/, else in
/// ~/.cache/tactograph/. Empty if the environment names no folder (or, against the XDG specification, a
/// relative one).
template <class Real>
std::string wisdom_path();

/// Adds a file's wisdom to FFTW's. A file that is absent, damaged, or of another FFTW or processor is
/// ignored. Returns whether it was used. Precondition: the planner is locked.
template <class Real>
bool read_wisdom(const std::string& path);

/// Merges FFTW's wisdom with the file's and writes the file as a whole; makes the folder if necessary.
/// Returns whether it was written. Precondition: the planner is locked.
template <class Real>
bool write_wisdom(const std::string& path);

// Two real frames in one complex transform: z = a + i b gives A_k = (Z_k + conj Z_-k) / 2 and B_k = (Z_k -
// conj Z_-k) / 2i (Press et al., Numerical Recipes, 12.3). Only arithmetic, no allocation. Real is float or
// double.

template <class Real>
using PackedSpectrum = std::span<const std::complex<Real>>;

/// One frame: its samples, the level that is subtracted from them, and the slope of a straight line that is
/// added.
struct Frame {
  const float* samples = nullptr;
  double level = 0;
  double slope = 0;  ///< per sample
};

/// packed_n = w_n (a_n - level_a + slope_a n) + i w_n (b_n - level_b + slope_b n) for every n of the window,
/// in single precision; the rest of `packed` is not changed.
template <class Real>
void pack_frames(const Frame& a, const Frame& b, std::span<const float> window,
                 std::span<std::complex<Real>> packed);

/// |A_k|^2 and |B_k|^2 for k from 0, as many as the rows hold: at most half the transform's length, plus one.
template <class Real>
void unpack_powers(PackedSpectrum<Real> z, std::span<float> a, std::span<float> b);

/// A_k and B_k themselves.
template <class Real>
void unpack_spectra(PackedSpectrum<Real> z, std::span<std::complex<float>> a,
                    std::span<std::complex<float>> b);

/// A planned transform with its buffers; reuse it for many frames. Not shared between threads.
///   Z_k = sum_n z_n exp(-2 pi i k n / length)
/// Real is float or double. Error of the whole spectrum (root of the sum of squares), for lengths to 2^16:
/// about 2e-7 of it in single precision, 4e-16 in double.
template <class Real>
class PackedFft {
 public:
  /// `expected` is the number of transforms. A measured plan in the user's cache is used if
  /// there is one. Otherwise a plan is measured and stored there if that takes no longer than the transforms;
  /// otherwise FFTW estimates one. Plans differ by rounding only. Throws bad_alloc.
  PackedFft(std::size_t length, std::size_t expected);
  PackedFft(PackedFft&&) noexcept;
  PackedFft& operator=(PackedFft&&) noexcept;
  ~PackedFft();

  std::size_t length() const;
  /// Zeros at first; transform() does not change it.
  std::span<std::complex<Real>> input();
  /// Of the last transform().
  std::span<const std::complex<Real>> output() const;
  void transform();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether the measurement of a plan saves time for so many transforms: it takes 0.05 s + 16 us per sample on
/// the machine of tests/MEASURED.md, and the transforms must take longer than that.
bool measuring_saves_time(std::size_t length, std::size_t expected);

/// Whether so many transforms take at most about 0.05 s, so that double precision, which takes twice as long,
/// is acceptable.
bool is_short_job(std::size_t length, std::size_t expected);

}  // namespace tacto::spatial
