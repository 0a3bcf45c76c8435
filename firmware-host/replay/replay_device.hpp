// SPDX-License-Identifier: GPL-3.0-or-later
// A recording as a device: the same frames, with the same gaps.
#pragma once

#include <optional>

#include "data-schema/wav/wav.hpp"
#include "firmware-host/link/device.hpp"
#include "firmware-host/link/pacer.hpp"

namespace tacto::firmware_host {

/// Returns the codes of a recording, with its channels and its rate; then the stream ends. A gap in the
/// recording is a gap in the stream. Runs at full speed, or paced. Reads the file during the replay: memory
/// does not depend on the length of the recording.
class ReplayDevice final : public Device {
 public:
  ReplayDevice(std::string uri, schema::Recording recording, bool paced);

  const Capabilities& capabilities() const override { return capabilities_; }
  schema::Result<void> start() override;
  schema::Result<std::size_t> read(std::span<std::int32_t> interleaved) override;
  schema::Result<void> stop() override;
  bool is_real_time() const override { return paced_; }
  StreamCounts counts() const override { return counts_; }
  StreamEvents take_events() override;

 private:
  std::size_t until_gap(std::size_t frames);
  void count(std::span<const std::int32_t> codes);

  schema::Recording recording_;
  bool paced_;
  Capabilities capabilities_;
  std::optional<schema::WavReader> reader_;
  std::optional<Pacer> pacer_;
  std::size_t next_gap_ = 0;  // among the gaps of the recording
  StreamCounts counts_;
  StreamEvents events_;
};

/// `parameters` is the text after "replay:": a recording's stem or file, optionally with ",paced=1". Errors:
/// as open_recording(); usage: no file; unsuitable: a recording of physical numbers, which are not converter
/// codes.
schema::Result<std::unique_ptr<Device>> open_replay_device(const std::string& uri,
                                                           std::string_view parameters);

}  // namespace tacto::firmware_host
