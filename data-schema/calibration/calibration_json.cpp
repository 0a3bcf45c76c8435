// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/calibration/calibration_json.hpp"

namespace tacto::schema {
namespace {

struct EntryPart {
  const char* name;
  std::optional<double> CalibrationEntry::*member;
};

constexpr EntryPart kParts[] = {
    {"scale", &CalibrationEntry::scale},         {"scale_uncertainty", &CalibrationEntry::scale_uncertainty},
    {"zero", &CalibrationEntry::zero},           {"zero_uncertainty", &CalibrationEntry::zero_uncertainty},
    {"noise_rms", &CalibrationEntry::noise_rms}, {"noise_density", &CalibrationEntry::noise_density},
};

Json entry_body(const CalibrationEntry& entry) {
  Json body = {{"channel", entry.channel},
               {"unit", entry.unit},
               {"method", entry.method},
               {"date", entry.date},
               {"nominal_scale", entry.nominal_scale}};
  for (const auto& [name, member] : kParts)
    if (entry.*member) body[name] = *(entry.*member);
  body["degrees_of_freedom"] = entry.degrees_of_freedom;
  for (const std::string& note : entry.notes) body["notes"].push_back(note);
  return body;
}

CalibrationEntry entry_from(const Json& body) {
  CalibrationEntry entry;
  entry.channel = body["channel"];
  entry.unit = body["unit"];
  entry.method = body["method"];
  entry.date = body["date"];
  entry.nominal_scale = body["nominal_scale"];
  for (const auto& [name, member] : kParts)
    if (body.contains(name)) entry.*member = body[name].get<double>();
  entry.degrees_of_freedom = number_or(body, "degrees_of_freedom", 0);
  if (body.contains("notes"))
    for (const Json& note : body["notes"]) entry.notes.push_back(note.get<std::string>());
  return entry;
}

}  // namespace

Json calibration_body(const CalibrationFile& file) {
  Json body = {{"serial", file.serial}};
  put_text(body, "device", file.device);
  put_text(body, "simulated", file.simulated);
  body["entries"] = Json::array();
  for (const CalibrationEntry& entry : file.entries) body["entries"].push_back(entry_body(entry));
  return body;
}

CalibrationFile calibration_from(const Json& body) {
  CalibrationFile file;
  file.serial = body["serial"];
  file.device = text_or(body, "device");
  file.simulated = text_or(body, "simulated");
  for (const Json& entry : body["entries"]) file.entries.push_back(entry_from(entry));
  return file;
}

}  // namespace tacto::schema
