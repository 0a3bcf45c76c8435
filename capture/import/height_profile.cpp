// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/height_profile.hpp"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <new>
#include <numeric>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "capture/table/channel_spec.hpp"
#include "capture/table/csv_number.hpp"
#include "capture/table/input_file.hpp"
#include "capture/table/source.hpp"
#include "capture/table/text_encoding.hpp"
#include "data-schema/base/column_unit.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "data-schema/version.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

// The unit of the last digit with which numbers were printed, 10^-k: the largest of which all are multiples.
class PrintedDigit {
 public:
  void add(double number);
  double value() const;

 private:
  int decimals_ = 0;
};

struct NearestGrid {
  double origin = 0, pitch = 0, deviation = 0;
};

// Instruments take the line as mean or as least squares, and the limits of the evaluation from cursors that
// are between points.
constexpr double kRoughnessTolerance = 0.01;

// The largest deviation of a position from the even grid, in pitches. Heights are assumed to be at the
// positions of the grid. A profile with a larger deviation is not even, unless its positions are those of
// nearest_grid(), rounded to their last printed digit.
constexpr double kMostUnevenness = 0.25;

// A pitch that is fitted to positions which are printed more coarsely is known to 1 % if the profile is at
// least so many printed digits long.
constexpr double kFewestPrintedDigits = 100;

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

bool is_xml(const std::string& file) {
  return file.ends_with(".xml") || file.ends_with(".XML");
}

bool names(const std::vector<std::string>& channels, std::string_view quantity) {
  return std::ranges::any_of(channels, [&](const std::string& text) {
    return text.starts_with(quantity) && text.find_first_not_of(' ', quantity.size()) == text.find('=');
  });
}

// The columns of a table that contains a profile.
struct Columns {
  ScaledColumn height;
  std::optional<ScaledColumn> position;
};

Result<Columns> columns_of(const ImportRequest& request, const Source& source) {
  const auto specs = parse_channels(request.channels, {source.columns, source.units});
  TACTO_TRY(specs);
  std::optional<ScaledColumn> height, position;
  for (const ChannelSpec& spec : *specs) {
    if (spec.quantity == "height") height = spec.source;
    if (spec.quantity == "position") position = spec.source;
    if (spec.quantity != "height" && spec.quantity != "position")
      return fail(ErrorKind::usage, fmt::format("a profile cannot contain {}", spec.quantity), "--channel",
                  "it consists of a height, and a position or --pitch");
  }
  if (!height)
    return fail(ErrorKind::usage,
                "the column of the height is not known; the columns are: " + columns_in_words(source.columns),
                source.file, "give it, for example --channel 'height=2*1um'");
  if (position.has_value() == request.pitch_m.has_value())
    return fail(ErrorKind::usage,
                position ? "both --pitch and a position were given" : "the pitch is missing", source.file,
                "give either --pitch 0.25um or --channel 'position=1*1mm'");
  return Columns{*height, position};
}

// The table's two columns in metres, and the name of a row for messages.
struct Table {
  std::vector<double> height_m, position_m;
  PrintedDigit printed;  // of the positions
  std::deque<CsvReader::Landmark> lines;

  std::string place_of(const std::string& file, std::size_t row) const {
    return lines.empty() ? fmt::format("{}: sample {}", file, row)
                         : fmt::format("{}: line {}", file, line_of_row(lines, row));
  }
};

std::vector<std::size_t> numbers_of(const Columns& columns) {
  std::vector<std::size_t> numbers = {columns.height.column};
  if (columns.position && columns.position->column != columns.height.column)
    numbers.push_back(columns.position->column);
  return numbers;
}

