// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/tty/tty_transport.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "data-schema/base/open_by.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

// Opening a port raises DTR, which resets many boards; the longest of Arduino's bootloaders takes 2 s (Mega).
// The client repeats hello every 0.5 s, so that the last one is sent after these 2 s.
constexpr double kStartUpS = 2.4;

tl::unexpected<schema::Error> busy(const std::string& path, const std::string& where) {
  return fail(
      ErrorKind::device, "another program uses the port", where,
      "stop " + schema::programs_with(path, "that program (ModemManager, a terminal, another tactograph)"));
}

std::string group_of(const std::string& path) {
  struct stat about {};
  const group* const owner = ::stat(path.c_str(), &about) == 0 ? ::getgrgid(about.st_gid) : nullptr;
  return owner != nullptr ? owner->gr_name : "dialout";
}

tl::unexpected<schema::Error> not_opened(int code, const std::string& path, const std::string& where) {
  if (code == EBUSY) return busy(path, where);
  if (code == EACCES || code == EPERM) {
    const std::string group = group_of(path);
    return fail(ErrorKind::not_found,
                fmt::format("this user may not open the port; the group '{}' may", group), where,
                fmt::format("sudo usermod -aG {} $USER, then log in again", group));
  }
  return fail(ErrorKind::not_found, fmt::format("the serial port cannot be opened: {}", std::strerror(code)),
              where, "plug the board in; 'tactograph scan' lists the devices on USB serial ports");
}

// The driver cdc_acm: the board is a USB device itself, or has an adapter of this class.
bool is_acm(const std::string& path) {
  std::error_code error;
  return std::filesystem::canonical(path, error).filename().string().starts_with("ttyACM");
}

timespec duration(double time_s) {
  const double whole_s = std::floor(time_s);
  return {static_cast<time_t>(whole_s), static_cast<long>((time_s - whole_s) * 1e9)};
}

}  // namespace

// An exclusive port refuses other programs, except those of root: the lock stops those that take one, too.
Result<std::unique_ptr<TtyTransport>> TtyTransport::open(const TtyAddress& address) {
  const std::string where = tty_uri(address);
  FileDescriptor port(::open(address.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port.is_open()) return not_opened(errno, address.path, where);
  termios before{};
  if (::tcgetattr(port.get(), &before) != 0)
    return fail(ErrorKind::usage, fmt::format("'{}' is not a serial port", address.path), where,
                "'tactograph scan' lists the devices on USB serial ports");
  if (::flock(port.get(), LOCK_EX | LOCK_NB) != 0) return busy(address.path, where);
  std::unique_ptr<TtyTransport> transport(new TtyTransport(std::move(port), where, before));
  TACTO_TRY(transport->configure(address.baud.value_or(kUsualBaud)));
  if (!address.baud && is_acm(address.path)) transport->baud_ = std::numeric_limits<double>::infinity();
  return transport;
}

// A driver may take another rate without an error, so the rate is read again.
Result<void> TtyTransport::configure(unsigned baud) {
  ::ioctl(port_.get(), TIOCEXCL);
  termios wanted = raw_settings(before_), set{};
  ::cfsetspeed(&wanted, baud);
  const bool done = ::tcsetattr(port_.get(), TCSANOW, &wanted) == 0 && ::tcgetattr(port_.get(), &set) == 0 &&
                    ::cfgetospeed(&set) == ::cfgetospeed(&wanted);
  if (!done)
    return fail(ErrorKind::device, fmt::format("the port does not support {} baud", baud), where_,
                "use another rate, for example baud=115200, on the board, too");
  ::tcflush(port_.get(), TCIOFLUSH);
  baud_ = baud;
  return {};
}

// close() waits for bytes that the device has not taken yet, so they are discarded.
TtyTransport::~TtyTransport() {
  ::tcflush(port_.get(), TCOFLUSH);
  ::tcsetattr(port_.get(), TCSANOW, &before_);
  ::ioctl(port_.get(), TIOCNXCL);
}

double TtyTransport::now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double TtyTransport::start_up_s() const {
  return kStartUpS;
}

// False if the time is over.
bool TtyTransport::wait(short events, double until_s) {
  const double left_s = until_s - now_s();
  if (left_s <= 0) return false;
  pollfd ready{port_.get(), events, 0};
  const timespec time = duration(left_s);
  ::ppoll(&ready, 1, &time, nullptr);
  return true;
}

tl::unexpected<schema::Error> TtyTransport::failed(int code) const {
  if (code == EIO || code == ENXIO || code == ENODEV)
    return fail(ErrorKind::device, "the device was unplugged", where_, "check its cable and its supply");
  return fail(ErrorKind::device, fmt::format("the serial port failed: {}", std::strerror(code)), where_,
              "unplug it and plug it in again");
}

// A port that is gone reads as its end.
Result<std::size_t> TtyTransport::read(std::span<std::uint8_t> bytes, double timeout_s) {
  const double until_s = now_s() + timeout_s;
  do {
    const ssize_t got = ::read(port_.get(), bytes.data(), bytes.size());
    if (got > 0) return static_cast<std::size_t>(got);
    if (got == 0) return failed(EIO);
    if (errno != EAGAIN && errno != EINTR) return failed(errno);
  } while (wait(POLLIN, until_s));
  return 0;
}

Result<void> TtyTransport::write(std::span<const std::uint8_t> bytes, double timeout_s) {
  const double until_s = now_s() + timeout_s;
  do {
    const ssize_t sent = ::write(port_.get(), bytes.data(), bytes.size());
    if (sent < 0 && errno != EAGAIN && errno != EINTR) return failed(errno);
    if (sent > 0) bytes = bytes.subspan(static_cast<std::size_t>(sent));
    if (bytes.empty()) return {};
  } while (wait(POLLOUT, until_s));
  return fail(ErrorKind::device, fmt::format("the port accepted no data for {:g} s", timeout_s), where_,
              "unplug it and plug it in again");
}

}  // namespace tacto::firmware_host
