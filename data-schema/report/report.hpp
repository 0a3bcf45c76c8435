// SPDX-License-Identifier: GPL-3.0-or-later
// The result of a verb: printed for people as aligned lines, for programs as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::cli {

/// Ordered keys and values. A key ends in its unit (`duration_s`, `pitch_m`, `force_rms_n`, `level_db`): JSON
/// keeps key and SI value, people read "duration  8.5 s".
class Report {
 public:
  Report& add(std::string key, double value_si);
  Report& add(std::string key, std::string text);
  Report& add(std::string key, const char* text) { return add(std::move(key), std::string(text)); }
  Report& add(std::string key, std::string_view text) { return add(std::move(key), std::string(text)); }
  Report& add(std::string key, bool value);
  template <class Integer>
    requires std::is_integral_v<Integer>
  Report& add(std::string key, Integer count) {
    return put(std::move(key), static_cast<std::int64_t>(count));
  }
  /// A list of similar items: a table for people (one below the other, if a row has over 20 columns or a
  /// table of its own), an array of objects for programs.
  Report& add(std::string key, std::vector<Report> rows);
  Report& add(std::string key, std::vector<std::string> lines);

  /// Makes the process end with this fault's exit code although the report was made (`validate` found
  /// faults).
  Report& ends_with(schema::ErrorKind fault);
  int exit_code() const { return exit_code_; }
  bool empty() const { return entries_.empty(); }

  std::string for_people() const;
  std::string json() const;

 private:
  using Value =
      std::variant<double, std::int64_t, bool, std::string, std::vector<Report>, std::vector<std::string>>;
  friend struct ReportPrinter;
  Report& put(std::string key, Value value);
  std::vector<std::pair<std::string, Value>> entries_;
  int exit_code_ = 0;
};

}  // namespace tacto::cli
