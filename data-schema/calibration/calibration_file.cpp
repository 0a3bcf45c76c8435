// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "data-schema/calibration/calibration.hpp"
#include "data-schema/files/config_folder.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kCalibrationKind = "calibration";

bool fits_a_file_name(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
}

std::string file_name_of(std::string serial) {
  std::ranges::replace_if(
      serial, [](char c) { return !fits_a_file_name(c); }, '_');
  return serial + ".calibration.json";
}

const CalibrationEntry* newest(const CalibrationFile& file, std::string_view channel,
                               std::optional<double> CalibrationEntry::*part) {
  const CalibrationEntry* found = nullptr;
  for (const CalibrationEntry& entry : file.entries)
    if (entry.channel == channel && (entry.*part).has_value() && (!found || entry.date >= found->date))
      found = &entry;
  return found;
}

std::optional<std::time_t> time_of(const std::string& date) {
  std::tm parts{};
  const char* const end =
      strptime(date.c_str(), date.size() > 10 ? "%Y-%m-%dT%H:%M:%SZ" : "%Y-%m-%d", &parts);
  if (end == nullptr || *end != '\0') return std::nullopt;
  return timegm(&parts);
}

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

// Without kind and version.
Json calibration_body(const CalibrationFile& file) {
  Json body = {{"serial", file.serial}};
  put_text(body, "device", file.device);
  put_text(body, "simulated", file.simulated);
  body["entries"] = Json::array();
  for (const CalibrationEntry& entry : file.entries) body["entries"].push_back(entry_body(entry));
  return body;
}

// From a document that fits its schema only; extra_json and newer_version stay empty.
CalibrationFile calibration_from(const Json& body) {
  CalibrationFile file;
  file.serial = body["serial"];
  file.device = text_or(body, "device");
  file.simulated = text_or(body, "simulated");
  for (const Json& entry : body["entries"]) file.entries.push_back(entry_from(entry));
  return file;
}

}  // namespace

Result<std::string> calibration_path(const std::string& serial) {
  if (serial.empty())
    return fail(ErrorKind::unsuitable, "the device has no serial number for the name of a calibration file",
                {}, "give a file with --calibration FILE");
  return config_folder("calibrations").map([&](const std::filesystem::path& folder) {
    return (folder / "calibrations" / file_name_of(serial)).string();
  });
}

Result<CalibrationFile> read_calibration(const std::string& path) {
  const auto document = open_document(path, kCalibrationKind);
  TACTO_TRY(document);
  CalibrationFile file = calibration_from(document->body);
  keep_unknown(*document, file);
  return file;
}

Result<void> write_calibration(const std::string& path, const CalibrationFile& file) {
  const auto text = document_text(kCalibrationKind, calibration_body(file), file.extra_json);
  TACTO_TRY(text);
  if (const auto made = make_folder_of(path); !made) return made;
  PendingFiles pending;
  if (const auto written = pending.write(path, *text); !written) return written;
  return pending.commit();
}

Result<FolderLock> lock_calibration(const std::string& path) {
  TACTO_TRY(make_folder_of(path));
  return FolderLock::take(path);
}

const CalibrationEntry* newest_scale(const CalibrationFile& file, std::string_view channel) {
  return newest(file, channel, &CalibrationEntry::scale);
}

const CalibrationEntry* newest_zero(const CalibrationFile& file, std::string_view channel) {
  return newest(file, channel, &CalibrationEntry::zero);
}

std::optional<double> seconds_between(const std::string& from, const std::string& to) {
  const auto first = time_of(from), last = time_of(to);
  return first && last ? std::optional(std::difftime(*last, *first)) : std::nullopt;
}

}  // namespace tacto::schema
