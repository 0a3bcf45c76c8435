// SPDX-License-Identifier: GPL-3.0-or-later
// Devices on serial ports: addresses, the port's settings, the rates that a line carries, and emulated boards
// on pseudo-terminals whose frames contain their numbers.
#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include "firmware-host/link/line_load.hpp"
#include "firmware-host/open_device.hpp"
#include "firmware-host/tty/tty_device.hpp"
#include "firmware-host/tty/tty_transport.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/firmware-host/pty_board.hpp"

namespace tacto::firmware_host {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using tests::PtyBoard;
using tests::TemporaryFolder;

constexpr const char* kCounter = "sim:source=counter,channels=2,rate=2kHz";

TEST(TtyAddress, IsAPathAndABaudRate) {
  const std::pair<const char*, TtyAddress> kGood[] = {
      {"", {"", std::nullopt}},
      {"/dev/ttyACM0", {"/dev/ttyACM0", std::nullopt}},
      {"/dev/ttyACM0,baud=2000000", {"/dev/ttyACM0", 2'000'000}},
      {"baud=115200", {"", 115'200}}};
  for (const auto& [text, wanted] : kGood) {
    const auto address = parse_tty_address(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->path, wanted.path);
    EXPECT_EQ(address->baud, wanted.baud);
    EXPECT_EQ(tty_uri(*address), std::string("tty:") + text);
  }
  for (const char* text :
       {"/dev/ttyACM0,", "/dev/ttyACM0,speed=9", "/dev/ttyACM0,baud=", "baud=115200,x",
        "/dev/ttyACM0,baud=115201", "/dev/ttyACM0,baud=9600", "/dev/ttyACM0,baud=-115200"}) {
    const auto address = parse_tty_address(text);
    ASSERT_FALSE(address) << text;
    EXPECT_EQ(address.error().kind, ErrorKind::usage);
  }
}

TEST(UsbSerialPorts, AreTheTtysWithAUsbParent) {
  const TemporaryFolder root;
  EXPECT_TRUE(usb_serial_ports(root / "").empty());
  const auto tty = [&](const std::string& name, const std::string& hardware) {
    fs::create_directories(root / ("sys/class/tty/" + name));
    fs::create_directories(root / hardware);
    fs::create_directory_symlink(root / hardware, root / ("sys/class/tty/" + name + "/device"));
  };
  const std::string usb = "sys/devices/pci0000:00/usb1/1-2";
  fs::create_directories(root / usb);
  std::ofstream(root / (usb + "/idVendor")) << "0483\n";
  tty("ttyUSB0", usb + "/1-2:1.2/ttyUSB0");
  tty("ttyACM3", usb + "/1-2:1.0");
  tty("ttyS0", "sys/devices/platform/serial8250");
  fs::create_directories(root / "sys/class/tty/tty0");
  EXPECT_EQ(usb_serial_ports(root / ""), (std::vector<std::string>{"/dev/ttyACM3", "/dev/ttyUSB0"}));
}

// A terminal as the system makes it: with echo, line by line.
struct Terminal {
  Terminal() : board_end(::posix_openpt(O_RDWR | O_NOCTTY)) {
    ::grantpt(board_end.get());
    ::unlockpt(board_end.get());
    path = ::ptsname(board_end.get());
    host_end = FileDescriptor(::open(path.c_str(), O_RDWR | O_NOCTTY));
  }
  termios settings() const {
    termios now{};
    EXPECT_EQ(::tcgetattr(host_end.get(), &now), 0);
    return now;
  }
  FileDescriptor board_end, host_end;
  std::string path;
};

TEST(TtyTransport, IsRawAndForOneProgramUntilItIsClosed) {
  const Terminal terminal;
  const termios before = terminal.settings();
  ASSERT_NE(before.c_lflag & (ICANON | ECHO), 0U);
  {
    const auto port = TtyTransport::open({terminal.path, 2'000'000});
    ASSERT_TRUE(port) << schema::message(port.error());
    EXPECT_EQ((*port)->baud(), 2e6);
    const termios during = terminal.settings();
    EXPECT_EQ(during.c_lflag & (ICANON | ECHO | ISIG | IEXTEN), 0U);
    EXPECT_EQ(during.c_iflag & (IXON | ICRNL | ISTRIP), 0U);
    EXPECT_EQ(during.c_oflag & OPOST, 0U);
    EXPECT_EQ(during.c_cflag & (CSIZE | PARENB | CSTOPB | CRTSCTS), unsigned{CS8});
    EXPECT_EQ(::cfgetospeed(&during), unsigned{B2000000});
    const auto second = TtyTransport::open({terminal.path, std::nullopt});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::device);
  }
  const termios after = terminal.settings();
  EXPECT_EQ(after.c_lflag, before.c_lflag);
  EXPECT_EQ(after.c_iflag, before.c_iflag);
  EXPECT_EQ(after.c_oflag, before.c_oflag);
  EXPECT_EQ(after.c_cflag, before.c_cflag);
  EXPECT_TRUE(TtyTransport::open({terminal.path, std::nullopt}));
}

TEST(TtyTransport, CarriesEveryByteBothWays) {
  const Terminal terminal;
  const auto port = TtyTransport::open({terminal.path, std::nullopt});
  ASSERT_TRUE(port);
  std::vector<std::uint8_t> all(256), back(256);
  std::iota(all.begin(), all.end(), std::uint8_t{0});
  ASSERT_TRUE((*port)->write(all, 5));
  ASSERT_EQ(::read(terminal.board_end.get(), back.data(), back.size()), 256);
  EXPECT_EQ(back, all);
  ASSERT_EQ(::write(terminal.board_end.get(), all.data(), all.size()), 256);
  for (std::size_t got = 0; got < back.size();) {
    const auto some = (*port)->read(std::span(back).subspan(got), 5);
    ASSERT_TRUE(some && *some > 0);
    got += *some;
  }
  EXPECT_EQ(back, all);
  EXPECT_EQ((*port)->read(back, 0.01).value(), 0U);
}

TEST(TtyTransport, SaysWhyAPortCannotBeOpened) {
  const TemporaryFolder folder;
  const auto absent = TtyTransport::open({folder / "absent", std::nullopt});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::not_found);
  std::ofstream(folder / "file") << "text\n";
  const auto file = TtyTransport::open({folder / "file", std::nullopt});
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::usage);
}

// For root every file is open, so the test becomes another user.
TEST(TtyTransport, NamesTheGroupThatMayOpenAPort) {
  const Terminal terminal;
  ASSERT_EQ(::chmod(terminal.path.c_str(), 0), 0);
  const uid_t me = ::geteuid();
  if (me == 0 && ::seteuid(65534) != 0) GTEST_SKIP() << "root cannot become another user here";
  const auto port = TtyTransport::open({terminal.path, std::nullopt});
  ASSERT_EQ(::seteuid(me), 0);
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().kind, ErrorKind::not_found);
  struct stat about {};
  ASSERT_EQ(::stat(terminal.path.c_str(), &about), 0);
  const group* const owner = ::getgrgid(about.st_gid);
  ASSERT_NE(owner, nullptr);
  EXPECT_NE(port.error().remedy.find(owner->gr_name), std::string::npos) << port.error().remedy;
}

