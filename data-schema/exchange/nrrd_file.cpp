// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/nrrd_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "data-schema/base/quantity.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kNrrdBlanks = " \t";
constexpr std::uint64_t kMostInflation = 1032;  // of deflate, by its format

using NrrdFields = std::map<std::string, std::string, std::less<>>;

struct NrrdType {
  std::string_view names;  // by the specification, each between bars
  std::size_t bytes;
  double (*value)(const unsigned char* at);
  bool whole = true;
};

template <class Number>
double number_at(const unsigned char* at) {
  Number number;
  std::memcpy(&number, at, sizeof number);
  return static_cast<double>(number);
}

constexpr NrrdType kNrrdTypes[] = {
    {"|signed char|int8|int8_t|", 1, number_at<std::int8_t>},
    {"|uchar|unsigned char|uint8|uint8_t|", 1, number_at<std::uint8_t>},
    {"|short|short int|signed short|signed short int|int16|int16_t|", 2, number_at<std::int16_t>},
    {"|ushort|unsigned short|unsigned short int|uint16|uint16_t|", 2, number_at<std::uint16_t>},
    {"|int|signed int|int32|int32_t|", 4, number_at<std::int32_t>},
    {"|uint|unsigned int|uint32|uint32_t|", 4, number_at<std::uint32_t>},
    {"|float|", 4, number_at<float>, false},
    {"|double|", 8, number_at<double>, false}};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kNrrdBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kNrrdBlanks) - first + 1);
}

std::string in_lower_case(std::string_view text) {
  std::string small(text);
  for (char& each : small)
    if (each >= 'A' && each <= 'Z') each = static_cast<char>(each - 'A' + 'a');
  return small;
}

// Up to the blank line; `at` is then behind it.
Result<NrrdFields> fields_of(std::string_view text, const std::string& path, std::size_t& at) {
  const auto next_line = [&]() -> std::optional<std::string_view> {
    const auto end = text.find('\n', at);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  };
  const auto magic = next_line();
  if (!magic || !magic->starts_with("NRRD000"))
    return fail(ErrorKind::malformed, "is no NRRD file: it does not begin with NRRD000", path);
  NrrdFields fields;
  while (const auto line = next_line()) {
    if (line->empty()) return fields;
    if (line->starts_with('#') || line->find(":=") != std::string_view::npos) continue;
    const auto colon = line->find(": ");
    if (colon == std::string_view::npos)
      return fail(ErrorKind::malformed, fmt::format("the line '{}' of its header is no field", *line), path);
    fields[in_lower_case(trimmed(line->substr(0, colon)))] = trimmed(line->substr(colon + 2));
  }
  return fail(ErrorKind::malformed, "its header has no end: a blank line is before the data", path);
}

// Numbers between blanks, commas and brackets.
std::vector<double> numbers_in(std::string_view text) {
  constexpr std::string_view kBetween = " \t,()";
  std::vector<double> numbers;
  for (auto at = text.find_first_not_of(kBetween); at != std::string_view::npos;
       at = text.find_first_not_of(kBetween, at)) {
    const std::string_view word = text.substr(at, text.find_first_of(kBetween, at) - at);
    double number = NAN;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    numbers.push_back(error == std::errc() && end == word.data() + word.size() ? number : NAN);
    at += word.size();
  }
  return numbers;
}

std::string field_of(const NrrdFields& fields, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    if (const auto found = fields.find(name); found != fields.end()) return found->second;
  return {};
}

class NrrdReader {
 public:
  NrrdReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  Result<NrrdVolume> read(std::optional<double> unit_m) {
    auto fields = fields_of(text_, path_, data_);
    TACTO_TRY(fields);
    fields_ = std::move(*fields);
    TACTO_TRY(check_kind());
    TACTO_TRY(read_sizes());
    TACTO_TRY(read_spacing(unit_m));
    TACTO_TRY(check_volume(read_.volume, path_));
    TACTO_TRY(read_data());
    TACTO_TRY(take_values());
    return std::move(read_);
  }

 private:
  tl::unexpected<Error> unsuitable(std::string what, std::string remedy) const {
    return fail(ErrorKind::unsuitable, std::move(what), path_, std::move(remedy));
  }
  tl::unexpected<Error> malformed(std::string what, std::string remedy = {}) const {
    return fail(ErrorKind::malformed, std::move(what), path_, std::move(remedy));
  }

