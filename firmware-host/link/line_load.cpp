// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/link/line_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/core/wire/frame.hpp"

namespace tacto::firmware_host {
namespace {

constexpr double kBitsPerByte = 10;  // a start bit, eight bits, a stop bit
// The rest is for answers, and for the clocks of the two ends, which may differ by some percent.
constexpr double kShareOfStreams = 0.9;
constexpr double kTickMessageS = 0.01;  // ticks_in_block() in core/firmware/firmware_commands.cpp

template <class Message>
double frame_bytes(const Message& message) {
  std::uint8_t frame[wire::kMaxFrame];
  return static_cast<double>(wire::encode_frame(message, 0, frame, sizeof frame));
}

}  // namespace

double bytes_per_frame(std::size_t channels, std::size_t block_frames) {
  wire::Samples block{};
  block.channels = static_cast<std::uint8_t>(channels);
  block.count = static_cast<std::uint8_t>(block_frames);
  return frame_bytes(block) / static_cast<double>(block_frames);
}

double bytes_per_tick(double rate_hz, std::size_t axes) {
  const double ticks = std::clamp(std::floor(rate_hz * kTickMessageS), 1.0, double{wire::kMaxBlockTicks});
  if (axes == 0) {
    wire::Ticks block{};
    block.count = static_cast<std::uint8_t>(ticks);
    return frame_bytes(block) / ticks;
  }
  wire::AxisTicks block{};
  block.axes = static_cast<std::uint8_t>(axes);
  block.count = static_cast<std::uint8_t>(ticks);
  return frame_bytes(block) / ticks;
}

schema::Result<void> check_line(const SerialLine& line, double rate_hz,
                                const std::function<double(double rate_hz)>& bytes_of_one,
                                const std::string& where) {
  const double carried = kShareOfStreams * line.baud / kBitsPerByte;
  const double room = std::max(0.0, carried - line.used_bytes_per_s);
  const double needed = rate_hz * bytes_of_one(rate_hz);
  if (needed <= room) return {};
  // A lower rate may need more bytes for each frame, because fewer of them share a message.
  double fits = std::ceil(rate_hz);
  while (fits > 0 && fits * bytes_of_one(fits) > room)
    fits = std::min(fits - 1, std::floor(room / bytes_of_one(fits)));
  return schema::fail(
      schema::ErrorKind::unsuitable,
      fmt::format(
          "{:g} Hz need {:.0f} bytes/s, and {:g} baud carry {:.0f}{}: at most {:g} Hz fit", rate_hz, needed,
          line.baud, carried,
          line.used_bytes_per_s > 0 ? fmt::format(", of which {:.0f} are used", line.used_bytes_per_s) : "",
          std::max(0.0, fits)),
      where,
      fmt::format("use a lower rate, or at least {:.0f} baud",
                  std::ceil((needed + line.used_bytes_per_s) * kBitsPerByte / kShareOfStreams)));
}

}  // namespace tacto::firmware_host
