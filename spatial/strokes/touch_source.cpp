// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/touch_source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/recording/recording_frames.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using MaybeIndex = std::optional<std::size_t>;

constexpr std::string_view kUsual = "tangential_force";  // the channel that becomes a texture

MaybeIndex channel_of(const schema::RecordingHeader& header, std::string_view quantity) {
  const auto found = std::ranges::find(header.channels, quantity, &schema::Channel::quantity);
  if (found == header.channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.channels.begin());
}

std::string names_of(const schema::RecordingHeader& header) {
  std::vector<std::string_view> names;
  for (const schema::Channel& channel : header.channels) names.push_back(channel.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string list_of(const schema::RecordingHeader& header, const std::vector<std::size_t>& channels) {
  std::vector<std::string> words;
  for (const std::size_t i : channels)
    words.push_back(fmt::format("{} ({})", header.channels[i].name, header.channels[i].quantity));
  return fmt::format("{}", fmt::join(words, ", "));
}

schema::Result<std::size_t> value_channel(const schema::Recording& recording, const std::string& value) {
  const schema::RecordingHeader& header = recording.header;
  if (!value.empty()) return schema::find_channel(header, value);
  if (const auto usual = std::ranges::find(header.channels, kUsual, &schema::Channel::name);
      usual != header.channels.end())
    return static_cast<std::size_t>(usual - header.channels.begin());
  const auto found = texture_channels(header);
  if (found.size() == 1) return found.front();
  if (found.empty())
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("has no channel that can become a texture, only {}", names_of(header)),
                        recording.stem, "import it with --channel tangential_force=COLUMN*SCALE");
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("has no tangential_force, but {} channels that can become a texture: {}",
                                  found.size(), list_of(header, found)),
                      recording.stem,
                      fmt::format("choose one, as in --channel {}", header.channels[found.front()].name));
}

class RecordingSource : public TouchSource {
 public:
  RecordingSource(schema::RecordingFrames frames, std::vector<schema::Channel> channels,
                  std::array<MaybeIndex, 3> indices)
      : frames_(std::move(frames)), channels_(std::move(channels)), indices_(indices) {}

  const schema::Channel* channel(Track track) const override {
    const MaybeIndex& index = indices_[static_cast<std::size_t>(track)];
    return index ? &channels_[*index] : nullptr;
  }
  schema::Result<void> read_stored(Track track, std::size_t first, std::span<double> out) override {
    return frames_.read_stored(*indices_[static_cast<std::size_t>(track)], first, out);
  }

 private:
  schema::RecordingFrames frames_;
  std::vector<schema::Channel> channels_;
  std::array<MaybeIndex, 3> indices_;  // by Track
};

schema::Result<std::unique_ptr<TouchSource>> open_source(const schema::Recording& recording,
                                                         MaybeIndex value) {
  const MaybeIndex position = channel_of(recording.header, "position");
  if (!position)
    return schema::fail(
        ErrorKind::unsuitable, fmt::format("has no position channel, only {}", names_of(recording.header)),
        recording.stem, "import it with --channel position=COLUMN*SCALE, or with --speed for a nominal one");
  auto frames = schema::RecordingFrames::open(recording);
  TACTO_TRY(frames);
  return std::make_unique<RecordingSource>(
      std::move(*frames), recording.header.channels,
      std::array{position, value ? value : position, channel_of(recording.header, "normal_force")});
}

}  // namespace

schema::Result<std::unique_ptr<TouchSource>> open_touch_source(const schema::Recording& recording,
                                                               const std::string& value) {
  const auto index = value_channel(recording, value);
  TACTO_TRY(index);
  return open_source(recording, *index);
}

schema::Result<std::unique_ptr<TouchSource>> open_position_source(const schema::Recording& recording) {
  return open_source(recording, std::nullopt);
}

}  // namespace tacto::spatial
