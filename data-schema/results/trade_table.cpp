// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/results/trade_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "data-schema/base/machine_words.hpp"
#include "data-schema/files/config_folder.hpp"
#include "data-schema/files/embedded_files.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kTradeKind = "trade";
constexpr std::string_view kShippedTable = "shipped.trade.json";

Json choice_body(const MeasuredChoice& choice) {
  Json body = {
      {"stage", choice.stage}, {"name", choice.name}, {"per", choice.per}, {"cost_ns", choice.cost_ns}};
  if (choice.memory_bytes > 0) body["memory_bytes"] = choice.memory_bytes;
  body["errors"] = Json::array();
  for (const ErrorPoint& point : choice.errors)
    body["errors"].push_back({{"points_per_period", point.points_per_period}, {"error", point.error}});
  return body;
}

MeasuredChoice choice_from(const Json& body) {
  MeasuredChoice choice{text_or(body, "stage"),
                        text_or(body, "name"),
                        text_or(body, "per"),
                        number_or(body, "cost_ns", 0),
                        number_or(body, "memory_bytes", 0),
                        {}};
  for (const Json& point : body["errors"])
    choice.errors.push_back({number_or(point, "points_per_period", 0), number_or(point, "error", 0)});
  return choice;
}

bool rises(const MeasuredChoice& choice) {
  return std::ranges::is_sorted(choice.errors, {}, &ErrorPoint::points_per_period);
}

Result<TradeTable> table_of(const Result<Document>& document, const std::string& where) {
  TACTO_TRY(document);
  const Json& body = document->body;
  TradeTable table;
  table.machine = text_or(body, "machine");
  for (const Json& each : body["choices"]) table.choices.push_back(choice_from(each));
  if (const auto bad = std::ranges::find_if_not(table.choices, rises); bad != table.choices.end())
    return fail(ErrorKind::malformed, "points per period do not increase",
                fmt::format("{}#/choices/{}/errors", where, bad - table.choices.begin()),
                "measure again with 'tactograph trade --calibrate'");
  table.created = text_or(body, "created");
  table.creator = text_or(body, "creator");
  keep_unknown(*document, table);
  return table;
}

}  // namespace

double MeasuredChoice::error_at(double points_per_period) const {
  double error = errors.empty() ? 0 : 1;
  for (const ErrorPoint& point : errors)
    if (point.points_per_period <= points_per_period) error = point.error;
  return error;
}

std::vector<MeasuredChoice> TradeTable::at(const std::string& stage) const {
  std::vector<MeasuredChoice> found;
  std::ranges::copy_if(choices, std::back_inserter(found),
                       [&](const MeasuredChoice& choice) { return choice.stage == stage; });
  return found;
}

Result<TradeTable> read_trade_table(const std::string& path) {
  return table_of(open_document(path, kTradeKind), path);
}

Result<std::string> trade_table_json(const TradeTable& table) {
  Json body = {{"machine", table.machine}};
  put_text(body, "created", table.created);
  put_text(body, "creator", table.creator);
  body["choices"] = Json::array();
  for (const MeasuredChoice& choice : table.choices) body["choices"].push_back(choice_body(choice));
  return document_text(kTradeKind, body, table.extra_json);
}

Result<TradeTable> shipped_trade_table() {
  const auto files = embedded_files();
  const auto found = std::ranges::find(files, kShippedTable, &EmbeddedFile::name);
  if (found == files.end())
    return fail(ErrorKind::internal, "is missing in the program", std::string(kShippedTable));
  return table_of(parse_document(found->content, std::string(found->name), kTradeKind),
                  std::string(found->name));
}

Result<std::string> machine_trade_path() {
  return config_folder("measured choices").map([](const std::filesystem::path& folder) {
    return (folder / "machine.trade.json").string();
  });
}

namespace {

// Also a link without a target, or a folder: the name is in use.
bool is_there(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
}

// A folder of settings may be copied to another machine.
std::string origin_of(const TradeTable& table, const std::string& path) {
  if (!table.newer_version.empty())
    return fmt::format("{}, of the newer version {}, whose unknown members are ignored", path,
                       table.newer_version);
  if (table.machine == machine_words()) return fmt::format("measured on this machine ({})", path);
  return fmt::format(
      "{}, measured on another machine or build ({}); 'tactograph trade --calibrate' measures this one", path,
      table.machine);
}

Result<FoundTradeTable> machines_own(const std::string& path) {
  auto own = read_trade_table(path);
  if (own) {
    const std::string origin = origin_of(*own, path);
    return FoundTradeTable{std::move(*own), origin};
  }
  return fail(own.error().kind, own.error().what, own.error().where,
              "measure it again with 'tactograph trade --calibrate', or remove it to use the shipped table");
}

}  // namespace

Result<FoundTradeTable> find_trade_table() {
  const auto path = machine_trade_path();
  if (path && is_there(*path)) return machines_own(*path);
  auto shipped = shipped_trade_table();
  TACTO_TRY(shipped);
  const std::string origin =
      fmt::format("the shipped table, measured on {}; 'tactograph trade --calibrate' measures this machine",
                  shipped->machine);
  return FoundTradeTable{std::move(*shipped), origin};
}

Result<std::string> write_machine_trade_table(const TradeTable& table) {
  const auto path = machine_trade_path();
  TACTO_TRY(path);
  const auto text = trade_table_json(table);
  TACTO_TRY(text);
  TACTO_TRY(make_folder_of(*path));
  PendingFiles pending;
  TACTO_TRY(pending.write(*path, *text));
  TACTO_TRY(pending.commit());
  return *path;
}

}  // namespace tacto::schema
