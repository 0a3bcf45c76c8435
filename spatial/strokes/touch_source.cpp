// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/touch_source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "data-schema/recording/recording_frames.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using MaybeIndex = std::optional<std::size_t>;

constexpr std::string_view kUsual = "tangential_force";  // the channel that becomes a texture
constexpr std::string_view kReduced = ":dft321";         // behind the names of three axes
constexpr std::string_view kReducedQuantity = "acceleration";
constexpr std::size_t kAxes = 3;

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

// The channels of a quantity, or those with names between commas.
schema::Result<std::vector<std::size_t>> named_axes(const schema::RecordingHeader& header,
                                                    std::string_view names) {
  std::vector<std::size_t> axes;
  if (names.find(',') == std::string_view::npos)
    for (std::size_t i = 0; i < header.channels.size(); ++i)
      if (header.channels[i].quantity == names) axes.push_back(i);
  if (!axes.empty()) return axes;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = names.find(',');
    const auto axis = schema::find_channel(header, names.substr(0, comma));
    TACTO_TRY(axis);
    axes.push_back(*axis);
    if (comma != std::string_view::npos) names.remove_prefix(comma + 1);
  }
  return axes;
}

// The three axes of an acceleration that one signal is made of.
schema::Result<std::vector<std::size_t>> reduced_axes(const schema::Recording& recording,
                                                      std::string_view names) {
  const schema::RecordingHeader& header = recording.header;
  auto axes = named_axes(header, names);
  TACTO_TRY(axes);
  for (const std::size_t i : *axes)
    if (const schema::Channel& axis = header.channels[i]; axis.quantity != kReducedQuantity)
      return schema::fail(
          ErrorKind::unsuitable,
          fmt::format("{} is {} in {}, no {}", axis.name, axis.quantity, axis.unit, kReducedQuantity),
          recording.stem, "dft321 takes the three axes of an accelerometer, all in m/s^2");
  const std::set<std::size_t> different(axes->begin(), axes->end());
  if (axes->size() == kAxes && different.size() == kAxes) return axes;
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("dft321 needs {} different axes, not {}", kAxes, list_of(header, *axes)), recording.stem,
      axes->size() > kAxes ? "name three of them, as in --channel x,y,z:dft321"
                           : "import all three axes, or make a texture of one: --channel NAME");
}

// One channel, or three axes.
schema::Result<std::vector<std::size_t>> value_channels(const schema::Recording& recording,
                                                        const std::string& value) {
  const schema::RecordingHeader& header = recording.header;
  if (value.ends_with(kReduced))
    return reduced_axes(recording, std::string_view(value).substr(0, value.size() - kReduced.size()));
  if (!value.empty()) {
    const auto index = schema::find_channel(header, value);
    TACTO_TRY(index);
    return std::vector{*index};
  }
  if (const auto usual = std::ranges::find(header.channels, kUsual, &schema::Channel::name);
      usual != header.channels.end())
    return std::vector{static_cast<std::size_t>(usual - header.channels.begin())};
  const auto found = texture_channels(header);
  if (found.size() == 1) return found;
  if (found.empty())
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("has no channel that can become a texture, only {}", names_of(header)),
                        recording.stem, "import it with --channel tangential_force=COLUMN*SCALE");
  const std::size_t axes = std::ranges::count(header.channels, kReducedQuantity, &schema::Channel::quantity);
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("has no tangential_force, but {} channels that can become a texture: {}",
                                  found.size(), list_of(header, found)),
                      recording.stem,
                      fmt::format("choose one, as in --channel {}{}", header.channels[found.front()].name,
                                  axes == kAxes ? ", or the three axes of the acceleration as one signal: "
                                                  "--channel acceleration:dft321"
                                                : ""));
}

class RecordingSource : public TouchSource {
 public:
  RecordingSource(schema::RecordingFrames frames, std::vector<schema::Channel> channels,
                  std::array<MaybeIndex, kTracks.size()> indices)
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
  std::array<MaybeIndex, kTracks.size()> indices_;  // by Track
};

// Without values, the value is the position.
schema::Result<std::unique_ptr<TouchSource>> open_source(const schema::Recording& recording,
                                                         std::span<const std::size_t> values) {
  const MaybeIndex position = channel_of(recording.header, "position");
  if (!position)
    return schema::fail(
        ErrorKind::unsuitable, fmt::format("has no position channel, only {}", names_of(recording.header)),
        recording.stem, "import it with --channel position=COLUMN*SCALE, or with --speed for a nominal one");
  auto frames = schema::RecordingFrames::open(recording);
  TACTO_TRY(frames);
  return std::make_unique<RecordingSource>(
      std::move(*frames), recording.header.channels,
      std::array{position, values.empty() ? position : values[0],
                 channel_of(recording.header, "normal_force"),
                 values.size() == kAxes ? MaybeIndex(values[1]) : std::nullopt,
                 values.size() == kAxes ? MaybeIndex(values[2]) : std::nullopt});
}

}  // namespace

schema::Result<std::unique_ptr<TouchSource>> open_touch_source(const schema::Recording& recording,
                                                               const std::string& value) {
  const auto indices = value_channels(recording, value);
  TACTO_TRY(indices);
  return open_source(recording, *indices);
}

schema::Result<std::unique_ptr<TouchSource>> open_position_source(const schema::Recording& recording) {
  return open_source(recording, {});
}

}  // namespace tacto::spatial
