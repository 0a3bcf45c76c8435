// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_address.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::string_view kSerialKey = "serial=", kPortKey = "port=";

std::vector<std::string> uris_of(const std::vector<UsbName>& names) {
  std::vector<std::string> uris;
  for (std::size_t i = 0; i < names.size(); ++i) uris.push_back(usb_uri(names, i));
  return uris;
}

bool meant(const UsbName& name, const UsbAddress& address) {
  if (!address.serial.empty()) return name.serial == address.serial;
  return address.port.empty() || name.port == address.port;
}

tl::unexpected<schema::Error> not_there(const std::vector<UsbName>& names, const UsbAddress& address) {
  if (names.empty())
    return fail(
        ErrorKind::not_found, "no device was found on USB", "device",
        "plug it in and switch it on; 'tactograph scan' lists available devices, including emulated ones");
  const bool by_serial = !address.serial.empty();
  return fail(ErrorKind::not_found,
              by_serial ? fmt::format("no device on USB has the serial number '{}'", address.serial)
                        : fmt::format("no device was found on USB port '{}'", address.port),
              "device", fmt::format("devices on USB: {}", fmt::join(uris_of(names), ", ")));
}

}  // namespace

Result<UsbAddress> parse_usb_address(std::string_view parameters) {
  UsbAddress address;
  if (parameters.empty()) return address;
  const bool by_serial = parameters.starts_with(kSerialKey), by_port = parameters.starts_with(kPortKey);
  const std::string value(parameters.substr(by_serial ? kSerialKey.size() : by_port ? kPortKey.size() : 0));
  if ((!by_serial && !by_port) || value.empty() || value.find(',') != std::string::npos)
    return fail(
        ErrorKind::usage, fmt::format("'{}' is not an address of a device on USB", parameters), "device",
        "give usb: (if there is only one), usb:serial=XYZ or usb:port=1-2; 'tactograph scan' lists them");
  (by_serial ? address.serial : address.port) = value;
  return address;
}

std::string usb_uri(const std::vector<UsbName>& names, std::size_t index) {
  const UsbName& one = names[index];
  const bool alone = std::count_if(names.begin(), names.end(),
                                   [&](const UsbName& other) { return other.serial == one.serial; }) == 1;
  const bool tells = alone && !one.serial.empty() && one.serial.find(',') == std::string::npos;
  return tells ? fmt::format("usb:{}{}", kSerialKey, one.serial)
               : fmt::format("usb:{}{}", kPortKey, one.port);
}

Result<std::size_t> choose_usb(const std::vector<UsbName>& names, const UsbAddress& address) {
  const auto target = [&](const UsbName& name) { return meant(name, address); };
  const auto found = std::find_if(names.begin(), names.end(), target);
  if (found == names.end()) return not_there(names, address);
  if (std::count_if(names.begin(), names.end(), target) > 1)
    return fail(ErrorKind::usage, fmt::format("there are {} devices on USB", names.size()), "device",
                fmt::format("choose one with -d: {}", fmt::join(uris_of(names), ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace tacto::firmware_host
