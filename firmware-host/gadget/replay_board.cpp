// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/replay_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "data-schema/version.hpp"
#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "firmware-host/link/wire_fields.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::uint32_t kClockHz = 1'000'000'000;

Result<void> check(const schema::Recording& recording) {
  const schema::RecordingHeader& header = recording.header;
  const auto unsuitable = [&](const char* what, const char* remedy) {
    return schema::fail(ErrorKind::unsuitable, what, recording.stem, remedy);
  };
  if (header.format != schema::SampleFormat::pcm32)
    return unsuitable("holds numbers of another program, not a converter's codes",
                      "only a recording of a device can be replayed");
  if (!header.gaps.empty())
    return unsuitable("has gaps, but a device has none in its ticks", "use a recording without gaps");
  if (header.channels.size() > wire::kMaxChannels)
    return unsuitable("has more than 16 channels, the limit of a device", "");
  return {};
}

std::string name_of(const schema::Recording& recording) {
  return "replay of " + std::filesystem::path(recording.stem).filename().string();
}

// The host finds a transducer by its name, so only a transducer with a known name is reported.
bool is_preset(const schema::Transducer& transducer) {
  return schema::read_transducer(transducer.name).has_value();
}

// Always flagged as simulated, because a replay is not a measurement. An empty `serial`: "replay". The
// device has an output if the recording names a transducer.
wire::Welcome replay_welcome(const schema::Recording& recording, const std::string& serial) {
  wire::Welcome welcome;
  put_text(welcome.name, name_of(recording));
  put_text(welcome.serial, serial.empty() ? "replay" : serial);
  put_text(welcome.firmware, kCreator);
  welcome.features = wire::kFeatureSimulated;
  if (const auto& transducer = recording.header.transducer) {
    welcome.features |= wire::kFeatureDrive;
    welcome.drive_limit_v = not_above(transducer->drive_limit_v);
    welcome.slew_limit_v_per_s = not_above(transducer->slew_limit_v_per_s);
  }
  return welcome;
}

std::vector<wire::Note> replay_notes(const schema::Recording& recording) {
  const schema::RecordingHeader& header = recording.header;
  std::vector<wire::Note> notes{
      note_of(wire::NoteKind::simulated_by, fmt::format("by {}'s {}", kCreator, name_of(recording)))};
  if (!header.simulated.empty())
    notes.push_back(note_of(wire::NoteKind::simulated_by, "itself simulated " + header.simulated));
  if (header.transducer && is_preset(*header.transducer))
    notes.push_back(note_of(wire::NoteKind::transducer, header.transducer->name));
  if (!header.surface.empty()) notes.push_back(note_of(wire::NoteKind::surface, header.surface));
  return numbered(std::move(notes));
}

}  // namespace

Result<std::unique_ptr<ReplayBoard>> ReplayBoard::open(const std::string& name, bool loop,
                                                       const std::string& serial) {
  auto recording = schema::open_recording(name);
  TACTO_TRY(recording);
  TACTO_TRY(check(*recording));
  auto reader = schema::WavReader::open(schema::wav_path(*recording));
  TACTO_TRY(reader);
  return std::unique_ptr<ReplayBoard>(
      new ReplayBoard(std::move(*recording), std::move(*reader), loop, serial));
}

ReplayBoard::ReplayBoard(schema::Recording recording, schema::WavReader reader, bool loop,
                         const std::string& serial)
    : recording_(std::move(recording)),
      reader_(std::move(reader)),
      loop_(loop),
      welcome_(replay_welcome(recording_, serial)),
      channels_(wire_channels(recording_.header.channels)),
      notes_(replay_notes(recording_)),
      frame_(channels_.size()) {
  if (const auto position = schema::find_channel(recording_.header, "position")) position_ = *position;
  firmware_ = std::make_unique<core::Firmware>(about(), hal());
}

core::Board ReplayBoard::about() {
  core::Board board = board_of(welcome_, channels_, notes_, texture_);
  board.about.clock_hz = kClockHz;
  const std::uint32_t rate = millihertz(recording_.header.sample_rate_hz);
  board.about.default_rate_millihertz = rate;
  board.about.least_rate_millihertz = board.about.most_rate_millihertz = rate;
  return board;
}

core::Hal ReplayBoard::hal() {
  core::Hal hal;
  hal.board = this;
  hal.read_encoder = [](void* b) noexcept {
    return of(b).position_ ? of(b).frame_[*of(b).position_] : std::int32_t{0};
  };
  hal.read_channels = [](void* b, std::int32_t* codes) noexcept {
    std::copy(of(b).frame_.begin(), of(b).frame_.end(), codes);
    return !of(b).ended_;
  };
  hal.write_drive = [](void* b, float drive_v) noexcept { of(b).drive_v_ = drive_v; };
  hal.enable_closed = [](void*) noexcept { return true; };
  hal.clock = [](void* b) noexcept {
    return static_cast<std::uint64_t>(static_cast<double>(of(b).ticks_) * of(b).period_s() * kClockHz);
  };
  hal.set_rate = [](void* b, std::uint32_t rate) noexcept { of(b).set_rate(rate); };
  use_queues<ReplayBoard, &ReplayBoard::from_host_, &ReplayBoard::to_host_>(hal);
  hal.restart = [](void* b) noexcept { of(b).set_rate(0); };
  return hal;
}

void ReplayBoard::set_rate(std::uint32_t rate_millihertz) {
  ticking_ = rate_millihertz > 0;
  if (!ticking_) return;
  ahead_.clear();
  used_ = 0;
  ended_ = !reader_.seek(0);
}

// False at the end, or if the file cannot be read any more: the core reports both as failed converters.
bool ReplayBoard::refill() {
  const auto frames = static_cast<std::size_t>(recording_.header.sample_rate_hz) + 1;
  used_ = 0;
  for (int attempt = 0; attempt < (loop_ ? 2 : 1); ++attempt) {
    ahead_.resize(frames * frame_.size());
    const auto got = reader_.read(ahead_);
    ahead_.resize(got ? *got * frame_.size() : 0);
    if (!ahead_.empty()) return true;
    if (loop_ && !reader_.seek(0)) return false;
  }
  return false;
}

void ReplayBoard::next_frame() {
  if (used_ == ahead_.size() && !refill()) {
    ended_ = true;
    return;
  }
  std::copy_n(ahead_.begin() + static_cast<std::ptrdiff_t>(used_), frame_.size(), frame_.begin());
  used_ += frame_.size();
}

void ReplayBoard::step() {
  if (!ended_) next_frame();
  firmware_->tick();
  ++ticks_;
}

}  // namespace tacto::firmware_host
