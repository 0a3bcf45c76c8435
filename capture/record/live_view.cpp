// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/live_view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "data-schema/base/stroke_rule.hpp"
#include "firmware-host/link/encoder_counts.hpp"

namespace tacto::capture {
namespace {

std::optional<std::size_t> channel_of(const schema::RecordingHeader& header, std::string_view quantity) {
  const auto found = std::ranges::find(header.channels, quantity, &schema::Channel::quantity);
  if (found == header.channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.channels.begin());
}

bool at_an_end(const schema::Channel& channel, const schema::Statistics& recent) {
  return (channel.range_max && recent.max() >= *channel.range_max) ||
         (channel.range_min && recent.min() <= *channel.range_min);
}

}  // namespace

void StrokeCounter::begin(double position_m) {
  from_m_ = furthest_m_ = position_m;
  furthest_frame_ = frame_;
  direction_ = 0;
}

void StrokeCounter::add(double position_m) {
  if (frame_ == 0) begin(position_m);
  if (direction_ == 0 && std::abs(position_m - from_m_) >= kTurn_m)
    direction_ = position_m > from_m_ ? 1 : -1;
  const double advance_m = (position_m - furthest_m_) * direction_;
  if (advance_m > 0) {
    furthest_m_ = position_m;
    furthest_frame_ = frame_;
  }
  const bool turned = direction_ != 0 && advance_m <= -kTurn_m;
  const bool rests =
      direction_ != 0 && static_cast<double>(frame_ - furthest_frame_) > schema::kStrokePause_s * rate_hz_;
  if (turned || rests) {
    strokes_ += std::abs(furthest_m_ - from_m_) >= schema::kShortestStroke_m;
    begin(turned ? furthest_m_ : position_m);
  }
  ++frame_;
}

LiveFigures::LiveFigures(const schema::RecordingHeader& header)
    : header_(header),
      position_(channel_of(header, "position")),
      normal_(channel_of(header, "normal_force")),
      statistics_(header.channels.size()),
      recent_(header.channels.size()),
      last_codes_(header.channels.size()),
      unchanged_(header.channels.size()),
      counter_(header.sample_rate_hz) {}

double LiveFigures::physical(std::span<const std::int32_t> codes, std::size_t frame,
                             std::size_t channel) const {
  const schema::Channel& properties = header_.channels[channel];
  return properties.physical(codes[frame * header_.channels.size() + channel]);
}

void LiveFigures::add(std::span<const std::int32_t> codes) {
  const std::size_t channels = header_.channels.size();
  for (std::size_t frame = 0; frame < codes.size() / channels; ++frame)
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const double value = physical(codes, frame, channel);
      statistics_[channel].add(value);
      recent_[channel].add(value);
      const std::int32_t code = codes[frame * channels + channel];
      const bool same = code == std::exchange(last_codes_[channel], code);
      unchanged_[channel] = same ? unchanged_[channel] + 1 : 0;
    }
  add_motion(codes);
}

double LiveFigures::next_position_m(std::int32_t code) {
  unwrapped_ = begun_ ? unwrapped_ + firmware_host::counts_between(last_code_, code) : code;
  last_code_ = code;
  const schema::Channel& properties = header_.channels[*position_];
  return properties.physical(static_cast<double>(unwrapped_));
}

void LiveFigures::add_motion(std::span<const std::int32_t> codes) {
  const std::size_t frames = codes.size() / header_.channels.size();
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double normal_n = normal_ ? physical(codes, frame, *normal_) : 0;
    load_sum_n_ += normal_n;
    if (!position_) continue;
    const double position_m = next_position_m(codes[frame * header_.channels.size() + *position_]);
    if (begun_) moved_m_ += position_m - last_position_m_;
    last_position_m_ = position_m;
    begun_ = true;
    counter_.add(position_m);
  }
  recent_frames_ += frames;
}

LiveView LiveFigures::take_view() {
  LiveView view;
  for (std::size_t i = 0; i < recent_.size(); ++i)
    view.levels.push_back({recent_[i].min(), recent_[i].max(), at_an_end(header_.channels[i], recent_[i]),
                           static_cast<double>(unchanged_[i]) / header_.sample_rate_hz});
  const auto frames = static_cast<double>(recent_frames_);
  if (position_ && frames > 0) view.speed_mps = std::abs(moved_m_) / frames * header_.sample_rate_hz;
  if (normal_ && frames > 0) view.normal_n = load_sum_n_ / frames;
  view.strokes = strokes();
  std::ranges::fill(recent_, schema::Statistics());
  recent_frames_ = 0;
  moved_m_ = load_sum_n_ = 0;
  return view;
}

}  // namespace tacto::capture
