// SPDX-License-Identifier: GPL-3.0-or-later
// The device in the kernel's configfs: its identity, its function, and the port that it is bound to.
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

/// `target`, or the first port if that is empty. Errors: device: there is none, or none of that name (with
/// the existing ones).
schema::Result<std::string> choose_port(const std::string& target);

/// One gadget with one FunctionFS function, named after its port; unbound and removed by the destructor.
class ConfigfsGadget {
 public:
  /// Creates the folders of the gadget, after removing those that a killed process left. Errors: device: no
  /// configfs, no permission, or a running gadget of this program on this port.
  static schema::Result<ConfigfsGadget> create(const std::string& port, const UsbIdentity& identity);
  ConfigfsGadget(ConfigfsGadget&& other) noexcept;
  ConfigfsGadget& operator=(ConfigfsGadget&&) = delete;
  ~ConfigfsGadget();

  /// The source to mount, with type functionfs.
  const std::string& instance() const { return instance_; }
  /// Plugs the device in: the host can see it. Errors: device: the port is in use.
  schema::Result<void> bind();
  /// Unplugs the device.
  void unbind();

 private:
  ConfigfsGadget(std::filesystem::path folder, std::string port);
  schema::Result<void> make(const UsbIdentity& identity);
  void remove() const;

  std::filesystem::path folder_;
  std::string port_, instance_;
};

}  // namespace tacto::firmware_host
