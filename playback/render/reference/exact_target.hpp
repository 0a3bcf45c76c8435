// SPDX-License-Identifier: GPL-3.0-or-later
// The exact target displacement of a texture along a path: the reference for every faster playback.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "data-schema/base/signal.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/model/texture_lookup.hpp"
#include "playback/render/reference/padded_spectrum.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// How densely a path is read. Content of spatial frequency k at speed v is k v Hz, so the texture is read at
/// oversampling * rate_hz, at least 2.2 times k v for the finest k and the greatest v: nothing aliases into
/// the band.
struct ReadingGrid {
  double rate_hz = 0;            ///< of the result
  std::size_t samples = 0;       ///< of the result
  std::size_t period = 0;        ///< samples of the result with the padding
  std::size_t oversampling = 1;  ///< readings per sample of the result
  bool capped = false;           ///< the finest content needs more than kMostReadings

  double reading_rate_hz() const { return rate_hz * static_cast<double>(oversampling); }
};

/// The padding is 30 periods of the band's lowest frequency, at least 1 s. There are at most 2^24 readings in
/// the padded period, about 0.5 GB of memory; `capped` is set if this limits the oversampling.
ReadingGrid reading_grid(double duration_s, double rate_hz, const spatial::Band& band, double finest_hz);

/// The (samples - 1) x oversampling + 1 places at which a grid reads a path. Precondition: a checked path.
std::vector<double> reading_places(const FingerPath& path, const ReadingGrid& grid);

/// The usual onset_s.
inline constexpr double kReferenceOnsetS = 0.005;

/// Values at rest before and after the readings; none: their mean, as in exact_target.
struct Rests {
  std::optional<double> start, end;
};

/// Filters the readings, m, to the band and gives the result's samples; before and after the path the tray
/// rests.
PaddedSpectrum target_of_readings(std::vector<double> readings, const ReadingGrid& grid,
                                  const spatial::Band& band, double onset_s, const Rests& rests = {});

/// Reads the texture along the path, filters it to the band (keep_band) and gives the result's samples:
/// gain_m_per_n * force, m. Before and after the path the force rests at its mean over the first and the last
/// period of band.low_hz. Over onset_s at each end a raised cosine joins rest and force, so that there is no
/// step although the finger may move there. Precondition: a checked path, 0 < band.low_hz.
PaddedSpectrum exact_target(const TextureLookup& texture, const FingerPath& path, const ReadingGrid& grid,
                            const spatial::Band& band, double gain_m_per_n, double onset_s);

/// A seamless loop repeated up to length_m, to be read along a path as a texture without ends.
schema::SpaceSignal unrolled_loop(const schema::SpaceSignal& loop, double length_m);

}  // namespace tacto::playback
