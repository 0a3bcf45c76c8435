// SPDX-License-Identifier: GPL-3.0-or-later
// The transport on a simulated bus with faults. In every case bytes arrive in order or not at all, failures
// are reported, and no transfer, object or claim is left.
#include "firmware-host/usb/usb_transport.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "firmware-host/open_device.hpp"
#include "firmware-host/usb/usb_device.hpp"
#include "tests/firmware-host/usb/fake_libusb.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using tests::FakeUsb;
using tests::FakeUsbDevice;
using tests::UsbEvent;
using Bytes = std::vector<std::uint8_t>;

constexpr double kTimeoutS = 20;  // longer than a busy machine stops: no case waits for it

class UsbTransportTest : public testing::Test {
 protected:
  UsbTransportTest() { tests::fake_usb() = {}; }
  ~UsbTransportTest() override {
    EXPECT_EQ(tests::fake_usb().lent, 0);
    EXPECT_TRUE(tests::fake_usb().faults.empty()) << tests::fake_usb().faults.front();
  }
  FakeUsb& usb() { return tests::fake_usb(); }
  FakeUsbDevice& add(std::string serial = "T1", std::uint8_t port = 1) {
    FakeUsbDevice& device = usb().devices.emplace_back();
    device.serial = std::move(serial);
    device.ports = {port};
    return device;
  }
  static std::unique_ptr<UsbTransport> transport() {
    auto connection = UsbConnection::open({});
    EXPECT_TRUE(connection) << message(connection.error());
    return std::make_unique<UsbTransport>(std::move(*connection));
  }
};

Bytes counting(std::size_t size, std::uint8_t first = 0) {
  Bytes bytes(size);
  std::iota(bytes.begin(), bytes.end(), first);
  return bytes;
}

// Reads until `size` bytes have come, or an error.
struct Heard {
  Bytes bytes;
  std::optional<schema::Error> error;
};
Heard listen(Transport& transport, std::size_t size, std::size_t piece = 16384) {
  Heard heard;
  for (Bytes room(piece);;) {
    const auto got = transport.read(room, kTimeoutS);
    if (!got) heard.error = got.error();
    if (!got || *got == 0) return heard;
    heard.bytes.insert(heard.bytes.end(), room.begin(), room.begin() + static_cast<std::ptrdiff_t>(*got));
    if (heard.bytes.size() >= size) return heard;
  }
}

TEST_F(UsbTransportTest, BytesComeInOrderHoweverTheyAreRead) {
  for (const std::size_t piece : {1U, 7U, 512U, 16384U}) {
    usb().devices.clear();
    FakeUsbDevice& device = add();
    Bytes sent;
    for (std::size_t i = 0; i < 3 * UsbInflow::kTransfers; ++i) {
      device.in.push_back({UsbEvent::data, counting(i % 5 == 0 ? 0 : 3 + i, static_cast<std::uint8_t>(i))});
      sent.insert(sent.end(), device.in.back().bytes.begin(), device.in.back().bytes.end());
    }
    const auto cable = transport();
    const Heard heard = listen(*cable, sent.size(), piece);
    EXPECT_FALSE(heard.error);
    EXPECT_EQ(heard.bytes, sent);
  }
}

TEST_F(UsbTransportTest, ItListensWithAllTransfersFromTheFirstWordOn) {
  FakeUsbDevice& device = add();
  const auto cable = transport();
  ASSERT_TRUE(cable->write(counting(20), kTimeoutS));
  EXPECT_EQ(device.in_under_way.size(), UsbInflow::kTransfers);
  EXPECT_EQ(device.taken, counting(20));
}

TEST_F(UsbTransportTest, ASilentDeviceIsNoErrorAndNoTimeIsNoWait) {
  add();
  const auto cable = transport();
  Bytes room(8);
  EXPECT_EQ(cable->read(room, 0).value(), 0U);
  EXPECT_EQ(cable->read(room, 0.01).value(), 0U);
}

TEST_F(UsbTransportTest, WithoutTimeWhatIsThereIsGiven) {
  add().in.push_back({UsbEvent::data, counting(5)});
  const auto cable = transport();
  Bytes room(8);
  EXPECT_EQ(cable->read(room, 0).value(), 5U);
}

