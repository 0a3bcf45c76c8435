// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/trade_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ranges>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "analysis/trade/rows/pareto.hpp"
#include "analysis/trade/rows/played_speeds.hpp"
#include "data-schema/base/decibels.hpp"

namespace tacto::analysis {
namespace {

double error_db(const TradeRow& row) {
  constexpr double kSmallest = 1e-8;
  return schema::amplitude_db(std::max(row.error, kSmallest));
}

bool drawn(const TradeRow& row) {
  return row.cost_ns > 0 && row.error > 0 && row.error < 1;
}

// Limits the number of knobs in a picture to those with most choices.
std::vector<std::vector<std::size_t>> those_with_most_choices(std::vector<std::vector<std::size_t>> knobs) {
  constexpr std::size_t kMostKnobs = 6;
  std::ranges::stable_sort(knobs, std::greater<>(), [](const auto& rows) { return rows.size(); });
  if (knobs.size() > kMostKnobs) knobs.resize(kMostKnobs);
  return knobs;
}

// Rows grouped by knob and unit of cost.
std::vector<std::vector<std::size_t>> by_knob(const TradeHalf& half) {
  std::vector<std::vector<std::size_t>> knobs;
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  for (std::size_t i = 0; i < half.rows.size(); ++i) {
    if (!drawn(half.rows[i])) continue;
    const auto [at, fresh] = place.try_emplace({half.rows[i].knob, half.rows[i].per}, knobs.size());
    if (fresh) knobs.emplace_back();
    knobs[at->second].push_back(i);
  }
  return knobs;
}

// Knobs with the same unit of cost, which can share an axis.
struct UnitKnobs {
  std::string per;
  std::vector<std::vector<std::size_t>> knobs;
  std::size_t rows = 0;
};

// The unit with most choices comes first.
std::vector<UnitKnobs> by_unit(const TradeHalf& half) {
  std::vector<UnitKnobs> units;
  for (auto& rows : by_knob(half)) {
    const std::string& per = half.rows[rows.front()].per;
    auto unit = std::ranges::find(units, per, &UnitKnobs::per);
    if (unit == units.end()) unit = units.insert(units.end(), UnitKnobs{per, {}, 0});
    unit->rows += rows.size();
    unit->knobs.push_back(std::move(rows));
  }
  for (UnitKnobs& unit : units) unit.knobs = those_with_most_choices(std::move(unit.knobs));
  std::ranges::stable_sort(units, std::greater<>(), &UnitKnobs::rows);
  return units;
}

std::string cost_axis(const std::string& per) {
  return fmt::format("CPU time (ns per {})", per);
}

std::string title_of(const TradeHalf& half, const std::string& per) {
  return fmt::format("Error against cost per {}, {}", per, half.name);
}

// Rows without a cheaper row of smaller error. A row that is on the front only for its memory would bend the
// curve.
std::vector<std::size_t> front_by_cost(const TradeHalf& half, std::vector<std::size_t> rows) {
  std::ranges::sort(rows, {}, [&](std::size_t i) { return half.rows[i].cost_ns; });
  double least = INFINITY;
  std::erase_if(rows, [&](std::size_t i) {
    const bool falls = half.rows[i].error < least;
    least = std::min(least, half.rows[i].error);
    return !falls;
  });
  return rows;
}

// "5 um" as "5 µm", as in the page's tables.
std::string with_micro(std::string text) {
  for (std::size_t at = 0; (at = text.find(" um", at)) != text.npos;) text.replace(at, 3, " \u00B5m");
  return text;
}

// The front comes first, because a name is left out where the names before it leave no space.
spatial::Series marks_of(const TradeHalf& half, const std::vector<Worth>& worth,
                         std::vector<std::size_t> rows, spatial::Colour colour) {
  std::ranges::stable_partition(rows, [&](std::size_t i) { return worth[i].knee || worth[i].on_front; });
  spatial::Series series{half.rows[rows.front()].knob, {}, {}, colour, 1.5, false, true, {}};
  for (const std::size_t i : rows) {
    series.x.push_back(half.rows[i].cost_ns);
    series.y.push_back(error_db(half.rows[i]));
    const std::string choice = with_micro(half.rows[i].choice);
    series.labels.push_back(worth[i].knee ? choice + "  (knee)" : choice);
  }
  return series;
}

std::string number(double value) {
  if (std::isnan(value)) return "";
  return fmt::format("{:.6g}", value);
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string error_words(const TradeRow& row) {
  if (!row.is_judged()) return "not measured";
  return fmt::format("{:.3g} % ({:.1f} dB)", 100 * row.error, error_db(row));
}

std::string cost_words(const TradeRow& row) {
  return row.cost_ns > 0 ? fmt::format("{:.3g} ns per {}", row.cost_ns, row.per) : "";
}

std::string words_by_speed(const TradeRow& row) {
  std::string words;
  for (const ErrorAtSpeed& each : row.by_speed)
    words += (words.empty() ? "" : ", ") +
             (std::isnan(each.error) ? "-" : fmt::format("{:.3g}", 100 * each.error));
  return words.empty() ? "" : words + " % at " + speed_words(row.by_speed);
}

bool is_worst_of_several(const TradeHalf& half) {
  return std::ranges::any_of(half.rows, [](const TradeRow& row) { return row.by_speed.size() > 1; });
}

std::string error_axis(const TradeHalf& half) {
  return is_worst_of_several(half) ? "error at the worst speed (dB re the RMS)" : "error (dB re the RMS)";
}

// Empty if no finger of this speed was measured.
double error_at(const TradeRow& row, double speed_mps) {
  const auto at = std::ranges::find(row.by_speed, speed_mps, &ErrorAtSpeed::speed_mps);
  return at == row.by_speed.end() ? kNotMeasured : at->error;
}

std::vector<std::vector<std::string>> table_of(const TradeHalf& half) {
  const auto worth = worth_of(half.rows);
  std::vector<std::vector<std::string>> rows = {
      {"choice of", "choice", "error", "by speed", "cost", "memory", "latency", "worth it", "note"}};
  for (std::size_t i = 0; i < half.rows.size(); ++i) {
    const TradeRow& row = half.rows[i];
    rows.push_back({row.knob, row.choice, error_words(row), words_by_speed(row), cost_words(row),
                    row.memory_bytes > 0 ? fmt::format("{:.4g} KiB", row.memory_bytes / 1024) : "",
                    row.latency_s > 0 ? fmt::format("{:.3g} ms", 1e3 * row.latency_s) : "",
                    worth_words(worth[i]), row.note});
  }
  return rows;
}

spatial::LineFigure figure_about(const TradeHalf& half, const Trade& trade, std::string title,
                                 const std::string& per) {
  spatial::LineFigure figure;
  figure.title = std::move(title);
  figure.subtitle = trade.texture;
  figure.x_label = cost_axis(per);
  figure.y_label = error_axis(half);
  figure.x_scale = spatial::AxisScale::logarithmic;
  return figure;
}

// Adds the marks of a knob and its front.
void add_knob(spatial::LineFigure& figure, const TradeHalf& half, const std::vector<Worth>& worth,
              const std::vector<std::size_t>& rows, spatial::Colour colour, const std::string& name) {
  spatial::Series line{"", {}, {}, colour, 1, true, false, {}};
  for (const std::size_t i : front_by_cost(half, rows)) {
    line.x.push_back(half.rows[i].cost_ns);
    line.y.push_back(error_db(half.rows[i]));
  }
  figure.series.push_back(std::move(line));
  figure.series.push_back(marks_of(half, worth, rows, colour));
  figure.series.back().name = name;
}

std::string under_fold(const std::string& summary, const std::string& html) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(summary), html);
}

std::string never_words(const PlainAnswer& answer) {
  return answer.choices < 2 ? answer.never : fmt::format("{} of {}", answer.never_worth_it, answer.choices);
}

std::string answers_table(const TradeHalf& half) {
  std::vector<std::vector<std::string>> rows = {
      {"choice of", "best for its cost", "its error", "its cost", "never worth it"}};
  for (const PlainAnswer& answer : plain_answers(half.rows)) {
    const TradeRow* const best = answer.knee_row ? &half.rows[*answer.knee_row] : nullptr;
    if (best)
      rows.push_back({answer.knob, best->choice, fmt::format("{:.3g} %", 100 * best->error),
                      cost_words(*best), never_words(answer)});
    else  // "not judged", "no best choice": the table of all rows has the reason
      rows.push_back(
          {answer.knob, answer.knee.substr(0, answer.knee.find(':')), "", "", never_words(answer)});
  }
  return html_table(rows);
}

// Two columns if the screen is wide enough.
schema::Result<std::string> knob_pictures(const TradeHalf& half, const Trade& trade) {
  std::string html =
      "<div class=\"small\" "
      "style=\"display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,24rem),1fr));"
      "gap:.5rem 1.5rem\">\n";
  for (const spatial::LineFigure& figure : knob_figures(half, trade)) {
    const auto svg = spatial::to_page_svg(figure);
    TACTO_TRY(svg);
    html += inline_svg(*svg, fmt::format("{}, {}: error against cost", half.name, figure.title));
  }
  return html + "</div>\n";
}

std::string speeds_paragraph() {
  return fmt::format(
      "<p>Each error is the worst of fingers at {:g} mm/s, unless a note names another.</p>\n",
      fmt::join(kTradeSpeeds_mps | std::views::transform([](double v) { return 1e3 * v; }), ", "));
}

}  // namespace

