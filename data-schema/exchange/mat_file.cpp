// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/mat_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <functional>
#include <set>
#include <type_traits>
#include <utility>

#include "data-schema/base/module.hpp"
#include "data-schema/exchange/mat5_check.hpp"
#include "data-schema/exchange/matio/matio_functions.hpp"
#include "data-schema/version.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kMat5 = "MATLAB 5.0 MAT-file", kMat73 = "MATLAB 7.3 MAT-file";
constexpr std::string_view kMadeBy = ", made by tactograph";
constexpr std::size_t kMostColumns = 1024;  // of a matrix; one of more is no table of channels
constexpr std::int64_t kLargestWhole = std::int64_t{1} << 53;

Result<const MatioFunctions*> matio() {
  static const auto entry = function_in_module(kMatioModule, kMatioEntry);
  TACTO_TRY(entry);
  static const MatioFunctions* const functions = reinterpret_cast<MatioEntry>(*entry)();
  return functions;
}

struct CloseMat {
  const MatioFunctions* functions;
  void operator()(mat_t* file) const { functions->close(file); }
};
struct FreeVariable {
  const MatioFunctions* functions;
  void operator()(matvar_t* variable) const { functions->free(variable); }
};
using OpenMat = std::unique_ptr<mat_t, CloseMat>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

// The first bytes of a file; fewer if it is shorter.
std::string beginning_of(const std::string& path) {
  std::string head(kMat5.size(), '\0');
  std::FILE* const file = std::fopen(path.c_str(), "rbe");
  if (file == nullptr) return {};
  head.resize(std::fread(head.data(), 1, head.size(), file));
  std::fclose(file);
  return head;
}

tl::unexpected<Error> damaged(const std::string& where) {
  return fail(ErrorKind::malformed,
              "cannot be read: it was cut, is damaged, or was not written as MATLAB does", where,
              "copy it again, or save it again in MATLAB");
}

Result<OpenMat> open_mat(const std::string& path) {
  const auto functions = matio();
  TACTO_TRY(functions);
  const std::string head = beginning_of(path);
  if (!is_mat(head)) return fail(ErrorKind::malformed, "is no MATLAB file of version 5 or 7.3", path);
  if (head == kMat5) TACTO_TRY(check_mat5(path));
  OpenMat file(nullptr, CloseMat{*functions});
  if (head == kMat5 || (*functions)->hdf5_members(path.c_str(), "/") >= 0)
    file.reset((*functions)->open(path.c_str(), MAT_ACC_RDONLY));
  if (file == nullptr) return damaged(path);
  return file;
}

std::string class_of(const matvar_t& array) {
  if (array.isLogical != 0) return "logical";
  switch (array.class_type) {
    case MAT_C_CELL:
      return "cell";
    case MAT_C_STRUCT:
      return "struct";
    case MAT_C_CHAR:
      return "char";
    case MAT_C_SPARSE:
      return "sparse";
    case MAT_C_DOUBLE:
      return "double";
    case MAT_C_SINGLE:
      return "single";
    case MAT_C_INT8:
      return "int8";
    case MAT_C_UINT8:
      return "uint8";
    case MAT_C_INT16:
      return "int16";
    case MAT_C_UINT16:
      return "uint16";
    case MAT_C_INT32:
      return "int32";
    case MAT_C_UINT32:
      return "uint32";
    case MAT_C_INT64:
      return "int64";
    case MAT_C_UINT64:
      return "uint64";
    case MAT_C_FUNCTION:
      return "function_handle";
    case MAT_C_EMPTY:
      return "empty";
    case MAT_C_OBJECT:
    case MAT_C_OPAQUE:
      break;
  }
  return "object";
}

std::span<const std::size_t> dims_of(const matvar_t& array) {
  if (array.dims == nullptr || array.rank < 1) return {};
  return {array.dims, static_cast<std::size_t>(array.rank)};
}

// The number of elements; none if it does not fit.
std::uint64_t count_of(const matvar_t& array) {
  std::uint64_t count = dims_of(array).empty() ? 0 : 1;
  for (const std::size_t dim : dims_of(array))
    if (__builtin_mul_overflow(count, dim, &count)) return UINT64_MAX;
  return count;
}

