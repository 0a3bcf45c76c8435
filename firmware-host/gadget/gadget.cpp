// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/gadget.hpp"

#include <fmt/format.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <exception>

#include "data-schema/base/standard_descriptors.hpp"
#include "data-schema/report/terminal.hpp"
#include "firmware-host/gadget/configfs_gadget.hpp"
#include "firmware-host/gadget/gadget_loop.hpp"
#include "firmware-host/gadget/pty_link.hpp"
#include "firmware-host/gadget/usb_link.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

bool read_hexadecimal(std::string_view text, std::uint16_t& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

Result<void> read_id(const std::string& text, GadgetOptions& options) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string_view words = text;
  const bool good = colon < text.size() && read_hexadecimal(words.substr(0, colon), options.vendor) &&
                    read_hexadecimal(words.substr(colon + 1), options.product);
  if (good) return {};
  return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a pair of numbers", text), "--id",
                      "give VENDOR:PRODUCT in hexadecimal, for example 1209:0001");
}

template <std::string GadgetOptions::*kField>
Result<void> read_text(const std::string& text, GadgetOptions& options) {
  options.*kField = text;
  return {};
}

struct Option {
  std::string_view name;
  Result<void> (*read)(const std::string& text, GadgetOptions& options);
};

constexpr Option kOptions[] = {{"--board", read_text<&GadgetOptions::board>},
                               {"--serial", read_text<&GadgetOptions::serial>},
                               {"--udc", read_text<&GadgetOptions::udc>},
                               {"--pty", read_text<&GadgetOptions::pty>},
                               {"--id", read_id}};

Result<void> read_option(std::string_view name, const char* value, GadgetOptions& options) {
  for (const Option& option : kOptions) {
    if (option.name != name) continue;
    if (value != nullptr) return option.read(value, options);
    return schema::fail(ErrorKind::usage, "needs a value", std::string(name), "tactograph-gadget --help");
  }
  return schema::fail(ErrorKind::usage, fmt::format("there is no option '{}'", name), {},
                      "tactograph-gadget --help");
}

volatile std::sig_atomic_t stop_asked = 0;

void stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { stop_asked = 1; });
}

void say(const std::string& words) {
  cli::write_message(fmt::format("tactograph-gadget: {}\n", words));
}

void run_loop(GadgetBoard& board, BoardLink& link) {
  GadgetLoop(board, link, say).run([] { return stop_asked != 0; });
}

// Plugged in during this function. The link is destroyed after unplugging, so that it cannot block.
Result<void> run_plugged(ConfigfsGadget& gadget, GadgetBoard& board, FunctionFs files,
                         const GadgetOptions& options, const std::string& port) {
  UsbLink link(std::move(files), say);
  if (const auto bound = gadget.bind(); !bound) return bound;
  say(fmt::format("{} with serial {} on {}", options.board, board.serial(), port));
  run_loop(board, link);
  gadget.unbind();
  return {};
}

Result<void> run_on_pty(GadgetBoard& board, const GadgetOptions& options) {
  const auto link = PtyLink::open(options.pty);
  TACTO_TRY(link);
  stop_on_signals();
  say(fmt::format("{} with serial {}: tty:{}", options.board, board.serial(), options.pty));
  run_loop(board, **link);
  return {};
}

Result<void> run(const GadgetOptions& options) {
  auto board = make_gadget_board(options.board, options.serial);
  TACTO_TRY(board);
  if (!options.pty.empty()) return run_on_pty(**board, options);
  const auto port = choose_port(options.udc);
  TACTO_TRY(port);
  auto gadget = ConfigfsGadget::create(
      *port, {options.vendor, options.product, (*board)->serial(), "tactograph device"});
  TACTO_TRY(gadget);
  auto files = open_functionfs(gadget->instance());
  TACTO_TRY(files);
  stop_on_signals();
  return run_plugged(*gadget, **board, std::move(*files), options, *port);
}

int run_with(std::span<const char* const> arguments) {
  const auto options = parse_gadget_options(arguments);
  if (options && options->help) {
    fmt::print("{}", gadget_help());
    return 0;
  }
  const Result<void> done = options ? run(*options) : schema::forward_error(options);
  if (done) return 0;
  say(schema::message(done.error()));
  return schema::exit_code(done.error().kind);
}

}  // namespace

Result<GadgetOptions> parse_gadget_options(std::span<const char* const> arguments) {
  GadgetOptions options;
  for (std::size_t i = 0; i < arguments.size(); i += 2) {
    const std::string_view name = arguments[i];
    options.help = name == "--help" || name == "-h";
    if (options.help) return options;
    const char* value = i + 1 < arguments.size() ? arguments[i + 1] : nullptr;
    TACTO_TRY(read_option(name, value, options));
  }
  return options;
}

std::string gadget_help() {
  return fmt::format(
      R"(tactograph-gadget: emulates a tactograph device at the USB device port of this machine

usage: tactograph-gadget [--board BOARD] [--serial TEXT] [--udc PORT] [--id VENDOR:PRODUCT]
       tactograph-gadget --pty NAME [--board BOARD] [--serial TEXT]

  --board BOARD   source of the samples: sim: (physics; for example sim:surface=C,speed=50mm/s), or replay:FILE (a
                  recording's codes, once; replay:FILE,loop=1 repeats them). Default: sim:
  --serial TEXT   serial number, on USB and in the welcome message. Default: that of the board
  --udc PORT      the device port, one of /sys/class/udc. Default: the first
  --pty NAME      instead of USB: makes a serial port with that name (a pseudo-terminal), as in
                  tactograph-gadget --pty board, then tactograph record -d tty:board. It needs neither root nor hardware
  --id V:P        USB vendor and product, hexadecimal. Default: {:04x}:{:04x}, which is for tests and in-house use only

It runs until Ctrl-C or SIGTERM, also after it was unplugged. On USB it needs root, libcomposite and usb_f_fs.
)",
      usb::kTestVendor, usb::kTestProduct);
}

int run_gadget(std::span<const char* const> arguments) {
  schema::open_closed_descriptors();
  try {
    return run_with(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tactograph-gadget: %s\n", error.what());
    return 1;
  }
}

}  // namespace tacto::firmware_host