Result<Table> read_table(const Source& source, const Columns& columns,
                         const std::function<void(double)>& progress) {
  Table table;
  const auto numbers = numbers_of(columns);
  const auto take = [&](const RowBlock& block) -> Result<void> {
    for (std::size_t row = 0; row < block.rows(); ++row) {
      const double* const at = block.numbers.data() + row * block.columns;
      table.height_m.push_back(columns.height.physical(at[0]));
      if (!columns.position) continue;
      table.position_m.push_back(columns.position->physical(at[block.columns - 1]));
      table.printed.add(at[block.columns - 1]);
    }
    if (block.landmarks == nullptr) return {};  // of a MATLAB file
    for (const CsvReader::Landmark& line : *block.landmarks)
      if (table.lines.empty() || line.row > table.lines.back().row) table.lines.push_back(line);
    return {};
  };
  const auto read = read_source(source, numbers, take, progress);
  return read ? Result<Table>(std::move(table)) : schema::forward_error(read);
}

void turn_round(HeightProfile& profile, std::vector<double>& position_m) {
  std::ranges::reverse(profile.height_m);
  std::ranges::reverse(position_m);
  profile.direction = -1;
}

// The even grid x = origin + i pitch whose largest deviation from the positions is the smallest (minimax).
// Positions of an even grid that were rounded to a digit deviate from it by half of that digit at most, and
// no other positions do. `x` has at least two.
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

// Whether the positions are those of an even grid, rounded to `digit_m`; then the grid is fitted to them.
// Positions that are even from the first to the last need no fit.
bool is_rounded_grid(HeightProfile& profile, const std::vector<double>& x, double digit_m) {
  constexpr double kEven = 1e-6;  // of the pitch
  double off_m = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    off_m = std::max(off_m, std::abs(x[i] - x.front() - static_cast<double>(i) * profile.pitch_m));
  if (off_m <= kEven * profile.pitch_m) return false;
  const NearestGrid grid = nearest_grid(x);
  const double half_m = digit_m / 2 * (1 + 1e-6) + 1e-12 * std::max(std::abs(x.front()), std::abs(x.back()));
  const bool long_enough =
      half_m <= kMostUnevenness * grid.pitch || x.back() - x.front() >= kFewestPrintedDigits * digit_m;
  if (!(grid.pitch > 0) || grid.deviation > half_m || !long_enough) return false;
  profile.origin_m = grid.origin, profile.pitch_m = grid.pitch, profile.unevenness_m = grid.deviation;
  return true;
}

// Finds the even grid, of rounded positions or from the first position to the last, and the largest deviation
// from it.
Result<void> find_grid(HeightProfile& profile, Table& table, double digit_m, const std::string& file) {
  std::vector<double>& x = table.position_m;
  if (x.back() < x.front()) turn_round(profile, x);
  const auto last = static_cast<double>(x.size() - 1);
  profile.origin_m = x.front();
  profile.pitch_m = (x.back() - x.front()) / last;
  if (profile.pitch_m == 0)
    return fail(ErrorKind::unsuitable, "the position does not change", file,
                "a profile needs heights at increasing positions; check that this is the right column");
  if (is_rounded_grid(profile, x, digit_m)) return {};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off_m = std::abs(x[i] - (x.front() + static_cast<double>(i) * profile.pitch_m));
    profile.unevenness_m = std::max(profile.unevenness_m, off_m);
    if (off_m <= kMostUnevenness * profile.pitch_m && profile.pitch_m > 0) continue;
    const std::size_t row = profile.direction > 0 ? i : x.size() - 1 - i;
    return fail(ErrorKind::unsuitable,
                fmt::format("the position of {:.6g} mm deviates by {:.3g} um from an even grid of {:.6g} um",
                            x[i] * 1e3, off_m * 1e6, profile.pitch_m * 1e6),
                table.place_of(file, row), "resample the profile evenly in the program that made it");
  }
  return {};
}

Result<HeightProfile> profile_of(const ImportRequest& request, const Columns& columns, Table table) {
  HeightProfile profile;
  if (table.height_m.size() < 2)
    return fail(ErrorKind::unsuitable, "a profile needs at least two heights", request.file);
  profile.height_m = std::move(table.height_m);
  profile.pitch_m = request.pitch_m.value_or(0);
  if (request.pitch_m) {
    if (*request.pitch_m > 0) return profile;
    return fail(ErrorKind::usage, "a pitch must be above 0", "--pitch");
  }
  const double digit_m = table.printed.value() * std::abs(columns.position->scale);
  const auto found = find_grid(profile, table, digit_m, request.file);
  return found ? Result<HeightProfile>(std::move(profile)) : schema::forward_error(found);
}

