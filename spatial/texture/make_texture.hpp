// SPDX-License-Identifier: GPL-3.0-or-later
// From a recording to textures: band-pass in time, path made invertible, resampled to space, with metadata.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/dft321.hpp"
#include "spatial/strokes/monotone_path.hpp"
#include "spatial/strokes/touch_record.hpp"
#include "spatial/texture/filtered_track.hpp"
#include "spatial/texture/resample.hpp"
#include "spatial/texture/space_filter.hpp"
#include "spatial/texture/time_filter.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::spatial {

/// Whether to divide by the sensor's response. automatic: if the recording names its transducer and the
/// channel is a tangential force.
enum class Equalise { automatic, on, off };

struct TextureOptions {
  std::string channel;  ///< as of open_touch_source()
  TimeFilter filter;
  /// If set, the band is in space: each texture is filtered along position, and nothing in time.
  std::optional<SpaceFilter> space;
  Equalise equalise = Equalise::automatic;
  double pitch_m = 1e-6;
  ResampleMethod method = ResampleMethod::hermite;
};

/// Makes the textures of one recording of any length; it holds a stroke, not the recording, in memory. Not
/// shared between threads.
class TextureMaker {
 public:
  /// Errors: of TouchRecord::open; unsuitable (a filter that does not fit the rate, equalising without a
  /// transducer, or a channel that is not a tangential force); usage (a pitch that is not above 0).
  static schema::Result<TextureMaker> open(const schema::Recording& recording, const TextureOptions& options);
  /// Of an open record; options.channel is not used.
  static schema::Result<TextureMaker> open(TouchRecord record, const TextureOptions& options);

  const TouchRecord& record() const { return record_; }
  /// Whether a stroke lasts at least one period of the band's lowest frequency; make() refuses a shorter one.
  bool is_long_enough(const Stroke& stroke) const;

  /// The texture of a stroke or section of record(). The whole piece between two gaps is filtered, then the
  /// stroke is resampled; strokes ordered by time are fast. Position 0 is a multiple of the pitch on the
  /// bench. `number` is stored as the stroke's number, 0 for a section. `shift_m` is added to its positions
  /// on the bench. Errors: unsuitable, for a stroke that a jump of the position cuts, for one shorter than
  /// one period of the lowest frequency, for one so slow that its whole band is above the highest frequency
  /// of the grid, and of grid_along(); of reading.
  schema::Result<schema::Texture> make(const Stroke& stroke, int number, double shift_m = 0);

 private:
  TextureMaker(TouchRecord record, TextureOptions options);
  schema::Result<void> prepare();
  schema::Result<void> choose_equaliser();
  double lowest_hz() const;
  schema::Result<void> check_duration(const Stroke& stroke) const;
  schema::Result<void> check_band(double usual_mps) const;
  schema::Result<MonotonePath> path_of(const Stroke& stroke, double shift_m) const;
  schema::Result<std::span<const double>> filtered(FrameRange piece, FrameRange frames);
  schema::Result<std::vector<double>> resampled(const Stroke& stroke, const MonotonePath& path,
                                                const SpaceGrid& grid);
  Band kept_band() const;
  schema::Result<std::vector<double>> on_grid(const Stroke& stroke, const MonotonePath& path,
                                              const SpaceGrid& grid, std::size_t finer);
  SpeedProfile profile_of(const Stroke& stroke, const MonotonePath& path, const SpaceGrid& grid) const;
  void describe(schema::Texture& texture, const Stroke& stroke, int number) const;
  void describe_filter(schema::TextureSource& source) const;
  void describe_position(schema::TextureSource& source, const Stroke& stroke) const;

  TouchRecord record_;
  TextureOptions options_;
  SpectralGain equaliser_;
  std::vector<FilteredTrack> filtered_;  // one, or one of each axis
  Dft321 reduced_;                       // of the axes in the last section
  Resampler resampler_;
};

/// The factor by which the grid for resampling is finer than the texture's, before it is thinned: it holds
/// content up to `highest_hz` at a quarter of the finger's usual speed. At stops no grid does.
std::size_t finer_grid(double pitch_m, double highest_hz, double usual_mps);

/// Root of the mean square of a texture's values, in their unit.
double rms_of(const schema::Texture& texture);

}  // namespace tacto::spatial
