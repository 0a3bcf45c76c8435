// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated device: physics, instruments and converters behind the firmware's core, connected by the wire
// protocol.
#pragma once

#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/sim/device/sim_board.hpp"

namespace tacto::firmware_host {

/// Channels: tangential_force (the transducer's output, V), position (encoder on the finger, counts),
/// normal_force and net_force (load cell, N). Runs at full speed, or paced; read() computes the frames.
/// start() starts the same recording again: equal parameters give the same bits in the frames, on every
/// machine.
class SimDevice final : public Device {
 public:
  /// Errors: as WireDevice::open().
  static schema::Result<std::unique_ptr<SimDevice>> open(std::string uri, const SimParameters& parameters,
                                                         const schema::Transducer& transducer,
                                                         Surface surface);

  const Capabilities& capabilities() const override { return wire_->capabilities(); }
  schema::Result<void> start() override { return wire_->start(); }
  schema::Result<std::size_t> read(std::span<std::int32_t> interleaved) override;
  schema::Result<void> stop() override { return wire_->stop(); }
  StreamCounts counts() const override { return wire_->counts(); }
  StreamEvents take_events() override { return wire_->take_events(); }
  bool is_real_time() const override { return paced_; }
  schema::Result<double> round_trip_s() override { return wire_->round_trip_s(); }

  Client* conversation() override { return &wire_->client(); }
  Client& client() { return wire_->client(); }
  SimBoard& board() { return *board_; }

 private:
  SimDevice(std::unique_ptr<SimBoard> board, std::unique_ptr<WireDevice> wire, bool paced)
      : board_(std::move(board)), wire_(std::move(wire)), paced_(paced) {}

  std::unique_ptr<SimBoard> board_;
  std::unique_ptr<WireDevice> wire_;
  bool paced_;
};

/// `parameters` is the text after "sim:". Errors: as parse_sim_parameters, make_surface, read_transducer.
schema::Result<std::unique_ptr<Device>> open_sim_device(const std::string& uri, std::string_view parameters);
schema::Result<std::unique_ptr<SimDevice>> make_sim_device(const std::string& uri,
                                                           std::string_view parameters);

}  // namespace tacto::firmware_host
