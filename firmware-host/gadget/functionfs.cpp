// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/functionfs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <span>

#include "firmware-host/core/firmware/usb_identity.hpp"
#include "firmware-host/gadget/functionfs_descriptors.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

tl::unexpected<schema::Error> failed(std::string_view what, const std::string& where,
                                     std::string remedy = {}) {
  return schema::fail(ErrorKind::device, fmt::format("{}: {}", what, std::strerror(errno)), where,
                      std::move(remedy));
}

/// A folder with the function mounted on it, during the opening of the files.
class Mount {
 public:
  ~Mount() {
    if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
    if (!folder_.empty()) ::rmdir(folder_.c_str());
  }

  Result<void> mount(const std::string& instance) {
    std::error_code none;
    std::string pattern = (std::filesystem::temp_directory_path(none) / "tactograph-ffs-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr)
      return failed("the folder of the mount cannot be created", pattern);
    folder_ = pattern;
    mounted_ = ::mount(instance.c_str(), folder_.c_str(), "functionfs", 0, nullptr) == 0;
    if (!mounted_) return failed("FunctionFS cannot be mounted", folder_, "run as root; modprobe usb_f_fs");
    return {};
  }

  Result<FileDescriptor> open(const char* name) const {
    const std::string path = folder_ + "/" + name;
    FileDescriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
    if (!file.is_open()) return failed("cannot be opened", path);
    return file;
  }

 private:
  std::string folder_;
  bool mounted_ = false;
};

Result<void> tell(const FileDescriptor& file, std::span<const std::uint8_t> bytes, const char* what) {
  const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
  if (written != static_cast<ssize_t>(bytes.size()))
    return failed(fmt::format("the kernel refuses the {}", what), "FunctionFS ep0");
  return {};
}

Result<FunctionFs> open_files(const Mount& mount) {
  FunctionFs files;
  auto events = mount.open("ep0");
  TACTO_TRY(events);
  files.events = std::move(*events);
  TACTO_TRY(tell(files.events, functionfs_descriptors(), "descriptors"));
  TACTO_TRY(tell(files.events, functionfs_strings(usb::kInterfaceName), "strings"));
  auto in = mount.open("ep1");
  TACTO_TRY(in);
  auto out = mount.open("ep2");
  TACTO_TRY(out);
  files.in = std::move(*in);
  files.out = std::move(*out);
  return files;
}

}  // namespace

Result<FunctionFs> open_functionfs(const std::string& instance) {
  Mount mount;
  TACTO_TRY(mount.mount(instance));
  return open_files(mount);
}

}  // namespace tacto::firmware_host
