// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/cli/live_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::capture {
namespace {

constexpr int kBar = 8;

// How far towards its converter's ends a channel went.
double part_of_range(const schema::Channel& channel, const ChannelLevel& level) {
  const double up = channel.range_max && *channel.range_max > 0 ? level.largest / *channel.range_max : 0;
  const double down = channel.range_min && *channel.range_min < 0 ? level.smallest / *channel.range_min : 0;
  return std::clamp(std::max(up, down), 0.0, 1.0);
}

std::string bar(const schema::Channel& channel, const ChannelLevel& level) {
  if (!channel.range_max && !channel.range_min) return "";
  const auto full = static_cast<std::size_t>(std::lround(kBar * part_of_range(channel, level)));
  return fmt::format("{} [{}{}]{}  ", channel.name, std::string(full, '#'), std::string(kBar - full, '-'),
                     level.clipped ? " CLIP" : "");
}

std::string judged(double value, const schema::TargetBand& band, const char* more, const char* less) {
  return band.holds(value) ? "ok" : value < band.middle ? more : less;
}

std::string finger(const LiveView& view) {
  std::string text;
  if (view.speed_mps)
    text += fmt::format("finger {:3.0f} mm/s {}  ", *view.speed_mps * 1e3,
                        judged(*view.speed_mps, schema::kTargetSpeed_mps, "FASTER", "SLOWER"));
  if (view.normal_n)
    text += fmt::format("load {:.2f} N {}  ", *view.normal_n,
                        judged(*view.normal_n, schema::kTargetLoad_n, "MORE", "LESS"));
  return text;
}

}  // namespace

std::string live_line(const LiveView& view, const schema::RecordingHeader& header, std::size_t columns) {
  std::string line = fmt::format("{:.1f} s  ", view.time_s);
  line += finger(view);
  line += fmt::format("{} strokes  {} lost  {:.1f} GB left  ", view.strokes, view.lost_frames,
                      static_cast<double>(view.disk_left_bytes) / 1e9);
  for (std::size_t i = 0; i < view.levels.size(); ++i) line += bar(header.channels[i], view.levels[i]);
  return line.substr(0, columns);
}

}  // namespace tacto::capture
