// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "data-schema/base/format_version.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/scene/playback_choices_json.hpp"
#include "data-schema/session/session.hpp"
#include "data-schema/session/session_blocks.hpp"
#include "data-schema/transducer/transducer_json.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kSessionKind = "session";
constexpr std::string_view kChangeKind = "session_change";

struct SessionText {
  const char* name;
  std::string SessionHeader::*member;
};
constexpr SessionText kSessionTexts[] = {{"created", &SessionHeader::created},
                                         {"creator", &SessionHeader::creator},
                                         {"build", &SessionHeader::build},
                                         {"loop", &SessionHeader::loop}};
constexpr SessionText kDeviceTexts[] = {{"uri", &SessionHeader::device_uri},
                                        {"name", &SessionHeader::device_name},
                                        {"serial", &SessionHeader::device_serial},
                                        {"firmware", &SessionHeader::device_firmware}};

struct SessionNumber {
  const char* name;
  double SessionHeader::*member;
};
constexpr SessionNumber kSessionNumbers[] = {{"rate_hz", &SessionHeader::rate_hz},
                                             {"clock_hz", &SessionHeader::clock_hz},
                                             {"metres_per_count", &SessionHeader::metres_per_count}};
struct ProgramNumber {
  const char* name;
  double SessionProgram::*member;
};
constexpr ProgramNumber kPlaybackNumbers[] = {{"delay_s", &SessionProgram::delay_s},
                                              {"loop_delay_s", &SessionProgram::loop_delay_s},
                                              {"low_hz", &SessionProgram::low_hz},
                                              {"high_hz", &SessionProgram::high_hz}};

Json device_body(const SessionHeader& header) {
  Json body = Json::object();
  for (const auto& [name, member] : kDeviceTexts) body[name] = header.*member;
  body["protocol"] = header.device_protocol;
  put_text(body, "simulated", header.simulated);
  return body;
}

Json texture_row(const SessionTexture& texture) {
  Json row = {{"file", texture.file},
              {"sha256", texture.sha256},
              {"at_m", texture.at_m},
              {"gain_m_per_n", texture.gain_m_per_n},
              {"ends", to_string(texture.ends)}};
  if (texture.ends == TextureEnds::loop) row["seam_m"] = texture.seam_m;
  return row;
}

TextureEnds ends_from(const std::string& word) {
  constexpr std::array kAll = {TextureEnds::stop, TextureEnds::mirror, TextureEnds::loop};
  const auto found = std::ranges::find(kAll, word, [](TextureEnds ends) { return to_string(ends); });
  return found == kAll.end() ? TextureEnds::stop : *found;
}

SessionTexture texture_of_row(const Json& row) {
  return {text_or(row, "file"),
          text_or(row, "sha256"),
          number_or(row, "at_m", 0),
          number_or(row, "gain_m_per_n", 0),
          ends_from(text_or(row, "ends")),
          number_or(row, "seam_m", 0)};
}

Json playback_body(const SessionProgram& program) {
  Json body = playback_choices_body(program.choices);
  body["inverse"] = program.inverse;
  for (const auto& [name, member] : kPlaybackNumbers) body[name] = program.*member;
  return body;
}

void put_textures(Json& body, const SessionProgram& program) {
  if (!program.scene_file.empty())
    body["scene"] = {{"file", program.scene_file}, {"sha256", program.scene_sha256}};
  body["textures"] = Json::array();
  for (const SessionTexture& texture : program.textures) body["textures"].push_back(texture_row(texture));
}

Json sensor_body(const SessionSensor& sensor) {
  Json body = {{"channel", sensor.channel},
               {"unit", "m"},
               {"rate_hz", sensor.rate_hz},
               {"scale", sensor.scale},
               {"offset", sensor.offset}};
  put_text(body, "source", sensor.source);
  put_text(body, "calibrated", sensor.calibrated);
  return body;
}

std::optional<SessionSensor> sensor_in(const Json& body) {
  if (!body.contains("measured")) return std::nullopt;
  const Json& measured = body["measured"];
  return SessionSensor{text_or(measured, "channel"),    text_or(measured, "source"),
                       text_or(measured, "calibrated"), number_or(measured, "rate_hz", 0),
                       number_or(measured, "scale", 1), number_or(measured, "offset", 0)};
}

Json forces_body(const SessionForces& forces) {
  Json body = {{"peak_n", forces.peak_n},
               {"continuous_n", forces.continuous_n},
               {"slew_n_per_s", forces.slew_n_per_s},
               {"axes", Json::array()}};
  for (const DeviceAxis& axis : forces.axes)
    body["axes"].push_back({{"name", axis.name},
                            {"metres_per_count", axis.encoder_step_m},
                            {"travel_m", {axis.travel_from_m, axis.travel_to_m}},
                            {"peak_n", axis.peak_force_n},
                            {"continuous_n", axis.continuous_force_n}});
  if (!forces.slides.empty()) body["slides"] = forces.slides;
  return body;
}