std::string size_words(const matvar_t& array) {
  return dims_of(array).empty() ? "0x0" : fmt::format("{}", fmt::join(dims_of(array), "x"));
}

// Why an array that is no plain struct has no columns.
std::string refusal_of(const matvar_t& array) {
  const std::string kind = class_of(array);
  if (kind == "struct") return "is an array of structs; only single structs are read";
  if (kind == "char") return "is text";
  if (kind == "cell" || kind == "sparse") return fmt::format("is a {} array", kind);
  if (kind == "function_handle" || kind == "object") return fmt::format("is of the class {}", kind);
  const std::uint64_t count = count_of(array);
  if (kind == "empty" && count > 0) return "has no MATLAB class that can be read";
  if (count == 0) return "is empty";
  if (array.isComplex != 0) return "is complex";
  if (array.rank != 2) return fmt::format("has {} dimensions", array.rank);
  if (count == 1) return "is a single number";
  if (std::min(array.dims[0], array.dims[1]) > kMostColumns)
    return fmt::format("has more than {} columns", kMostColumns);
  return {};
}

// Whether each number that is stored so is one of the class (a 64-bit integer is no exact double).
bool holds(const std::string& class_name, const StoredNumbers& stored) {
  if (stored.bytes == 0) return false;
  if (class_name == "double") return stored.bytes <= (stored.floating ? 8 : 4);
  if (class_name == "single") return stored.bytes <= (stored.floating ? 4 : 2);
  if (stored.floating) return false;
  if (class_name == "logical") return stored.bytes == 1;
  const bool has_sign = class_name.starts_with("int");
  const auto bytes = static_cast<std::size_t>(std::stoi(class_name.substr(has_sign ? 3 : 4)) / 8);
  return stored.has_sign == has_sign ? stored.bytes <= bytes : has_sign && stored.bytes < bytes;
}

// Why an array of a file of version 7.3 has no columns although its class has some.
std::string contradiction(const MatioFunctions& functions, const std::string& path, std::string array,
                          const std::string& class_name) {
  std::ranges::replace(array, '.', '/');
  const StoredNumbers stored = functions.hdf5_numbers(path.c_str(), ("/" + array).c_str());
  if (holds(class_name, stored)) return {};
  if (stored.bytes == 0) return "has no numbers that can be read";
  return fmt::format("is of the class {}, but stored as {} numbers of {} bits", class_name,
                     stored.floating   ? "floating-point"
                     : stored.has_sign ? "whole"
                                       : "unsigned",
                     8 * stored.bytes);
}

// Calls `visit` for each array that is not a single struct, with its dotted path.
void for_each_array(const MatioFunctions& functions, matvar_t& array, const std::string& path,
                    const std::function<void(const std::string&, matvar_t&)>& visit) {
  if (array.class_type != MAT_C_STRUCT || count_of(array) != 1) return visit(path, array);
  char* const* const names = functions.field_names(&array);
  for (unsigned i = 0; i < functions.fields(&array); ++i)
    if (matvar_t* const field = functions.field(&array, i, 0); field != nullptr && names != nullptr)
      for_each_array(functions, *field, path + "." + names[i], visit);
}

// Whether matio found all fields of the structs of a file of version 7.3.
Result<void> check_fields(const MatioFunctions& functions, matvar_t& array, const std::string& path,
                          const std::string& group) {
  if (array.class_type != MAT_C_STRUCT || count_of(array) != 1) return {};
  const unsigned fields = functions.fields(&array);
  char* const* const names = functions.field_names(&array);
  // A struct without fields is no group.
  if (std::max(functions.hdf5_members(path.c_str(), group.c_str()), 0L) != static_cast<long>(fields))
    return damaged(fmt::format("{}: {}", path, group));
  for (unsigned i = 0; i < fields; ++i)
    if (matvar_t* const field = functions.field(&array, i, 0); field != nullptr)
      TACTO_TRY(check_fields(functions, *field, path, fmt::format("{}/{}", group, names[i])));
  return {};
}

