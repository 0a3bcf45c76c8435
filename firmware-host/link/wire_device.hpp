// SPDX-License-Identifier: GPL-3.0-or-later
// A device that uses the wire protocol, over any transport.
#pragma once

#include "firmware-host/link/client.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// Streams at the device's default rate. Its description becomes its capabilities; its transducer, named by a
/// note, is read as in read_transducer().
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
  /// For functions besides the stream: drive, heartbeat.
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

/// The name of the device's simulation, from its first note of that kind. Empty for a real device.
std::string simulated_device(const Description& description);

/// Capabilities from a description; `simulated` also contains the source of the samples. Errors: device: no
/// rate, no channel, a channel of an unknown quantity or with a scale that is not a number; as
/// read_transducer().
schema::Result<Capabilities> capabilities_of(const Description& description, std::string uri);

}  // namespace tacto::firmware_host
