// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/import_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace tacto::capture {
namespace {

using schema::RecordingHeader;

schema::Channel described(const ChannelSpec& spec, const Source& source, const std::string& calibrated) {
  schema::Channel channel;
  channel.name = spec.name;
  channel.quantity = spec.quantity;
  channel.unit = schema::si_symbol(spec.dimension);
  channel.scale = spec.source.scale;
  channel.offset = spec.source.offset;
  channel.source = source.columns[spec.source.column];
  if (channel.source.empty()) channel.source = column_in_words(source.columns, spec.source.column);
  channel.calibrated = calibrated;
  return channel;
}

// The range of integer codes follows from their width: -32768 to 32767 for 16 bits.
void describe_range(schema::Channel& channel, int code_bits) {
  if (code_bits == 0) return;
  const double full = std::ldexp(1.0, code_bits - 1);
  const auto [low, high] = std::minmax({channel.physical(-full), channel.physical(full - 1)});
  channel.range_min = low;
  channel.range_max = high;
}

void describe_clock(RecordingHeader& header, const ImportRequest& request, const ImportPlan& plan) {
  if (plan.time) {
    header.clock = "times of the source, " + column_in_words(plan.source.columns, plan.time->column);
    return;
  }
  const auto& given = request.rate_hz;
  header.sample_rate_hz = given ? *given : *plan.source.rate_hz;
  header.clock = given ? "nominal rate, given at import" : "rate of the sound file";
  if (given && plan.source.rate_hz)
    header.clock += fmt::format(" (its header has {:g} Hz)", *plan.source.rate_hz);
}

}  // namespace

RecordingHeader import_header(const ImportRequest& request, const ImportPlan& plan) {
  RecordingHeader header;
  for (const ChannelSpec& spec : plan.channels) {
    header.channels.push_back(described(spec, plan.source, request.calibrated));
    describe_range(header.channels.back(), plan.source.code_bits);
  }
  header.source_file = std::filesystem::path(request.file).filename().string();
  header.recorded = request.recorded;
  header.subject = request.subject;
  header.finger = request.finger;
  header.surface = request.surface;
  header.notes = request.notes;
  header.humidity_percent = request.humidity_percent;
  describe_clock(header, request, plan);
  return header;
}

std::vector<std::string> gap_warnings(const std::vector<schema::Gap>& gaps) {
  if (gaps.empty()) return {};
  const auto missing =
      std::accumulate(gaps.begin(), gaps.end(), std::uint64_t{0},
                      [](std::uint64_t sum, const schema::Gap& gap) { return sum + gap.count; });
  return {fmt::format("{} gap{} in the times, {} frames missing (not filled in)", gaps.size(),
                      gaps.size() == 1 ? "" : "s", missing)};
}

}  // namespace tacto::capture
