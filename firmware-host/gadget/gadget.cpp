// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/gadget.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "data-schema/base/standard_descriptors.hpp"
#include "data-schema/report/terminal.hpp"
#include "firmware-host/gadget/configfs_gadget.hpp"
#include "firmware-host/gadget/gadget_loop.hpp"
#include "firmware-host/gadget/gadget_options.hpp"
#include "firmware-host/gadget/pty_link.hpp"
#include "firmware-host/gadget/usb_link.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Result;

volatile std::sig_atomic_t stop_asked = 0;

void stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { stop_asked = 1; });
}

void say(const std::string& words) {
  cli::write_message(fmt::format("tactograph-gadget: {}\n", words));
}

void run_loop(GadgetBoard& board, BoardLink& link, const GadgetHooks& hooks) {
  const auto wrapped = hooks.wrap ? hooks.wrap(link) : nullptr;
  GadgetLoop(board, wrapped ? *wrapped : link, say).run([] { return stop_asked != 0; });
}

// Plugged in during this function. The link is destroyed after unplugging, so that it cannot block.
Result<void> run_plugged(ConfigfsGadget& gadget, GadgetBoard& board, FunctionFs files,
                         const GadgetOptions& options, const std::string& port, const GadgetHooks& hooks) {
  UsbLink link(std::move(files), {port, hooks.stop_reading_after, say});
  if (const auto bound = gadget.bind(); !bound) return bound;
  say(fmt::format("{} with serial {} on {}", options.board, board.serial(), port));
  run_loop(board, link, hooks);
  gadget.unbind();
  return {};
}

Result<void> run_on_pty(GadgetBoard& board, const GadgetOptions& options, const GadgetHooks& hooks) {
  const auto link = PtyLink::open(options.pty);
  TACTO_TRY(link);
  stop_on_signals();
  say(fmt::format("{} with serial {}: tty:{}", options.board, board.serial(), options.pty));
  run_loop(board, **link, hooks);
  return {};
}

Result<void> run(const GadgetOptions& options, const GadgetHooks& hooks) {
  auto board = make_gadget_board(options.board, options.serial);
  TACTO_TRY(board);
  if (!options.pty.empty()) return run_on_pty(**board, options, hooks);
  const auto port = choose_port(options.udc);
  TACTO_TRY(port);
  auto gadget = ConfigfsGadget::create(
      *port, {options.vendor, options.product, (*board)->serial(), "tactograph device"});
  TACTO_TRY(gadget);
  auto files = open_functionfs(gadget->instance());
  TACTO_TRY(files);
  stop_on_signals();
  return run_plugged(*gadget, **board, std::move(*files), options, *port, hooks);
}

int run_with(std::span<const char* const> arguments, const GadgetHooks& hooks) {
  const auto options = parse_gadget_options(arguments);
  if (options && options->help) {
    fmt::print("{}", gadget_help());
    return 0;
  }
  const Result<void> done = options ? run(*options, hooks) : schema::forward_error(options);
  if (done) return 0;
  say(schema::message(done.error()));
  return schema::exit_code(done.error().kind);
}

}  // namespace

int run_gadget(std::span<const char* const> arguments, const GadgetHooks& hooks) {
  schema::open_closed_descriptors();
  try {
    return run_with(arguments, hooks);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tactograph-gadget: %s\n", error.what());
    return 1;
  }
}

}  // namespace tacto::firmware_host
