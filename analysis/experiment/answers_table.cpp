// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/answers_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/table/csv_number.hpp"
#include "capture/table/source.hpp"
#include "capture/table/text_columns.hpp"
#include "data-schema/base/column_unit.hpp"
#include "data-schema/base/nearest_word.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

using Places = std::vector<std::size_t>;

// The chosen columns of a table: row by row the numbers, their line, and the texts.
struct Table {
  capture::Source source;
  Places number_columns;
  std::vector<std::vector<double>> rows;
  std::vector<std::string> lines;
  std::vector<std::vector<std::string>> texts;  // row by row

  std::string where(std::size_t row, std::size_t number) const {
    return fmt::format("{}: {}, {}", source.file, lines[row],
                       capture::column_in_words(source.columns, number_columns[number]));
  }
};

Result<capture::Source> open_answers(const std::string& file) {
  auto source = capture::open_source(file);
  TACTO_TRY(source);
  if (!source->csv) return fail(ErrorKind::unsuitable, "is no table of answers", file, "name a CSV file");
  if (!source->csv->header)
    return fail(ErrorKind::malformed, "has no names of columns in its first line", file,
                "add a line such as level,correct,trials");
  return source;
}

Result<std::size_t> column_named(const capture::Source& source, const std::string& name) {
  const auto& names = source.columns;
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  return fail(ErrorKind::usage,
              fmt::format("there is no column '{}'{}", name, schema::did_you_mean(name, names)), source.file,
              "the columns are: " + capture::columns_in_words(names));
}

Result<Places> columns_named(const capture::Source& source, const std::vector<std::string>& names) {
  Places places;
  for (const std::string& name : names) {
    const auto place = column_named(source, name);
    TACTO_TRY(place);
    places.push_back(*place);
  }
  return places;
}

Result<Table> read_table(capture::Source source, const Places& numbers, const Places& texts) {
  Table table;
  table.number_columns = numbers;
  const auto take = [&](const capture::RowBlock& block) -> Result<void> {
    for (std::size_t row = 0; row < block.rows(); ++row) {
      const auto values = block.numbers.subspan(row * block.columns, block.columns);
      table.rows.emplace_back(values.begin(), values.end());
      table.lines.push_back(block.place_of(block.first_row + row));
    }
    return {};
  };
  TACTO_TRY(capture::read_source(source, numbers, take, [](double) {}));
  const auto columns = capture::read_texts(source, texts);
  TACTO_TRY(columns);
  table.texts.resize(table.rows.size());
  for (const auto& column : *columns)
    for (std::size_t row = 0; row < table.rows.size(); ++row) table.texts[row].push_back(column[row]);
  table.source = std::move(source);
  return table;
}

Result<void> check_count(const Table& table, std::size_t row, std::size_t number) {
  const double count = table.rows[row][number];
  if (count >= 0 && count == std::floor(count)) return {};
  return fail(ErrorKind::malformed, fmt::format("{:g} is not a number of answers", count),
              table.where(row, number), "numbers of answers are whole and not below 0");
}

template <class Row>
std::vector<Row>& group_of(std::vector<AnswerGroup<Row>>& groups, std::vector<std::string> by) {
  const auto found = std::ranges::find(groups, by, &AnswerGroup<Row>::by);
  if (found != groups.end()) return found->rows;
  groups.push_back({std::move(by), {}});
  return groups.back().rows;
}

// Numbers in their order, texts in that of their letters.
bool is_before(const std::string& a, const std::string& b) {
  char mark_a = 0, mark_b = 0;
  double x = 0, y = 0;
  const bool numbers = capture::read_number(a, mark_a, x) == capture::NumberFault::none &&
                       capture::read_number(b, mark_b, y) == capture::NumberFault::none;
  return numbers && x != y ? x < y : a < b;
}

template <class Row>
Result<void> sort_groups(std::vector<AnswerGroup<Row>>& groups, const std::string& file) {
  if (groups.empty()) return fail(ErrorKind::unsuitable, "has no answers: all their numbers are 0", file);
  std::ranges::sort(groups, [](const AnswerGroup<Row>& a, const AnswerGroup<Row>& b) {
    return std::ranges::lexicographical_compare(a.by, b.by, is_before);
  });
  return {};
}

bool counts_trials(const std::string& name) {
  return name == "trials" || name == "n" || name == "total" || name == "count";
}

