// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/cli/live_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::capture {
namespace {

constexpr int kBar = 8;

// The largest value of a channel as a fraction of its converter's range.
double part_of_range(const schema::Channel& channel, const ChannelLevel& level) {
  const double up = channel.range_max && *channel.range_max > 0 ? level.largest / *channel.range_max : 0;
  const double down = channel.range_min && *channel.range_min < 0 ? level.smallest / *channel.range_min : 0;
  return std::clamp(std::max(up, down), 0.0, 1.0);
}

bool has_range(const schema::Channel& channel) {
  return channel.range_max || channel.range_min;
}

std::string bars(const LiveView& view, const schema::RecordingHeader& header) {
  std::string text;
  for (std::size_t i = 0; i < view.levels.size(); ++i) {
    if (!has_range(header.channels[i])) continue;
    const auto full =
        static_cast<std::size_t>(std::lround(kBar * part_of_range(header.channels[i], view.levels[i])));
    text += fmt::format("{} [{}{}]  ", header.channels[i].name, std::string(full, '#'),
                        std::string(kBar - full, '-'));
  }
  return text;
}

// The same as numbers, for lines too short for bars.
std::string peaks(const LiveView& view, const schema::RecordingHeader& header) {
  std::string text;
  for (std::size_t i = 0; i < view.levels.size(); ++i)
    if (has_range(header.channels[i]))
      text += fmt::format("{}{:.0f}", text.empty() ? "peaks " : "/",
                          100 * part_of_range(header.channels[i], view.levels[i]));
  return text.empty() ? text : text + " %  ";
}

// Clipping is shown near the beginning of the line, because it cannot be corrected afterwards.
std::string clipping(const LiveView& view, const schema::RecordingHeader& header) {
  std::string text;
  for (std::size_t i = 0; i < view.levels.size(); ++i)
    if (view.levels[i].clipped) text += (text.empty() ? "CLIP " : ", ") + header.channels[i].name;
  return text.empty() ? text : text + "  ";
}

std::string judged(double value, const schema::TargetBand& band, const char* more, const char* less) {
  return band.holds(value) ? "ok" : value < band.middle ? more : less;
}

std::string finger(const LiveView& view) {
  std::string text;
  if (view.speed_mps)
    text += fmt::format("{:3.0f} mm/s {}  ", *view.speed_mps * 1e3,
                        judged(*view.speed_mps, schema::kTargetSpeed_mps, "FASTER", "SLOWER"));
  if (view.normal_n)
    text += fmt::format("load {:.2f} N {}  ", *view.normal_n,
                        judged(*view.normal_n, schema::kTargetLoad_n, "MORE", "LESS"));
  return text;
}

}  // namespace

std::string live_line(const LiveView& view, const schema::RecordingHeader& header, std::size_t columns) {
  std::string line = fmt::format("{:.1f} s  ", view.time_s);
  line += clipping(view, header);
  line += finger(view);
  line += fmt::format("{} strokes  {} lost  ", view.strokes, view.lost_frames);
  const std::string levels = bars(view, header);
  line += line.size() + levels.size() <= columns ? levels : peaks(view, header);
  line += fmt::format("{:.1f} GB left  ", static_cast<double>(view.disk_left_bytes) / 1e9);
  return line.substr(0, columns);
}

}  // namespace tacto::capture
