// SPDX-License-Identifier: GPL-3.0-or-later
// The valid band of a texture by position: the recording's band in Hz, converted by the finger's speed there.
#pragma once

#include <span>
#include <vector>

#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/resample/hermite.hpp"
#include "spatial/dsp/resample/hermite_inverse.hpp"
#include "spatial/strokes/monotone_path.hpp"

namespace tacto::spatial {

/// Windows for speeds, in samples, and the distance from which on a speed is accurate to a percent, in m.
struct SpeedWindows {
  double longest, shortest, min_distance_m;
};

/// Each limit of the band has its own window. Motion that is fast for a period of the highest frequency moves
/// content above that frequency. A rest shorter than half a period of the lowest one (at most 0.1 s) passes
/// the filter as a level between two others. No window is shorter than an accurate speed requires (`least`,
/// in samples, and 100 resolutions of distance: a percent).
SpeedWindows speed_windows(double resolution_m, double least, Band band, double sample_rate_hz);

/// The finger's speed along its path, over windows of time. The path must outlive it.
class LocalSpeed {
 public:
  LocalSpeed(const MonotonePath& path, double sample_rate_hz, const SpeedWindows& windows);
  /// Over the longest window. m/s, above 0.
  double at(double way_m) const;
  /// Over the shortest window for which the position is accurate enough, so that slips of a few milliseconds
  /// are found; at least at(way_m). Content of a motion that was fast for a period of the band's highest
  /// frequency is outside the band.
  double fastest_at(double way_m) const;
  /// The positions where the finger rested, or crept, for longer than the window: the middle of each step
  /// between knots that took that long. Increasing.
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

/// Speeds, over the longest window and the fastest, from 0 to `length_m`: at positions at most 0.1 mm apart,
/// and where the finger rested.
struct SpeedProfile {
  std::vector<double> position_m, speed_mps, fastest_mps;
};

/// `origin_m` is the bench position of the texture's position 0, `direction` the stroke's.
SpeedProfile speed_profile(const LocalSpeed& speed, double origin_m, double length_m, int direction);

/// k = f / v at the profile's positions, the low limit at the mean speed and the high one at the fastest.
/// Points that linear interpolation of their neighbours gives to 1 % are omitted. In 1/m.
std::vector<schema::BandPoint> valid_band(const SpeedProfile& profile, Band band);

/// Intersects the band with another one, in 1/m; zero width where they do not overlap.
void narrow(std::span<schema::BandPoint> points, double low_per_m, double high_per_m);

/// The band that is valid along the whole texture; low_per_m >= high_per_m if there is none. In 1/m.
schema::BandPoint band_throughout(std::span<const schema::BandPoint> band);

}  // namespace tacto::spatial
