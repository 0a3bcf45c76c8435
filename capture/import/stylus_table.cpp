// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/stylus_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "capture/table/csv_number.hpp"
#include "capture/table/input_file.hpp"
#include "capture/table/text_encoding.hpp"
#include "data-schema/base/column_unit.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::Result;

// The words of a line. A comma divides them, unless the line is divided otherwise: then it is a decimal mark.
std::vector<std::string_view> words_of(std::string_view line) {
  std::string_view dividers = ",;\t:= \"";
  if (line.find_first_of(";\t") != std::string_view::npos || line.find(": ") != std::string_view::npos ||
      line.find('=') != std::string_view::npos)
    dividers.remove_prefix(1);
  std::vector<std::string_view> words;
  while (!line.empty()) {
    const std::string_view word = line.substr(0, line.find_first_of(dividers));
    if (!word.empty()) words.push_back(word);
    line.remove_prefix(std::min(line.size(), word.size() + 1));
  }
  return words;
}

// Half of the last digit of a printed number: 0.05 of "12.3", 5 of "1.2e2".
double half_digit(std::string_view number) {
  const auto exponent = number.find_first_of("eE");
  const std::string_view digits = number.substr(0, exponent);
  const auto mark = digits.find_first_of(".,");
  int power = mark == std::string_view::npos ? 0 : -static_cast<int>(digits.size() - mark - 1);
  if (exponent != std::string_view::npos) {
    double value = 0;
    char decimal = 0;
    if (read_number(number.substr(exponent + 1), decimal, value) == NumberFault::none)
      power += static_cast<int>(std::clamp(value, -400.0, 400.0));
  }
  return 0.5 * std::pow(10.0, power);
}

struct Stated {
  std::string name;
  double value_m = 0, half_digit_m = 0;
};

std::optional<Stated> stated_in(std::string_view line) {
  const auto words = words_of(line);
  if (words.empty() || (words[0] != "Ra" && words[0] != "Rq")) return std::nullopt;
  std::optional<double> number, unit_m;
  double half = 0;
  for (const std::string_view word : std::span(words).subspan(1)) {
    double value = 0;
    char mark = 0;
    if (!number && read_number(word, mark, value) == NumberFault::none) {
      number = value;
      half = half_digit(word);
    }
    const auto unit = schema::known_unit(word, Dimension::length);
    if (!unit_m && unit && unit->dimension == Dimension::length) unit_m = unit->si;
  }
  if (!number || !unit_m) return std::nullopt;
  return Stated{std::string(words[0]), *number * *unit_m, half * *unit_m};
}

struct Roughness {
  double ra_m = 0, rq_m = 0;
};

Roughness roughness_of(std::span<const double> height_m) {
  const auto n = static_cast<double>(height_m.size());
  double sum = 0, moment = 0, spread = 0;
  for (const double height : height_m) sum += height;
  for (std::size_t i = 0; i < height_m.size(); ++i) {
    const double x = static_cast<double>(i) - (n - 1) / 2;
    moment += x * (height_m[i] - sum / n);
    spread += x * x;
  }
  Roughness roughness;
  for (std::size_t i = 0; i < height_m.size(); ++i) {
    const double x = static_cast<double>(i) - (n - 1) / 2;
    const double off_m = height_m[i] - sum / n - moment / spread * x;
    roughness.ra_m += std::abs(off_m) / n;
    roughness.rq_m += off_m * off_m / n;
  }
  roughness.rq_m = std::sqrt(roughness.rq_m);
  return roughness;
}

}  // namespace

Result<std::vector<std::string>> preamble_of(const Source& source) {
  std::vector<std::string> lines;
  if (!source.csv || source.csv->lines_before == 0) return lines;
  auto input = InputFile::open(source.file);
  TACTO_TRY(input);
  std::string head(source.csv->data_offset, '\0');
  const auto got = input->read(head);
  TACTO_TRY(got);
  head.resize(*got);
  std::string text = to_utf8(head);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  const std::size_t table_line = source.csv->header ? source.csv->header_line : source.csv->data_line;
  for (std::size_t number = 1; number < table_line && !text.empty(); ++number) {
    const std::size_t size = std::min(text.find(source.csv->line_end), text.size());
    std::string line(schema::without_blanks(std::string_view(text).substr(0, size)));
    std::erase_if(line, [](unsigned char c) { return c < 0x20 && c != '\t'; });
    if (!line.empty()) lines.push_back(std::move(line));
    text.erase(0, size + 1);
  }
  return lines;
}

void PrintedDigit::add(double number) {
  constexpr int kMost = 15;  // digits of a double
  for (; decimals_ < kMost; ++decimals_) {
    const double scaled = number * std::pow(10.0, decimals_);
    if (std::abs(scaled - std::round(scaled)) <=
        4 * std::numeric_limits<double>::epsilon() * std::abs(scaled))
      return;
  }
}

double PrintedDigit::value() const {
  return std::pow(10.0, -decimals_);
}

// The width of the strip of a slope that holds all positions is convex in the slope, and its derivative is
// the index of the lowest position in the strip minus that of the highest: bisection finds the smallest
// width.
NearestGrid nearest_grid(std::span<const double> x) {
  double low = x[1] - x[0], high = low;
  for (std::size_t i = 1; i < x.size(); ++i) {
    low = std::min(low, x[i] - x[i - 1]);
    high = std::max(high, x[i] - x[i - 1]);
  }
  NearestGrid grid;
  for (;;) {
    grid.pitch = low + (high - low) / 2;
    std::size_t lowest = 0, highest = 0;
    double least = x[0], most = x[0];
    for (std::size_t i = 1; i < x.size(); ++i) {
      const double above = x[i] - static_cast<double>(i) * grid.pitch;
      if (above < least) least = above, lowest = i;
      if (above > most) most = above, highest = i;
    }
    grid.origin = (least + most) / 2;
    grid.deviation = (most - least) / 2;
    if (!(low < grid.pitch && grid.pitch < high) || lowest == highest) return grid;
    (highest > lowest ? low : high) = grid.pitch;
  }
}

std::vector<StatedRoughness> compare_roughness(std::span<const std::string> preamble,
                                               std::span<const double> height_m) {
  std::vector<StatedRoughness> all;
  for (const std::string& line : preamble) {
    const auto stated = stated_in(line);
    if (!stated || height_m.size() < 2) continue;
    const Roughness computed = roughness_of(height_m);
    const double computed_m = stated->name == "Ra" ? computed.ra_m : computed.rq_m;
    const double most_m = stated->half_digit_m + kRoughnessTolerance * stated->value_m;
    all.push_back(
        {stated->name, stated->value_m, computed_m, std::abs(computed_m - stated->value_m) <= most_m});
  }
  return all;
}

}  // namespace tacto::capture
