// SPDX-License-Identifier: GPL-3.0-or-later
// The band that a texture knows, by position: what the recording's band in Hz became at the finger's speed
// there.
#pragma once

#include <span>
#include <vector>

#include "data-schema/texture.hpp"
#include "spatial/dsp/band.hpp"
#include "spatial/dsp/hermite.hpp"
#include "spatial/dsp/hermite_inverse.hpp"
#include "spatial/monotone_path.hpp"

namespace tacto::spatial {

/// The finger's speed along its way, over a window of time. The path must outlive it.
class LocalSpeed {
 public:
  /// `window` in samples.
  LocalSpeed(const MonotonePath& path, double sample_rate_hz, double window);
  /// m/s, above 0.
  double at(double way_m) const;
  /// Where on its way the finger stood still, or crept, for longer than the window: the middle of each step
  /// from knot to knot that took as long. Growing.
  std::vector<double> stops_m() const;

 private:
  const MonotonePath& path_;
  HermiteCurve way_;
  HermiteInverse sample_;
  double sample_rate_hz_, half_window_;
};

/// Speed at positions at most 0.1 mm apart, and at those where the finger stood, from 0 to `length_m`.
struct SpeedProfile {
  std::vector<double> position_m, speed_mps;
};

/// `origin_m` is where position 0 lay on the bench, `direction` the stroke's.
SpeedProfile speed_profile(const LocalSpeed& speed, double origin_m, double length_m, int direction);

/// k = f / v at the profile's positions; left out is what the line between its neighbours tells to 1 %. In
/// 1/m.
std::vector<schema::BandPoint> valid_band(const SpeedProfile& profile, Band band);

/// What of it lies within another band, in 1/m; of no width where nothing does.
void narrow(std::span<schema::BandPoint> points, double low_per_m, double high_per_m);

/// The band that is valid along the whole texture; low_per_m >= high_per_m where there is none. In 1/m.
schema::BandPoint band_throughout(std::span<const schema::BandPoint> band);

}  // namespace tacto::spatial
