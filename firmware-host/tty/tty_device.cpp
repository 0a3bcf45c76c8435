// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/tty/tty_device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/tty/tty_transport.hpp"

namespace tacto::firmware_host {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

// The folder of a USB device has a file idVendor; that of a device on another bus has none.
bool is_on_usb(const fs::path& tty) {
  std::error_code error;
  fs::path folder = fs::canonical(tty / "device", error);
  if (error) return false;
  for (; folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(folder / "idVendor", error)) return true;
  return false;
}

using Opened = Result<std::unique_ptr<Device>>;

// At a wrong baud rate a board seems silent, or seems to send something else.
Opened open_port(const TtyAddress& address) {
  auto transport = TtyTransport::open(address);
  TACTO_TRY(transport);
  auto device = WireDevice::open(tty_uri(address), std::move(*transport));
  if (device) return std::unique_ptr<Device>(std::move(*device));
  schema::Error error = device.error();
  if (error.kind == ErrorKind::device)
    error.remedy += fmt::format("; if its baud rate is not {}, name it: tty:{},baud=RATE",
                                address.baud.value_or(kUsualBaud), address.path);
  return tl::unexpected(std::move(error));
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

Opened open_tty_among(std::span<const TtyAddress> ports) {
  if (ports.empty())
    return fail(ErrorKind::not_found, "no serial port was found on USB", "device",
                "plug the board in; another port has to be named, as in tty:/dev/ttyS0");
  if (ports.size() == 1) return open_port(ports.front());
  std::vector<std::unique_ptr<Device>> answered;
  std::vector<std::string> uris, problems;
  for (const TtyAddress& port : ports) {
    auto device = open_port(port);
    if (!device) {
      problems.push_back(schema::message({device.error().kind, device.error().what, tty_uri(port), {}}));
      continue;
    }
    uris.push_back((*device)->capabilities().uri);
    answered.push_back(std::move(*device));
  }
  if (answered.size() == 1) return std::move(answered.front());
  if (answered.empty())
    return fail(ErrorKind::not_found,
                fmt::format("no device answered on the USB serial ports: {}", fmt::join(problems, "; ")),
                "device", "name the port and its baud rate, as in tty:/dev/ttyUSB0,baud=115200");
  return fail(ErrorKind::usage, fmt::format("there are {} devices on USB serial ports", answered.size()),
              "device", fmt::format("choose one with -d: {}", fmt::join(uris, ", ")));
}

Opened open_tty_device(const std::string&, std::string_view parameters) {
  const auto address = parse_tty_address(parameters);
  TACTO_TRY(address);
  if (!address->path.empty()) return open_port(*address);
  std::vector<TtyAddress> ports;
  for (std::string& path : usb_serial_ports()) ports.push_back({std::move(path), address->baud});
  return open_tty_among(ports);
}

std::vector<std::string> tty_uris() {
  std::vector<std::string> uris;
  for (std::string& path : usb_serial_ports()) uris.push_back(tty_uri({std::move(path), std::nullopt}));
  return uris;
}

}  // namespace tacto::firmware_host
