// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/scene/scene_trade_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "analysis/trade/rows/pareto.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/report/value_text.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;

bool is_unstable_row(const SceneTradeRow& row) {
  return row.verdict == to_string(Stability::unstable);
}

// An unstable row is not compared with others: it is no choice.
std::vector<TradeRow> trade_rows(const SceneTrade& trade) {
  std::vector<TradeRow> rows;
  for (const SceneTradeRow& each : trade.rows) {
    rows.push_back(each.row);
    if (is_unstable_row(each)) rows.back().error = kNotMeasured;
  }
  return rows;
}

// As plain_answers(), with the unstable choices among those that are never worth it.
std::vector<PlainAnswer> scene_answers(const SceneTrade& trade) {
  const auto rows = trade_rows(trade);
  auto answers = plain_answers(rows);
  for (PlainAnswer& answer : answers) {
    std::vector<std::string> unstable;
    for (const SceneTradeRow& row : trade.rows)
      if (row.row.knob == answer.knob && is_unstable_row(row))
        unstable.push_back(row.row.choice + " (unstable)");
    if (answer.knee_row) answer.knee = rows[*answer.knee_row].choice;
    if (unstable.empty()) continue;
    if (!answer.knee_row) answer.knee = "no best choice";
    const std::string others = answer.never_worth_it > 0 ? answer.never + "; " : "";
    answer.never = others + fmt::format("{}", fmt::join(unstable, "; "));
    answer.never_worth_it += unstable.size();
  }
  return answers;
}

// Keys and SI values; NaN: nothing.
using TradeCells = std::vector<std::pair<std::string, std::variant<double, std::string>>>;

TradeCells trade_cells(const SceneTradeRow& row, const Worth& worth) {
  return {{"choice_of", row.row.knob},
          {"choice", row.row.choice},
          {"error_n", row.error_n},
          {"error_rms_n", row.error_rms_n},
          {"promised_n", row.promised_n},
          {"cost_ns", row.row.cost_ns},
          {"per", row.row.per},
          {"memory_kib", row.row.memory_bytes / 1024},
          {"stiffness_n_per_m", row.stiffness_n_per_m},
          {"limit_n_per_m", row.limit_n_per_m},
          {"stability", row.verdict},
          {"worth_it", is_unstable_row(row) ? "never: unstable" : worth_words(worth)},
          {"note", row.row.note}};
}

std::vector<std::string> column_keys() {
  std::vector<std::string> keys;
  for (const auto& [key, value] : trade_cells({}, {})) keys.push_back(key);
  return keys;
}

cli::Report report_row(const TradeCells& cells) {
  cli::Report report;
  for (const auto& [key, value] : cells)
    if (const auto* number = std::get_if<double>(&value); number == nullptr)
      report.add(key, std::get<std::string>(value));
    else if (std::isfinite(*number))
      report.add(key, *number);
  return report;
}

std::string best_of(const SceneTrade& trade) {
  std::string words;
  for (const PlainAnswer& answer : scene_answers(trade))
    if (answer.knee_row)
      words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", answer.knob, answer.knee);
  return words.empty() ? "no best choice" : words;
}

constexpr const char* kChosenFor =
    "filters and added dampers are numbers now, for this device, rate and hand";

std::string scene_answer(const SceneTrade& trade) {
  if (!trade.chosen) return "best for its cost: " + best_of(trade);
  const SceneChoice& chosen = *trade.chosen;
  return fmt::format(
      "{}: an error of at most {} at any place{}, a tick of {} on this computer{}{}",
      chosen.changed.empty() ? "the scene as it is" : fmt::format("{}", fmt::join(chosen.changed, "; ")),
      for_people(chosen.promised_n, Dimension::force),
      trade.assumed.empty() ? "" : " with the patches at their places",
      for_people(chosen.tick_s, Dimension::time), chosen.is_for_loop ? "; " : "",
      chosen.is_for_loop ? kChosenFor : "");
}