  Result<void> check_kind() {
    constexpr const char* kSave = "save it as one file .nrrd, raw or gzip, from its program";
    if (fields_.contains("data file") || fields_.contains("datafile"))
      return unsuitable("its data are in another file", kSave);
    for (const char* skip : {"line skip", "lineskip", "byte skip", "byteskip"})
      if (const auto found = fields_.find(skip); found != fields_.end() && found->second != "0")
        return unsuitable(fmt::format("it has '{}: {}'", skip, found->second), kSave);
    if (const std::string dimension = field_of(fields_, {"dimension"}); dimension != "3")
      return unsuitable(fmt::format("its dimension is '{}'", dimension), "a volume has three axes");
    const std::string type = in_lower_case(field_of(fields_, {"type"}));
    for (const NrrdType& each : kNrrdTypes)
      if (!type.empty() && each.names.find("|" + type + "|") != std::string_view::npos) type_ = &each;
    if (type_ == nullptr)
      return unsuitable(fmt::format("its type is '{}'", type),
                        "convert it to whole numbers of 16 bits, or to float");
    encoding_ = in_lower_case(field_of(fields_, {"encoding"}));
    if (encoding_ == "gz") encoding_ = "gzip";
    if (encoding_ != "raw" && encoding_ != "gzip")
      return unsuitable(fmt::format("its encoding is '{}'", encoding_), kSave);
    const std::string endian = in_lower_case(field_of(fields_, {"endian"}));
    if (type_->bytes > 1 && endian != "little" && endian != "big")
      return malformed(fmt::format("its endian is '{}'", endian),
                       "the field is 'endian: little' or 'endian: big'");
    big_ = endian == "big";
    return {};
  }

