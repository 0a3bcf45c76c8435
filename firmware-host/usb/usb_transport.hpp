// SPDX-License-Identifier: GPL-3.0-or-later
// The cable to a device on USB.
#pragma once

#include <libusb.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "firmware-host/link/transport.hpp"

namespace tacto::firmware_host {

// The address of a device on USB.

/// The text after "usb:". Both empty: the only device.
struct UsbAddress {
  std::string serial;
  std::string port;  ///< bus and the ports up to the device, in the kernel's notation: "1-2.4"
};

/// "", "serial=XYZ" or "port=1-2.4"; a serial may contain any byte except a comma. Errors: usage.
schema::Result<UsbAddress> parse_usb_address(std::string_view parameters);

/// The properties of a device that are known before it is opened.
struct UsbName {
  std::string serial;  ///< empty if it has none, or if this user may not read it
  std::string port;
};

/// The URI that identifies `names[index]`: by serial, or by port if the serial is missing or not unique.
std::string usb_uri(const std::vector<UsbName>& names, std::size_t index);

/// The index of the device in `names`. Errors: not_found: it does not exist; usage: several match, with their
/// names.
schema::Result<std::size_t> choose_usb(const std::vector<UsbName>& names, const UsbAddress& address);

// An open USB device with its interface claimed.

/// A session with libusb. It scans the bus at the start, which takes milliseconds. Errors: device.
schema::Result<std::shared_ptr<libusb_context>> begin_usb();

/// Owning pointers for objects of libusb.
struct UsbDeleter {
  void operator()(libusb_context* context) const { libusb_exit(context); }
  void operator()(libusb_device* device) const { libusb_unref_device(device); }
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
  void operator()(libusb_config_descriptor* descriptor) const { libusb_free_config_descriptor(descriptor); }
  void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};

template <class Lent>
using UsbPointer = std::unique_ptr<Lent, UsbDeleter>;

/// The interface of the wire among those of a device.
struct UsbInterface {
  std::uint8_t number = 0, setting = 0;
  std::uint8_t in = 0, out = 0;  ///< addresses of the bulk endpoints
};

struct UsbFound {
  UsbName name;
  UsbInterface interface;
  UsbPointer<libusb_device> device;
};

/// Every USB device with an interface of the wire, of any vendor, in the order of buses and ports, with its
/// serial if this user may read it. Errors: device: the bus cannot be read.
schema::Result<std::vector<UsbFound>> find_usb(libusb_context* context);

std::vector<UsbName> names_of(const std::vector<UsbFound>& found);

/// For one thread. Its transfers must have ended before it is destroyed.
class UsbConnection {
 public:
  /// Errors: as choose_usb(); not_found: this user may not open it; device: another program uses it, or it
  /// fails.
  static schema::Result<UsbConnection> open(const UsbAddress& address);
  UsbConnection(UsbConnection&&) = default;
  UsbConnection& operator=(UsbConnection&&) = delete;
  ~UsbConnection();

  libusb_device_handle* handle() const { return handle_.get(); }
  const UsbInterface& interface() const { return interface_; }
  /// The URI that distinguishes it from all other devices at that time.
  const std::string& uri() const { return uri_; }
  /// Completes transfers until one has set `done` or the time is over.
  schema::Result<void> handle_events(double timeout_s, int& done) const;

 private:
  UsbConnection() = default;
  schema::Result<void> claim(const UsbFound& found);

  std::shared_ptr<libusb_context> context_;
  UsbPointer<libusb_device_handle> handle_;
  UsbInterface interface_;
  std::string uri_;
};

/// Bytes to a device, one transfer after the other. A transfer ends with a short packet, or an empty one if
/// its size is a multiple of the packet size. For one thread.
class UsbOutflow {
 public:
  /// The connection must outlive this object.
  explicit UsbOutflow(const UsbConnection& connection);
  UsbOutflow(const UsbOutflow&) = delete;
  UsbOutflow& operator=(const UsbOutflow&) = delete;
  ~UsbOutflow();