spatial::LineFigure pareto_figure(const TradeHalf& half, const Trade& trade) {
  const auto units = by_unit(half);
  if (units.empty()) return figure_about(half, trade, "Error against cost, " + half.name, "tick");
  spatial::LineFigure figure =
      figure_about(half, trade, title_of(half, units.front().per), units.front().per);
  figure.simulated = trade.simulated;
  figure.size = {1000, 480};
  const auto worth = worth_of(half.rows);
  std::size_t colour = 0;
  for (const auto& rows : units.front().knobs)
    add_knob(figure, half, worth, rows, spatial::series_colour(colour++), half.rows[rows.front()].knob);
  return figure;
}

std::vector<spatial::LineFigure> knob_figures(const TradeHalf& half, const Trade& trade) {
  const auto worth = worth_of(half.rows);
  std::vector<spatial::LineFigure> figures;
  for (const auto& rows : by_knob(half)) {
    if (rows.size() < 2) continue;
    const TradeRow& first = half.rows[rows.front()];
    spatial::LineFigure figure = figure_about(half, trade, first.knob, first.per);
    if (!trade.simulated.empty()) figure.simulated = kSimulatedOnPage;
    figure.size = {360, 280};
    add_knob(figure, half, worth, rows, spatial::series_colour(0), "");
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<schema::ResultPicture> trade_pictures(const Trade& trade) {
  std::vector<schema::ResultPicture> pictures;
  for (const TradeHalf& half : trade.halves)
    for (const UnitKnobs& unit : by_unit(half)) {
      schema::ResultPicture picture{
          title_of(half, unit.per), cost_axis(unit.per), error_axis(half), true, {}};
      for (const auto& rows : unit.knobs) {
        schema::ResultCurve curve{half.rows[rows.front()].knob, {}, {}, false};
        for (const std::size_t i : front_by_cost(half, rows)) {
          curve.x.push_back(half.rows[i].cost_ns);
          curve.y.push_back(error_db(half.rows[i]));
        }
        picture.curves.push_back(std::move(curve));
      }
      pictures.push_back(std::move(picture));
    }
  return pictures;
}

std::vector<schema::ResultFigure> trade_figures(const Trade& trade) {
  std::vector<schema::ResultFigure> figures = {{"machine", trade.machine}};
  for (const TradeHalf& half : trade.halves)
    for (const PlainAnswer& answer : plain_answers(half.rows))
      figures.push_back({half.name + ", " + answer.knob,
                         fmt::format("the knee: {}; never worth it: {}", answer.knee, answer.never)});
  return figures;
}

std::string trade_csv(const Trade& trade) {
  std::string csv =
      std::string(kTradeCsvHead) +
      "cost_ns,per,memory_bytes,latency_s,on_front,knee,beaten_by,note,simulated,worst_speed_mps";
  for (const double speed_mps : kTradeSpeeds_mps) csv += fmt::format(",error_at_{:g}mmps", 1e3 * speed_mps);
  csv += "\n";
  for (const TradeHalf& half : trade.halves) {
    const auto worth = worth_of(half.rows);
    for (std::size_t i = 0; i < half.rows.size(); ++i) {
      const TradeRow& row = half.rows[i];
      csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}", half.name, quoted(row.knob),
                         quoted(row.choice), number(row.error), number(row.cost_ns), row.per,
                         number(row.memory_bytes), number(row.latency_s), worth[i].on_front, worth[i].knee,
                         quoted(worth[i].beaten_by), quoted(row.note), quoted(trade.simulated),
                         number(row.worst_speed_mps()));
      for (const double speed_mps : kTradeSpeeds_mps) csv += "," + number(error_at(row, speed_mps));
      csv += "\n";
    }
  }
  return csv;
}

schema::Result<std::string> trade_page(const Trade& trade) {
  std::string body = fmt::format(
      "<h1>Speed for accuracy</h1>\n<p>Measured on {}, with {}. First the best of each choice. Then the "
      "errors and costs as pictures; all rows are below them.</p>\n",
      escaped(trade.machine), escaped(trade.texture));
  if (!trade.simulated.empty())
    body +=
        fmt::format("<p class=\"simulated\"><strong>Simulated</strong> {}.</p>\n", escaped(trade.simulated));
  for (const TradeHalf& half : trade.halves) {
    body += fmt::format("<h2>The best of each choice, {}</h2>\n", escaped(half.name));
    if (is_worst_of_several(half)) body += speeds_paragraph();
    body += answers_table(half);
  }
  for (const TradeHalf& half : trade.halves) {
    const auto pictures = knob_pictures(half, trade);
    TACTO_TRY(pictures);
    body += fmt::format("<h2>Error against cost, {}</h2>\n", escaped(half.name));
    body += *pictures;
    body += under_fold(fmt::format("All {} choices measured, {}", half.rows.size(), half.name),
                       html_table(table_of(half)));
  }
  return html_document("Speed for accuracy: " + trade.texture, body);
}

}  // namespace tacto::analysis