  Result<void> read_sizes() {
    const std::vector<double> sizes = numbers_in(field_of(fields_, {"sizes"}));
    if (sizes.size() != 3) return malformed("its field 'sizes' has not three numbers");
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(sizes[i] >= 1 && sizes[i] == std::floor(sizes[i])))
        return malformed(fmt::format("a size is {}", sizes[i]));
      read_.volume.samples[i] = static_cast<std::size_t>(std::min(sizes[i], 1e9));
    }
    return {};
  }

  // Quoted; all the same.
  Result<std::optional<double>> stated_unit() const {
    const std::string units = field_of(fields_, {"space units", "units"});
    std::optional<double> unit_m;
    std::size_t named = 0;
    for (auto at = units.find('"'); at != std::string::npos; at = units.find('"', at)) {
      const auto end = units.find('"', at + 1);
      if (end == std::string::npos) return malformed(fmt::format("its units are {}", units));
      const std::string name = units.substr(at + 1, end - at - 1);
      at = end + 1;
      if (name.empty()) continue;
      const auto unit = parse_quantity("1" + name, Dimension::length);
      if (!unit || (unit_m && *unit_m != *unit))
        return unsuitable(fmt::format("its units are {}", units), "give all axes one unit of length, as mm");
      unit_m = *unit;
      ++named;
    }
    if (named != 0 && named != 3)
      return unsuitable(fmt::format("its units are {}", units), "give each axis a unit");
    return unit_m;
  }

  Result<void> read_spacing(std::optional<double> asked_m) {
    const std::string directions = field_of(fields_, {"space directions"});
    VolumePoint length = {};
    if (!directions.empty()) {
      TACTO_TRY(read_directions(numbers_in(directions), directions, length));
    } else {
      const std::vector<double> spacings = numbers_in(field_of(fields_, {"spacings"}));
      if (spacings.size() != 3)
        return unsuitable("it states no spacing of its values",
                          "give it the field 'spacings' or 'space directions' in its program");
      std::copy_n(spacings.begin(), 3, length.begin());
    }
    for (const double each : length)
      if (!(each > 0 && std::isfinite(each)))
        return unsuitable(fmt::format("a spacing of its values is {}", each),
                          "give it the field 'spacings' or 'space directions' in its program");
    const auto stated_m = stated_unit();
    TACTO_TRY(stated_m);
    if (*stated_m && asked_m)
      return fail(ErrorKind::usage, "this file states its unit of length", path_, "omit --unit");
    if (!*stated_m && !asked_m)
      return fail(ErrorKind::usage, "this file states no unit of length", path_,
                  "give it, for example --unit mm");
    const double unit_m = *stated_m ? **stated_m : *asked_m;
    for (std::size_t i = 0; i < 3; ++i) read_.volume.spacing_m[i] = length[i] * unit_m;
    return {};
  }

  Result<void> read_directions(const std::vector<double>& n, const std::string& words, VolumePoint& length) {
    constexpr double kRightAngle = 1e-4;  // cosine; programs write six digits
    if (n.size() != 9 || std::ranges::any_of(n, [](double each) { return !std::isfinite(each); }))
      return malformed(fmt::format("its space directions are {}", words),
                       "give three vectors of three numbers");
    const auto dot = [&](std::size_t i, std::size_t j) {
      return n[3 * i] * n[3 * j] + n[3 * i + 1] * n[3 * j + 1] + n[3 * i + 2] * n[3 * j + 2];
    };
    for (std::size_t i = 0; i < 3; ++i) length[i] = std::sqrt(dot(i, i));
    for (std::size_t i = 0; i < 3; ++i)
      if (const std::size_t j = (i + 1) % 3; std::abs(dot(i, j)) > kRightAngle * length[i] * length[j])
        return unsuitable(fmt::format("its space directions {} are not at right angles", words),
                          "resample it on a straight grid");
    read_.mirrored = n[0] * (n[4] * n[8] - n[5] * n[7]) - n[1] * (n[3] * n[8] - n[5] * n[6]) +
                         n[2] * (n[3] * n[7] - n[4] * n[6]) <
                     0;
    return {};
  }

  Result<void> read_data() {
    const auto& [columns, rows, layers] = read_.volume.samples;
    const std::size_t needed = columns * rows * layers * type_->bytes, there = text_.size() - data_;
    const bool packed = encoding_ == "gzip";
    if (packed ? needed / kMostInflation > there : there < needed)
      return malformed(fmt::format("it is cut: its sizes need {} bytes, it has {}{}", needed, there,
                                   packed ? " of gzip" : ""),
                       "export it again");
    if (!packed && there > needed)
      return malformed(fmt::format("it has {} bytes, but its sizes need {}", there, needed),
                       "export it again");
    bytes_.resize(needed);
    if (packed) return inflate_data();
    std::memcpy(bytes_.data(), text_.data() + data_, needed);
    return {};
  }

  Result<void> inflate_data() {
    constexpr int kGzip = 16 + MAX_WBITS;
    z_stream stream = {};
    if (inflateInit2(&stream, kGzip) != Z_OK) return fail(ErrorKind::internal, "zlib does not start", path_);
    std::size_t in = data_, out = 0;
    unsigned char beyond = 0;
    int status = Z_OK;
    while (status == Z_OK && out <= bytes_.size()) {
      // zlib counts in 32 bits; one byte more shows data that are too long.
      constexpr std::size_t kPart = std::size_t{1} << 30;
      const std::size_t more_in = std::min(text_.size() - in, kPart),
                        more_out = std::min(bytes_.size() - out, kPart);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text_.data() + in));
      stream.avail_in = static_cast<uInt>(more_in);
      stream.next_out = more_out > 0 ? bytes_.data() + out : &beyond;
      stream.avail_out = more_out > 0 ? static_cast<uInt>(more_out) : 1;
      status = inflate(&stream, Z_NO_FLUSH);
      in += more_in - stream.avail_in;
      out += (more_out > 0 ? more_out : 1) - stream.avail_out;
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END || out != bytes_.size())
      return malformed(
          status != Z_STREAM_END && out < bytes_.size()
              ? fmt::format("its gzip data end or break after {} of {} bytes", out, bytes_.size())
              : fmt::format("its gzip data are not the {} bytes that its sizes need", bytes_.size()),
          "export it again");
    return {};
  }

  double value(std::size_t i) const {
    std::array<unsigned char, 8> at;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(i * type_->bytes), type_->bytes, at.begin());
    if (big_ != (std::endian::native == std::endian::big))
      std::reverse(at.begin(), at.begin() + type_->bytes);
    return type_->value(at.data());
  }

  Result<void> take_values() {
    Volume& volume = read_.volume;
    const std::size_t count = bytes_.size() / type_->bytes;
    double least = INFINITY, most = -INFINITY;
    bool whole = true;
    for (std::size_t i = 0; i < count; ++i) {
      const double each = value(i);
      if (!std::isfinite(each))
        return malformed(fmt::format("value {} is not a number", i), "export it without such values");
      least = std::min(least, each), most = std::max(most, each);
      whole = whole && (type_->whole || each == std::floor(each));
    }
    constexpr double kSteps = 65535;
    if (!whole || most - least > kSteps) {
      volume.scale = most > least ? (most - least) / kSteps : 1;
      volume.offset = least - INT16_MIN * volume.scale;
      read_.rounding = volume.scale / 2;
    } else if (least < INT16_MIN || most > INT16_MAX) {
      volume.offset = least - INT16_MIN;
    }
    volume.stored.reserve(count);
    const std::size_t layer = volume.samples[0] * volume.samples[1];
    for (std::size_t z = 0; z < volume.samples[2]; ++z) {
      const std::size_t from = (read_.mirrored ? volume.samples[2] - 1 - z : z) * layer;
      for (std::size_t i = from; i < from + layer; ++i)
        volume.stored.push_back(static_cast<std::int16_t>(std::clamp(
            std::round((value(i) - volume.offset) / volume.scale), double{INT16_MIN}, double{INT16_MAX})));
    }
    return {};
  }

  std::string_view text_;
  const std::string& path_;
  NrrdFields fields_;
  std::size_t data_ = 0;
  const NrrdType* type_ = nullptr;
  std::string encoding_;
  bool big_ = false;
  std::vector<unsigned char> bytes_;
  NrrdVolume read_;
};

}  // namespace

bool is_nrrd_file(const std::string& path) {
  return in_lower_case(path).ends_with(".nrrd");
}

Result<NrrdVolume> read_nrrd(const std::string& path, std::optional<double> unit_m) {
  const auto text = read_file(path);
  TACTO_TRY(text);
  return NrrdReader(*text, path).read(unit_m);
}

}  // namespace tacto::schema
