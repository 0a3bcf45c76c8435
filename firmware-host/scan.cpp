// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/scan.hpp"

#include "firmware-host/sim/surface.hpp"

namespace tacto::firmware_host {
namespace {

schema::Result<Capabilities> asked(const std::string& uri) {
  const auto device = open_device(uri);
  if (!device) return schema::forward_error(device);
  return (*device)->capabilities();
}

}  // namespace

std::vector<FoundDevice> scan_devices() {
  std::vector<FoundDevice> found;
  const std::string names = surface_names() + ", ";
  for (std::size_t at = 0, end; (end = names.find(", ", at)) != std::string::npos; at = end + 2) {
    const std::string uri = "sim:surface=" + names.substr(at, end - at);
    found.push_back({uri, asked(uri)});
  }
  return found;
}

}  // namespace tacto::firmware_host
