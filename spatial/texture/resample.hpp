// SPDX-License-Identifier: GPL-3.0-or-later
// f(x_i) = S_f(S_x^-1(x_i)): values over time to an even grid in space (Wiertlewski 2011, its chain's second
// step), by one of the known methods.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"
#include "spatial/dsp/resample/hermite_resampler.hpp"
#include "spatial/dsp/resample/windowed_sinc.hpp"
#include "spatial/strokes/monotone_path.hpp"

namespace tacto::spatial {

/// The method of resampling to space. Error: RMS relative to that of the force, for a surface of one line
/// every 0.4 mm, or every 0.1 mm (125 and 500 Hz), under a finger of 50 mm/s whose speed varies by a tenth,
/// at 10 kHz and with exact positions (asserted by resample_test). Straight lines and the PCHIP of exchanged
/// axes were slower than hermite and no better (DECISIONS.md).
enum class ResampleMethod {
  hermite,  ///< monotone cubics, true inverse of S_x. Error 1.1e-4, 3.2e-3: the monotone cubic flattens peaks
  sinc,     ///< windowed sinc of 32 samples at the true inverse's time. Error 3.1e-7, 3e-7. Ten times slower
};

/// "hermite", "sinc".
std::string_view name_of(ResampleMethod method);

/// The highest frequency, Hz, at which a method keeps nine tenths of the amplitude: 0.24 of the sample rate
/// with the cubics, 0.45 with the windowed sinc (resample_test). Above it, the missing part has become images
/// at other frequencies.
double kept_hz(ResampleMethod method, double sample_rate_hz);

/// Samples beyond each end of a path that a method uses: with this margin its values at the ends are those of
/// the whole signal.
std::size_t margin_of(ResampleMethod method);

/// Positions (first + i) pitch_m on the bench, i = 0 ... count - 1.
struct SpaceGrid {
  double pitch_m = 1e-6;
  double first = 0;
  std::size_t count = 0;
  double origin_m() const { return first * pitch_m; }
  double position_m(std::size_t i) const { return (first + static_cast<double>(i)) * pitch_m; }
};

/// The multiples of the pitch that the path covers. Errors: unsuitable, for fewer than two of them and for
/// more than 1e9.
schema::Result<SpaceGrid> grid_along(const MonotonePath& path, int direction, double pitch_m);

/// Resamples stroke after stroke to space and keeps its buffers between them. Not shared between threads.
class Resampler {
 public:
  explicit Resampler(ResampleMethod method = ResampleMethod::hermite);

  /// Values at the grid's positions, by increasing position; out.size() = grid.count. values[i] belongs to
  /// sample i - margin of the path's time; there are at least 2 and they cover the path. Beyond them each
  /// method extrapolates as its kernel does. The path has at least 2 knots.
  void operator()(const MonotonePath& path, int direction, const SpaceGrid& grid,
                  std::span<const double> values, std::size_t margin, std::span<double> out);

 private:
  ResampleMethod method_;
  HermiteResampler hermite_;
  std::unique_ptr<const WindowedSinc> sinc_;  // only for that method, because it holds a table
};

/// The same for one stroke.
std::vector<double> resample(const MonotonePath& path, int direction, const SpaceGrid& grid,
                             std::span<const double> values, std::size_t margin,
                             ResampleMethod method = ResampleMethod::hermite);

}  // namespace tacto::spatial