// The roles of columns that no option names.
Result<AnswerColumns> find_columns(const capture::Source& source, AnswerColumns columns) {
  std::vector<std::string> left;
  for (const std::string& name : source.columns)
    if (std::ranges::find(columns.by, name) == columns.by.end()) left.push_back(name);
  if (left.size() < 2 || left.size() > 3)
    return fail(
        ErrorKind::usage,
        fmt::format("{} columns are left for level and answers instead of 2 or 3", left.size()), source.file,
        fmt::format("name them with --level, --yes and --no or --trials, or group the rows with --by; "
                    "the columns are: {}",
                    capture::columns_in_words(source.columns)));
  columns.level = left[0];
  columns.yes = left[1];
  if (left.size() == 3) (counts_trials(left[2]) ? columns.trials : columns.no) = left[2];
  return columns;
}

Result<AnswerColumns> used_columns(const capture::Source& source, const AnswerColumns& columns) {
  if (columns.level.empty() && columns.yes.empty() && columns.no.empty() && columns.trials.empty())
    return find_columns(source, columns);
  if (columns.level.empty() || columns.yes.empty() || !(columns.no.empty() || columns.trials.empty()))
    return fail(ErrorKind::usage, "the roles of the columns are incomplete", source.file,
                "give --level and --yes, and at most one of --no and --trials");
  return columns;
}

schema::NameWithUnit level_in_words(const capture::Source& source, std::size_t column) {
  schema::NameWithUnit split = schema::split_unit(source.columns[column]);
  if (split.unit.empty() && column < source.units.size()) split.unit = source.units[column];
  return split;
}

Result<LevelCount> level_count(const Table& table, std::size_t row, const AnswerColumns& columns) {
  const auto& numbers = table.rows[row];
  for (std::size_t number = 1; number < numbers.size(); ++number) TACTO_TRY(check_count(table, row, number));
  LevelCount count{numbers[0], numbers[1], 1};
  if (numbers.size() > 2) count.trials = columns.no.empty() ? numbers[2] : numbers[1] + numbers[2];
  if (count.yes <= count.trials) return count;
  return fail(
      ErrorKind::malformed, fmt::format("{:g} answers of {:g} trials are too many", count.yes, count.trials),
      table.where(row, 1),
      columns.trials.empty() ? "name the number of trials with --trials, or the other answers with --no"
                             : "correct the row");
}

}  // namespace

Result<AnswersTable> read_answers(const std::string& file, const AnswerColumns& columns) {
  auto source = open_answers(file);
  TACTO_TRY(source);
  const auto by = columns_named(*source, columns.by);
  TACTO_TRY(by);
  const auto used = used_columns(*source, columns);
  TACTO_TRY(used);
  std::vector<std::string> names = {used->level, used->yes};
  if (const std::string& third = used->no.empty() ? used->trials : used->no; !third.empty())
    names.push_back(third);
  const auto numbers = columns_named(*source, names);
  TACTO_TRY(numbers);
  const auto table = read_table(std::move(*source), *numbers, *by);
  TACTO_TRY(table);
  const auto words = level_in_words(table->source, numbers->front());
  AnswersTable answers{*used, words.name, words.unit, {}, {}};
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    const auto count = level_count(*table, row, *used);
    TACTO_TRY(count);
    if (count->trials > 0) group_of(answers.groups, table->texts[row]).push_back(*count);
  }
  TACTO_TRY(sort_groups(answers.groups, file));
  return answers;
}

Result<std::vector<AnswerGroup<Preference>>> read_preferences(const std::string& file,
                                                              const std::vector<std::string>& by) {
  auto source = open_answers(file);
  TACTO_TRY(source);
  std::vector<std::string> names = {"winner", "loser"};
  names.insert(names.end(), by.begin(), by.end());
  const auto texts = columns_named(*source, names);
  TACTO_TRY(texts);
  const auto numbers = columns_named(*source, {"count"});
  TACTO_TRY(numbers);
  const auto table = read_table(std::move(*source), *numbers, *texts);
  TACTO_TRY(table);
  std::vector<AnswerGroup<Preference>> groups;
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    TACTO_TRY(check_count(*table, row, 0));
    const auto& cells = table->texts[row];
    if (const double count = table->rows[row][0]; count > 0)
      group_of(groups, {cells.begin() + 2, cells.end()}).push_back({cells[0], cells[1], count});
  }
  TACTO_TRY(sort_groups(groups, file));
  return groups;
}

}  // namespace tacto::analysis