std::optional<SessionForces> forces_in(const Json& body) {
  if (!body.contains("forces")) return std::nullopt;
  const Json& from = body["forces"];
  SessionForces forces{from["peak_n"], from["continuous_n"], from["slew_n_per_s"], {}};
  for (const Json& row : from["axes"]) {
    DeviceAxis axis;
    axis.name = text_or(row, "name");
    axis.encoder_step_m = row["metres_per_count"];
    axis.travel_from_m = row["travel_m"][0];
    axis.travel_to_m = row["travel_m"][1];
    axis.peak_force_n = row["peak_n"];
    axis.continuous_force_n = row["continuous_n"];
    forces.axes.push_back(std::move(axis));
  }
  if (from.contains("slides")) forces.slides = from["slides"];
  return forces;
}

Json session_body(const SessionHeader& header) {
  Json body = Json::object();
  for (const auto& [name, member] : kSessionTexts) body[name] = header.*member;
  for (const auto& [name, member] : kSessionNumbers) body[name] = header.*member;
  body["device"] = device_body(header);
  if (header.forces)
    body["forces"] = forces_body(*header.forces);
  else
    body["transducer"] = transducer_body(header.transducer);
  put_text(body, "transducer_sha256", header.transducer_sha256);
  if (header.sensor) body["measured"] = sensor_body(*header.sensor);
  put_textures(body, header);
  body["initial"] = {
      {"state", "idle"}, {"gain", header.initial_gain}, {"encoder_count", header.initial_encoder}};
  if (!header.forces) body["playback"] = playback_body(header);
  return body;
}

void read_device(const Json& body, SessionHeader& header) {
  for (const auto& [name, member] : kDeviceTexts) header.*member = text_or(body, name);
  header.device_protocol = text_or(body, "protocol");
  header.simulated = text_or(body, "simulated");
}

void read_textures(const Json& body, SessionProgram& program) {
  for (const Json& row : body["textures"]) program.textures.push_back(texture_of_row(row));
  if (!body.contains("scene")) return;
  program.scene_file = text_or(body["scene"], "file");
  program.scene_sha256 = text_or(body["scene"], "sha256");
}

void read_program(const Json& body, SessionProgram& program) {
  read_textures(body, program);
  if (!body.contains("playback")) return;
  program.inverse = text_or(body["playback"], "inverse");
  program.choices = playback_choices_in(body);
  program.choices.extra_json.clear();
  for (const auto& [name, member] : kPlaybackNumbers) program.*member = number_or(body["playback"], name, 0);
}

constexpr std::size_t kMostProgramText = kMostPayload - 16;  // beside a change's moment

Result<std::string> too_long(std::size_t bytes) {
  return fail(ErrorKind::unsuitable,
              fmt::format("the description of the textures needs {} bytes, but a session allows {}", bytes,
                          kMostProgramText),
              "session", "play a scene with fewer layers");
}

// It has neither kind nor version, and otherwise fits the transducer's schema.
Result<void> check_transducer_in(const Json& body, const std::string& where) {
  if (body.contains("forces")) return {};
  Json transducer = body["transducer"];
  transducer["kind"] = "transducer";
  if (!transducer.contains("version")) transducer["version"] = kFormatVersion;
  static const auto kRules = schema_of("transducer");
  const auto faults = breaches(transducer, *kRules);
  if (faults.empty()) return {};
  return fail(ErrorKind::malformed, faults.front().what,
              fmt::format("{}#/transducer{}", where, faults.front().pointer), "restore the right file");
}

SessionHeader session_from(const Json& body) {
  SessionHeader header;
  for (const auto& [name, member] : kSessionTexts) header.*member = text_or(body, name);
  for (const auto& [name, member] : kSessionNumbers) header.*member = number_or(body, name, 0);
  read_device(body["device"], header);
  read_program(body, header);
  header.forces = forces_in(body);
  if (!header.forces) header.transducer = transducer_from(body["transducer"]);
  header.transducer_sha256 = text_or(body, "transducer_sha256");
  header.sensor = sensor_in(body);
  header.initial_gain = number_or(body["initial"], "gain", 1);
  header.initial_encoder = body["initial"].value("encoder_count", std::int32_t{0});
  return header;
}

}  // namespace

Result<std::string> session_header_text(const SessionHeader& header) {
  auto text = document_text(kSessionKind, session_body(header), header.extra_json);
  return text && text->size() > kMostProgramText ? too_long(text->size()) : text;
}

Result<std::string> session_program_text(const SessionProgram& program) {
  Json body = Json::object();
  put_textures(body, program);
  body["playback"] = playback_body(program);
  auto text = document_text(kChangeKind, body, {});
  return text && text->size() > kMostProgramText ? too_long(text->size()) : text;
}

Result<SessionProgram> parse_session_program(std::string_view text, const std::string& where) {
  const auto document = parse_document(text, where, kChangeKind);
  TACTO_TRY(document);
  SessionProgram program;
  read_program(document->body, program);
  return program;
}

Result<SessionHeader> parse_session_header(std::string_view text, const std::string& where) {
  const auto document = parse_document(text, where, kSessionKind);
  TACTO_TRY(document);
  TACTO_TRY(check_transducer_in(document->body, where));
  SessionHeader header = session_from(document->body);
  keep_unknown(*document, header);
  return header;
}

}  // namespace tacto::schema