cli::Report trade_head(const SceneTrade& trade) {
  cli::Report head;
  head.add("answer", scene_answer(trade)).add("scene", trade.scene).add("device", trade.device);
  head.add("hand", trade.hand);
  head.add("rate_hz", trade.rate_hz).add("machine", trade.machine).add("paths", trade.paths);
  head.add("timed_along", trade.timed_along);
  head.add("largest_force_n", trade.largest_force_n).add("rounding_n", trade.rounding_n);
  if (trade.chosen) {
    const SceneChoice& chosen = *trade.chosen;
    head.add("changed", chosen.changed).add("promised_n", chosen.promised_n);
    head.add("error_n", chosen.error_n).add("tick_s", chosen.tick_s).add("memory_bytes", chosen.bytes);
    head.add("stability", chosen.verdict);
    if (chosen.is_for_loop) head.add("chosen_for", kChosenFor);
  }
  if (!trade.assumed.empty()) head.add("assumed", trade.assumed);
  head.add("not_promised", trade.not_promised);
  if (!trade.without_choice.empty())
    head.add("without_choice", fmt::format("{}", fmt::join(trade.without_choice, ", ")));
  return head;
}

double error_level(const SceneTradeRow& row) {
  constexpr double kLeast_n = 1e-9;
  return schema::amplitude_db(std::max(row.error_rms_n, kLeast_n));
}

constexpr const char* kSceneTradeNotes =
    "<h2>What the columns mean</h2>\n"
    "<p><em>Error</em>: the largest difference of the force from the reference in double precision, along "
    "the paths, and its RMS. <em>Promised</em>: the largest difference at any place and speed, with the "
    "worse ends of the "
    "sliders and the patches at their places; - where it is measured only. Both are of the force before "
    "the limits of the device. <em>Cost</em>: CPU time on this computer, of a tick of the whole scene, of a "
    "rate per ms of playing. <em>Memory</em>: the scene's block and the kernel's state. <em>Stiffness</em> "
    "and <em>limit</em>: of all layers that act there, and the largest stable one, as design computes it; of "
    "a rate those of the layer nearest to its limit.</p>\n"
    "<p>The interpolant of relief (a cubic B-spline with 12 samples to the shortest period of a level), the "
    "precision of the tick (single) and the filter of the velocity have no choice: the program has one of "
    "each.</p>\n";

}  // namespace

cli::Report scene_trade_report(const SceneTrade& trade) {
  cli::Report report = trade_head(trade);
  const auto rows = trade_rows(trade);
  const auto worth = worth_of(rows);
  std::vector<cli::Report> answers, choices;
  for (const PlainAnswer& answer : scene_answers(trade))
    answers.push_back(cli::Report()
                          .add("choice_of", answer.knob)
                          .add("knee", answer.knee)
                          .add("never_worth_it", answer.never));
  for (std::size_t i = 0; i < rows.size(); ++i)
    choices.push_back(report_row(trade_cells(trade.rows[i], worth[i])));
  return report.add("answers", std::move(answers)).add("choices", std::move(choices));
}

std::vector<schema::ResultFigure> scene_trade_figures(const SceneTrade& trade) {
  std::vector<schema::ResultFigure> figures;
  const cli::Report head = trade_head(trade);
  for (const auto& [key, value] : cli::ReportPrinter::entries(head))
    figures.push_back({cli::labels_of({key}).front(), cli::cell_text(key, value)});
  return figures;
}

