// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/x3p_file.hpp"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include "data-schema/base/column_unit.hpp"
#include "data-schema/base/module.hpp"
#include "data-schema/base/sha256.hpp"
#include "data-schema/exchange/zip/zip_functions.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers of X3P are little-endian");

constexpr std::uint64_t kLargestMainXml = std::uint64_t{64} << 20;
constexpr std::uint64_t kLargestChecksumFile = 4096;
constexpr std::string_view kMainXml = "main.xml";

template <class Number>
double stored_height(const char* raw) {
  Number number;
  std::memcpy(&number, raw, sizeof number);
  return static_cast<double>(number);
}

struct HeightType {
  std::string_view letter;
  std::uint64_t bytes;
  double (*number)(const char* raw);
};

constexpr HeightType kHeightTypes[] = {{"I", 2, stored_height<std::int16_t>},
                                       {"L", 4, stored_height<std::int32_t>},
                                       {"F", 4, stored_height<float>},
                                       {"D", 8, stored_height<double>}};

// The files of an archive.
class Archive {
 public:
  static Result<Archive> open(const std::string& path);

  const std::string& path() const { return path_; }
  // The names of all files.
  Result<std::vector<std::string>> names() const;
  // The bytes of a file. Errors: malformed, if there is none, it has another size, or it is damaged.
  Result<std::string> read(const std::string& name, std::uint64_t most_bytes,
                           std::optional<std::uint64_t> bytes = std::nullopt) const;

 private:
  struct CloseZip {
    const ZipFunctions* functions;
    void operator()(zip_t* zip) const { functions->close(zip); }
  };
  struct CloseEntry {
    const ZipFunctions* functions;
    void operator()(zip_file_t* entry) const { functions->close_entry(entry); }
  };
  Archive(std::string path, const ZipFunctions* functions, zip_t* zip)
      : path_(std::move(path)), functions_(functions), zip_(zip, CloseZip{functions}) {}
  tl::unexpected<Error> damaged(const std::string& where) const {
    return fail(ErrorKind::malformed, "cannot be read: it was cut or is damaged", where,
                "copy it again from the measuring computer");
  }

  std::string path_;
  const ZipFunctions* functions_;
  std::unique_ptr<zip_t, CloseZip> zip_;
};

Result<Archive> Archive::open(const std::string& path) {
  TACTO_TRY(check_readable(path));
  static const auto entry = function_in_module(kZipModule, kZipEntry);
  TACTO_TRY(entry);
  static const ZipFunctions* const functions = reinterpret_cast<ZipEntry>(*entry)();
  int ignored = 0;
  Archive archive(path, functions, functions->open(path.c_str(), ZIP_RDONLY, &ignored));
  if (archive.zip_ == nullptr)
    return fail(ErrorKind::malformed, "is no ZIP archive: it was cut, or is no X3P file", path,
                "copy it again from the measuring computer");
  return archive;
}

Result<std::vector<std::string>> Archive::names() const {
  std::vector<std::string> names;
  for (zip_int64_t i = 0; i < functions_->entries(zip_.get(), 0); ++i) {
    zip_stat_t stat;
    if (functions_->stat(zip_.get(), static_cast<zip_uint64_t>(i), 0, &stat) != 0 ||
        (stat.valid & ZIP_STAT_NAME) == 0)
      return damaged(path_);
    names.emplace_back(stat.name);
  }
  return names;
}

