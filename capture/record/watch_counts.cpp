// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/watch_counts.hpp"

#include <algorithm>

#include "capture/record/record_header.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr double kWatch_s = 0.02;

struct Watch {
  firmware_host::Device& device;
  std::size_t channels, channel;
  std::vector<std::int32_t> block;

  // The channel's count at the end of the next block.
  Result<double> next() {
    const auto got = device.read(block);
    TACTO_TRY(got);
    if (*got == 0)
      return schema::fail(ErrorKind::device, "the stream ended before the last travel",
                          device.capabilities().uri);
    return block[(*got - 1) * channels + channel];
  }
};

Result<std::vector<double>> counts_at_marks(Watch& watch, std::size_t marks,
                                            const std::function<Result<bool>()>& marked) {
  std::vector<double> counts;
  while (counts.size() < marks) {
    const auto count = watch.next();
    TACTO_TRY(count);
    const auto now = marked();
    TACTO_TRY(now);
    if (*now) counts.push_back(*count);
  }
  return counts;
}

}  // namespace

Result<WatchedCounts> watch_counts(firmware_host::Device& device, const std::string& channel,
                                   std::size_t marks, const std::function<Result<bool>()>& marked) {
  auto header = header_for(device.capabilities(), {});
  TACTO_TRY(header);
  const auto index = schema::find_channel(*header, channel);
  if (!index)
    return schema::fail(ErrorKind::usage, index.error().what, index.error().where, index.error().remedy);
  const std::size_t channels = header->channels.size();
  const auto frames = std::max<std::size_t>(1, static_cast<std::size_t>(header->sample_rate_hz * kWatch_s));
  TACTO_TRY(device.start());
  Watch watch{device, channels, *index, std::vector<std::int32_t>(frames * channels)};
  auto counts = counts_at_marks(watch, marks, marked);
  const auto stopped = device.stop();
  TACTO_TRY(counts);
  TACTO_TRY(stopped);
  return WatchedCounts{{std::move(*header), device.capabilities().name, {}}, std::move(*counts)};
}

}  // namespace tacto::capture
