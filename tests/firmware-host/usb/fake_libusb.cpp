// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/firmware-host/usb/fake_libusb.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>

namespace tacto::tests {
namespace {

constexpr int kMostCompletionsInATurn = 3;  // so that the caller has to call again

std::vector<libusb_transfer*>& cancelled() {
  static std::vector<libusb_transfer*> list;
  return list;
}

FakeUsbDevice& of(libusb_device* device) {
  return *reinterpret_cast<FakeUsbDevice*>(device);
}
FakeUsbDevice& of(libusb_device_handle* handle) {
  return *reinterpret_cast<FakeUsbDevice*>(handle);
}

bool inwards(const libusb_transfer* transfer) {
  return (transfer->endpoint & LIBUSB_ENDPOINT_IN) != 0;
}

std::deque<libusb_transfer*>& under_way(FakeUsbDevice& device, bool in) {
  return in ? device.in_under_way : device.out_under_way;
}

bool is_under_way(const libusb_transfer* transfer) {
  for (FakeUsbDevice& device : fake_usb().devices)
    for (const auto* list : {&device.in_under_way, &device.out_under_way})
      if (std::find(list->begin(), list->end(), transfer) != list->end()) return true;
  return false;
}

void wrong(const char* what) {
  fake_usb().faults.emplace_back(what);
}

// Ends the first transfer under way and discards its remaining events.
void complete(FakeUsbDevice& device, bool in, libusb_transfer_status status, std::size_t bytes) {
  auto& list = under_way(device, in);
  libusb_transfer* const transfer = list.front();
  list.pop_front();
  std::erase(cancelled(), transfer);
  transfer->status = status;
  transfer->actual_length = static_cast<int>(bytes);
  transfer->callback(transfer);
}

bool complete_cancelled() {
  if (cancelled().empty()) return false;
  libusb_transfer* const transfer = cancelled().front();
  FakeUsbDevice& device = of(transfer->dev_handle);
  auto& list = under_way(device, inwards(transfer));
  std::erase(list, transfer);
  list.push_front(transfer);
  complete(device, inwards(transfer), LIBUSB_TRANSFER_CANCELLED, 0);
  return true;
}

libusb_transfer_status status_of(UsbEvent::Kind kind) {
  if (kind == UsbEvent::halt) return LIBUSB_TRANSFER_STALL;
  if (kind == UsbEvent::error) return LIBUSB_TRANSFER_ERROR;
  if (kind == UsbEvent::overflow) return LIBUSB_TRANSFER_OVERFLOW;
  return kind == UsbEvent::silence ? LIBUSB_TRANSFER_TIMED_OUT : LIBUSB_TRANSFER_COMPLETED;
}

std::size_t move_bytes(FakeUsbDevice& device, bool in, const UsbEvent* event) {
  libusb_transfer* const transfer = under_way(device, in).front();
  const auto room = static_cast<std::size_t>(transfer->length);
  if (in) {
    const std::size_t size = std::min(room, event->bytes.size());
    std::copy_n(event->bytes.begin(), size, transfer->buffer);
    return size;
  }
  const std::size_t size = event ? std::min(room, event->bytes.size()) : room;
  device.taken.insert(device.taken.end(), transfer->buffer, transfer->buffer + size);
  return size;
}

void complete_all(FakeUsbDevice& device, libusb_transfer_status status) {
  for (const bool in : {true, false})
    for (std::size_t left = under_way(device, in).size(); left > 0; --left) complete(device, in, status, 0);
}

// Advances one endpoint; true if something happened. An OUT endpoint without events accepts everything.
bool advance(FakeUsbDevice& device, bool in) {
  auto& events = in ? device.in : device.out;
  bool& halted = in ? device.in_halted : device.out_halted;
  if (under_way(device, in).empty()) return false;
  if (halted) return complete(device, in, LIBUSB_TRANSFER_STALL, 0), true;
  if (events.empty() && in) return false;
  if (events.empty())
    return complete(device, in, LIBUSB_TRANSFER_COMPLETED, move_bytes(device, in, nullptr)), true;
  const UsbEvent event = events.front();
  events.pop_front();
  halted = event.kind == UsbEvent::halt;
  if (event.kind == UsbEvent::unplug) device.plugged = false;
  if (event.kind == UsbEvent::unplug) return complete_all(device, LIBUSB_TRANSFER_NO_DEVICE), true;
  if (event.kind == UsbEvent::reset) return complete_all(device, LIBUSB_TRANSFER_NO_DEVICE), true;
  complete(device, in, status_of(event.kind), move_bytes(device, in, &event));
  return true;
}

bool advance_any() {
  if (complete_cancelled()) return true;
  for (FakeUsbDevice& device : fake_usb().devices)
    for (const bool in : {false, true})
      if (advance(device, in)) return true;
  return false;
}

}  // namespace

FakeUsb& fake_usb() {
  static FakeUsb usb;
  return usb;
}

}  // namespace tacto::tests

