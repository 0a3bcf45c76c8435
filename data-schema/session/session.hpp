// SPDX-License-Identifier: GPL-3.0-or-later
// A session: a playback with every tick and every command, from arming to disarming. SESSION.md describes the
// bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/physical_value.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {

/// One tick of the drive.
struct SessionTick {
  std::uint64_t tick = 0;                       ///< since arming
  std::int64_t time_ns = 0;                     ///< by the device's clock
  std::int32_t encoder = 0;                     ///< counts
  float drive_v = 0;                            ///< at the amplifier's input
  std::uint32_t flags = 0;                      ///< as in the wire's `ticks` (firmware-host/core/WIRE.md)
  std::int32_t lateness_ns = kLatenessUnknown;  ///< behind its time
  /// Of a force device: the number of its axes, their counts, and the forces on the hand, N.
  std::uint8_t axes = 0;
  std::array<std::int32_t, 3> counts = {};
  std::array<float, 3> force_n = {};
  static constexpr std::int32_t kLatenessUnknown = INT32_MIN;
  bool operator==(const SessionTick&) const = default;
};

/// A command as it was sent: a frame of the wire. It took effect in the first tick whose flags count it, and
/// not before tick `not_before`.
struct SessionCommand {
  std::uint64_t not_before = 0;
  std::int64_t time_ns = 0;  ///< host's steady clock, when it was answered
  std::vector<std::uint8_t> frame;
};

/// Samples of the driven tray's sensor: frames that follow each other at the sensor's rate.
struct SessionSamples {
  std::uint64_t first_frame = 0;  ///< since the sensor began; frames between two of these are missing
  std::int64_t time_ns = 0;       ///< of the first frame, by the clock of the ticks
  std::vector<std::int32_t> codes;
  bool operator==(const SessionSamples&) const = default;
};

/// That sensor, as the device describes its channel: displacement in m = code x scale + offset.
struct SessionSensor {
  std::string channel, source, calibrated;
  double rate_hz = 0, scale = 1, offset = 0;

  double physical(double code) const { return physical_value(code, scale, offset); }
};

/// Ticks that are not in the file, and why.
struct SessionLoss {
  enum class Why : std::uint8_t { link = 0, recorder = 1, disk = 2 };
  std::uint64_t first_tick = 0, count = 0;
  Why why = Why::link;
};

/// An event as text: a state, a fault.
struct SessionEvent {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::string text;
};

/// A client's mark is an event with this before the client's text.
inline constexpr std::string_view kMarkEvent = "mark: ";
inline constexpr std::size_t kMostMarks = 10000;  ///< of a session

/// The last block of a session that was closed.
struct SessionEnd {
  std::uint64_t ticks = 0, lost_ticks = 0, late_ticks = 0;
};

/// The force device, as it describes itself.
struct SessionForces {
  double peak_n = 0, continuous_n = 0;  ///< of the vector
  double slew_n_per_s = 0;
  std::vector<DeviceAxis> axes;          ///< mass and friction are not known
  std::vector<std::string> slides = {};  ///< names of the pieces that slide, in the order of the block
};

struct SessionTexture {
  std::string file, sha256;
  double at_m = 0, gain_m_per_n = 0;
  TextureEnds ends = TextureEnds::stop;
  double seam_m = 0;  ///< of a loop: the part of its end that fades into its beginning
};

/// What is played, and how the drive is made of it.
struct SessionProgram {
  std::string scene_file, scene_sha256;  ///< empty where a texture was played by itself
  std::vector<SessionTexture> textures;
  std::string inverse;
  PlaybackChoices choices;  ///< used for the playback
  double delay_s = 0, low_hz = 0, high_hz = 0;
  double loop_delay_s = 0;  ///< of a loop closed on the host: from the count to the drive at the device
};

/// A header contains the program that was armed.
struct SessionHeader : SessionProgram {
  std::string created, creator, build;
  std::string loop = "device";  ///< or "host"
  double rate_hz = 0, clock_hz = 0, metres_per_count = 0;
  std::string device_uri, device_name, device_serial, device_firmware, simulated;
  std::string device_protocol;  ///< "1.0", of the wire
  Transducer transducer;
  std::string transducer_sha256;
  std::optional<SessionForces> forces = std::nullopt;  ///< of a scene with force patches: no transducer
  std::optional<SessionSensor> sensor;                 ///< none: the device does not report its tray
  double initial_gain = 1;
  std::int32_t initial_encoder = 0;
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
};

/// The program that the next `change` command brings. If several precede it, the last one is valid: an
/// earlier one failed.
struct SessionChange {
  std::uint64_t not_before = 0;
  std::int64_t time_ns = 0;  ///< host's steady clock, before its upload
  SessionProgram program;
};

/// The header as JSON and back; `where` names the file in errors. Errors: as document_text, parse_document.
Result<std::string> session_header_text(const SessionHeader& header);
Result<SessionHeader> parse_session_header(std::string_view text, const std::string& where);

/// The same for a change's program. Errors: as of the header's; unsuitable, if it is larger than a block.
Result<std::string> session_program_text(const SessionProgram& program);
Result<SessionProgram> parse_session_program(std::string_view text, const std::string& where);

/// NAME.session of a stem or file name.
std::string session_path(const std::string& name);

}  // namespace tacto::schema
