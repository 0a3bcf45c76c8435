// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "data-schema/json_document.hpp"
#include "data-schema/json_schema.hpp"
#include "data-schema/playback_choices_json.hpp"
#include "data-schema/session.hpp"
#include "data-schema/transducer_json.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kSessionKind = "session";

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
constexpr SessionNumber kPlaybackNumbers[] = {{"delay_s", &SessionHeader::delay_s},
                                              {"low_hz", &SessionHeader::low_hz},
                                              {"high_hz", &SessionHeader::high_hz}};

Json device_body(const SessionHeader& header) {
  Json body = Json::object();
  for (const auto& [name, member] : kDeviceTexts) body[name] = header.*member;
  put_text(body, "protocol", header.device_protocol);
  put_text(body, "simulated", header.simulated);
  return body;
}

Json texture_row(const SessionTexture& texture) {
  return {{"file", texture.file},
          {"sha256", texture.sha256},
          {"at_m", texture.at_m},
          {"gain_m_per_n", texture.gain_m_per_n},
          {"ends", word_of(texture.ends)}};
}

TextureEnds ends_from(const std::string& word) {
  constexpr std::array kAll = {TextureEnds::stop, TextureEnds::mirror, TextureEnds::loop};
  const auto found = std::ranges::find(kAll, word, [](TextureEnds ends) { return word_of(ends); });
  return found == kAll.end() ? TextureEnds::stop : *found;
}

SessionTexture texture_of_row(const Json& row) {
  return {text_or(row, "file"), text_or(row, "sha256"), number_or(row, "at_m", 0),
          number_or(row, "gain_m_per_n", 0), ends_from(text_or(row, "ends"))};
}

Json playback_body(const SessionHeader& header) {
  Json body = playback_choices_body(header.choices);
  body["inverse"] = header.inverse;
  for (const auto& [name, member] : kPlaybackNumbers) body[name] = header.*member;
  return body;
}

Json session_body(const SessionHeader& header) {
  Json body = Json::object();
  for (const auto& [name, member] : kSessionTexts) body[name] = header.*member;
  for (const auto& [name, member] : kSessionNumbers) body[name] = header.*member;
  body["device"] = device_body(header);
  body["transducer"] = transducer_body(header.transducer);
  put_text(body, "transducer_sha256", header.transducer_sha256);
  if (!header.scene_file.empty())
    body["scene"] = {{"file", header.scene_file}, {"sha256", header.scene_sha256}};
  body["textures"] = Json::array();
  for (const SessionTexture& texture : header.textures) body["textures"].push_back(texture_row(texture));
  body["initial"] = {
      {"state", "idle"}, {"gain", header.initial_gain}, {"encoder_count", header.initial_encoder}};
  body["playback"] = playback_body(header);
  return body;
}

void read_device(const Json& body, SessionHeader& header) {
  for (const auto& [name, member] : kDeviceTexts) header.*member = text_or(body, name);
  header.device_protocol = text_or(body, "protocol");
  header.simulated = text_or(body, "simulated");
}

void read_played(const Json& body, SessionHeader& header) {
  header.transducer = transducer_from(body["transducer"]);
  header.transducer_sha256 = text_or(body, "transducer_sha256");
  for (const Json& row : body["textures"]) header.textures.push_back(texture_of_row(row));
  if (!body.contains("scene")) return;
  header.scene_file = text_or(body["scene"], "file");
  header.scene_sha256 = text_or(body["scene"], "sha256");
}

// It says neither kind nor version, and fits the transducer's schema in all else.
Result<void> check_transducer_in(const Json& body, const std::string& where) {
  Json transducer = body["transducer"];
  transducer["kind"] = "transducer";
  if (!transducer.contains("version")) transducer["version"] = "1.0";
  static const auto kRules = schema_of("transducer");
  const auto faults = breaches(transducer, *kRules);
  if (faults.empty()) return {};
  return fail(Fault::malformed, faults.front().what,
              fmt::format("{}#/transducer{}", where, faults.front().pointer), "bring the right file back");
}

SessionHeader session_from(const Json& body) {
  SessionHeader header;
  for (const auto& [name, member] : kSessionTexts) header.*member = text_or(body, name);
  for (const auto& [name, member] : kSessionNumbers) header.*member = number_or(body, name, 0);
  read_device(body["device"], header);
  read_played(body, header);
  header.initial_gain = number_or(body["initial"], "gain", 1);
  header.initial_encoder = body["initial"].value("encoder_count", std::int32_t{0});
  header.inverse = text_or(body["playback"], "inverse");
  header.choices = playback_choices_in(body);
  header.choices.extra_json.clear();
  for (const auto& [name, member] : kPlaybackNumbers) header.*member = number_or(body["playback"], name, 0);
  return header;
}

}  // namespace

Result<std::string> session_header_text(const SessionHeader& header) {
  return document_text(kSessionKind, session_body(header), header.extra_json);
}

Result<SessionHeader> parse_session_header(std::string_view text, const std::string& where) {
  const auto document = parse_document(text, where, kSessionKind);
  if (!document) return forward_error(document);
  if (const auto sound = check_transducer_in(document->body, where); !sound) return forward_error(sound);
  SessionHeader header = session_from(document->body);
  header.extra_json = unknown_members(document->body, kSessionKind);
  header.newer_version = document->newer_version;
  return header;
}

}  // namespace tacto::schema