// By WIRE.md a message of samples has 40 bytes beside its codes, one of ticks 36 and 12 for each tick. A byte
// takes 10 bits, and streams may use nine tenths of a line.
TEST(LineLoad, RefusesTheFirstRateThatDoesNotFit) {
  const auto frame = [](double) { return bytes_per_frame(2, 16); };
  EXPECT_EQ(frame(0), 8 + 40.0 / 16);
  EXPECT_TRUE(check_line({115'200}, 987, frame, "here"));  // 0.9 * 11520 / 10.5 = 987.4
  const auto refused = check_line({115'200}, 988, frame, "here");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_NE(refused.error().what.find("987 Hz"), std::string::npos) << refused.error().what;

  const auto tick = [](double rate_hz) { return bytes_per_tick(rate_hz, 0); };
  EXPECT_EQ(tick(2000), 12 + 36.0 / 20);
  EXPECT_EQ(tick(50), 48);
  EXPECT_EQ(tick(20'000), 12 + 36.0 / 64);
  EXPECT_EQ(bytes_per_tick(1000, 2), 20 + 36.0 / 10);
  // At 540 Hz there are 5 ticks in a message: 0.9 * 11520 / 19.2 = 540.
  EXPECT_TRUE(check_line({115'200}, 540, tick, "here"));
  const auto fast = check_line({115'200}, 20'000, tick, "here");
  ASSERT_FALSE(fast);
  EXPECT_NE(fast.error().what.find("540 Hz"), std::string::npos) << fast.error().what;
  EXPECT_FALSE(check_line({115'200, 10'000}, 540, tick, "here"));
  EXPECT_TRUE(check_line({std::numeric_limits<double>::infinity()}, 1e6, tick, "here"));
}

struct Counted {
  std::uint64_t frames = 0, lost = 0;
  std::optional<schema::Error> ended;
};

// Reads `target` frames; the code of channel c in frame i is 16 i + c.
Counted read_counted(Device& device, std::uint64_t target) {
  Counted counted;
  std::vector<std::int32_t> codes(std::size_t{2} * 200);
  while (counted.frames + counted.lost < target) {
    const auto frames = device.read(codes);
    for (const schema::Gap& gap : device.take_events().gaps) {
      counted.lost += gap.count;
      EXPECT_EQ(gap.device_sequence, counted.frames + counted.lost) << "of the first frame after the gap";
    }
    if (!frames) {
      counted.ended = frames.error();
      break;
    }
    for (std::size_t i = 0; i < 2 * *frames; ++i)
      EXPECT_EQ(static_cast<std::uint64_t>(codes[i]), 16 * (counted.frames + counted.lost + i / 2) + i % 2);
    counted.frames += *frames;
  }
  return counted;
}

TEST(TtyDevice, ReceivesEveryFrame) {
  const TemporaryFolder folder;
  const PtyBoard board(folder / "port", kCounter);
  const auto device = open_device(board.uri());
  ASSERT_TRUE(device) << schema::message(device.error());
  EXPECT_EQ((*device)->capabilities().uri, board.uri());
  ASSERT_TRUE((*device)->start());
  const Counted counted = read_counted(**device, 3000);
  EXPECT_FALSE(counted.ended);
  EXPECT_EQ(counted.lost, 0U);
  EXPECT_TRUE((*device)->stop());
}

TEST(TtyDevice, ADamagedMessageIsAGapWithItsCount) {
  for (const char* faults : {"corrupt-every=10", "drop-every=10", "truncate-every=10"}) {
    const TemporaryFolder folder;
    const PtyBoard board(folder / "port", kCounter, faults);
    const auto device = open_device(board.uri());
    ASSERT_TRUE(device) << schema::message(device.error());
    ASSERT_TRUE((*device)->start());
    const Counted counted = read_counted(**device, 2000);
    EXPECT_FALSE(counted.ended) << faults;
    EXPECT_GE(counted.lost, 16U * 11) << "2000 frames are 125 messages; each tenth is damaged: " << faults;
    EXPECT_EQ(counted.lost % 16, 0U) << "whole messages are lost";
    EXPECT_EQ((*device)->counts().lost_frames, counted.lost);
    EXPECT_GE((*device)->counts().missing_messages, 11U);
  }
}

TEST(TtyDevice, AnUnpluggedBoardIsAnErrorAfterItsFrames) {
  const TemporaryFolder folder;
  const PtyBoard board(folder / "port", kCounter, "unplug-after=60");
  const auto device = open_device(board.uri());
  ASSERT_TRUE(device) << schema::message(device.error());
  ASSERT_TRUE((*device)->start());
  const Counted counted = read_counted(**device, 5000);
  ASSERT_TRUE(counted.ended);
  EXPECT_EQ(counted.ended->kind, ErrorKind::device);
  EXPECT_EQ(counted.lost, 0U);
}

TEST(TtyDevice, AnotherVersionIsRefusedByName) {
  const TemporaryFolder folder;
  const PtyBoard board(folder / "port", kCounter, "version=2.0");
  const auto device = open_device(board.uri());
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::unsupported_version);
}

// Over USB three hellos are sent; a serial port may have reset the board.
TEST(TtyDevice, ABoardThatStartsIsWaitedFor) {
  const TemporaryFolder folder;
  const PtyBoard board(folder / "port", kCounter, "", 3);
  const auto device = open_device(board.uri());
  ASSERT_TRUE(device) << schema::message(device.error());
}

TEST(TtyDevice, BytesOfAnotherProgramAreShown) {
  const Terminal terminal;
  std::atomic<bool> stop = false;
  std::thread arduino([&] {
    const std::string words = "temp 21\r\n";
    for (; !stop; std::this_thread::sleep_for(std::chrono::milliseconds(20)))
      EXPECT_GT(::write(terminal.board_end.get(), words.data(), words.size()), 0);
  });
  const auto device = open_device("tty:" + terminal.path);
  stop = true;
  arduino.join();
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::device);
  EXPECT_NE(device.error().what.find("temp 21\\x0d\\x0a"), std::string::npos) << device.error().what;
}

TEST(TtyDevice, TheOnlyOneThatAnswersIsTaken) {
  const TemporaryFolder folder;
  const Terminal silent;
  const PtyBoard one(folder / "one", kCounter), two(folder / "two", kCounter);
  const auto among = [](std::vector<TtyAddress> ports) { return open_tty_among(ports); };
  const auto found = among({{silent.path, std::nullopt}, one.address()});
  ASSERT_TRUE(found) << schema::message(found.error());
  EXPECT_EQ((*found)->capabilities().uri, one.uri());

  const auto busy = among({one.address()});
  ASSERT_FALSE(busy);
  EXPECT_EQ(busy.error().kind, ErrorKind::device);
  const auto none = among({{folder / "absent", std::nullopt}, one.address()});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::not_found);
  EXPECT_EQ(among({}).error().kind, ErrorKind::not_found);

  const PtyBoard three(folder / "three", kCounter);
  const auto several = among({two.address(), three.address()});
  ASSERT_FALSE(several);
  EXPECT_EQ(several.error().kind, ErrorKind::usage);
  for (const PtyBoard* board : {&two, &three})
    EXPECT_NE(several.error().remedy.find(board->uri()), std::string::npos) << several.error().remedy;
}

}  // namespace
}  // namespace tacto::firmware_host