// The lines before the header of a table, in UTF-8, without blanks around them and without empty ones.
// Errors: not_found.
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

// Values without a unit of length are not compared.
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

Result<HeightProfile> read_profile_table(const ImportRequest& request,
                                         const std::function<void(double)>& progress) {
  const auto source = open_source(request.file, request.skip_lines);
  TACTO_TRY(source);
  if (!source->csv && !source->mat)
    return fail(ErrorKind::unsuitable, "is not a table", request.file,
                "a profile must be a CSV table, a MATLAB file or XML");
  const auto columns = columns_of(request, *source);
  TACTO_TRY(columns);
  const auto preamble = preamble_of(*source);
  TACTO_TRY(preamble);
  auto table = read_table(*source, *columns, progress);
  TACTO_TRY(table);
  auto profile = profile_of(request, *columns, std::move(*table));
  TACTO_TRY(profile);
  profile->notes = fmt::format("{}", fmt::join(*preamble, "; "));
  profile->roughness = compare_roughness(*preamble, profile->height_m);
  return profile;
}

Result<void> check_no_channels(const ImportRequest& request) {
  if (request.channels.empty() && !request.pitch_m && !request.rate_hz && request.time_column.empty())
    return {};
  return fail(ErrorKind::usage, "the file already contains the channel of its heights and their spacing",
              request.file, "omit --channel, --pitch, --rate and --time-column");
}

// Options of recordings. A texture has no place for them.
Result<void> check_options(const ImportRequest& request) {
  const bool is_table = !is_xml(request.file) && !is_x3p(request.file);
  const std::pair<std::string_view, bool> given[] = {{"--date", !request.recorded.empty()},
                                                     {"--calibrated", !request.calibrated.empty()},
                                                     {"--humidity", request.humidity_percent.has_value()},
                                                     {"--speed", request.speed_mps.has_value()},
                                                     {"--no-position", !request.integrate_speed},
                                                     {"--mask-outliers", request.mask_outliers},
                                                     {"--stream", !request.stream.empty()},
                                                     {"--skip", request.skip_lines > 0 && !is_table}};
  for (const auto& [option, is_given] : given)
    if (is_given)
      return fail(ErrorKind::usage, "is not stored with a height profile", std::string(option),
                  "omit it; --notes can state it in words");
  return {};
}

Result<void> check_pitch(double pitch_m, const std::string& file) {
  constexpr double kLargestRate = std::numeric_limits<int>::max();  // of a WAV file, per metre
  const double rate = schema::header_rate_of(pitch_m);
  if (rate >= 1 && rate <= kLargestRate) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("has a pitch of {:.4g} m: a texture's is {:.2g} m to 2 m", pitch_m, 1 / kLargestRate), file,
      "check the unit of the position, or of --pitch");
}

Result<schema::Texture> texture_of(const HeightProfile& profile, const ImportRequest& request) {
  const auto sum = schema::sha256_of_file(request.file);
  TACTO_TRY(sum);
  schema::Texture texture;
  texture.signal.pitch_m = profile.pitch_m;
  texture.signal.values = profile.height_m;
  texture.quantity = "height";
  texture.unit = "m";
  texture.direction = profile.direction;
  texture.source_origin_m = profile.origin_m;
  const double last_m = static_cast<double>(profile.height_m.size() - 1) * profile.pitch_m;
  texture.valid_band = {{0, 0, 0.5 / profile.pitch_m}, {last_m, 0, 0.5 / profile.pitch_m}};
  texture.surface = request.surface.empty() ? profile.surface : request.surface;
  texture.subject = request.subject;
  texture.finger = request.finger;
  const std::string file = std::filesystem::path(request.file).filename().string();
  texture.notes = fmt::format("measured profile, imported from {} (SHA-256 {})", file, *sum);
  for (const std::string& text : {profile.notes, request.notes})
    if (!text.empty()) texture.notes += "; " + text;
  texture.notes += subtract_mean(texture.signal.values);
  texture.created = schema::creation_time();
  texture.creator = kCreator;
  return texture;
}

