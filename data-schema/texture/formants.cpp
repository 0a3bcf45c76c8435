// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.formants.json, read and written, and their table as CSV.
#include <fmt/format.h>

#include <filesystem>

#include "data-schema/base/table_text.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/texture/formants.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kFormantsKind = "formants";

template <class Owner, class Value>
struct Member {
  const char* name;
  Value Owner::*member;
};

constexpr Member<FormantPoint, double> kPointNumbers[] = {
    {"position_m", &FormantPoint::position_m},
    {"frequency_per_m", &FormantPoint::frequency_per_m},
    {"level_db", &FormantPoint::level_db},
    {"prominence_db", &FormantPoint::prominence_db},
};

constexpr Member<Formant, double> kFormantNumbers[] = {
    {"from_m", &Formant::from_m},
    {"to_m", &Formant::to_m},
    {"frequency_per_m", &Formant::frequency_per_m},
    {"lowest_per_m", &Formant::lowest_per_m},
    {"highest_per_m", &Formant::highest_per_m},
    {"width_per_m", &Formant::width_per_m},
    {"level_db", &Formant::level_db},
    {"peak_level_db", &Formant::peak_level_db},
    {"peak_position_m", &Formant::peak_position_m},
    {"prominence_db", &Formant::prominence_db},
};

constexpr Member<FormantTable, std::string> kTableTexts[] = {
    {"texture", &FormantTable::texture},     {"quantity", &FormantTable::quantity},
    {"unit", &FormantTable::unit},           {"level_reference", &FormantTable::level_reference},
    {"simulated", &FormantTable::simulated},
};

constexpr Member<FormantTable, double> kTableNumbers[] = {
    {"window_m", &FormantTable::window_m},
    {"hop_m", &FormantTable::hop_m},
    {"resolution_per_m", &FormantTable::resolution_per_m},
    {"start_db", &FormantTable::start_db},
    {"go_on_db", &FormantTable::go_on_db},
};

template <class Owner>
Json numbers_body(const Owner& owner, const auto& members) {
  Json body = Json::object();
  for (const auto& [name, member] : members) body[name] = owner.*member;
  return body;
}

template <class Owner>
void read_numbers(const Json& body, const auto& members, Owner& owner) {
  for (const auto& [name, member] : members) owner.*member = number_or(body, name, 0);
}

Json formant_body(const Formant& formant) {
  Json body = numbers_body(formant, kFormantNumbers);
  body["open_from"] = formant.open_from;
  body["open_to"] = formant.open_to;
  body["track"] = Json::array();
  for (const FormantPoint& point : formant.track) body["track"].push_back(numbers_body(point, kPointNumbers));
  return body;
}

Json table_body(const FormantTable& table) {
  Json body = Json::object();
  for (const auto& [name, member] : kTableTexts)
    if (member != &FormantTable::simulated) body[name] = table.*member;
  put_text(body, "simulated", table.simulated);
  body.update(numbers_body(table, kTableNumbers));
  body["formants"] = Json::array();
  for (const Formant& formant : table.formants) body["formants"].push_back(formant_body(formant));
  return body;
}

Formant formant_from(const Json& body) {
  Formant formant;
  read_numbers(body, kFormantNumbers, formant);
  formant.open_from = body.value("open_from", false);
  formant.open_to = body.value("open_to", false);
  if (!body.contains("track")) return formant;
  for (const Json& point : body["track"]) read_numbers(point, kPointNumbers, formant.track.emplace_back());
  return formant;
}

FormantTable table_from(const Json& body) {
  FormantTable table;
  for (const auto& [name, member] : kTableTexts) table.*member = text_or(body, name);
  read_numbers(body, kTableNumbers, table);
  for (const Json& formant : body["formants"]) table.formants.push_back(formant_from(formant));
  return table;
}

}  // namespace

Result<FormantFile> read_formants(const std::string& name) {
  const auto document = open_document(stem_of(name, ".formants") + ".formants.json", kFormantsKind);
  TACTO_TRY(document);
  FormantFile file;
  for (const Json& table : document->body["textures"]) file.tables.push_back(table_from(table));
  file.created = text_or(document->body, "created");
  file.creator = text_or(document->body, "creator");
  keep_unknown(*document, file);
  return file;
}

Result<std::string> formants_json(const FormantFile& file) {
  Json body = {{"textures", Json::array()}};
  for (const FormantTable& table : file.tables) body["textures"].push_back(table_body(table));
  put_text(body, "created", file.created);
  put_text(body, "creator", file.creator);
  return document_text(kFormantsKind, body, file.extra_json);
}

std::string formants_csv(const FormantFile& file) {
  const std::string reference = file.tables.empty() ? "" : file.tables.front().level_reference;
  std::string text = fmt::format(
      "texture,from_mm,to_mm,open_from,open_to,frequency_per_mm,lowest_per_mm,highest_per_mm,width_per_mm,"
      "\"level (dB re {})\",\"peak level (dB re {})\",peak_position_mm,prominence_db\n",
      reference, reference);
  for (const FormantTable& table : file.tables)
    for (const Formant& f : table.formants)
      text += fmt::format("{},{},{},{:d},{:d},{},{},{},{},{},{},{},{}\n", csv_cell(table.texture),
                          csv_number(1e3 * f.from_m), csv_number(1e3 * f.to_m), f.open_from, f.open_to,
                          csv_number(1e-3 * f.frequency_per_m), csv_number(1e-3 * f.lowest_per_m),
                          csv_number(1e-3 * f.highest_per_m), csv_number(1e-3 * f.width_per_m),
                          csv_number(f.level_db, 6), csv_number(f.peak_level_db, 6),
                          csv_number(1e3 * f.peak_position_m), csv_number(f.prominence_db, 6));
  return text;
}

}  // namespace tacto::schema
