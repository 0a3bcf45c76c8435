// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/touch_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ranges>

#include "data-schema/quantity.hpp"
#include "spatial/smoothed_speed.hpp"

namespace tacto::spatial {
namespace {

using schema::Fault;

// What a finger may go back within a stretch and still be said to go one way: a few counts, or its elastic
// rebound.
constexpr double kBackwardQuanta = 4;
constexpr double kBackwardOfWay = 0.002;
// Half a sample period belongs to its frame: a time that was written with few digits still names it.
constexpr double kWithinFrame = 0.5;

std::string seconds(double s) {
  return fmt::format("{:.4g} s", s);
}

std::optional<std::size_t> channel_of(const schema::RecordingHeader& header, std::string_view quantity) {
  const auto found = std::ranges::find(header.channels, quantity, &schema::Channel::quantity);
  if (found == header.channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.channels.begin());
}

std::string names_of(const schema::RecordingHeader& header) {
  std::vector<std::string_view> names;
  for (const schema::Channel& channel : header.channels) names.push_back(channel.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

schema::Result<std::vector<double>> values_of(const schema::Recording& recording, std::size_t channel) {
  auto signal = schema::read_channel(recording, channel);
  if (!signal) return schema::forward_error(signal);
  return std::move(signal->values);
}

schema::Result<std::size_t> position_channel(const schema::Recording& recording) {
  if (const auto index = channel_of(recording.header, "position")) return *index;
  return schema::fail(
      Fault::unsuitable, fmt::format("has no position channel, only {}", names_of(recording.header)),
      recording.stem, "import it with --channel position=COLUMN*SCALE, or with --speed for a nominal one");
}

}  // namespace

schema::Result<TouchRecord> TouchRecord::open(const schema::Recording& recording,
                                              const std::string& channel) {
  const auto index = schema::find_channel(recording.header, channel);
  if (!index) return schema::forward_error(index);
  TouchRecord record;
  record.header_ = recording.header;
  record.where_ = recording.stem;
  record.channel_ = recording.header.channels[*index];
  auto values = values_of(recording, *index);
  if (!values) return schema::forward_error(values);
  record.values_ = std::move(*values);
  if (const auto read = record.read(recording); !read) return schema::forward_error(read);
  return record;
}

schema::Result<void> TouchRecord::read(const schema::Recording& recording) {
  const auto index = position_channel(recording);
  if (!index) return schema::forward_error(index);
  auto position = values_of(recording, *index);
  if (!position) return schema::forward_error(position);
  position_m_ = std::move(*position);
  if (std::ranges::all_of(position_m_, [&](double x) { return x == position_m_.front(); }))
    return schema::fail(Fault::unsuitable, "the position never moves", where_,
                        "a texture needs a finger that strokes; is this the right position channel?");
  if (const auto normal = channel_of(header_, "normal_force")) {
    auto force = values_of(recording, *normal);
    if (!force) return schema::forward_error(force);
    normal_force_n_ = std::move(*force);
  }
  quantum_m_ = position_quantum(position_m_);
  pieces_ = pieces_between_gaps(position_m_.size(), header_.gaps);
  strokes_ = find_strokes(position_m_, header_.sample_rate_hz, header_.gaps);
  return {};
}

std::span<const double> TouchRecord::values(FrameRange frames) const {
  return std::span(values_).subspan(frames.begin, frames.size());
}

std::span<const double> TouchRecord::position_m(FrameRange frames) const {
  return std::span(position_m_).subspan(frames.begin, frames.size());
}

double TouchRecord::from_s(const Stroke& stroke) const {
  return schema::frame_time_s(header_, stroke.frames.begin);
}

double TouchRecord::to_s(const Stroke& stroke) const {
  return schema::frame_time_s(header_, stroke.frames.end - 1);
}

double TouchRecord::length_m(const Stroke& stroke) const {
  return std::abs(position_m_[stroke.frames.end - 1] - position_m_[stroke.frames.begin]);
}

double TouchRecord::mean_speed_mps(const Stroke& stroke) const {
  return length_m(stroke) / (to_s(stroke) - from_s(stroke));
}

std::optional<double> TouchRecord::mean_normal_force_n(const Stroke& stroke) const {
  if (normal_force_n_.empty()) return std::nullopt;
  const auto forces = std::span(normal_force_n_).subspan(stroke.frames.begin, stroke.frames.size());
  return std::accumulate(forces.begin(), forces.end(), 0.0) / static_cast<double>(forces.size());
}

std::string TouchRecord::list_of_strokes() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < strokes_.size(); ++i)
    lines.push_back(
        fmt::format("{}: {} to {}", i + 1, seconds(from_s(strokes_[i])), seconds(to_s(strokes_[i]))));
  return lines.empty() ? "no stroke was found" : fmt::format("there are {}", fmt::join(lines, ", "));
}

schema::Result<Stroke> TouchRecord::stroke(int number) const {
  if (number >= 1 && static_cast<std::size_t>(number) <= strokes_.size())
    return strokes_[static_cast<std::size_t>(number) - 1];
  return schema::fail(Fault::unsuitable, fmt::format("there is no stroke {}", number), where_,
                      list_of_strokes());
}

schema::Result<FrameRange> TouchRecord::frames_between(double from_s, double to_s) const {
  const std::size_t frames = position_m_.size();
  const double slack_s = kWithinFrame / header_.sample_rate_hz;
  const double first_s = schema::frame_time_s(header_, 0), last_s = schema::frame_time_s(header_, frames - 1);
  if (!(from_s < to_s))
    return schema::fail(
        Fault::usage,
        fmt::format("the stretch ends at {}, not after its start at {}", seconds(to_s), seconds(from_s)),
        where_);
  if (from_s < first_s - slack_s || to_s > last_s + 3 * slack_s)
    return schema::fail(
        Fault::unsuitable,
        fmt::format("the stretch {} to {} reaches out of the recording", seconds(from_s), seconds(to_s)),
        where_, fmt::format("it lasts from {} to {}", seconds(first_s), seconds(last_s)));
  const auto first_from = [&](double time_s) {
    const auto frame_numbers = std::views::iota(std::size_t{0}, frames);
    const auto time_of = [&](std::size_t frame) { return schema::frame_time_s(header_, frame); };
    return *std::ranges::lower_bound(frame_numbers, time_s, {}, time_of);
  };
  return FrameRange{first_from(from_s - slack_s), first_from(to_s + slack_s)};
}

schema::Result<void> TouchRecord::check_gapless(FrameRange frames) const {
  for (const schema::Gap& gap : header_.gaps)
    if (gap.frame > frames.begin && gap.frame < frames.end)
      return schema::fail(Fault::unsuitable,
                          fmt::format("{} frames are missing at {}, inside the stretch", gap.count,
                                      seconds(schema::frame_time_s(header_, gap.frame))),
                          where_, "ask for a stretch before or after them");
  return {};
}

schema::Result<Stroke> TouchRecord::directed(FrameRange frames) const {
  const auto positions = position_m(frames);
  if (positions.size() < 2 || positions.front() == positions.back())
    return schema::fail(Fault::unsuitable, "the finger gets nowhere in the stretch", where_,
                        list_of_strokes());
  const double advance_m = positions.back() - positions.front();
  const int direction = advance_m > 0 ? 1 : -1;
  const double backward_m = backward_travel(positions, direction);
  if (backward_m > std::max(kBackwardQuanta * quantum_m_, kBackwardOfWay * std::abs(advance_m)))
    return schema::fail(Fault::unsuitable,
                        fmt::format("the finger turns round in the stretch, by {}",
                                    schema::for_people(backward_m, schema::Dimension::length)),
                        where_, list_of_strokes());
  return Stroke{frames, direction};
}

schema::Result<Stroke> TouchRecord::stretch(double from_s, double to_s) const {
  const auto frames = frames_between(from_s, to_s);
  if (!frames) return schema::forward_error(frames);
  if (const auto gapless = check_gapless(*frames); !gapless) return schema::forward_error(gapless);
  return directed(*frames);
}

}  // namespace tacto::spatial
