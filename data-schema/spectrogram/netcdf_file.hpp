// SPDX-License-Identifier: GPL-3.0-or-later
// The only use of the netCDF library: an open file that keeps its first failure, so that a sequence of calls
// is checked once at its end.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A variable's dimensions, and the size of its blocks in the file: a length for each dimension.
struct Blocks {
  std::vector<int> dimensions;
  std::vector<std::size_t> lengths;
};

/// A part of a variable, one number a dimension.
struct Part {
  std::vector<std::size_t> start, count;
};

/// A netCDF-4 file being written. After a failure every call does nothing, and close() reports the failure.
class NetcdfWriter {
 public:
  explicit NetcdfWriter(const std::string& path);
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;
  ~NetcdfWriter();

  /// A dimension without a length grows with the data.
  int dimension(const char* name, std::optional<std::size_t> length);
  /// Variables, each with its unit (none where empty) and long name.
  int axis(const char* name, int dimension, const std::string& units, const std::string& long_name);
  /// Double precision, absent values NaN.
  int values(const char* name, const Blocks& blocks, const std::string& units, const std::string& long_name);
  /// Single precision, absent cells NaN.
  int cells(const char* name, const Blocks& blocks, bool deflated, const std::string& units,
            const std::string& long_name);
  /// Whole numbers of 32 bits, deflated; put as doubles.
  int indices(const char* name, const Blocks& blocks, const std::string& long_name);
  /// Whole numbers of 16 bits, deflated; put as doubles. Programs that know CF read number x scale + offset.
  int shorts(const char* name, const Blocks& blocks, double scale, double offset,
             const std::string& long_name);
  /// Bytes that are 0 or 1, deflated, with the names of both values ("unknown known").
  int flags(const char* name, const Blocks& blocks, const std::string& meanings,
            const std::string& long_name);
  /// Of the whole file.
  void attribute(const char* name, const std::string& text);
  void attribute(const char* name, double value);
  void attribute(const char* name, long long value);

  void put(int variable, std::span<const double> values);
  void put(int variable, const Part& part, std::span<const double> values);
  void put(int variable, const Part& part, std::span<const float> values);
  void put(int variable, const Part& part, std::span<const signed char> values);
  /// Errors: cannot_write, with the library's words. `path` names the file in them.
  Result<void> close(const std::string& path);

 private:
  bool sound() const { return status_ == 0; }
  int define(const char* name, int type, const Blocks& blocks, bool deflated);
  void describe(int variable, const std::string& units, const std::string& long_name);
  int file_ = -1;
  int status_ = 0;
};

/// A netCDF file being read. After a failure every call returns nothing, and status() reports the failure.
class NetcdfReader {
 public:
  explicit NetcdfReader(const std::string& path);
  NetcdfReader(const NetcdfReader&) = delete;
  NetcdfReader& operator=(const NetcdfReader&) = delete;
  ~NetcdfReader();

  /// An attribute of the whole file, or of a variable; empty or NaN where there is none (which is no
  /// failure).
  std::string text(const char* name);
  /// A variable's attribute `units`; empty where there is none.
  std::string units(const char* name);
  double number(const char* name, const char* variable = nullptr);
  /// A dimension's length; 0 where there is none.
  std::size_t length(const char* name);
  std::vector<double> axis(const char* name);
  bool has(const char* name) const;
  std::vector<float> cells(const char* name, const Part& part);
  std::vector<double> values(const char* name, const Part& part);
  /// Errors: malformed, with the library's words.
  Result<void> status(const std::string& path) const;

 private:
  int variable(const char* name);
  std::string text_of(int variable, const char* name);
  template <class Number>
  std::vector<Number> read(const char* name, const Part& part);
  int file_ = -1;
  int status_ = 0;
};

}  // namespace tacto::schema
