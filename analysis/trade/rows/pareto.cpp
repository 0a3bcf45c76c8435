// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/rows/pareto.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/trade/rows/played_speeds.hpp"

namespace tacto::analysis {
namespace {

constexpr double kAlikeCost = 1.1;
constexpr double kAlikeError = 1e-6, kAlikeErrors = 1.02;
constexpr double kGoodError = 1e-2;
constexpr const char* kOneChoice = "only one choice was measured";
constexpr const char* kNotJudged = "not judged: error and cost are not measured";

double floored(double error) {
  return std::max(error, kAlikeError);
}

bool no_worse(const TradeRow& a, const TradeRow& b) {
  return floored(a.error) <= kAlikeErrors * floored(b.error) && a.cost_ns <= kAlikeCost * b.cost_ns &&
         a.memory_bytes <= b.memory_bytes && a.latency_s <= b.latency_s;
}

bool better_in_one(const TradeRow& a, const TradeRow& b) {
  return kAlikeErrors * floored(a.error) < floored(b.error) || kAlikeCost * a.cost_ns < b.cost_ns ||
         a.memory_bytes < b.memory_bytes || a.latency_s < b.latency_s;
}

// A choice with an error of 1 or more has no value at any cost.
bool beats(const TradeRow& a, const TradeRow& b) {
  if (!a.is_judged() || !b.is_judged()) return false;
  if (a.error < 1 && b.error >= 1) return true;
  return no_worse(a, b) && better_in_one(a, b);
}

// Sorted: the cost increases and the error decreases.
using Front = std::vector<std::size_t>;

Front front_of(std::span<const TradeRow> rows, const std::vector<Worth>& worth, const std::string& knob) {
  Front front;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].knob == knob && worth[i].on_front) front.push_back(i);
  std::ranges::sort(front, {}, [&](std::size_t i) { return rows[i].cost_ns; });
  return front;
}

double log_cost(const TradeRow& row) {
  return std::log(std::max(row.cost_ns, 1e-3));
}

std::optional<std::size_t> first_good(std::span<const TradeRow> rows, const Front& front) {
  for (const std::size_t i : front)
    if (rows[i].error < kGoodError) return i;
  return std::nullopt;
}

std::ptrdiff_t choices_of(std::span<const TradeRow> rows, const std::string& knob) {
  return std::ranges::count_if(rows,
                               [&](const TradeRow& row) { return row.knob == knob && row.is_judged(); });
}

// The point farthest below the line between the ends, both axes scaled to 0...1.
std::optional<std::size_t> knee_of(std::span<const TradeRow> rows, const Front& front) {
  if (front.empty() || choices_of(rows, rows[front.front()].knob) < 2) return std::nullopt;
  if (front.size() < 3) return first_good(rows, front);
  const TradeRow &first = rows[front.front()], &last = rows[front.back()];
  const double width = log_cost(last) - log_cost(first);
  const double height = std::log(floored(first.error)) - std::log(floored(last.error));
  if (!(width > 0) || !(height > 0)) return first_good(rows, front);
  std::optional<std::size_t> knee;
  double farthest = 0;
  for (const std::size_t i : front) {
    const double right = (log_cost(rows[i]) - log_cost(first)) / width;
    const double fallen = (std::log(floored(first.error)) - std::log(floored(rows[i].error))) / height;
    if (fallen - right <= farthest) continue;
    farthest = fallen - right;
    knee = i;
  }
  return knee ? knee : first_good(rows, front);
}

std::vector<std::string> knobs_of(std::span<const TradeRow> rows) {
  std::vector<std::string> knobs;
  for (const TradeRow& row : rows)
    if (std::ranges::find(knobs, row.knob) == knobs.end()) knobs.push_back(row.knob);
  return knobs;
}

std::string knee_words(const TradeRow& row) {
  std::string off = fmt::format("{} (error {:.3g} %", row.choice, 100 * row.error);
  if (!row.by_speed.empty()) off += fmt::format(" at {:g} mm/s", 1e3 * row.worst_speed_mps());
  if (row.by_speed.size() > 1) off += ", the worst of " + speed_words(row.by_speed);
  return row.cost_ns > 0 ? fmt::format("{}, {:.3g} ns per {})", off, row.cost_ns, row.per) : off + ")";
}

}  // namespace

std::vector<Worth> worth_of(std::span<const TradeRow> rows) {
  std::vector<Worth> worth(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto winner = std::ranges::find_if(
        rows, [&](const TradeRow& other) { return other.knob == rows[i].knob && beats(other, rows[i]); });
    worth[i].judged = rows[i].is_judged();
    worth[i].on_front = worth[i].judged && winner == rows.end();
    if (winner != rows.end()) worth[i].beaten_by = winner->choice;
  }
  for (const std::string& knob : knobs_of(rows))
    if (const auto knee = knee_of(rows, front_of(rows, worth, knob))) worth[*knee].knee = true;
  return worth;
}

std::string worth_words(const Worth& worth) {
  if (!worth.judged) return "not judged";
  if (worth.knee) return "the knee";
  return worth.on_front ? "yes" : "never: " + worth.beaten_by;
}

std::vector<PlainAnswer> plain_answers(std::span<const TradeRow> rows) {
  const auto worth = worth_of(rows);
  std::vector<PlainAnswer> answers;
  for (const std::string& knob : knobs_of(rows)) {
    const auto choices = choices_of(rows, knob);
    PlainAnswer answer{knob, choices > 1 ? "no best choice" : choices == 1 ? kOneChoice : kNotJudged, ""};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].knob != knob) continue;
      ++answer.choices;
      if (!worth[i].on_front && worth[i].judged) {
        answer.never += (answer.never.empty() ? "" : "; ") + rows[i].choice;
        ++answer.never_worth_it;
      }
      if (worth[i].knee) answer.knee = knee_words(rows[i]), answer.knee_row = i;
    }
    if (answer.never.empty()) answer.never = choices > 0 ? "none" : kNotJudged;
    answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace tacto::analysis
