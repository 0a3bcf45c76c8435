// SPDX-License-Identifier: GPL-3.0-or-later
// An emulated board on a pseudo-terminal, in a thread of its own, as tactograph-gadget serves it.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "firmware-host/gadget/gadget_loop.hpp"
#include "firmware-host/gadget/pty_link.hpp"
#include "firmware-host/tty/tty_address.hpp"
#include "tests/firmware-host/faulty_link.hpp"

namespace tacto::tests {

/// Drops all bytes until `hellos` of them have begun, as a board in its bootloader does.
class BootingLink final : public firmware_host::BoardLink {
 public:
  BootingLink(BoardLink& inner, int hellos) : inner_(inner), hellos_(hellos) {}
  void send(std::span<const std::uint8_t> bytes) override { inner_.send(bytes); }
  std::size_t waiting() const override { return inner_.waiting(); }
  void wait_until(Clock::time_point time) override { inner_.wait_until(time); }
  void take_received(std::vector<std::uint8_t>& bytes) override {
    if (seen() >= hellos_) return inner_.take_received(bytes);
    inner_.take_received(dropped_);
  }
  int seen() const {
    int hellos = 0;
    for (std::size_t i = 0; i + 4 <= dropped_.size(); ++i)
      hellos += dropped_[i] == 0xA5 && dropped_[i + 1] == 0x54 && dropped_[i + 3] == 0x01 ? 1 : 0;
    return hellos;
  }

 private:
  BoardLink& inner_;
  int hellos_;
  std::vector<std::uint8_t> dropped_;
};

class PtyBoard {
 public:
  /// `path` is the name of the port, `board` as of the gadget's option, `faults` as of parse_fault_plan().
  PtyBoard(const std::string& path, const std::string& board, std::string_view faults = "",
           int deaf_hellos = 0)
      : address_{path, std::nullopt},
        board_(firmware_host::make_gadget_board(board, "").value()),
        link_(firmware_host::PtyLink::open(path).value()),
        booting_(*link_, deaf_hellos),
        faulty_(booting_, parse_fault_plan(faults).value(), {[] {}, [this] { link_.reset(); }}),
        thread_([this] {
          firmware_host::GadgetLoop(*board_, faulty_, [](const std::string&) {}).run([this] {
            return stop_.load();
          });
        }) {}
  ~PtyBoard() {
    stop_ = true;
    thread_.join();
  }
  const firmware_host::TtyAddress& address() const { return address_; }
  std::string uri() const { return firmware_host::tty_uri(address_); }

 private:
  firmware_host::TtyAddress address_;
  std::unique_ptr<firmware_host::GadgetBoard> board_;
  std::unique_ptr<firmware_host::PtyLink> link_;
  BootingLink booting_;
  FaultyLink faulty_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tacto::tests
