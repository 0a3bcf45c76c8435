// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated device: physics, instruments and converters behind the interface of a real one.
#pragma once

#include "firmware-host/device.hpp"
#include "firmware-host/sim/pacer.hpp"
#include "firmware-host/sim/sim_parameters.hpp"
#include "firmware-host/sim/sim_run.hpp"

namespace tacto::firmware_host {

/// Channels: tangential_force (the transducer's output, V), position (encoder on the finger, counts),
/// normal_force and net_force (load cell, N). Runs as fast as it can; read() computes what it gives. start()
/// begins the same recording anew: equal parameters give equal frames, to the bit, on every machine.
class SimDevice final : public Device {
 public:
  SimDevice(std::string uri, const SimParameters& parameters, const schema::Transducer& transducer,
            Surface surface);

  const Capabilities& capabilities() const override { return capabilities_; }
  schema::Result<void> start() override;
  schema::Result<std::size_t> read(std::span<std::int32_t> interleaved) override;
  schema::Result<void> stop() override;
  StreamCounts counts() const override;

 private:
  tl::unexpected<schema::Error> diverged() const;

  SimParameters parameters_;
  schema::Transducer transducer_;
  HeightProfile profile_;
  Capabilities capabilities_;
  std::unique_ptr<SimRun> run_;
  StreamCounts counts_;
  Pacer pacer_;  // begins with start()
};

/// `parameters` is what follows "sim:". Errors: as parse_sim_parameters, make_surface, read_transducer.
schema::Result<std::unique_ptr<Device>> open_sim_device(const std::string& uri, std::string_view parameters);

}  // namespace tacto::firmware_host