Result<std::string> Archive::read(const std::string& name, std::uint64_t most_bytes,
                                  std::optional<std::uint64_t> bytes) const {
  const auto all = names();
  TACTO_TRY(all);
  const std::string where = fmt::format("{}: {}", path_, name);
  const auto found = std::ranges::find(*all, name);
  if (found == all->end()) return fail(ErrorKind::malformed, "is not in the archive", where);
  const auto index = static_cast<zip_uint64_t>(found - all->begin());
  zip_stat_t stat;
  if (functions_->stat(zip_.get(), index, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0)
    return damaged(where);
  if (bytes && stat.size != *bytes)
    return fail(ErrorKind::malformed, fmt::format("has {} bytes, but {} are needed", stat.size, *bytes),
                where);
  if (stat.size > most_bytes)
    return fail(ErrorKind::unsuitable,
                fmt::format("has {} bytes; at most {} are read", stat.size, most_bytes), where);
  const std::unique_ptr<zip_file_t, CloseEntry> entry(functions_->open_entry(zip_.get(), index, 0),
                                                      CloseEntry{functions_});
  std::string content(stat.size, '\0');
  char end = 0;  // reading the end makes libzip compare its checksum
  if (entry == nullptr ||
      functions_->read(entry.get(), content.data(), content.size()) != static_cast<zip_int64_t>(stat.size) ||
      functions_->read(entry.get(), &end, 1) != 0)
    return damaged(where);
  return content;
}

// main.xml at the top, or the only one in a folder.
Result<std::string> main_xml_of(const Archive& archive) {
  const auto names = archive.names();
  TACTO_TRY(names);
  std::vector<std::string> found;
  for (const std::string& name : *names) {
    if (name == kMainXml) return name;
    if (name.ends_with("/" + std::string(kMainXml))) found.push_back(name);
  }
  if (found.size() == 1) return found[0];
  return fail(ErrorKind::malformed,
              found.empty() ? "has no main.xml, so it is no X3P file" : "has a main.xml in several folders",
              archive.path());
}

std::string lower_hex(std::string_view text) {
  std::string lower(without_blanks(text).substr(0, 32));
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// The document during reading.
struct MainXml {
  const Archive& archive;
  std::string folder;  // of main.xml, with a slash, or empty
  pugi::xml_node root;
  std::string notes;

  tl::unexpected<Error> broken(std::string what, const char* element) const {
    return fail(ErrorKind::malformed, std::move(what),
                fmt::format("{}: {}{}: {}", archive.path(), folder, kMainXml, element));
  }
  tl::unexpected<Error> unsuitable(std::string what, std::string remedy) const {
    return fail(ErrorKind::unsuitable, std::move(what), archive.path(), std::move(remedy));
  }
  pugi::xml_node element(const char* path) const { return root.first_element_by_path(path); }
  std::string_view text(const char* path) const { return without_blanks(element(path).child_value()); }
  template <class Number>
  Result<Number> number(const char* path) const {
    const std::string_view written = text(path);
    Number value{};
    const bool plus = written.starts_with('+') && !written.starts_with("+-");  // from_chars takes none
    const auto [end, error] =
        std::from_chars(written.data() + (plus ? 1 : 0), written.data() + written.size(), value);
    if (error == std::errc() && end == written.data() + written.size() && std::isfinite(double(value)))
      return value;
    return broken(fmt::format("'{}' is not a number", written.substr(0, 40)), path);
  }
  Result<double> number_or(const char* path, double otherwise) const {
    return text(path).empty() ? Result<double>(otherwise) : number<double>(path);
  }
  Result<double> pitch(const char* axis) const {
    const std::string at = fmt::format("Record1/Axes/{}/", axis);
    if (text((at + "AxisType").c_str()) != "I")
      return unsuitable(fmt::format("has no even spacing of points: its axis {} is not incremental", axis),
                        "resample it evenly in the program that made it");
    const std::string increment = at + "Increment";
    const auto pitch_m = number<double>(increment.c_str());
    if (pitch_m && !(*pitch_m > 0)) return broken("an increment must be above 0", increment.c_str());
    return pitch_m;
  }

  Result<void> check_sum(std::string_view content, std::string_view stated, const std::string& name) {
    if (without_blanks(stated).empty()) {
      notes += fmt::format("; no checksum of {}", name);
      return {};
    }
    if (md5_of(content) == lower_hex(stated)) return {};
    return fail(ErrorKind::malformed, "does not have the MD5 that the file states",
                fmt::format("{}: {}", archive.path(), name), "copy it again from the measuring computer");
  }
};

// The matrix of points.
struct Matrix {
  bool surface = true;
  std::uint64_t columns = 0, rows = 1;
  HeightType type{};
  double scale = 1, offset_m = 0;
};

Result<void> read_sizes(const MainXml& xml, Matrix& matrix) {
  constexpr const char* kLayers = "Record3/MatrixDimension/SizeZ";
  if (const auto list = xml.text("Record3/ListDimension"); !list.empty() && !matrix.surface) {
    const auto points = xml.number<std::uint64_t>("Record3/ListDimension");
    TACTO_TRY(points);
    matrix.columns = *points;
    return {};
  }
  const auto columns = xml.number<std::uint64_t>("Record3/MatrixDimension/SizeX");
  TACTO_TRY(columns);
  const auto rows = xml.number<std::uint64_t>("Record3/MatrixDimension/SizeY");
  TACTO_TRY(rows);
  matrix.columns = *columns, matrix.rows = *rows;
  if (const auto layers = xml.number_or(kLayers, 1); !layers || *layers != 1)
    return xml.unsuitable("has several layers", "export one of them in the program that made it");
  if (!matrix.surface && matrix.rows != 1)
    return xml.broken(fmt::format("a profile has one row, not {}", matrix.rows), "Record3/MatrixDimension");
  return {};
}

Result<Matrix> read_matrix(const MainXml& xml) {
  Matrix matrix;
  const std::string_view feature = xml.text("Record1/FeatureType");
  if (feature != "SUR" && feature != "PRF")
    return xml.unsuitable(
        fmt::format("has the feature type '{}'; SUR and PRF are read", feature.substr(0, 40)),
        "export a surface or a profile in the program that made it");
  matrix.surface = feature == "SUR";
  const std::string_view letter = xml.text("Record1/Axes/CZ/DataType");
  const auto* const type = std::ranges::find(kHeightTypes, letter, &HeightType::letter);
  if (type == std::end(kHeightTypes))
    return xml.broken(fmt::format("'{}' is none of the types I, L, F, D", letter.substr(0, 40)),
                      "Record1/Axes/CZ/DataType");
  matrix.type = *type;
  const auto scale = xml.number_or("Record1/Axes/CZ/Increment", 1);
  TACTO_TRY(scale);
  const auto offset_m = xml.number_or("Record1/Axes/CZ/Offset", 0);
  TACTO_TRY(offset_m);
  if (*scale == 0)
    return xml.broken("an increment of 0 makes all heights equal", "Record1/Axes/CZ/Increment");
  matrix.scale = *scale, matrix.offset_m = *offset_m;
  TACTO_TRY(read_sizes(xml, matrix));
  std::uint64_t bytes = 0;
  if (matrix.columns == 0 || matrix.rows == 0) return xml.broken("has no points", "Record3");
  if (__builtin_mul_overflow(matrix.columns, matrix.rows, &bytes) ||
      __builtin_mul_overflow(bytes, matrix.type.bytes, &bytes) || bytes > kMostX3pBytes)
    return xml.unsuitable(
        fmt::format("has {} x {} points: more than {} bytes", matrix.columns, matrix.rows, kMostX3pBytes),
        "export a part of it in the program that made it");
  return matrix;
}

// The points of a line or of all rows: their indices in the matrix.
struct ChosenPoints {
  std::string name;
  std::uint64_t first = 0, step = 1, count = 0;
  const char* axis = "CX";
  std::uint64_t rows = 1;
};

Result<ChosenPoints> chosen_points(const MainXml& xml, const Matrix& matrix, const X3pChoice& choice) {
  const auto& [row, column, most_points] = choice;
  if (!matrix.surface) {
    if (!row && !column) return ChosenPoints{"the profile", 0, 1, matrix.columns, "CX"};
    return fail(ErrorKind::usage, "is a profile: it has no rows to choose from", xml.archive.path(),
                "omit --row and --column");
  }
  if (!row && !column && most_points) {
    const std::uint64_t count = matrix.columns * matrix.rows;
    if (count <= *most_points) return ChosenPoints{"the surface", 0, 1, count, "CX", matrix.rows};
    return xml.unsuitable(fmt::format("has {} x {} points; at most {} are read of a whole surface",
                                      matrix.columns, matrix.rows, *most_points),
                          "export a part of it in the program that made it");
  }
  const std::string all =
      fmt::format("--row N (1 to {}) or --column N (1 to {})", matrix.rows, matrix.columns);
  if (row.has_value() == column.has_value())
    return fail(ErrorKind::usage, "is a surface, and a texture is one line of it", xml.archive.path(),
                "give one of " + all + "; -o NAME.height.nc makes a height map of the whole surface");
  const std::uint64_t number = row ? *row : *column, most = row ? matrix.rows : matrix.columns;
  if (number < 1 || number > most)
    return fail(ErrorKind::usage, fmt::format("there is no {} {}", row ? "row" : "column", number),
                xml.archive.path(), "give one of " + all);
  const std::string name = fmt::format("{} {} of {}", row ? "row" : "column", number, most);
  if (row) return ChosenPoints{name, (number - 1) * matrix.columns, 1, matrix.columns, "CX"};
  return ChosenPoints{name, number - 1, matrix.columns, matrix.rows, "CY"};
}

// Of a link inside the archive.
std::string linked_name(const MainXml& xml, std::string_view link) {
  return xml.folder + std::string(link.starts_with("./") ? link.substr(2) : link);
}

// The mask: a bit for each point, the lowest of a byte first; empty if the file has none.
Result<std::string> read_mask(MainXml& xml, const Matrix& matrix) {
  const std::string_view link = xml.text("Record3/DataLink/ValidPointsLink");
  if (link.empty()) return std::string();
  const std::string name = linked_name(xml, link);
  auto mask = xml.archive.read(name, kMostX3pBytes, (matrix.columns * matrix.rows + 7) / 8);
  TACTO_TRY(mask);
  TACTO_TRY(xml.check_sum(*mask, xml.text("Record3/DataLink/MD5ChecksumValidPoints"), name));
  return mask;
}

Result<std::string> read_points(MainXml& xml, const Matrix& matrix) {
  const std::string_view link = xml.text("Record3/DataLink/PointDataLink");
  if (link.empty())
    return xml.unsuitable("has its points as text in main.xml",
                          "store them in binary form in the program that made it");
  const std::string name = linked_name(xml, link);
  auto points = xml.archive.read(name, kMostX3pBytes, matrix.columns * matrix.rows * matrix.type.bytes);
  TACTO_TRY(points);
  TACTO_TRY(xml.check_sum(*points, xml.text("Record3/DataLink/MD5ChecksumPointData"), name));
  return points;
}

Result<X3pHeights> read_heights(MainXml& xml, const X3pChoice& choice) {
  const auto matrix = read_matrix(xml);
  TACTO_TRY(matrix);
  const auto points = chosen_points(xml, *matrix, choice);
  TACTO_TRY(points);
  X3pHeights heights;
  heights.name = points->name;
  const auto pitch_m = xml.pitch(points->axis);
  TACTO_TRY(pitch_m);
  const auto origin_m = xml.number_or(fmt::format("Record1/Axes/{}/Offset", points->axis).c_str(), 0);
  TACTO_TRY(origin_m);
  heights.pitch_m = *pitch_m, heights.origin_m = *origin_m, heights.rows = points->rows;
  if (points->rows > 1) {
    const auto row_pitch_m = xml.pitch("CY");
    TACTO_TRY(row_pitch_m);
    heights.row_pitch_m = *row_pitch_m;
  }
  const auto stored = read_points(xml, *matrix);
  TACTO_TRY(stored);
  const auto mask = read_mask(xml, *matrix);
  TACTO_TRY(mask);
  for (std::uint64_t i = 0; i < points->count; ++i) {
    const std::uint64_t at = points->first + i * points->step;
    const bool valid = mask->empty() || (static_cast<unsigned char>((*mask)[at / 8]) >> (at % 8) & 1U) != 0;
    const double height_m =
        matrix->type.number(stored->data() + at * matrix->type.bytes) * matrix->scale + matrix->offset_m;
    heights.height_m.push_back(valid && std::isfinite(height_m) ? height_m
                                                                : std::numeric_limits<double>::quiet_NaN());
  }
  heights.notes = xml.notes;
  return heights;
}

std::string described(const MainXml& xml) {
  std::string notes = "X3P";
  for (const char* path : {"Record2/Creator", "Record2/Instrument/Manufacturer", "Record2/Instrument/Model",
                           "Record2/Date", "Record2/Comment"})
    if (const std::string_view text = xml.text(path); !text.empty()) notes += "; " + std::string(text);
  return notes;
}

Result<void> check_own_sum(MainXml& xml, std::string_view content) {
  const std::string_view link = xml.text("Record4/ChecksumFile");
  const std::string name = linked_name(xml, link.empty() ? "md5checksum.hex" : link);
  const auto names = xml.archive.names();
  TACTO_TRY(names);
  if (link.empty() && std::ranges::find(*names, name) == names->end())
    return xml.check_sum(content, {}, std::string(kMainXml));
  const auto stated = xml.archive.read(name, kLargestChecksumFile);
  TACTO_TRY(stated);
  return xml.check_sum(content, *stated, xml.folder + std::string(kMainXml));
}

}  // namespace

Result<X3pHeights> read_x3p(const std::string& path, const X3pChoice& choice) try {
  const auto archive = Archive::open(path);
  TACTO_TRY(archive);
  const auto name = main_xml_of(*archive);
  TACTO_TRY(name);
  const auto content = archive->read(*name, kLargestMainXml);
  TACTO_TRY(content);
  pugi::xml_document document;
  const auto parsed = document.load_buffer(content->data(), content->size());
  const std::string where = fmt::format("{}: {}", path, *name);
  if (!parsed)
    return fail(ErrorKind::malformed,
                fmt::format("is not XML: {} at byte {}", parsed.description(), parsed.offset), where);
  MainXml xml{*archive, name->substr(0, name->size() - kMainXml.size()), document.document_element(), {}};
  if (!xml.root.child("Record1") || !xml.root.child("Record3"))
    return fail(ErrorKind::malformed, "contains no Record1 and Record3 of ISO 25178-72", where);
  xml.notes = described(xml);
  TACTO_TRY(check_own_sum(xml, *content));
  return read_heights(xml, choice);
} catch (const std::bad_alloc&) {
  return fail(ErrorKind::unsuitable, "is too large for the memory", path);
}

}  // namespace tacto::schema
