// SPDX-License-Identifier: GPL-3.0-or-later
// The band that a texture knows, by position: what the recording's band in Hz became at the finger's speed
// there.
#pragma once

#include <span>
#include <vector>

#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/resample/hermite.hpp"
#include "spatial/dsp/resample/hermite_inverse.hpp"
#include "spatial/strokes/monotone_path.hpp"

namespace tacto::spatial {

/// Times over which a speed is taken, in samples, and the way that tells a speed to a percent, in m.
struct SpeedWindows {
  double longest, shortest, telling_m;
};

/// Each end of a band has its own time. What is fast for a period of the highest frequency carries its
/// content past it; what rests for less than half a period of the lowest one (at most 0.1 s) passes as a
/// level between two others. No window is shorter than tells a speed (`least`, in samples, and 100
/// resolutions of way: a percent).
SpeedWindows speed_windows(double resolution_m, double least, Band band, double sample_rate_hz);

/// The finger's speed along its way, over windows of time. The path must outlive it.
class LocalSpeed {
 public:
  LocalSpeed(const MonotonePath& path, double sample_rate_hz, const SpeedWindows& windows);
  /// Over the longest window. m/s, above 0.
  double at(double way_m) const;
  /// Over the shortest window in which the position tells it, so that slips of a few milliseconds are seen;
  /// at least at(way_m). What was fast for as long as a period of the band's highest frequency has left the
  /// band.
  double fastest_at(double way_m) const;
  /// Where on its way the finger stood still, or crept, for longer than the window: the middle of each step
  /// from knot to knot that took as long. Growing.
  std::vector<double> stops_m() const;

 private:
  struct Advance {
    double way_m, samples;
  };
  Advance around(double sample, double window) const;

  const MonotonePath& path_;
  HermiteCurve way_;
  HermiteInverse sample_;
  double sample_rate_hz_;
  SpeedWindows windows_;
};

/// Speeds, over the longest window and the fastest, at positions at most 0.1 mm apart, and at those where the
/// finger stood, from 0 to `length_m`.
struct SpeedProfile {
  std::vector<double> position_m, speed_mps, fastest_mps;
};

/// `origin_m` is where position 0 lay on the bench, `direction` the stroke's.
SpeedProfile speed_profile(const LocalSpeed& speed, double origin_m, double length_m, int direction);

/// k = f / v at the profile's positions, the low limit at the mean speed and the high one at the fastest;
/// left out is what the line between its neighbours tells to 1 %. In 1/m.
std::vector<schema::BandPoint> valid_band(const SpeedProfile& profile, Band band);

/// What of it lies within another band, in 1/m; of no width where nothing does.
void narrow(std::span<schema::BandPoint> points, double low_per_m, double high_per_m);

/// The band that is valid along the whole texture; low_per_m >= high_per_m where there is none. In 1/m.
schema::BandPoint band_throughout(std::span<const schema::BandPoint> band);

}  // namespace tacto::spatial
