// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/open_device.hpp"

#include <fmt/format.h>

#include "firmware-host/comedi/comedi_device.hpp"
#include "firmware-host/replay/replay_device.hpp"
#include "firmware-host/sim/device/sim_device.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "firmware-host/tty/tty_device.hpp"
#include "firmware-host/usb/usb_device.hpp"

namespace tacto::firmware_host {
namespace {

struct Scheme {
  std::string_view name;
  schema::Result<std::unique_ptr<Device>> (*open)(const std::string& uri, std::string_view parameters);
};

constexpr Scheme kSchemes[] = {{"usb:", open_usb_device},        {"tty:", open_tty_device},
                               {"comedi:", open_comedi_device},  {kPlanarScheme, open_planar_device},
                               {kArmScheme, open_planar_device}, {"sim:", open_sim_device},
                               {"replay:", open_replay_device}};

std::string schemes() {
  std::string list;
  for (const Scheme& scheme : kSchemes) list += (list.empty() ? "" : ", ") + std::string(scheme.name);
  return list;
}

}  // namespace

schema::Result<std::unique_ptr<Device>> open_device(const std::string& uri) {
  for (const Scheme& scheme : kSchemes)
    if (uri.starts_with(scheme.name))
      return scheme.open(uri, std::string_view(uri).substr(scheme.name.size()));
  return schema::fail(
      schema::ErrorKind::usage, fmt::format("'{}' is not a device that can be opened", uri), "device",
      fmt::format("the transports are: {} (for example usb: or sim:surface=C,speed=50mm/s or replay:oak)",
                  schemes()));
}

}  // namespace tacto::firmware_host