  /// Waits until the device has received all bytes; other transfers complete in the meantime. A transfer that
  /// stalls or is truncated is sent again as a whole: the wire's decoder finds it after the incomplete one.
  /// Errors: device: gone, three stalls, or not received within `timeout_s`.
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s);

 private:
  static void LIBUSB_CALL gone(libusb_transfer* transfer);
  schema::Result<void> send(double timeout_s);
  bool sent_whole() const;
  schema::Result<void> clear();
  schema::Result<void> await_end();

  const UsbConnection& connection_;
  UsbPointer<libusb_transfer> transfer_;
  std::vector<std::uint8_t> buffer_;
  bool under_way_ = false;
  int done_ = 0;
};

/// Bytes from a device: many transfers are pending at once, so that the device never waits. Transfers
/// complete in libusb's event loop, which the caller runs; their bytes are queued here, in order. After a
/// stall, an overflow or a cable error all transfers are cancelled, the endpoint is cleared, and all are
/// submitted again; bytes that were lost in between are gaps for the reader of frames. For one thread.
class UsbInflow {
 public:
  /// 1 MiB in all: 0.3 s of the fastest stream (100 kHz x 8 channels, 3.2 MB/s) or 64 bursts of a slow one
  /// (0.2 s at 10 kHz) before the device has to wait. The kernel does not have to split a transfer of this
  /// size.
  static constexpr std::size_t kTransfers = 64, kTransferBytes = 16384;
  /// The number of consecutive errors, without a byte between them, that are tolerated.
  static constexpr int kMostTroubles = 5;

  /// The connection must outlive this object.
  explicit UsbInflow(const UsbConnection& connection);
  UsbInflow(const UsbInflow&) = delete;
  UsbInflow& operator=(const UsbInflow&) = delete;
  /// Cancels all transfers and waits for them.
  ~UsbInflow();

  /// Submits the idle transfers, and recovers from errors. Errors: device: gone, or not recoverable; from
  /// then on at each call.
  schema::Result<void> keep_going();
  bool empty() const { return full_.empty(); }
  /// Bytes of at most one transfer; returns their number.
  std::size_t take(std::span<std::uint8_t> bytes);
  /// Waits until a transfer has completed, or the time is over. Errors: device.
  schema::Result<void> wait(double timeout_s);

 private:
  struct Slot {
    UsbPointer<libusb_transfer> transfer;
    std::vector<std::uint8_t> buffer;
  };
  static void LIBUSB_CALL arrived(libusb_transfer* transfer);
  void sort_in(libusb_transfer* transfer);
  void note(libusb_transfer_status status);
  void recover();
  void give_up(libusb_transfer_status trouble);
  void submit_idle();
  void cancel_all();
  void end(const tl::unexpected<schema::Error>& reason);

  const UsbConnection& connection_;
  std::unique_ptr<std::vector<Slot>> slots_;
  std::vector<libusb_transfer*> idle_;
  std::deque<libusb_transfer*> full_;
  std::size_t used_ = 0;  // bytes of the first full one
  std::size_t under_way_ = 0;
  std::optional<libusb_transfer_status> trouble_;
  bool cancelled_ = false;
  int consecutive_errors_ = 0;
  std::optional<schema::Error> ended_;
  int woken_ = 0;
};

/// All work is done in the caller's thread, within read() and write(); between calls the kernel continues to
/// fill transfers (see UsbInflow for how long). Bytes received before an error are returned before the error.
class UsbTransport final : public Transport {
 public:
  explicit UsbTransport(UsbConnection connection);

  /// Errors, besides those of Transport: device: the endpoint fails and does not recover.
  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override;
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) override;
  /// Of the steady clock.
  double now_s() override;

  /// The URI that distinguishes the device from others.
  const std::string& uri() const { return connection_.uri(); }

 private:
  UsbConnection connection_;
  UsbInflow inflow_;
  UsbOutflow outflow_;
};

}  // namespace tacto::firmware_host
