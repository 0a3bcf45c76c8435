// SPDX-License-Identifier: GPL-3.0-or-later
// The displacement that a texture asks for along a path, exactly: what every faster playback is measured
// against.
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

/// How finely a path is read. Content of spatial frequency k under speed v is k v Hz, so the texture is read
/// at oversampling * rate_hz, at least 2.2 times k v for the finest k and the greatest v: nothing folds into
/// the band.
struct ReadingGrid {
  double rate_hz = 0;            ///< of the result
  std::size_t samples = 0;       ///< of the result
  std::size_t period = 0;        ///< samples of the result with the silent padding
  std::size_t oversampling = 1;  ///< readings for each sample of the result
  bool capped = false;           ///< the finest content would need more readings than kMostReadings

  double reading_rate_hz() const { return rate_hz * static_cast<double>(oversampling); }
};

/// The padding is 30 periods of the band's lowest frequency, 1 s at least. The readings in the padded period
/// stay below 2^24, about 0.5 GB of memory: `capped` says that oversampling had to stop there.
ReadingGrid reading_grid(double duration_s, double rate_hz, const spatial::Band& band, double finest_hz);

/// Places at which a grid reads a path: (samples - 1) x oversampling + 1 of them. Precondition: a checked
/// path.
std::vector<double> reading_places(const FingerPath& path, const ReadingGrid& grid);

/// Where readings rest before and after them; none: at their mean, as in exact_wanted.
struct Rests {
  std::optional<double> start, end;
};

/// What was read there, m, kept to the band, at the result's samples; before and after the path it rests.
PaddedSpectrum target_of_readings(std::vector<double> readings, const ReadingGrid& grid,
                                  const spatial::Band& band, double onset_s, const Rests& rests = {});

/// Reads the texture along the path, keeps the band (keep_band) and gives the result's samples:
/// gain_m_per_n * force, m. Before and after the path the force rests at its mean over the first and the last
/// period of band.low_hz; over onset_s at either end it leaves and reaches that rest by a raised cosine, so
/// that neither end is a step although the finger may move there. Precondition: a checked path, 0 <
/// band.low_hz.
PaddedSpectrum exact_target(const TextureLookup& texture, const FingerPath& path, const ReadingGrid& grid,
                            const spatial::Band& band, double gain_m_per_n, double onset_s);

/// A seamless loop laid end to end until length_m is covered, as a texture without ends to read along a path.
schema::SpaceSignal unrolled_loop(const schema::SpaceSignal& loop, double length_m);

}  // namespace tacto::playback
