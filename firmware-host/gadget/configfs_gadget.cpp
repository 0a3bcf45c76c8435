// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/configfs_gadget.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "firmware-host/link/file_descriptor.hpp"

namespace tacto::firmware_host {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;

const fs::path kGadgets = "/sys/kernel/config/usb_gadget", kPorts = "/sys/class/udc";
constexpr const char* kLanguage = "strings/0x409";  // English
constexpr const char* kConfiguration = "configs/c.1";

// One write() per value: configfs and sysfs require it. Returns 0, or the error number.
int write_value(const fs::path& path, const std::string& value) {
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  return file.is_open() && ::write(file.get(), value.data(), value.size()) >= 0 ? 0 : errno;
}

Result<void> put(const fs::path& path, const std::string& value) {
  const int error = write_value(path, value);
  if (error == 0) return {};
  return schema::fail(ErrorKind::device,
                      fmt::format("cannot be set to '{}': {}", value, std::strerror(error)), path.string(),
                      error == EACCES ? "run as root" : "");
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::string text;
  std::getline(file, text);
  return text;
}

Result<void> make_folders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return {};
  const bool may_not = error == std::errc::permission_denied;
  return schema::fail(ErrorKind::device, fmt::format("cannot be made: {}", error.message()), folder.string(),
                      may_not ? "run as root" : "modprobe libcomposite usb_f_fs, and check the kernel's log");
}

Result<void> require_configfs() {
  std::error_code none;
  if (fs::is_directory(kGadgets, none)) return {};
  return schema::fail(
      ErrorKind::device, "this kernel has no USB gadget support, or its modules are not loaded",
      kGadgets.string(), "as root: modprobe libcomposite; mount -t configfs none /sys/kernel/config");
}

// The names of the device ports (USB device controllers).
std::vector<std::string> device_ports() {
  std::vector<std::string> ports;
  std::error_code none;
  for (const fs::directory_entry& port : fs::directory_iterator(kPorts, none))
    ports.push_back(port.path().filename().string());
  std::sort(ports.begin(), ports.end());
  return ports;
}

}  // namespace

Result<std::string> choose_port(const std::string& target) {
  const std::vector<std::string> ports = device_ports();
  if (ports.empty())
    return schema::fail(ErrorKind::device, "this machine has no USB device port", kPorts.string(),
                        "use a board with a device or OTG port, in device mode; for a test on this machine, "
                        "as root: modprobe dummy_hcd");
  if (target.empty()) return ports.front();
  if (std::find(ports.begin(), ports.end(), target) != ports.end()) return target;
  return schema::fail(ErrorKind::device, fmt::format("there is no device port '{}'", target), "--udc",
                      fmt::format("the device ports are: {}", fmt::join(ports, ", ")));
}

ConfigfsGadget::ConfigfsGadget(fs::path folder, std::string port)
    : folder_(std::move(folder)), port_(std::move(port)), instance_("tactograph-" + port_) {}

ConfigfsGadget::ConfigfsGadget(ConfigfsGadget&& other) noexcept
    : folder_(std::move(other.folder_)),
      port_(std::move(other.port_)),
      instance_(std::move(other.instance_)) {
  other.folder_.clear();
}

ConfigfsGadget::~ConfigfsGadget() {
  if (folder_.empty()) return;
  unbind();
  remove();
}

Result<ConfigfsGadget> ConfigfsGadget::create(const std::string& port, const UsbIdentity& identity) {
  TACTO_TRY(require_configfs());
  const fs::path folder = kGadgets / ("tactograph-" + port);
  if (const std::string bound = text_of(folder / "UDC"); !bound.empty())
    return schema::fail(ErrorKind::device, fmt::format("another tactograph gadget already uses {}", bound),
                        folder.string(), "stop that one, or use another port with --udc");
  ConfigfsGadget gadget(folder, port);
  gadget.remove();
  TACTO_TRY(gadget.make(identity));
  return gadget;
}

Result<void> ConfigfsGadget::make(const UsbIdentity& identity) {
  const fs::path function = folder_ / ("functions/ffs." + instance_);
  for (const fs::path& folder : {folder_ / kLanguage, folder_ / kConfiguration, function})
    if (const auto made = make_folders(folder); !made) return made;
  const std::pair<const char*, std::string> values[] = {
      {"idVendor", fmt::format("0x{:04x}", identity.vendor)},
      {"idProduct", fmt::format("0x{:04x}", identity.product)},
      {"bcdDevice", "0x0100"},
      {"strings/0x409/manufacturer", "tactograph"},
      {"strings/0x409/product", identity.name},
      {"strings/0x409/serialnumber", identity.serial},
      {"configs/c.1/MaxPower", "100"}};
  for (const auto& [name, value] : values)
    if (const auto set = put(folder_ / name, value); !set) return set;
  std::error_code error;
  fs::create_directory_symlink(function, folder_ / kConfiguration / "function", error);
  if (!error) return {};
  return schema::fail(ErrorKind::device, error.message(), (folder_ / kConfiguration).string());
}

Result<void> ConfigfsGadget::bind() {
  const int error = write_value(folder_ / "UDC", port_);
  if (error == 0) return {};
  if (error != EBUSY)
    return schema::fail(ErrorKind::device,
                        fmt::format("does not accept the device: {}", std::strerror(error)), port_,
                        "check the kernel's log");
  return schema::fail(ErrorKind::device, fmt::format("the device port {} is used by another gadget", port_),
                      "--udc", fmt::format("'grep . {}/*/UDC' shows which", kGadgets.string()));
}

// If this fails, the gadget is not bound: it may have been unbound from outside.
void ConfigfsGadget::unbind() {
  write_value(folder_ / "UDC", "\n");
}

// In the order that configfs requires; missing entries are no error.
void ConfigfsGadget::remove() const {
  std::error_code none;
  fs::remove(folder_ / kConfiguration / "function", none);
  for (const fs::path& folder :
       {folder_ / kConfiguration, folder_ / ("functions/ffs." + instance_), folder_ / kLanguage, folder_})
    fs::remove(folder, none);
}

}  // namespace tacto::firmware_host
