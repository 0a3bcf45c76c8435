// SPDX-License-Identifier: GPL-3.0-or-later
// Where the frames of a touch come from: a recording on disk, or anything else that can be read from any
// place.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::spatial {

/// What the spatial rooms take from a record: where the finger was, what is made a texture, how hard it
/// pressed.
enum class Track { position, value, normal_force };

/// A record of any length, read stretch by stretch. Not shared between threads.
class TouchSource {
 public:
  virtual ~TouchSource() = default;
  /// Null where the record has no such channel; the position and the value are always there.
  virtual const schema::Channel* channel(Track track) const = 0;
  /// Stored numbers from frame `first` on, as many as `out` has; physical = stored x scale + offset of the
  /// channel. Precondition: there are such frames, and such a channel. Errors: of reading.
  virtual schema::Result<void> read_stored(Track track, std::size_t first, std::span<double> out) = 0;

  /// The same in SI units.
  schema::Result<void> read(Track track, std::size_t first, std::span<double> out) {
    if (auto done = read_stored(track, first, out); !done) return done;
    const schema::Channel& told = *channel(track);
    for (double& value : out) value = value * told.scale + told.offset;
    return {};
  }
};

/// A recording on disk; `value` names the channel that is made a texture. Empty: tangential_force, else the
/// one channel that can be a texture (a force along the surface, an acceleration, a displacement, a height, a
/// signal). Errors: unsuitable, without such a channel, with several, or without a position; of opening the
/// file.
schema::Result<std::unique_ptr<TouchSource>> open_touch_source(const schema::Recording& recording,
                                                               const std::string& value);

}  // namespace tacto::spatial
