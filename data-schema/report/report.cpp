// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/report.hpp"

#include <nlohmann/json.hpp>

#include "data-schema/report/report_entries.hpp"
#include "data-schema/report/report_text.hpp"

namespace tacto::cli {
namespace {

nlohmann::ordered_json json_of(const Report& report);

nlohmann::ordered_json json_value(const std::vector<Report>& rows) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const Report& row : rows) array.push_back(json_of(row));
  return array;
}
nlohmann::ordered_json json_value(const auto& plain) {
  return plain;
}

nlohmann::ordered_json json_of(const Report& report) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [key, value] : ReportPrinter::entries(report))
    std::visit([&, k = &key](const auto& v) { object[*k] = json_value(v); }, value);
  return object;
}

}  // namespace

Report& Report::put(std::string key, Value value) {
  entries_.emplace_back(std::move(key), std::move(value));
  return *this;
}
Report& Report::add(std::string key, double value_si) {
  return put(std::move(key), value_si);
}
Report& Report::add(std::string key, std::string text) {
  return put(std::move(key), std::move(text));
}
Report& Report::add(std::string key, bool value) {
  return put(std::move(key), value);
}
Report& Report::add(std::string key, std::vector<Report> rows) {
  return put(std::move(key), std::move(rows));
}
Report& Report::add(std::string key, std::vector<std::string> lines) {
  return put(std::move(key), std::move(lines));
}

Report& Report::ends_with(schema::ErrorKind fault) {
  exit_code_ = schema::exit_code(fault);
  return *this;
}

std::string Report::for_people() const {
  return text_of(*this, {});
}

std::string json_line(const Report& report) {
  using Dump = nlohmann::ordered_json;
  return json_of(report).dump(-1, ' ', false, Dump::error_handler_t::replace) + "\n";
}

std::string Report::json() const {
  using Dump = nlohmann::ordered_json;
  return json_of(*this).dump(2, ' ', false, Dump::error_handler_t::replace) + "\n";
}

}  // namespace tacto::cli
