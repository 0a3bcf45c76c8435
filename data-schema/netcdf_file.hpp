// SPDX-License-Identifier: GPL-3.0-or-later
// The wall around the netCDF library: an open file whose first failure sticks, so that a sequence of calls is
// checked once at its end. Internal to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data-schema/error.hpp"

namespace tacto::schema {

/// A netCDF-4 file being written. After a failure every call does nothing, and close() says what it was.
class NetcdfWriter {
 public:
  explicit NetcdfWriter(const std::string& path);
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;
  ~NetcdfWriter();

  int dimension(const char* name, std::size_t length);
  /// Variables, each with its unit (none where empty) and long name.
  int axis(const char* name, int dimension, const std::string& units, const std::string& long_name);
  /// Single precision, deflated, absent cells NaN. `chunk` has a length for each dimension.
  int density(std::span<const int> dimensions, std::span<const std::size_t> chunk, const std::string& units,
              const std::string& long_name);
  /// Of the whole file.
  void attribute(const char* name, const std::string& text);
  void attribute(const char* name, double value);
  void attribute(const char* name, long long value);

  void put(int variable, std::span<const double> values);
  void put(int variable, std::span<const std::size_t> start, std::span<const std::size_t> count,
           std::span<const float> values);
  /// Errors: cannot_write, with the library's words. `path` names the file in them.
  Result<void> close(const std::string& path);

 private:
  bool sound() const { return status_ == 0; }
  void describe(int variable, const std::string& units, const std::string& long_name);
  int file_ = -1;
  int status_ = 0;
};

/// A netCDF file being read. After a failure every call gives nothing, and status() says what it was.
class NetcdfReader {
 public:
  explicit NetcdfReader(const std::string& path);
  NetcdfReader(const NetcdfReader&) = delete;
  NetcdfReader& operator=(const NetcdfReader&) = delete;
  ~NetcdfReader();

  /// An attribute of the whole file; empty or NaN where there is none (which is no failure).
  std::string text(const char* name);
  double number(const char* name);
  /// A dimension's length; 0 where there is none.
  std::size_t length(const char* name);
  std::vector<double> axis(const char* name);
  /// The block of `count` cells from `start` on, one number a dimension.
  std::vector<float> cells(const char* name, std::span<const std::size_t> start,
                           std::span<const std::size_t> count);
  /// Errors: malformed, with the library's words.
  Result<void> status(const std::string& path) const;

 private:
  int variable(const char* name);
  int file_ = -1;
  int status_ = 0;
};

}  // namespace tacto::schema
