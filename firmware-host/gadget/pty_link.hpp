// SPDX-License-Identifier: GPL-3.0-or-later
// A pseudo-terminal as the cable: the host opens its other end as a serial port.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "data-schema/base/error.hpp"
#include "firmware-host/gadget/board_link.hpp"
#include "firmware-host/link/file_descriptor.hpp"

namespace tacto::firmware_host {

/// For one thread. Bytes that the host does not read wait here.
class PtyLink final : public BoardLink {
 public:
  /// `path` becomes a symbolic link to the port, and is removed at the end. Errors: cannot_write: it exists,
  /// or cannot be made; device: no pseudo-terminal.
  static schema::Result<std::unique_ptr<PtyLink>> open(const std::string& path);
  PtyLink(const PtyLink&) = delete;
  PtyLink& operator=(const PtyLink&) = delete;
  ~PtyLink() override;

  void send(std::span<const std::uint8_t> bytes) override;
  std::size_t waiting() const override { return to_host_.size(); }
  void take_received(std::vector<std::uint8_t>& bytes) override;
  void wait_until(Clock::time_point time) override;

 private:
  PtyLink(FileDescriptor board_end, FileDescriptor host_end, std::string path)
      : board_end_(std::move(board_end)), host_end_(std::move(host_end)), path_(std::move(path)) {}
  void write_some();

  // The host's end stays open here, so that the port exists between two hosts.
  FileDescriptor board_end_, host_end_;
  std::string path_;
  std::deque<std::uint8_t> to_host_;
};

}  // namespace tacto::firmware_host