class Recovered : public UsbTransportTest, public testing::WithParamInterface<UsbEvent::Kind> {};

TEST_P(Recovered, BytesBeforeAndBehindItCome) {
  FakeUsbDevice& device = add();
  device.in = {
      {UsbEvent::data, counting(100)}, {GetParam(), counting(3, 100)}, {UsbEvent::data, counting(50, 103)}};
  const auto cable = transport();
  const Heard heard = listen(*cable, 153);
  EXPECT_FALSE(heard.error);
  EXPECT_EQ(heard.bytes, counting(153));
  // The transfers are sent again while the host reads.
  Bytes room(8);
  for (int i = 0; i < 1000 && device.in_under_way.size() < UsbInflow::kTransfers; ++i)
    EXPECT_EQ(cable->read(room, 0.01).value_or(1), 0U);
  EXPECT_EQ(usb().cleared, 1);
  EXPECT_EQ(device.in_under_way.size(), UsbInflow::kTransfers);
}

INSTANTIATE_TEST_SUITE_P(Troubles, Recovered,
                         testing::Values(UsbEvent::halt, UsbEvent::error, UsbEvent::overflow));

TEST_F(UsbTransportTest, AResetByAnotherProgramGoesOn) {
  FakeUsbDevice& device = add();
  device.in = {{UsbEvent::data, counting(9)}, {UsbEvent::reset}, {UsbEvent::data, counting(9, 9)}};
  device.out = {{UsbEvent::reset}};
  const auto cable = transport();
  EXPECT_TRUE(cable->write(counting(3), kTimeoutS));
  EXPECT_EQ(listen(*cable, 18).bytes, counting(18));
  EXPECT_EQ(device.taken, counting(3));
}

TEST_F(UsbTransportTest, TroubleWithoutEndIsAnErrorAfterTheBytes) {
  for (const auto& [kind, words] : {std::pair{UsbEvent::halt, "stalls, 6 times in a row"},
                                    std::pair{UsbEvent::overflow, "longer packets than it announced"},
                                    std::pair{UsbEvent::error, "sends unreadable transfers"}}) {
    usb().devices.clear();
    FakeUsbDevice& device = add();
    device.in.assign(20 * UsbInflow::kTransfers, {kind});
    device.in.push_front({UsbEvent::data, counting(10)});
    const auto cable = transport();
    for (int again = 0; again < 2; ++again) {
      const Heard heard = listen(*cable, SIZE_MAX, 100);
      EXPECT_EQ(heard.bytes, counting(again == 0 ? 10 : 0));
      ASSERT_TRUE(heard.error);
      EXPECT_EQ(heard.error->kind, ErrorKind::device);
      EXPECT_NE(heard.error->what.find(words), std::string::npos) << heard.error->what;
    }
    EXPECT_FALSE(cable->write(counting(3), kTimeoutS));
  }
}

TEST_F(UsbTransportTest, UnpluggedItGivesItsBytesAndThenTheReason) {
  FakeUsbDevice& device = add();
  device.in = {{UsbEvent::data, counting(70)}, {UsbEvent::unplug}};
  const auto cable = transport();
  const Heard heard = listen(*cable, SIZE_MAX, 33);
  EXPECT_EQ(heard.bytes, counting(70));
  ASSERT_TRUE(heard.error);
  EXPECT_EQ(heard.error->what, "the device was unplugged");
  EXPECT_EQ(heard.error->kind, ErrorKind::device);
  EXPECT_EQ(heard.error->where, "usb:serial=T1");
  EXPECT_EQ(cable->write(counting(3), kTimeoutS).error().what, "the device was unplugged");
}

TEST_F(UsbTransportTest, UnpluggedWhileItIsSpokenTo) {
  add().out = {{UsbEvent::unplug}};
  const auto cable = transport();
  EXPECT_EQ(cable->write(counting(30), kTimeoutS).error().what, "the device was unplugged");
}

