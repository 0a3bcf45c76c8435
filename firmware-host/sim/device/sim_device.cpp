// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_device.hpp"

#include <fmt/format.h>

#include "firmware-host/sim/device/sim_transport.hpp"
#include "firmware-host/sim/physics/finger_path.hpp"

namespace tacto::firmware_host {

using schema::ErrorKind;
using schema::Result;

Result<std::unique_ptr<SimDevice>> SimDevice::open(std::string uri, const SimParameters& parameters,
                                                   const schema::Transducer& transducer, Surface surface) {
  auto board = std::make_unique<SimBoard>(parameters, transducer, std::move(surface));
  auto wire = WireDevice::open(
      std::move(uri), std::make_unique<SimTransport>(*board, parameters.paced, parameters.link_buffer_s));
  TACTO_TRY(wire);
  return std::unique_ptr<SimDevice>(new SimDevice(std::move(board), std::move(*wire), parameters.paced));
}

// On the wire this is a failed converter; here the reason is known.
Result<std::size_t> SimDevice::read(std::span<std::int32_t> interleaved) {
  const auto frames = wire_->read(interleaved);
  if (frames || board_->diverged_s() < 0) return frames;
  if (board_->diverged_s() < StrokePlan{}.rest_s)
    return schema::fail(ErrorKind::device,
                        fmt::format("the motion of the transducer '{}' diverges before the finger has moved",
                                    capabilities().transducer ? capabilities().transducer->name : ""),
                        capabilities().uri,
                        "its parameters are not those of a working tray: use another transducer");
  return schema::fail(ErrorKind::device,
                      fmt::format("the simulated finger's motion diverged at {:.4f} s", board_->diverged_s()),
                      capabilities().uri, "use less friction, load or depth");
}

Result<std::unique_ptr<SimDevice>> make_sim_device(const std::string& uri, std::string_view parameters) {
  const auto asked = parse_sim_parameters(parameters);
  TACTO_TRY(asked);
  auto surface = make_surface(asked->surface);
  TACTO_TRY(surface);
  const auto transducer = schema::read_transducer(asked->transducer);
  TACTO_TRY(transducer);
  TACTO_TRY(check_against(*asked, *transducer, surface->profile.length_m()));
  return SimDevice::open(uri, *asked, *transducer, std::move(*surface));
}

Result<std::unique_ptr<Device>> open_sim_device(const std::string& uri, std::string_view parameters) {
  return make_sim_device(uri, parameters);
}

}  // namespace tacto::firmware_host
