// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/record_header.hpp"

#include <fmt/format.h>

#include <utility>

namespace tacto::capture {

schema::Channel sensor_in_newtons(const schema::Channel& volts, const schema::Transducer& transducer) {
  const double gain = schema::nominal_newtons_per_volt(transducer);
  schema::Channel newtons = volts;
  newtons.unit = "N";
  newtons.scale *= gain;
  if (newtons.offset != 0) newtons.offset *= gain;  // avoids -0 in the sidecar
  if (newtons.range_min) *newtons.range_min *= gain;
  if (newtons.range_max) *newtons.range_max *= gain;
  if (gain < 0) std::swap(newtons.range_min, newtons.range_max);
  newtons.derivation = fmt::format(
      "nominal: output voltage x {:.6g} N/V, the gain of {} at 100 Hz; its response is not flat: divide by "
      "the transducer's model for the force",
      gain, transducer.name);
  return newtons;
}

schema::Result<schema::RecordingHeader> header_for(const firmware_host::Capabilities& capabilities,
                                                   const RecordRequest& request) {
  schema::RecordingHeader header;
  header.format = schema::SampleFormat::pcm32;
  header.sample_rate_hz = capabilities.sample_rate_hz;
  header.clock = capabilities.clock;
  header.device = capabilities.uri;
  header.serial = capabilities.serial;
  header.firmware = capabilities.firmware;
  header.simulated = capabilities.simulated;
  header.transducer = capabilities.transducer;
  header.subject = request.subject;
  header.finger = request.finger;
  header.surface = request.surface.empty() ? capabilities.surface : request.surface;
  header.notes = request.notes;
  header.warnings = capabilities.warnings;
  for (const schema::Channel& channel : capabilities.channels) {
    const bool volts = channel.quantity == "tangential_force" && channel.unit == "V";
    if (volts && !header.transducer)
      return schema::fail(schema::ErrorKind::device, "the device measures volts but reports no transducer",
                          capabilities.uri);
    header.channels.push_back(volts ? sensor_in_newtons(channel, *header.transducer) : channel);
  }
  return header;
}

std::vector<std::string> stream_warnings(const firmware_host::StreamCounts& counts,
                                         std::uint64_t frames_requested) {
  std::vector<std::string> warnings;
  if (counts.clipped > 0)
    warnings.push_back(
        fmt::format("{} samples exceeded the range of a converter and are clipped", counts.clipped));
  if (counts.lost_frames > 0)
    warnings.push_back(
        fmt::format("{} frames were lost during the transfer from the device", counts.lost_frames));
  if (counts.damaged_messages + counts.missing_messages > 0)
    warnings.push_back(
        fmt::format("of the device's messages {} were damaged and {} are missing; their frames are gaps",
                    counts.damaged_messages, counts.missing_messages));
  if (counts.frames < frames_requested)
    warnings.push_back(
        fmt::format("the device's stream ended after {} of {} frames", counts.frames, frames_requested));
  return warnings;
}

}  // namespace tacto::capture