std::vector<schema::ResultPicture> scene_trade_pictures(const SceneTrade& trade) {
  const auto worth = worth_of(trade_rows(trade));
  std::vector<schema::ResultPicture> pictures;
  for (const char* per : {"tick", "ms"}) {
    schema::ResultPicture picture{fmt::format("Error against cost per {}", per),
                                  fmt::format("CPU time (ns per {})", per),
                                  "error, RMS (dB re 1 N)",
                                  true,
                                  {}};
    std::vector<schema::ResultCurve> knees;  // of the last curve, behind it in the list: they get its colour
    const auto add_knees = [&] {
      picture.curves.insert(picture.curves.end(), knees.begin(), knees.end());
      knees.clear();
    };
    std::string knob;
    for (std::size_t i = 0; i < trade.rows.size(); ++i) {
      const SceneTradeRow& row = trade.rows[i];
      if (row.row.per != per || !row.row.is_judged()) continue;
      if (picture.curves.empty() || knob != row.row.knob) {
        add_knees();
        knob = row.row.knob;
        picture.curves.push_back({knob, {}, {}, false, false});
      }
      picture.curves.back().x.push_back(row.row.cost_ns);
      picture.curves.back().y.push_back(error_level(row));
      if (worth[i].knee)
        knees.push_back({row.row.choice + " (knee)", {row.row.cost_ns}, {error_level(row)}, false, true});
    }
    if (picture.curves.empty()) continue;
    add_knees();
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

std::string scene_trade_csv(const SceneTrade& trade) {
  const auto quoted = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('"', at)) != text.npos; at += 2) text.insert(at, 1, '"');
    return '"' + text + '"';
  };
  const auto worth = worth_of(trade_rows(trade));
  std::string csv = fmt::format("{}", fmt::join(column_keys(), ","));
  for (std::size_t i = 0; i < trade.rows.size(); ++i) {
    char separator = '\n';
    for (const auto& [key, value] : trade_cells(trade.rows[i], worth[i])) {
      csv += separator;
      separator = ',';
      if (const auto* number = std::get_if<double>(&value); number == nullptr)
        csv += quoted(std::get<std::string>(value));
      else if (std::isfinite(*number))
        csv += fmt::format("{:.9g}", *number);
    }
  }
  return csv + '\n';
}

// A table for each knob; what its rows have in common stands once, above it or below it.
std::string knob_tables(const SceneTrade& trade) {
  constexpr std::array<std::string_view, 3> kOnce = {"choice_of", "per", "note"};
  std::vector<std::string> keys = column_keys();
  std::erase_if(keys, [&](const std::string& key) { return std::ranges::find(kOnce, key) != kOnce.end(); });
  const auto worth = worth_of(trade_rows(trade));
  std::string html;
  for (std::size_t from = 0, to = 0; from < trade.rows.size(); from = to) {
    const TradeRow& first = trade.rows[from].row;
    std::vector<std::string> notes;
    std::vector<std::map<std::string, std::string>> rows;
    for (; to < trade.rows.size() && trade.rows[to].row.knob == first.knob; ++to) {
      auto& row = rows.emplace_back();
      for (const auto& [key, value] : trade_cells(trade.rows[to], worth[to])) {
        const double* const number = std::get_if<double>(&value);
        row[key] = number == nullptr        ? std::get<std::string>(value)
                   : std::isfinite(*number) ? cli::cell_text(key, *number)
                                            : "-";
      }
      const std::string& note = trade.rows[to].row.note;
      if (note == kAsItIs)
        row["choice"] += fmt::format(" ({})", note);
      else if (!note.empty() && std::ranges::find(notes, note) == notes.end())
        notes.push_back(note);
    }
    html += fmt::format("<h3>{}, cost in ns per {}</h3>\n", escaped(first.knob), first.per);
    html += html_table(cli::labels_of(keys), rows.size(),
                       [&](std::size_t row, std::size_t column) { return rows[row].at(keys[column]); });
    for (const std::string& note : notes) html += fmt::format("<p>{}</p>\n", escaped(note));
  }
  return html;
}

schema::Result<std::string> scene_trade_page(const SceneTrade& trade) {
  const auto drawn = pictures_html(scene_trade_pictures(trade), "");
  TACTO_TRY(drawn);
  std::vector<schema::ResultFigure> figures = scene_trade_figures(trade);
  std::erase_if(figures, [](const auto& figure) { return figure.name == "answer"; });
  return html_document("Speed for accuracy: " + trade.scene,
                       fmt::format("<h1>{}</h1>\n", escaped(trade.scene + " on " + trade.device)) +
                           answer(scene_answer(trade)) + figures_html(figures) + *drawn +
                           "<h2>Choices</h2>\n" + knob_tables(trade) + kSceneTradeNotes);
}

}  // namespace tacto::analysis