void add_columns(MatContents& contents, const std::string& path, const matvar_t& array) {
  const std::uint64_t rows = array.dims[0], columns = array.dims[1];
  if (rows == 1 || columns == 1) {
    contents.columns.push_back({path, path, 0, 1, rows * columns});
  } else if (rows >= columns) {
    for (std::uint64_t k = 0; k < columns; ++k)
      contents.columns.push_back({fmt::format("{}(:,{})", path, k + 1), path, k * rows, 1, rows});
  } else {
    for (std::uint64_t k = 0; k < rows; ++k)
      contents.columns.push_back({fmt::format("{}({},:)", path, k + 1), path, k, rows, columns});
  }
}

// The memory that an array and its parts need; cells and fields are read with it.
std::uint64_t bytes_of_array(const matvar_t& array) {
  constexpr std::uint64_t kEach = 16;  // a complex double, the largest element
  const std::uint64_t count = count_of(array);
  std::uint64_t bytes =
      count > kMostMatBytes ? kMostMatBytes + 1 : count * (array.isComplex != 0 ? kEach : 8);
  if ((array.class_type != MAT_C_STRUCT && array.class_type != MAT_C_CELL) || array.data == nullptr)
    return bytes;
  const auto* const parts = static_cast<matvar_t* const*>(array.data);
  const std::size_t number = array.nbytes / sizeof(matvar_t*);
  for (std::size_t i = 0; i < number && bytes <= kMostMatBytes; ++i)
    if (parts[i] != nullptr) bytes += bytes_of_array(*parts[i]);
  return bytes;
}

template <class Number>
Result<void> gather(const matvar_t& array, const MatColumn& column, const std::string& where,
                    std::vector<double>& values) {
  const auto* const numbers = static_cast<const Number*>(array.data);
  for (std::uint64_t i = 0; i < column.rows; ++i) {
    const Number number = numbers[column.first + i * column.step];
    if constexpr (std::is_integral_v<Number> && sizeof(Number) == 8)
      if (std::cmp_greater(number, kLargestWhole) || std::cmp_less(number, -kLargestWhole))
        return fail(ErrorKind::unsuitable, fmt::format("{} is beyond 2^53 and has no exact double", number),
                    fmt::format("{}: {}, sample {}", where, column.name, i),
                    "in MATLAB subtract an offset before saving");
    values.push_back(static_cast<double>(number));
  }
  return {};
}

Result<void> gather_any(const matvar_t& array, const MatColumn& column, const std::string& where,
                        std::vector<double>& values) {
  switch (array.class_type) {
    case MAT_C_DOUBLE:
      return gather<double>(array, column, where, values);
    case MAT_C_SINGLE:
      return gather<float>(array, column, where, values);
    case MAT_C_INT8:
      return gather<std::int8_t>(array, column, where, values);
    case MAT_C_UINT8:
      return gather<std::uint8_t>(array, column, where, values);
    case MAT_C_INT16:
      return gather<std::int16_t>(array, column, where, values);
    case MAT_C_UINT16:
      return gather<std::uint16_t>(array, column, where, values);
    case MAT_C_INT32:
      return gather<std::int32_t>(array, column, where, values);
    case MAT_C_UINT32:
      return gather<std::uint32_t>(array, column, where, values);
    case MAT_C_INT64:
      return gather<std::int64_t>(array, column, where, values);
    case MAT_C_UINT64:
      return gather<std::uint64_t>(array, column, where, values);
    default:
      return fail(ErrorKind::internal, "has no numbers", where);
  }
}

Result<void> check_lengths(const std::string& path, std::span<const MatColumn> columns) {
  for (const MatColumn& column : columns)
    if (column.rows != columns[0].rows)
      return fail(ErrorKind::unsuitable,
                  fmt::format("'{}' has {} rows, '{}' has {}", columns[0].name, columns[0].rows, column.name,
                              column.rows),
                  path, "import channels of one length together, the others into another recording");
  return {};
}

// MATLAB's names: a letter, then letters, digits and underlines, at most 63.
std::string matlab_name(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name[0])) == 0) name.insert(0, "x");
  return name.substr(0, 63);
}