TEST_F(UsbTransportTest, WhatStallsOrIsCutShortIsSentAgainWhole) {
  for (const auto kind : {UsbEvent::halt, UsbEvent::error, UsbEvent::data}) {
    usb().devices.clear();
    FakeUsbDevice& device = add();
    device.out = {{kind, counting(4)}};
    const auto cable = transport();
    ASSERT_TRUE(cable->write(counting(30), kTimeoutS));
    ASSERT_EQ(device.taken.size(), 34U);
    EXPECT_EQ(Bytes(device.taken.begin() + 4, device.taken.end()), counting(30));
  }
}

TEST_F(UsbTransportTest, ADeviceThatAlwaysRefusesIsAnError) {
  add().out.assign(9, {UsbEvent::halt});
  const auto cable = transport();
  const auto written = cable->write(counting(30), kTimeoutS);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, schema::ErrorKind::device);
  EXPECT_NE(written.error().what.find(" 3 times"), std::string::npos);
}

TEST_F(UsbTransportTest, ADeviceThatTakesNothingIsAnError) {
  add().out = {{UsbEvent::silence}};
  const auto cable = transport();
  const auto written = cable->write(counting(30), 0.5);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, schema::ErrorKind::device);
  EXPECT_NE(written.error().what.find("0.5 s"), std::string::npos);
}

TEST_F(UsbTransportTest, WhatWasTakenWholeAtTheLastMomentIsTaken) {
  FakeUsbDevice& device = add();
  device.out = {{UsbEvent::silence, counting(30)}};
  const auto cable = transport();
  EXPECT_TRUE(cable->write(counting(30), 0.05));
  EXPECT_EQ(device.taken, counting(30));
}

TEST_F(UsbTransportTest, OnlyTheWiresInterfaceIsLookedAt) {
  add("wrong class").interface_class = 3;
  add("wrong subclass").interface_subclass = 0x42;
  add("no way in").endpoints = {0x02};
  add("no way out").endpoints = {0x81};
  EXPECT_TRUE(usb_uris()->empty());
  EXPECT_EQ(UsbConnection::open({}).error().kind, ErrorKind::not_found);
  FakeUsbDevice& newer = add("newer", 7);
  newer.protocol = 2;
  newer.endpoints = {0x03, 0x85};
  EXPECT_EQ(usb_uris().value(), std::vector<std::string>{"usb:serial=newer"});
  const auto connection = UsbConnection::open({});
  ASSERT_TRUE(connection);
  EXPECT_EQ(connection->interface().in, 0x85);
  EXPECT_EQ(connection->interface().out, 0x03);
}

TEST_F(UsbTransportTest, OneOfSeveralIsTakenBySerial) {
  add("A", 1);
  add("B", 2);
  EXPECT_EQ(UsbConnection::open({}).error().kind, ErrorKind::usage);
  EXPECT_EQ(UsbConnection::open({"B", ""})->uri(), "usb:serial=B");
}

TEST_F(UsbTransportTest, WhyItCannotBeOpenedIsSaid) {
  FakeUsbDevice& device = add();
  const std::pair<int, const char*> kCodes[] = {{LIBUSB_ERROR_ACCESS, "60-tactograph.rules"},
                                                {LIBUSB_ERROR_NO_DEVICE, "unplugged"},
                                                {LIBUSB_ERROR_OTHER, "what libusb says"}};
  for (const auto& [code, words] : kCodes) {
    device.open_code = code;
    const auto connection = UsbConnection::open({});
    ASSERT_FALSE(connection);
    EXPECT_NE(message(connection.error()).find(words), std::string::npos) << message(connection.error());
    EXPECT_EQ(connection.error().where, "usb:port=1-1");  // its serial is not known
  }
  device.open_code = 0;
  device.claim_code = LIBUSB_ERROR_BUSY;
  EXPECT_EQ(UsbConnection::open({}).error().what, "another program uses the device");
  usb().init_code = LIBUSB_ERROR_OTHER;
  EXPECT_EQ(usb_uris().error().kind, ErrorKind::device);
}

TEST_F(UsbTransportTest, ADeviceThatAnswersNothingIsRefusedInItsTime) {
  add();
  const auto device = open_device("usb:");
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().what.find("1.5 s"), std::string::npos);
}

}  // namespace
}  // namespace tacto::firmware_host
