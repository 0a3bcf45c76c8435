// SPDX-License-Identifier: GPL-3.0-or-later
// A device that speaks the wire, as a Device: whatever the transport.
#pragma once

#include "firmware-host/link/client.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// Streams at the device's default rate. What the device says of itself becomes its capabilities; its
/// transducer, named by a note, is read as read_transducer() does.
class WireDevice final : public Device {
 public:
  /// Connects. Errors: as Client::connect(); device: a description that cannot be used; as read_transducer().
  static schema::Result<std::unique_ptr<WireDevice>> open(std::string uri,
                                                          std::unique_ptr<Transport> transport);

  const Capabilities& capabilities() const override { return capabilities_; }
  schema::Result<void> start() override;
  schema::Result<std::size_t> read(std::span<std::int32_t> interleaved) override;
  schema::Result<void> stop() override;
  StreamCounts counts() const override;
  StreamEvents take_events() override;
  schema::Result<double> round_trip_s() override;

  Client* conversation() override { return client_.get(); }
  /// For what is not a stream: drive, heartbeat.
  Client& client() { return *client_; }

 private:
  WireDevice(std::unique_ptr<Client> client, Capabilities capabilities);
  void take_gaps();
  void count(std::span<const std::int32_t> codes);
  void note_clock();

  std::unique_ptr<Client> client_;
  Capabilities capabilities_;
  bool started_ = false;
  std::optional<schema::Error> ended_;
  StreamCounts counts_;
  LinkCounts link_at_start_;
  StreamEvents events_;
  double next_pair_s_ = 0;
};

/// By what the device is simulated, whatever it does: its first note of that. Empty for a real one.
std::string simulated_device(const Description& description);

/// Capabilities from a description; `simulated` says also what the samples are of. Errors: device: no rate,
/// no channel, a channel of an unknown quantity or with a scale that is no number; as read_transducer().
schema::Result<Capabilities> capabilities_of(const Description& description, std::string uri);

}  // namespace tacto::firmware_host