// MATLAB's characters of 16 bits; `text` is UTF-8. SciPy reads no file in which a character needs two of
// them, so one beyond U+FFFF becomes the replacement character.
std::u16string utf16_of(const std::string& text) {
  std::u16string units;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const unsigned more = lead < 0x80 ? 0U : lead < 0xE0 ? 1U : lead < 0xF0 ? 2U : 3U;
    std::uint32_t point = more == 0 ? lead : lead & (0x3FU >> more);
    for (unsigned k = 0; k < more && i < text.size(); ++k)
      point = point << 6U | (static_cast<unsigned char>(text[i++]) & 0x3FU);
    units += point > 0xFFFF ? u'\uFFFD' : static_cast<char16_t>(point);
  }
  return units;
}

}  // namespace

bool is_mat(std::string_view beginning) {
  return beginning.starts_with(kMat5) || beginning.starts_with(kMat73);
}

bool is_own_mat(std::string_view beginning) {
  return is_mat(beginning) && beginning.substr(kMat5.size()).starts_with(kMadeBy);
}

MatVersion mat_version_for(std::uint64_t largest_variable_bytes) {
  constexpr std::uint64_t kMostOfVersion5 = (std::uint64_t{2} << 30) - 65536;  // with its tags below 2^31
  return largest_variable_bytes > kMostOfVersion5 ? MatVersion::v73 : MatVersion::v5;
}

Result<MatContents> mat_contents(const std::string& path) {
  const auto functions = matio();
  TACTO_TRY(functions);
  const auto file = open_mat(path);
  TACTO_TRY(file);
  MatContents contents{beginning_of(path), {}, {}};
  long variables = 0;
  while (matvar_t* const next = (*functions)->next_info(file->get())) {
    const Variable variable(next, FreeVariable{*functions});
    ++variables;
    if (next->name == nullptr) continue;
    if (contents.format == kMat73)
      TACTO_TRY(check_fields(**functions, *next, path, std::string("/") + next->name));
    for_each_array(**functions, *next, next->name, [&](const std::string& name, const matvar_t& array) {
      contents.arrays.push_back({name, class_of(array), size_words(array), refusal_of(array)});
      MatArray& added = contents.arrays.back();
      if (contents.format == kMat73 && added.refusal.empty())
        added.refusal = contradiction(**functions, path, name, added.class_name);
      if (added.refusal.empty()) add_columns(contents, name, array);
    });
  }
  if (contents.format == kMat73 && variables != (*functions)->hdf5_members(path.c_str(), "/"))
    return damaged(path);
  return contents;
}

Result<std::vector<std::vector<double>>> read_mat(const std::string& path,
                                                  std::span<const MatColumn> columns) {
  const auto functions = matio();
  TACTO_TRY(functions);
  TACTO_TRY(check_lengths(path, columns));
  const auto file = open_mat(path);
  TACTO_TRY(file);
  std::set<std::string> names;
  for (const MatColumn& column : columns) names.insert(column.array.substr(0, column.array.find('.')));
  std::vector<std::vector<double>> values(columns.size());
  std::uint64_t bytes = 0;
  for (const std::string& name : names) {
    const Variable variable((*functions)->info(file->get(), name.c_str()), FreeVariable{*functions});
    bytes += variable == nullptr ? 0 : bytes_of_array(*variable);
    if (bytes > kMostMatBytes)
      return fail(ErrorKind::unsuitable, "needs more than 2 GiB of memory", fmt::format("{}: {}", path, name),
                  "in MATLAB save the channels as variables of their own, or in parts");
    if (variable == nullptr || (*functions)->read_all(file->get(), variable.get()) != 0)
      return damaged(fmt::format("{}: {}", path, name));
    Result<void> gathered;
    for_each_array(**functions, *variable, name, [&](const std::string& array, const matvar_t& data) {
      for (std::size_t k = 0; k < columns.size() && gathered; ++k) {
        if (columns[k].array != array || !values[k].empty()) continue;
        const std::uint64_t last = columns[k].first + (columns[k].rows - 1) * columns[k].step;
        if (data.data == nullptr || last >= count_of(data))
          gathered = damaged(fmt::format("{}: {}", path, array));
        else
          gathered = gather_any(data, columns[k], path, values[k]);
      }
    });
    TACTO_TRY(gathered);
  }
  return values;
}

struct MatWriter::State {
  const MatioFunctions* functions;
  OpenMat file;
  std::string path, named;
  std::set<std::string> names;

