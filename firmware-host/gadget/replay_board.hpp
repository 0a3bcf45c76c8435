// SPDX-License-Identifier: GPL-3.0-or-later
// A board whose converters return a recording's codes, one frame per tick.
#pragma once

#include <optional>

#include "data-schema/recording/recording.hpp"
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/gadget/gadget_board.hpp"
#include "firmware-host/link/hosted_board.hpp"

namespace tacto::firmware_host {

/// The recording begins with the first tick each time the board starts to tick. At its end the converters
/// fail, which ends the stream with that fault; with `loop` it begins again. If the recording names a
/// transducer, the board accepts drive within its limits and ignores it. Reads ahead by a second.
class ReplayBoard final : public GadgetBoard {
 public:
  /// `name` as for open_recording(). Errors: as open_recording() and WavReader::open(); unsuitable: not codes
  /// of a converter, gaps, more channels than a device may have.
  static schema::Result<std::unique_ptr<ReplayBoard>> open(const std::string& name, bool loop,
                                                           const std::string& serial);

  std::string serial() const override { return welcome_.serial; }
  bool ticking() const override { return ticking_; }
  double period_s() const override { return 1 / recording_.header.sample_rate_hz; }
  void step() override;
  void poll() override { firmware_->poll(); }
  double drive_v() const override { return drive_v_; }
  const core::DriveSupervisor& supervisor() const override { return firmware_->supervisor(); }
  std::vector<std::uint8_t>& from_host() override { return from_host_; }
  std::vector<std::uint8_t>& to_host() override { return to_host_; }

 private:
  ReplayBoard(schema::Recording recording, schema::WavReader reader, bool loop, const std::string& serial);
  static ReplayBoard& of(void* board) noexcept { return *static_cast<ReplayBoard*>(board); }
  core::Board about();
  core::Hal hal();
  void set_rate(std::uint32_t rate_millihertz);
  bool refill();
  void next_frame();

  schema::Recording recording_;
  schema::WavReader reader_;
  bool loop_;
  wire::Welcome welcome_;
  std::vector<wire::Channel> channels_;
  std::vector<wire::Note> notes_;
  HostedProfile texture_;
  std::optional<std::size_t> position_;  // the encoder's channel
  std::vector<std::int32_t> ahead_;      // frames that have been read but not used
  std::size_t used_ = 0;                 // of it
  std::vector<std::int32_t> frame_;
  bool ticking_ = false, ended_ = false;
  std::uint64_t ticks_ = 0;
  double drive_v_ = 0;
  std::vector<std::uint8_t> from_host_, to_host_;
  std::unique_ptr<core::Firmware> firmware_;
};

}  // namespace tacto::firmware_host
