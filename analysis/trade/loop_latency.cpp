// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/loop_latency.hpp"

#include <fmt/format.h>

#include "firmware-host/sim/device/sim_device.hpp"
#include "playback/host-loop/host_loop.hpp"
#include "playback/prepare/upload.hpp"

namespace tacto::analysis {
namespace {

using firmware_host::Client;
using schema::Result;

constexpr double kMeasuredS = 0.5, kListenS = 0.02;
constexpr double kQueueS = 4e-3;  // HostLoop keeps this much drive in the device's queue
constexpr const char* kLoopKnob = "loop";

Result<void> play_on(Client& client, const playback::Prepared& prepared) {
  if (auto sent = playback::upload(client, prepared); !sent) return sent;
  if (auto armed = client.command(wire::Arm{wire::DriveSource::profile, prepared.rate_millihertz()}); !armed)
    return armed;
  if (auto playing = client.command(wire::Play{}); !playing) return playing;
  for (const double end_s = client.transport().now_s() + kMeasuredS; client.transport().now_s() < end_s;) {
    TACTO_TRY(client.heartbeat());
    TACTO_TRY(client.receive(kListenS));
    (void)client.take_ticks();
  }
  return client.command(wire::Disarm{});
}

Result<playback::EdgeToDrive> measured_latency(const playback::Prepared& prepared) {
  auto device = firmware_host::make_sim_device("sim:paced=1", "paced=1,speed=40mm/s");
  TACTO_TRY(device);
  auto loop = playback::HostLoop::begin((*device)->client(), {prepared.rate_hz, 50, 1000});
  TACTO_TRY(loop);
  auto client = Client::connect((*loop)->transport(), "sim:");
  TACTO_TRY(client);
  TACTO_TRY(play_on(**client, prepared));
  return (*loop)->latency();
}

}  // namespace

TradeRow device_loop_row(const playback::Prepared& prepared, double tick_ns) {
  TradeRow row{kLoopKnob, "device", kNotMeasured, 0, "tick", static_cast<double>(prepared.built.sample_bytes),
               0,         {}};
  row.latency_s = 0.5 / prepared.rate_hz + 1e-9 * tick_ns;
  row.note =
      "reads and drives in one tick: half a tick of waiting, and the tick's time on this computer; only the "
      "latency is given";
  return row;
}

TradeRow host_loop_row(const playback::Prepared& prepared) {
  TradeRow row{kLoopKnob, "host", kNotMeasured, 0, "tick", static_cast<double>(prepared.built.sample_bytes),
               kQueueS,   {}};
  const auto latency = measured_latency(prepared);
  if (!latency || !(latency->p50_s > 0)) {
    row.note = "not measured: " + (latency ? "no drive was sent" : schema::message(latency.error()));
    return row;
  }
  row.latency_s = latency->p50_s;
  row.note = fmt::format("on an emulated device: p50; p99 is {:.2g} ms; only the latency was measured",
                         1e3 * latency->p99_s);
  return row;
}

}  // namespace tacto::analysis
