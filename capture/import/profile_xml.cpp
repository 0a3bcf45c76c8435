// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/profile_xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <new>
#include <pugixml.hpp>
#include <string_view>

#include "capture/table/csv_number.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

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
  Result<double> number(const char* path) const;
  Result<double> unit() const;
  Result<std::vector<double>> heights(double unit_m) const;
};

Result<double> Reader::number(const char* path) const {
  char mark = '.';
  double value = 0;
  const std::string_view written = text(path);
  if (read_number(written, mark, value) == NumberFault::none) return value;
  return broken(fmt::format("'{}' is not a number", written.substr(0, 40)), path);
}

Result<double> Reader::unit() const {
  constexpr const char* kPath = "/DATA/DATAFILE/UNITS";
  const auto known = schema::parse_unit(text(kPath));
  if (known && known->dimension == schema::Dimension::length) return known->si;
  return broken(fmt::format("'{}' is not a unit of length", text(kPath).substr(0, 40)), kPath);
}

Result<std::vector<double>> Reader::heights(double unit_m) const {
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

}  // namespace

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

}  // namespace tacto::capture
