// SPDX-License-Identifier: GPL-3.0-or-later
// The source of the frames of a touch: a recording on disk, or anything else with random access.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::spatial {

/// The channels of a record that `spatial` uses: the finger's position, the value that becomes a texture, the
/// normal force, and the other two axes of a value that is one of three (dft321).
enum class Track { position, value, normal_force, second_axis, third_axis };
inline constexpr std::array kTracks = {Track::position, Track::value, Track::normal_force, Track::second_axis,
                                       Track::third_axis};
inline constexpr std::array kValueTracks = {Track::value, Track::second_axis, Track::third_axis};

/// A record of any length, read section by section. Not shared between threads.
class TouchSource {
 public:
  virtual ~TouchSource() = default;
  /// Null if the record has no such channel; position and value always exist, of the axes both or none.
  virtual const schema::Channel* channel(Track track) const = 0;
  /// Reads out.size() stored numbers from frame `first` on; physical = stored x scale + offset of the
  /// channel. Precondition: the frames and the channel exist. Errors: of reading.
  virtual schema::Result<void> read_stored(Track track, std::size_t first, std::span<double> out) = 0;

  /// The same in SI units.
  schema::Result<void> read(Track track, std::size_t first, std::span<double> out) {
    if (auto done = read_stored(track, first, out); !done) return done;
    const schema::Channel& properties = *channel(track);
    for (double& value : out) value = properties.physical(value);
    return {};
  }
};

/// A recording on disk; `value` names the channel that becomes a texture. Empty: tangential_force, otherwise
/// the only channel that can become a texture (a force along the surface, an acceleration, a displacement, a
/// height, a signal). "acceleration:dft321": its three channels of acceleration; of more than three the names
/// of three, as "x,y,z:dft321". Errors: unsuitable, without such a channel, with several, with another number
/// of axes, with an axis that is no acceleration, or without a position; of opening the file.
schema::Result<std::unique_ptr<TouchSource>> open_touch_source(const schema::Recording& recording,
                                                               const std::string& value);

/// The same for strokes alone: the value is the position, too. Errors: unsuitable, without a position; of
/// opening the file.
schema::Result<std::unique_ptr<TouchSource>> open_position_source(const schema::Recording& recording);

}  // namespace tacto::spatial