Result<void> check_free(const std::string& stem, bool replace) {
  std::error_code ignored;
  for (const char* ending : {".texture.json", ".texture.wav"})
    if (!replace && std::filesystem::exists(stem + ending, ignored))
      return fail(ErrorKind::usage, "exists already", stem + ending,
                  "choose another name, or replace it with --force");
  return {};
}

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view stripped(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// The document during reading; `file` is for messages.
struct Reader {
  const std::string& file;
  pugi::xml_document document;

  tl::unexpected<schema::Error> broken(std::string what, std::string_view element) const {
    return fail(ErrorKind::malformed, std::move(what), fmt::format("{}: {}", file, element));
  }
  std::string_view text(const char* path) const {
    return stripped(document.select_node(path).node().child_value());
  }
  Result<double> number(const char* path) const {
    char mark = '.';
    double value = 0;
    const std::string_view written = text(path);
    if (read_number(written, mark, value) == NumberFault::none) return value;
    return broken(fmt::format("'{}' is not a number", written.substr(0, 40)), path);
  }

  Result<double> unit() const {
    constexpr const char* kPath = "/DATA/DATAFILE/UNITS";
    const auto known = schema::parse_unit(text(kPath));
    if (known && known->dimension == schema::Dimension::length) return known->si;
    return broken(fmt::format("'{}' is not a unit of length", text(kPath).substr(0, 40)), kPath);
  }

  Result<std::vector<double>> heights(double unit_m) const {
    constexpr const char* kPath = "/DATA/DATAFILE/DATA_POINT_VALUES";
    std::string_view left = text(kPath);
    std::vector<double> heights;
    while (!left.empty()) {
      const std::string_view word = left.substr(0, left.find_first_of(kBlanks));
      char mark = '.';
      double value = 0;
      if (read_number(word, mark, value) != NumberFault::none)
        return broken(fmt::format("value {}, '{}', is not a number", heights.size() + 1, word.substr(0, 40)),
                      kPath);
      heights.push_back(value * unit_m);
      left = stripped(left.substr(word.size()));
    }
    return heights;
  }
};

std::string joined(std::initializer_list<std::string_view> texts) {
  std::string all;
  for (const std::string_view text : texts)
    if (!text.empty() && text != "N/A") all += (all.empty() ? "" : "; ") + std::string(text);
  return all;
}

Result<HeightProfile> profile_in(const Reader& reader) {
  if (const auto type = reader.text("/DATA/DATAFILE/DATA_TYPE"); !type.empty() && type != "2D")
    return fail(ErrorKind::unsuitable, fmt::format("contains {} data, not a profile", type), reader.file,
                "extract a profile, and import that");
  const auto unit_m = reader.unit();
  TACTO_TRY(unit_m);
  const auto spacing = reader.number("/DATA/DATAFILE/SPACING");
  TACTO_TRY(spacing);
  if (!(*spacing > 0)) return reader.broken("a spacing must be above 0", "/DATA/DATAFILE/SPACING");
  auto heights = reader.heights(*unit_m);
  TACTO_TRY(heights);
  const auto points = reader.number("/DATA/DATAFILE/NUMPOINTS");
  TACTO_TRY(points);
  if (*points != static_cast<double>(heights->size()))
    return reader.broken(fmt::format("{} values, but NUMPOINTS is {}", heights->size(), *points),
                         "/DATA/DATAFILE/NUMPOINTS");
  HeightProfile profile;
  profile.pitch_m = *spacing * *unit_m;
  profile.height_m = std::move(*heights);
  profile.surface = reader.text("/DATA/PART/PART_NAME");
  profile.notes =
      joined({reader.text("/DATA/PART/PART_DESCRIPTION"), reader.text("/DATA/PART/PART_MANUFACTURER"),
              reader.text("/DATA/MEASUREMENT/MEASUREMENT_INSTRUMENT_TYPE")});
  return profile;
}

// DATA/DATAFILE: UNITS (a length, of heights and of the spacing), NUMPOINTS, SPACING, DATA_POINT_VALUES;
// DATA/PART: name, manufacturer and description, kept as surface and notes. Errors: not_found; malformed,
// with the byte or the element; unsuitable, for profiles that are not 2D.
Result<HeightProfile> read_profile_xml(const std::string& file) try {
  const auto bytes = schema::read_file(file);
  TACTO_TRY(bytes);
  Reader reader{file, {}};
  const auto parsed = reader.document.load_buffer(bytes->data(), bytes->size());
  if (!parsed)
    return fail(ErrorKind::malformed,
                fmt::format("is not XML: {} at byte {}", parsed.description(), parsed.offset), file);
  if (!reader.document.child("DATA").child("DATAFILE"))
    return fail(ErrorKind::malformed, "contains no profile: there is no DATA/DATAFILE", file);
  return profile_in(reader);
} catch (const std::bad_alloc&) {
  return fail(ErrorKind::malformed, "is too large to be read", file);
}

// Consecutive points of a line, counted from 0.
struct Section {
  std::size_t first = 0, count = 0;
};

Result<Section> section_of(const ImportRequest& request, const schema::X3pHeights& line) {
  if (request.points.empty()) return Section{0, line.height_m.size()};
  const std::string_view text = request.points;
  const auto dots = text.find("..");
  std::size_t from = 0, to = 0;
  const auto number = [](std::string_view part, std::size_t& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  const bool read = dots != std::string_view::npos && number(text.substr(0, dots), from) &&
                    number(text.substr(dots + 2), to);
  if (read && 1 <= from && from < to && to <= line.height_m.size()) return Section{from - 1, to - from + 1};
  return fail(ErrorKind::usage, fmt::format("'{}' is no section of {} points", text, line.height_m.size()),
              "--points", fmt::format("write FIRST..LAST, for example 1..{}", line.height_m.size()));
}

Result<void> refuse_holes(const ImportRequest& request, const schema::X3pHeights& line,
                          const Section& section) {
  std::size_t holes = 0;
  Section whole, longest;
  for (std::size_t i = section.first; i < section.first + section.count; ++i) {
    const bool hole = std::isnan(line.height_m[i]);
    holes += hole ? 1 : 0;
    whole = hole ? Section{i + 1, 0} : Section{whole.count == 0 ? i : whole.first, whole.count + 1};
    if (whole.count > longest.count) longest = whole;
  }
  if (holes == 0) return {};
  const std::string what =
      fmt::format("{} of {} points have no height in {}", holes, section.count, line.name);
  if (longest.count < 2) return fail(ErrorKind::unsuitable, what, request.file, "choose another line");
  return fail(ErrorKind::unsuitable, what, request.file,
              fmt::format("heights are not filled in: the longest whole section is --points {}..{}",
                          longest.first + 1, longest.first + longest.count));
}

// Their number, and the rows and columns between which they are.
Result<void> refuse_holes_of_surface(const ImportRequest& request, const schema::X3pHeights& surface) {
  const std::size_t columns = surface.height_m.size() / surface.rows;
  std::size_t holes = 0, first_row = surface.rows, last_row = 0, first_column = columns, last_column = 0;
  for (std::size_t i = 0; i < surface.height_m.size(); ++i) {
    if (!std::isnan(surface.height_m[i])) continue;
    ++holes;
    first_row = std::min(first_row, i / columns), last_row = std::max(last_row, i / columns);
    first_column = std::min(first_column, i % columns), last_column = std::max(last_column, i % columns);
  }
  if (holes == 0) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("{} of {} points have no height, in rows {} to {}, columns {} to {}", holes,
                  surface.height_m.size(), first_row + 1, last_row + 1, first_column + 1, last_column + 1),
      request.file,
      "heights are not filled in here: fill them in the program that made it, or export a part "
      "without holes");
}

Result<HeightProfile> read_profile_x3p(const ImportRequest& request) {
  TACTO_TRY(check_no_channels(request));
  const auto line = schema::read_x3p(request.file, {request.row, request.column, std::nullopt});
  TACTO_TRY(line);
  const auto section = section_of(request, *line);
  TACTO_TRY(section);
  TACTO_TRY(refuse_holes(request, *line, *section));
  if (section->count < 2)
    return fail(ErrorKind::unsuitable, "a profile needs at least two heights", request.file);
  HeightProfile profile;
  profile.pitch_m = line->pitch_m;
  profile.origin_m = line->origin_m + static_cast<double>(section->first) * line->pitch_m;
  const auto begin = line->height_m.begin() + static_cast<std::ptrdiff_t>(section->first);
  profile.height_m.assign(begin, begin + static_cast<std::ptrdiff_t>(section->count));
  profile.notes = fmt::format("{}; {}", line->notes, line->name);
  if (!request.points.empty()) profile.notes += ", points " + request.points;
  return profile;
}

}  // namespace

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
bool is_x3p(const std::string& file) {
  return file.ends_with(".x3p") || file.ends_with(".X3P");
}

