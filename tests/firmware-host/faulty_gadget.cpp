// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph-gadget with simulated faults, for tests of a host: faulty_gadget FAULTS OPTION...; FAULTS as of
// parse_fault_plan().
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <optional>
#include <thread>

#include "firmware-host/gadget/configfs_gadget.hpp"
#include "firmware-host/gadget/gadget.hpp"
#include "firmware-host/gadget/gadget_loop.hpp"
#include "firmware-host/gadget/pty_link.hpp"
#include "firmware-host/gadget/usb_link.hpp"
#include "tests/firmware-host/faulty_link.hpp"

namespace tacto::tests {
namespace {

using namespace firmware_host;
using schema::Result;
using std::chrono::milliseconds;

volatile std::sig_atomic_t stop_asked = 0;

void say(const std::string& words) {
  fmt::print(stderr, "faulty_gadget: {}\n", words);
}

void run_loop(GadgetBoard& board, BoardLink& link) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { stop_asked = 1; });
  GadgetLoop(board, link, say).run([] { return stop_asked != 0; });
}

// FunctionFS halts an endpoint that is used in the wrong direction; not while a transfer is under way.
void stall(int to_host) {
  std::uint8_t byte = 0;
  ssize_t got = 0;
  for (int i = 0; i < 1000 && (got = ::read(to_host, &byte, 1)) < 0 && errno == EAGAIN; ++i)
    std::this_thread::sleep_for(milliseconds(1));
  if (got >= 0 || errno == EAGAIN) say("the endpoint did not stall");
}

void unplug(const std::string& port) {
  if (!(std::ofstream("/sys/class/udc/" + port + "/soft_connect") << "disconnect" << std::flush))
    say("the port did not disconnect");
}

/// Takes the place of the endpoint from the host: passes on so many transfers, and reads no more.
class DeafEndpoint {
 public:
  DeafEndpoint(FileDescriptor& from_host, std::uint64_t transfers) : real_(std::move(from_host)) {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) say("no pipe");
    from_host = FileDescriptor(ends[0]);
    to_link_ = FileDescriptor(ends[1]);
    thread_ = std::thread([this, transfers] { pass_on(transfers); });
  }
  ~DeafEndpoint() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void pass_on(std::uint64_t transfers) {
    std::array<std::uint8_t, 16384> bytes{};
    while (!stopping_ && transfers > 0) {
      const ssize_t got = ::read(real_.get(), bytes.data(), bytes.size());
      if (got < 0) std::this_thread::sleep_for(milliseconds(20));
      if (got < 0) continue;
      --transfers;
      if (::write(to_link_.get(), bytes.data(), static_cast<std::size_t>(got)) != got)
        say("the pipe is full");
    }
  }

  FileDescriptor real_, to_link_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

Result<void> run_on_pty(GadgetBoard& board, const GadgetOptions& options, const FaultPlan& plan) {
  auto link = PtyLink::open(options.pty);
  TACTO_TRY(link);
  FaultyLink faulty(**link, plan, {[] {}, [&] { link->reset(); }});
  run_loop(board, faulty);
  return {};
}

Result<void> run_on_usb(GadgetBoard& board, const GadgetOptions& options, const FaultPlan& plan) {
  const auto port = choose_port(options.udc);
  TACTO_TRY(port);
  auto gadget =
      ConfigfsGadget::create(*port, {options.vendor, options.product, board.serial(), "tactograph device"});
  TACTO_TRY(gadget);
  auto files = open_functionfs(gadget->instance());
  TACTO_TRY(files);
  std::optional<DeafEndpoint> deaf;
  if (plan.stop_reading_after) deaf.emplace(files->out, *plan.stop_reading_after);
  const int to_host = files->in.get();
  UsbLink link(std::move(*files), say);
  TACTO_TRY(gadget->bind());
  FaultyLink faulty(link, plan, {[=] { stall(to_host); }, [&] { unplug(*port); }});
  run_loop(board, faulty);
  gadget->unbind();
  return {};
}

Result<void> run(std::span<const char* const> arguments, const FaultPlan& plan) {
  const auto options = parse_gadget_options(arguments);
  TACTO_TRY(options);
  const auto board = make_gadget_board(options->board, options->serial);
  TACTO_TRY(board);
  return options->pty.empty() ? run_on_usb(**board, *options, plan) : run_on_pty(**board, *options, plan);
}

}  // namespace
}  // namespace tacto::tests

int main(int count, char** values) {
  const auto plan = tacto::tests::parse_fault_plan(count > 1 ? values[1] : "");
  if (count < 2 || !plan) {
    std::fprintf(stderr, "usage: faulty_gadget FAULTS OPTION... (tests/firmware-host/faulty_link.hpp)\n");
    return 2;
  }
  const auto done = tacto::tests::run({values + 2, values + count}, *plan);
  if (done) return 0;
  tacto::tests::say(tacto::schema::message(done.error()));
  return tacto::schema::exit_code(done.error().kind);
}
