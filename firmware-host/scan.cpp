// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/scan.hpp"

#include "firmware-host/open_device.hpp"
#include "firmware-host/sim/physics/surface.hpp"
#include "firmware-host/tty/tty_device.hpp"
#include "firmware-host/usb/usb_device.hpp"

namespace tacto::firmware_host {
namespace {

schema::Result<Capabilities> asked(const std::string& uri) {
  const auto device = open_device(uri);
  TACTO_TRY(device);
  return (*device)->capabilities();
}

std::vector<FoundDevice> scan_usb() {
  const auto uris = usb_uris();
  if (!uris) return {{"usb:", schema::forward_error(uris)}};
  std::vector<FoundDevice> found;
  for (const std::string& uri : *uris) found.push_back({uri, asked(uri)});
  return found;
}

}  // namespace

std::vector<FoundDevice> scan_devices() {
  std::vector<FoundDevice> found = scan_usb();
  for (const std::string& uri : tty_uris()) found.push_back({uri, asked(uri)});
  const std::string names = surface_names() + ", ";
  for (std::size_t at = 0, end; (end = names.find(", ", at)) != std::string::npos; at = end + 2) {
    const std::string uri = "sim:surface=" + names.substr(at, end - at);
    found.push_back({uri, asked(uri)});
  }
  return found;
}

}  // namespace tacto::firmware_host