std::string subtract_mean(std::vector<double>& heights_m) {
  constexpr double kCoarse = 0.01;
  const auto count = static_cast<double>(heights_m.size());
  const double mean_m = std::accumulate(heights_m.begin(), heights_m.end(), 0.0) / count;
  double squares = 0, largest_m = 0;
  for (const double height_m : heights_m) {
    squares += (height_m - mean_m) * (height_m - mean_m);
    largest_m = std::max(largest_m, std::abs(height_m));
  }
  const double step_m = largest_m * std::numeric_limits<float>::epsilon();
  if (squares == 0 || step_m <= kCoarse * std::sqrt(squares / count)) return {};
  for (double& height_m : heights_m) height_m -= mean_m;
  return fmt::format("; mean height of {} m subtracted", mean_m);
}

Result<schema::X3pHeights> read_x3p_surface(const ImportRequest& request, std::uint64_t most_points) {
  TACTO_TRY(check_no_channels(request));
  auto surface = schema::read_x3p(request.file, {std::nullopt, std::nullopt, most_points});
  TACTO_TRY(surface);
  TACTO_TRY(refuse_holes_of_surface(request, *surface));
  return surface;
}

bool is_profile_request(const ImportRequest& request) {
  if (is_xml(request.file) || is_x3p(request.file) || request.pitch_m) return true;
  return names(request.channels, "height") && names(request.channels, "position") && !request.rate_hz &&
         request.time_column.empty();
}

Result<HeightProfile> read_height_profile(const ImportRequest& request,
                                          const std::function<void(double)>& progress) {
  if (is_x3p(request.file)) return read_profile_x3p(request);
  if (!is_xml(request.file)) return read_profile_table(request, progress);
  TACTO_TRY(check_no_channels(request));
  return read_profile_xml(request.file);
}

Result<ImportedProfile> import_profile(const ImportRequest& request,
                                       const std::function<void(double)>& progress) {
  const std::string stem = schema::stem_of(request.name, ".texture");
  TACTO_TRY(check_options(request));
  TACTO_TRY(check_free(stem, request.replace));
  auto profile = read_height_profile(request, progress);
  TACTO_TRY(profile);
  TACTO_TRY(check_pitch(profile->pitch_m, request.file));
  const auto texture = texture_of(*profile, request);
  TACTO_TRY(texture);
  TACTO_TRY(schema::write_texture(stem, *texture));
  return ImportedProfile{std::move(*profile), stem};
}

}  // namespace tacto::capture
