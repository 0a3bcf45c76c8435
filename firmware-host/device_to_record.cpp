// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/device_to_record.hpp"
#include "firmware-host/open_device.hpp"

#include <string_view>
#include <utility>

#include "firmware-host/sim/device/sim_device.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Result;

constexpr std::string_view kSimScheme = "sim:", kReplayScheme = "replay:";

// The largest value of the key: over a day with the shortest and fastest strokes.
constexpr std::string_view kStrokesWithoutEnd = "strokes=1000000";

bool has_strokes_key(std::string_view parameters) {
  return parameters.starts_with("strokes=") || parameters.find(",strokes=") != std::string_view::npos;
}

Result<DeviceToRecord> open_sim_to_record(const std::string& uri) {
  std::string parameters = uri.substr(kSimScheme.size());
  const auto asked = parse_sim_parameters(parameters);
  TACTO_TRY(asked);
  DeviceToRecord opened;
  const bool strokes_asked = has_strokes_key(parameters) || asked->counter || asked->known_force;
  if (strokes_asked)
    opened.strokes = asked->counter ? 0 : static_cast<std::uint64_t>(asked->strokes.strokes);
  else
    parameters.append(parameters.empty() ? "" : ",").append(kStrokesWithoutEnd);
  auto device = make_sim_device(uri, parameters);
  TACTO_TRY(device);
  opened.device = std::move(*device);
  return opened;
}

}  // namespace

Result<DeviceToRecord> open_device_to_record(const std::string& uri) {
  if (is_planar(uri))
    return schema::fail(schema::ErrorKind::unsuitable, "a force device has no channels to record", uri,
                        "play a scene with force patches on it");
  if (uri.starts_with(kSimScheme)) return open_sim_to_record(uri);
  auto device = open_device(uri);
  TACTO_TRY(device);
  return DeviceToRecord{std::move(*device), uri.starts_with(kReplayScheme), std::nullopt};
}

}  // namespace tacto::firmware_host
