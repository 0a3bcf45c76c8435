// SPDX-License-Identifier: GPL-3.0-or-later
// Reads golden numbers: text files with lines of numbers, made by the scripts beside them.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace tacto::spatial {

class GoldenFile {
 public:
  explicit GoldenFile(const std::string& name)
      : file_(std::string(TACTO_SOURCE "/tests/spatial/golden/") + name) {}
  bool good() const { return file_.good(); }
  /// The next line; false at the end.
  bool next(std::string& line) { return static_cast<bool>(std::getline(file_, line)); }
  /// The next line's numbers; none at the end. Uses strtod through stod, because streams refuse denormals.
  std::vector<double> numbers() {
    std::string line, word;
    std::getline(file_, line);
    std::istringstream words(line);
    std::vector<double> values;
    while (words >> word) values.push_back(std::stod(word));
    return values;
  }

 private:
  std::ifstream file_;
};

}  // namespace tacto::spatial