using namespace tacto::tests;

extern "C" {

int libusb_init(libusb_context** context) {
  if (fake_usb().init_code != 0) return fake_usb().init_code;
  ++fake_usb().lent;
  *context = reinterpret_cast<libusb_context*>(&fake_usb());
  return 0;
}
void libusb_exit(libusb_context*) {
  if (--fake_usb().lent != 0) wrong("the session ended while something was lent");
}
ssize_t libusb_get_device_list(libusb_context*, libusb_device*** list) {
  auto& devices = fake_usb().devices;
  *list = new libusb_device*[devices.size() + 1]();
  ++fake_usb().lent;
  for (std::size_t i = 0; i < devices.size(); ++i)
    (*list)[i] = libusb_ref_device(reinterpret_cast<libusb_device*>(&devices[i]));
  return static_cast<ssize_t>(devices.size());
}
void libusb_free_device_list(libusb_device** list, int unreference) {
  for (libusb_device** one = list; unreference != 0 && *one != nullptr; ++one) libusb_unref_device(*one);
  delete[] list;
  --fake_usb().lent;
}
libusb_device* libusb_ref_device(libusb_device* device) {
  return ++fake_usb().lent, device;
}
void libusb_unref_device(libusb_device*) {
  --fake_usb().lent;
}
std::uint8_t libusb_get_bus_number(libusb_device* device) {
  return of(device).bus;
}
std::uint8_t libusb_get_device_address(libusb_device*) {
  return 0;  // no node of /dev has this number
}
int libusb_get_port_numbers(libusb_device* device, std::uint8_t* ports, int) {
  std::copy(of(device).ports.begin(), of(device).ports.end(), ports);
  return static_cast<int>(of(device).ports.size());
}
int libusb_get_device_descriptor(libusb_device* device, libusb_device_descriptor* about) {
  about->iSerialNumber = of(device).serial.empty() ? 0 : 3;
  return 0;
}
int libusb_get_string_descriptor_ascii(libusb_device_handle* handle, std::uint8_t, unsigned char* text,
                                       int size) {
  const std::string& serial = of(handle).serial;
  std::memcpy(text, serial.data(), std::min(serial.size(), static_cast<std::size_t>(size)));
  return static_cast<int>(serial.size());
}
int libusb_get_active_config_descriptor(libusb_device* device, libusb_config_descriptor** descriptor) {
  const FakeUsbDevice& said = of(device);
  auto* endpoints = new libusb_endpoint_descriptor[said.endpoints.size()]();
  for (std::size_t i = 0; i < said.endpoints.size(); ++i) {
    endpoints[i].bEndpointAddress = said.endpoints[i];
    endpoints[i].bmAttributes = LIBUSB_TRANSFER_TYPE_BULK;
  }
  auto* setting = new libusb_interface_descriptor();
  setting->bInterfaceClass = said.interface_class;
  setting->bInterfaceSubClass = said.interface_subclass;
  setting->bInterfaceProtocol = said.protocol;
  setting->bNumEndpoints = static_cast<std::uint8_t>(said.endpoints.size());
  setting->endpoint = endpoints;
  auto* interface = new libusb_interface{setting, 1};
  *descriptor = new libusb_config_descriptor();
  (*descriptor)->bNumInterfaces = 1;
  (*descriptor)->interface = interface;
  ++fake_usb().lent;
  return 0;
}
void libusb_free_config_descriptor(libusb_config_descriptor* descriptor) {
  delete[] descriptor->interface->altsetting->endpoint;
  delete descriptor->interface->altsetting;
  delete descriptor->interface;
  delete descriptor;
  --fake_usb().lent;
}
int libusb_open(libusb_device* device, libusb_device_handle** handle) {
  if (!of(device).plugged) return LIBUSB_ERROR_NO_DEVICE;
  if (of(device).open_code != 0) return of(device).open_code;
  ++fake_usb().lent;
  *handle = reinterpret_cast<libusb_device_handle*>(device);
  return 0;
}
void libusb_close(libusb_device_handle* handle) {
  --fake_usb().lent;
  if (!of(handle).in_under_way.empty() || !of(handle).out_under_way.empty())
    wrong("closed with transfers under way");
  if (of(handle).claimed) wrong("closed while claimed");
}
int libusb_set_auto_detach_kernel_driver(libusb_device_handle*, int) {
  return 0;
}
int libusb_claim_interface(libusb_device_handle* handle, int) {
  of(handle).claimed = of(handle).claim_code == 0;
  return of(handle).claim_code;
}
int libusb_release_interface(libusb_device_handle* handle, int) {
  return of(handle).claimed = false, 0;
}
int libusb_set_interface_alt_setting(libusb_device_handle*, int, int) {
  return 0;
}
int libusb_clear_halt(libusb_device_handle* handle, unsigned char endpoint) {
  FakeUsbDevice& device = of(handle);
  const bool in = (endpoint & LIBUSB_ENDPOINT_IN) != 0;
  if (!under_way(device, in).empty()) wrong("cleared while transfers were under way");
  ++fake_usb().cleared;
  if (!device.plugged) return LIBUSB_ERROR_NO_DEVICE;
  (in ? device.in_halted : device.out_halted) = false;
  return 0;
}
libusb_transfer* libusb_alloc_transfer(int) {
  return ++fake_usb().lent, new libusb_transfer();
}
void libusb_free_transfer(libusb_transfer* transfer) {
  if (is_under_way(transfer)) wrong("freed while under way");
  --fake_usb().lent;
  delete transfer;
}
int libusb_submit_transfer(libusb_transfer* transfer) {
  FakeUsbDevice& device = of(transfer->dev_handle);
  if (!device.plugged) return LIBUSB_ERROR_NO_DEVICE;
  if (is_under_way(transfer)) return LIBUSB_ERROR_BUSY;
  if (!inwards(transfer) && (transfer->flags & LIBUSB_TRANSFER_ADD_ZERO_PACKET) == 0)
    wrong("no packet ends the burst");
  under_way(device, inwards(transfer)).push_back(transfer);
  return 0;
}
int libusb_cancel_transfer(libusb_transfer* transfer) {
  if (!is_under_way(transfer)) return LIBUSB_ERROR_NOT_FOUND;
  cancelled().push_back(transfer);
  return 0;
}
int libusb_handle_events_timeout_completed(libusb_context*, timeval* timeout, int* done) {
  const bool waits = timeout->tv_sec > 0 || timeout->tv_usec > 0;
  bool any = false;
  for (int i = 0; i < kMostCompletionsInATurn && advance_any(); ++i) any = true;
  if (!any && waits && *done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return 0;
}
const char* libusb_strerror(int) {
  return "what libusb says";
}
}
