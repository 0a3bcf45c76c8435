// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/open_device.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "firmware-host/comedi/comedi_device.hpp"
#include "firmware-host/comedi/comedi_player.hpp"
#include "firmware-host/replay/replay_device.hpp"
#include "firmware-host/sim/device/sim_device.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "firmware-host/tty/tty_device.hpp"
#include "firmware-host/usb/usb_device.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Result;

constexpr std::string_view kSimScheme = "sim:", kReplayScheme = "replay:", kComediScheme = "comedi:";

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

struct Scheme {
  std::string_view name;
  schema::Result<std::unique_ptr<Device>> (*open)(const std::string& uri, std::string_view parameters);
};

constexpr Scheme kSchemes[] = {{"usb:", open_usb_device},           {"tty:", open_tty_device},
                               {kComediScheme, open_comedi_device}, {kPlanarScheme, open_planar_device},
                               {kArmScheme, open_planar_device},    {"sim:", open_sim_device},
                               {"replay:", open_replay_device}};

std::string schemes() {
  std::string list;
  for (const Scheme& scheme : kSchemes) list += (list.empty() ? "" : ", ") + std::string(scheme.name);
  return list;
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

schema::Result<std::unique_ptr<Device>> open_device(const std::string& uri) {
  for (const Scheme& scheme : kSchemes)
    if (uri.starts_with(scheme.name))
      return scheme.open(uri, std::string_view(uri).substr(scheme.name.size()));
  return schema::fail(
      schema::ErrorKind::usage, fmt::format("'{}' is not a device that can be opened", uri), "device",
      fmt::format("the transports are: {} (for example usb: or sim:surface=C,speed=50mm/s or replay:oak)",
                  schemes()));
}

Result<std::unique_ptr<Device>> open_device_to_play(const std::string& uri, bool without_watchdog) {
  if (uri.starts_with(kComediScheme))
    return open_comedi_to_play(uri, std::string_view(uri).substr(kComediScheme.size()), without_watchdog);
  if (!without_watchdog) return open_device(uri);
  return schema::fail(schema::ErrorKind::usage, "--no-watchdog is for a data acquisition card (comedi:)", uri,
                      "leave it out: a board has a watchdog of its own");
}

}  // namespace tacto::firmware_host
