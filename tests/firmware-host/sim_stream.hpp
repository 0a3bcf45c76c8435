// SPDX-License-Identifier: GPL-3.0-or-later
// The stream of the emulated device for a URI, channel by channel in physical units.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "firmware-host/link/device.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::tests {

struct SimStream {
  firmware_host::Capabilities capabilities;
  std::vector<std::int32_t> codes;  ///< interleaved
  firmware_host::StreamCounts counts;

  std::vector<double> channel(std::size_t index) const {
    const std::size_t channels = capabilities.channels.size();
    const auto& channel = capabilities.channels[index];
    std::vector<double> values;
    for (std::size_t i = index; i < codes.size(); i += channels) values.push_back(channel.physical(codes[i]));
    return values;
  }
};

enum SimChannel : std::size_t { kSensor, kPosition, kNormal, kNet };

inline std::vector<std::int32_t> read_frames(firmware_host::Device& device, double time_s) {
  const auto& capabilities = device.capabilities();
  const auto frames = static_cast<std::size_t>(time_s * capabilities.sample_rate_hz);
  std::vector<std::int32_t> codes(frames * capabilities.channels.size());
  const auto read = device.read(codes);
  if (!read || *read != frames) throw std::runtime_error(read ? "short read" : message(read.error()));
  return codes;
}

inline SimStream stream_of(const std::string& uri, double time_s) {
  auto device = firmware_host::open_device(uri);
  if (!device) throw std::runtime_error(message(device.error()));
  if (!(*device)->start()) throw std::runtime_error("did not start");
  SimStream stream{(*device)->capabilities(), read_frames(**device, time_s), (*device)->counts()};
  return stream;
}

}  // namespace tacto::tests
