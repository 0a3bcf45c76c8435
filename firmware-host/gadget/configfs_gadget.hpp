// SPDX-License-Identifier: GPL-3.0-or-later
// The device as the kernel's configfs knows it: who it is, what it has, and the port that it is bound to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

struct UsbIdentity {
  std::uint16_t vendor = 0, product = 0;
  std::string serial, name;
};

/// The device ports (USB device controllers) that there are, by name.
std::vector<std::string> device_ports();
/// `wanted`, or the first where that is empty. Errors: device: there is none, or none of that name (with
/// those there are).
schema::Result<std::string> choose_port(const std::string& target);

/// One gadget with one FunctionFS function, named after its port; taken down and removed with the object.
class ConfigfsGadget {
 public:
  /// Makes the gadget's folders; what a process that was killed left of them goes first. Errors: device: no
  /// configfs, no permission, or a running gadget of ours on this port.
  static schema::Result<ConfigfsGadget> create(const std::string& port, const UsbIdentity& identity);
  ConfigfsGadget(ConfigfsGadget&& other) noexcept;
  ConfigfsGadget& operator=(ConfigfsGadget&&) = delete;
  ~ConfigfsGadget();

  /// What to mount, as type functionfs.
  const std::string& instance() const { return instance_; }
  /// Plugs the device in: from now on the host sees it. Errors: device: the port is taken.
  schema::Result<void> bind();
  /// Pulls it out.
  void unbind();

 private:
  ConfigfsGadget(std::filesystem::path folder, std::string port);
  schema::Result<void> make(const UsbIdentity& identity);
  void remove() const;

  std::filesystem::path folder_;
  std::string port_, instance_;
};

/// Lets go of the data line, as pulling the cable does, or takes it again. Errors: device.
schema::Result<void> set_connected(const std::string& port, bool connected);

}  // namespace tacto::firmware_host
