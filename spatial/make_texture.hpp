// SPDX-License-Identifier: GPL-3.0-or-later
// From a recording to textures: band-pass in time, path made invertible, resampled to space, described.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/recording.hpp"
#include "data-schema/texture.hpp"
#include "spatial/monotone_path.hpp"
#include "spatial/resample.hpp"
#include "spatial/time_filter.hpp"
#include "spatial/touch_record.hpp"

namespace tacto::spatial {

/// Whether to divide by the sensor's response. automatic: where the recording names its transducer and the
/// channel is a tangential force.
enum class Equalise { automatic, on, off };

struct TextureOptions {
  std::string channel = "tangential_force";
  TimeFilter filter;
  Equalise equalise = Equalise::automatic;
  double pitch_m = 1e-6;
  ResampleMethod method = ResampleMethod::hermite;
};

/// What a channel became by filtering, between two gaps.
struct FilteredPiece {
  FrameRange frames;
  std::vector<double> values;
};

/// Makes the textures of one recording. Not shared between threads.
class TextureMaker {
 public:
  /// Errors: of TouchRecord::open; unsuitable (a filter that does not fit the rate, equalising without a
  /// transducer); usage (a pitch that is not above 0).
  static schema::Result<TextureMaker> open(const schema::Recording& recording, const TextureOptions& options);

  const TouchRecord& record() const { return record_; }

  /// The texture of a stroke or stretch of record(). All between two gaps is filtered, then the stroke is
  /// resampled. Its position 0 is a multiple of the pitch on the bench. `number` is kept as the stroke's, 0
  /// for a stretch. Errors: unsuitable, for a stroke shorter than one period of the lowest frequency, and of
  /// grid_along().
  schema::Result<schema::Texture> make(const Stroke& stroke, int number);

 private:
  TextureMaker(TouchRecord record, TextureOptions options);
  schema::Result<void> prepare();
  schema::Result<void> check_duration(const Stroke& stroke) const;
  schema::Result<const FilteredPiece*> filtered_piece(FrameRange frames);
  void add_band(schema::Texture& texture, const MonotonePath& path) const;
  void describe(schema::Texture& texture, const Stroke& stroke, int number) const;

  TouchRecord record_;
  TextureOptions options_;
  SpectralGain equaliser_;
  std::optional<FilteredPiece> piece_;  // the last that was filtered: strokes come by time
};

/// Root of the mean square of a texture's values, in their unit.
double rms_of(const schema::Texture& texture);

}  // namespace tacto::spatial
