// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/tty/usb_serial_ports.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace tacto::firmware_host {
namespace {

namespace fs = std::filesystem;

// The folder of a USB device has a file idVendor; that of a device on another bus has none.
bool is_on_usb(const fs::path& tty) {
  std::error_code error;
  fs::path folder = fs::canonical(tty / "device", error);
  if (error) return false;
  for (; folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(folder / "idVendor", error)) return true;
  return false;
}

}  // namespace

std::vector<std::string> usb_serial_ports(const std::string& root) {
  std::vector<std::string> ports;
  std::error_code error;
  for (fs::directory_iterator tty(fs::path(root) / "sys/class/tty", error), end; !error && tty != end;
       tty.increment(error))
    if (is_on_usb(tty->path())) ports.push_back("/dev/" + tty->path().filename().string());
  std::ranges::sort(ports);
  return ports;
}

}  // namespace tacto::firmware_host
