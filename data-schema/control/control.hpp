// SPDX-License-Identifier: GPL-3.0-or-later
// The lines that tactographd and its clients exchange: newline-delimited JSON (playback/daemon/CONTROL.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::schema {

inline constexpr std::string_view kControlVersion = "1.0";
inline constexpr std::size_t kMostControlLine = 16384;  ///< bytes, newline included

enum class ControlVerb { hello, load, arm, play, stop, disarm, gain, set, move, raise, mark, status, watch };

struct ControlRequest {
  ControlVerb verb = ControlVerb::status;
  std::string id_json;  ///< as it came, JSON; empty where there was none
  std::string version;  ///< hello
  std::string token;    ///< hello over TCP
  std::string file;     ///< load
  std::optional<double> at_m;
  std::optional<double> gain_m_per_n, times_default;  ///< load, gain: displacement for force, or a factor
  std::optional<double> fade_s;                       ///< load while armed
  std::optional<TextureEnds> ends;
  PlaybackChoices playback;          ///< load
  bool while_connected = false;      ///< arm
  std::optional<double> dead_man_s;  ///< arm
  std::optional<double> gain;        ///< gain: a factor of the loaded gain
  bool save = false;
  std::string number;              ///< set: PATCH.LAYER.MEMBER
  std::optional<double> value;     ///< set
  std::string patch;               ///< move, raise
  std::optional<double> x_m, y_m;  ///< move: of its centre
  std::optional<double> over_s;    ///< set, move
  std::string text;                ///< mark
  bool ticks = false;              ///< watch: also the ticks
  /// Filled in by the socket; not in the line.
  std::string asked_by;  ///< the user, for a saved gain
  std::uint64_t client = 0;
  bool by_tcp = false;
};

/// One member of a reply or event.
using ControlValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;
using ControlFields = std::vector<std::pair<std::string, ControlValue>>;

/// One line without its newline. Errors: malformed, naming the member, also an unknown one;
/// unsupported_version, in hello.
/// `id_json`, if given, gets the request's id also if the rest is faulty.
Result<ControlRequest> parse_control_request(std::string_view line, std::string* id_json = nullptr);
/// The same as a line, newline included.
std::string control_request_line(const ControlRequest& request);

/// {"id":..., "ok":true, fields...}, {"id":..., "ok":false, "error":{...}}, {"event":name, fields...}: lines,
/// newline included. A number that is not finite is left out.
std::string control_reply_line(const std::string& id_json, const ControlFields& fields);
std::string control_error_line(const std::string& id_json, const Error& error);
std::string control_event_line(std::string_view name, const ControlFields& fields);

/// An answer or an event. `event` is the event's name.
struct ControlReply {
  bool ok = false;
  std::string event;
  Error error;
  ControlFields fields;
};

/// Errors: malformed, if it is neither.
Result<ControlReply> parse_control_reply(std::string_view line);

/// A field's number or text; `fallback` if there is none.
double control_number(const ControlFields& fields, std::string_view name, double fallback = 0);
std::string control_text(const ControlFields& fields, std::string_view name);

}  // namespace tacto::schema
