// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/usb_link.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/usb/functionfs.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mount.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <span>

#include "firmware-host/core/firmware/usb_identity.hpp"
#include "firmware-host/gadget/configfs_gadget.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;
using std::chrono::milliseconds;

constexpr std::uint8_t kInEndpoint = 0x81, kOutEndpoint = 0x02;  // the kernel may assign others
constexpr std::uint16_t kEnglish = 0x0409;

/// Little-endian on every machine, as USB and FunctionFS require.
class Bytes {
 public:
  void u8(std::initializer_list<std::uint8_t> values) { bytes_.insert(bytes_.end(), values); }
  void u16(std::uint16_t value) {
    u8({static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)});
  }
  void u32(std::uint32_t value) {
    u16(static_cast<std::uint16_t>(value));
    u16(static_cast<std::uint16_t>(value >> 16));
  }
  void text(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  /// Writes the total size into the header.
  std::vector<std::uint8_t> with_length_at(std::size_t place) {
    for (std::size_t i = 0; i < 4; ++i)
      bytes_[place + i] = static_cast<std::uint8_t>(bytes_.size() >> (8 * i));
    return std::move(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

void add_endpoint(Bytes& bytes, std::uint8_t address, std::size_t packet) {
  bytes.u8({USB_DT_ENDPOINT_SIZE, USB_DT_ENDPOINT, address, USB_ENDPOINT_XFER_BULK});
  bytes.u16(static_cast<std::uint16_t>(packet));
  bytes.u8({0});
  if (packet != usb::kSuperSpeedPacket) return;
  bytes.u8({USB_DT_SS_EP_COMP_SIZE, USB_DT_SS_ENDPOINT_COMP, 0, 0, 0, 0});
}

void add_interface(Bytes& bytes, std::size_t packet) {
  bytes.u8({USB_DT_INTERFACE_SIZE, USB_DT_INTERFACE, 0, 0, 2, usb::kInterfaceClass, usb::kInterfaceSubclass,
            usb::kInterfaceProtocol, 1});
  add_endpoint(bytes, kInEndpoint, packet);
  add_endpoint(bytes, kOutEndpoint, packet);
}

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

constexpr std::size_t kTransfer = 16384;        // the largest transfer, bytes
constexpr std::size_t kMostReceived = 1 << 18;  // bytes that the board has not read
constexpr milliseconds kPollInterval{20};       // interval of polling for changes without an event

const char* speed_of(std::size_t packet) {
  return packet >= usb::kSuperSpeedPacket ? "super" : packet >= usb::kHighSpeedPacket ? "high" : "full";
}

}  // namespace

std::vector<std::uint8_t> functionfs_descriptors() {
  Bytes bytes;
  bytes.u32(FUNCTIONFS_DESCRIPTORS_MAGIC_V2);
  bytes.u32(0);
  bytes.u32(FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_HAS_SS_DESC);
  for (const std::uint32_t descriptors : {3, 3, 5}) bytes.u32(descriptors);
  for (const std::size_t packet : {usb::kFullSpeedPacket, usb::kHighSpeedPacket, usb::kSuperSpeedPacket})
    add_interface(bytes, packet);
  return bytes.with_length_at(4);
}

std::vector<std::uint8_t> functionfs_strings(std::string_view interface_name) {
  Bytes bytes;
  bytes.u32(FUNCTIONFS_STRINGS_MAGIC);
  bytes.u32(0);
  bytes.u32(1);
  bytes.u32(1);
  bytes.u16(kEnglish);
  bytes.text(interface_name);
  bytes.u8({0});
  return bytes.with_length_at(4);
}

Result<FunctionFs> open_functionfs(const std::string& instance) {
  Mount mount;
  TACTO_TRY(mount.mount(instance));
  return open_files(mount);
}

UsbLink::UsbLink(FunctionFs files, std::function<void(const std::string&)> say)
    : files_(std::move(files)),
      say_(std::move(say)),
      events_thread_([this] { watch_events(); }),
      send_thread_([this] { send_bursts(); }),
      receive_thread_([this] { receive_bursts(); }) {}

UsbLink::~UsbLink() {
  stopping_ = true;
  for (std::thread* thread : {&events_thread_, &send_thread_, &receive_thread_}) thread->join();
}

void UsbLink::send(std::span<const std::uint8_t> bytes) {
  if (up_) to_host_.put(bytes);
}

void UsbLink::take_received(std::vector<std::uint8_t>& bytes) {
  const std::lock_guard lock(mutex_);
  bytes.insert(bytes.end(), from_host_.begin(), from_host_.end());
  from_host_.clear();
}

void UsbLink::wait_until(Clock::time_point time) {
  std::unique_lock lock(mutex_);
  came_.wait_until(lock, time, [&] { return fresh_; });
  fresh_ = false;
}

void UsbLink::watch_events() {
  while (!stopping_) {
    pollfd ready{files_.events.get(), POLLIN, 0};
    if (::poll(&ready, 1, 5 * static_cast<int>(kPollInterval.count())) > 0) handle_event();
  }
}

void UsbLink::handle_event() {
  usb_functionfs_event event{};
  if (::read(files_.events.get(), &event, sizeof event) != sizeof event) return;
  switch (event.type) {
    case FUNCTIONFS_ENABLE:
      return come_up();
    case FUNCTIONFS_DISABLE:
      return go_down("the host disconnected or restarts");
    case FUNCTIONFS_UNBIND:
      return go_down("the device port is closed");
    case FUNCTIONFS_SETUP:
      return refuse_setup((event.u.setup.bRequestType & USB_DIR_IN) != 0);
    default:  // bind, suspend, resume: transfers continue
      return;
  }
}

void UsbLink::come_up() {
  usb_endpoint_descriptor endpoint{};
  const bool known = ::ioctl(files_.in.get(), FUNCTIONFS_ENDPOINT_DESC, &endpoint) == 0;
  packet_ = known ? endpoint.wMaxPacketSize : usb::kHighSpeedPacket;
  up_ = true;
  say_(fmt::format("a host has configured the device, {} speed", speed_of(packet_)));
}

void UsbLink::go_down(const char* why) {
  if (!up_.exchange(false)) return;
  to_host_.clear();
  say_(why);
}

// FunctionFS stalls a request that is answered in the wrong direction.
void UsbLink::refuse_setup(bool in) const {
  const ssize_t refused =
      in ? ::read(files_.events.get(), nullptr, 0) : ::write(files_.events.get(), nullptr, 0);
  if (refused >= 0) say_("an unknown request was not refused");
}

void UsbLink::send_bursts() {
  while (!stopping_) {
    const Burst burst = to_host_.take(kTransfer, kPollInterval);
    if (!burst.bytes.empty() && !send_burst(burst)) {
      to_host_.clear();
      std::this_thread::sleep_for(kPollInterval);
    }
  }
}

// False if the host is gone. Its unread bytes are lost, as with an unplugged cable.
bool UsbLink::send_burst(const Burst& burst) {
  const auto size = static_cast<ssize_t>(burst.bytes.size());
  if (::write(files_.in.get(), burst.bytes.data(), burst.bytes.size()) != size) return false;
  const bool whole_packets = burst.bytes.size() % packet_ == 0;
  return !whole_packets || !burst.last || ::write(files_.in.get(), burst.bytes.data(), 0) == 0;
}

// A host that sends faster than the board reads has to wait.
bool UsbLink::input_is_full() {
  const std::lock_guard lock(mutex_);
  return from_host_.size() > kMostReceived;
}

// If no host has configured the device, the endpoint returns an error at once.
void UsbLink::receive_bursts() {
  std::array<std::uint8_t, kTransfer> bytes{};
  while (!stopping_) {
    const ssize_t got = input_is_full() ? -1 : ::read(files_.out.get(), bytes.data(), bytes.size());
    if (got < 0) {
      std::this_thread::sleep_for(kPollInterval);
      continue;
    }
    const std::lock_guard lock(mutex_);
    from_host_.insert(from_host_.end(), bytes.begin(), bytes.begin() + got);
    fresh_ = true;
    came_.notify_one();
  }
}

}  // namespace tacto::firmware_host