  tl::unexpected<Error> failed() const {
    return fail(ErrorKind::cannot_write, "can't be written", named, "is the disk full?");
  }
  // A name that MATLAB accepts and that is not used yet.
  std::string free_name(const std::string& wanted) {
    std::string name = matlab_name(wanted);
    for (int k = 2; !names.insert(name).second; ++k)
      name = matlab_name(wanted).substr(0, 58) + fmt::format("_{}", k);
    return name;
  }
  Result<void> write(matvar_t* made) {
    const Variable variable(made, FreeVariable{functions});
    if (made == nullptr || functions->write(file.get(), made, MAT_COMPRESSION_NONE) != 0) return failed();
    return {};
  }
  template <class Number>
  Result<void> put(const std::string& name, std::span<const Number> values, std::size_t columns) {
    constexpr bool kIsDouble = sizeof(Number) == sizeof(double);
    std::size_t dims[2] = {values.size() / columns, columns};
    // matio does not change the numbers; MAT_F_DONT_COPY_DATA leaves them the caller's.
    return write(functions->variable(free_name(name).c_str(), kIsDouble ? MAT_C_DOUBLE : MAT_C_SINGLE,
                                     kIsDouble ? MAT_T_DOUBLE : MAT_T_SINGLE, 2, dims,
                                     const_cast<Number*>(values.data()), MAT_F_DONT_COPY_DATA));
  }
  // A member: copied by matio, and freed with its struct.
  matvar_t* member(const std::variant<std::string, double>& value) const {
    std::size_t dims[2] = {1, 1};
    if (const auto* number = std::get_if<double>(&value)) {
      double copy = *number;
      return functions->variable(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, &copy, 0);
    }
    std::u16string text = utf16_of(std::get<std::string>(value));
    dims[1] = text.size();
    dims[0] = text.empty() ? 0 : 1;
    return functions->variable(nullptr, MAT_C_CHAR, MAT_T_UTF16, 2, dims, text.data(), 0);
  }
};

MatWriter::MatWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
MatWriter::MatWriter(MatWriter&&) noexcept = default;
MatWriter& MatWriter::operator=(MatWriter&&) noexcept = default;
MatWriter::~MatWriter() = default;

Result<MatWriter> MatWriter::create(const std::string& path, const std::string& named, MatVersion version) {
  const auto functions = matio();
  TACTO_TRY(functions);
  const bool v5 = version == MatVersion::v5;
  const std::string header =
      fmt::format("{}{}{}", v5 ? kMat5 : kMat73,
                  kMadeBy.substr(0, kMadeBy.size() - std::string_view("tactograph").size()), kCreator);
  OpenMat file((*functions)->create(path.c_str(), header.c_str(), v5 ? MAT_FT_MAT5 : MAT_FT_MAT73),
               CloseMat{*functions});
  auto state = std::make_unique<State>(State{*functions, std::move(file), path, named, {}});
  if (state->file == nullptr) return state->failed();
  return MatWriter(std::move(state));
}

Result<void> MatWriter::put(const std::string& name, std::span<const double> values, std::size_t columns) {
  return state_->put(name, values, columns);
}

Result<void> MatWriter::put(const std::string& name, std::span<const float> values, std::size_t columns) {
  return state_->put(name, values, columns);
}

Result<void> MatWriter::put(const std::string& name, const MatMembers& members) {
  std::vector<std::string> names;
  for (const auto& [key, value] : members) names.push_back(matlab_name(key));
  std::vector<const char*> pointers;
  for (const std::string& key : names) pointers.push_back(key.c_str());
  pointers.push_back(nullptr);  // ends the list
  const std::size_t dims[2] = {1, 1};
  matvar_t* const made =
      state_->functions->structure(state_->free_name(name).c_str(), 2, dims, pointers.data());
  for (std::size_t i = 0; made != nullptr && i < members.size(); ++i)
    state_->functions->set_field(made, pointers[i], 0, state_->member(members[i].second));
  return state_->write(made);
}

Result<void> MatWriter::close() {
  const bool closed = state_->functions->close(state_->file.release()) == 0;
  if (!closed || !mat_contents(state_->path)) return state_->failed();
  return {};
}

}  // namespace tacto::schema
