// SPDX-License-Identifier: GPL-3.0-or-later
// MATLAB files of version 5 and 7.3, read and written by matio.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A variable, or a field of a struct.
struct MatArray {
  std::string name;        ///< by dotted path: "data.force"
  std::string class_name;  ///< as MATLAB's class(): "double"
  std::string size;        ///< "20000x3"
  std::string refusal;     ///< why it has no columns: "is complex"; empty if it has some
};

/// Numbers of an array that belong to one channel. The longer dimension is time: a vector is one column, a
/// matrix of more rows than columns has "acc(:,1)" ..., one of fewer rows "acc(1,:)" ...
struct MatColumn {
  std::string name, array;
  std::uint64_t first = 0, step = 1, rows = 0;  ///< in the array, column by column
};

struct MatContents {
  std::string format;  ///< "MATLAB 5.0 MAT-file"
  std::vector<MatArray> arrays;
  std::vector<MatColumn> columns;
};

/// The most memory for the variables that hold the selected columns. Whole variables are read.
inline constexpr std::uint64_t kMostMatBytes = std::uint64_t{2} << 30;

/// Whether a file begins as a MATLAB file of version 5 or 7.3.
bool is_mat(std::string_view beginning);

/// The arrays of a file, without their numbers. Only real, full arrays of numbers have columns; logical ones
/// are 0 and 1. An array whose class cannot hold the numbers that are stored has none. Errors: not_found;
/// malformed: cut or damaged (check_mat5(), or HDF5's checks).
Result<MatContents> mat_contents(const std::string& path);

/// Columns of one length, as double. Errors: as mat_contents; unsuitable: of different lengths, larger than
/// kMostMatBytes, an integer beyond 2^53.
Result<std::vector<std::vector<double>>> read_mat(const std::string& path,
                                                  std::span<const MatColumn> columns);

enum class MatVersion { v5, v73 };

/// Version 5 holds variables below 2 GB.
MatVersion mat_version_for(std::uint64_t largest_variable_bytes);

/// The beginning of every file of MatWriter, after the version: "MATLAB 5.0 MAT-file, made by tactograph".
bool is_own_mat(std::string_view beginning);

/// The members of a struct; texts are UTF-8, characters beyond U+FFFF become U+FFFD.
using MatMembers = std::vector<std::pair<std::string, std::variant<std::string, double>>>;

/// Writes variables one after the other, not compressed: measured doubles hardly become smaller. Names become
/// MATLAB's: other characters than letters, digits and underlines become underlines, at most 63.
class MatWriter {
 public:
  /// `named` is the file's name in errors. Errors: cannot_write.
  static Result<MatWriter> create(const std::string& path, const std::string& named, MatVersion version);
  MatWriter(MatWriter&&) noexcept;
  MatWriter& operator=(MatWriter&&) noexcept;
  ~MatWriter();

  /// A matrix of `columns` columns, column by column. Errors: cannot_write.
  Result<void> put(const std::string& name, std::span<const double> values, std::size_t columns = 1);
  Result<void> put(const std::string& name, std::span<const float> values, std::size_t columns = 1);
  Result<void> put(const std::string& name, const MatMembers& members);
  /// Closes the file and checks that it is whole. Errors: cannot_write.
  Result<void> close();

 private:
  struct State;
  explicit MatWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tacto::schema
