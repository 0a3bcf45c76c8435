// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_transport.hpp"

#include <gtest/gtest.h>

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;

const std::vector<UsbName> kThree = {{"A7", "1-1"}, {"", "1-2.3"}, {"B,9", "2-4"}};

TEST(UsbAddress, IsParsed) {
  EXPECT_EQ(parse_usb_address("")->serial + parse_usb_address("")->port, "");
  EXPECT_EQ(parse_usb_address("serial=00 7x")->serial, "00 7x");
  EXPECT_EQ(parse_usb_address("port=1-2.4")->port, "1-2.4");
}

TEST(UsbAddress, IsRefusedWhereItNamesNothing) {
  for (const char* bad : {"serial=", "port=", "serial", "speed=3", "1-2", "serial=A,port=1-1"}) {
    const auto address = parse_usb_address(bad);
    ASSERT_FALSE(address) << bad;
    EXPECT_EQ(address.error().kind, ErrorKind::usage);
    EXPECT_NE(address.error().remedy.find("usb:serial=XYZ"), std::string::npos);
  }
}

// Each URI identifies the device from which it was made.
TEST(UsbAddress, AnUriTellsADeviceFromAllOthers) {
  const std::vector<UsbName> twins = {{"A7", "1-1"}, {"A7", "1-2"}, {"C", "1-3"}};
  for (const auto& names : {kThree, twins})
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string uri = usb_uri(names, i);
      ASSERT_TRUE(uri.starts_with("usb:"));
      EXPECT_EQ(choose_usb(names, *parse_usb_address(std::string_view(uri).substr(4))).value(), i) << uri;
    }
  EXPECT_EQ(usb_uri(kThree, 0), "usb:serial=A7");
  EXPECT_EQ(usb_uri(kThree, 1), "usb:port=1-2.3");
  EXPECT_EQ(usb_uri(twins, 0), "usb:port=1-1");
}

TEST(UsbAddress, TheOnlyOneNeedsNoName) {
  EXPECT_EQ(choose_usb({{"", "1-1"}}, {}).value(), 0U);
}

TEST(UsbAddress, OfSeveralOneMustBeNamed) {
  const auto chosen = choose_usb(kThree, {});
  ASSERT_FALSE(chosen);
  EXPECT_EQ(chosen.error().kind, ErrorKind::usage);
  EXPECT_NE(chosen.error().remedy.find("usb:port=1-2.3"), std::string::npos) << message(chosen.error());
}

TEST(UsbAddress, OneThatIsNotThereIsNotFound) {
  for (const UsbAddress& address : {UsbAddress{"Z", ""}, UsbAddress{"", "9-9"}}) {
    const auto chosen = choose_usb(kThree, address);
    ASSERT_FALSE(chosen);
    EXPECT_EQ(chosen.error().kind, ErrorKind::not_found);
    EXPECT_NE(chosen.error().remedy.find("usb:serial=A7"), std::string::npos);
  }
  EXPECT_EQ(choose_usb({}, {}).error().kind, ErrorKind::not_found);
}

}  // namespace
}  // namespace tacto::firmware_host
