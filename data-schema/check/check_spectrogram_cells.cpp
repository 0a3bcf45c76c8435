// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "data-schema/base/decibels.hpp"
#include "data-schema/check/check_parts.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"
#include "data-schema/spectrogram/spectrogram_sum.hpp"

namespace tacto::schema {
namespace {

// Other machines round the logarithm differently: to_decibels() is within 2e-5.
constexpr float kSameDecibels = 1e-3F;

// One spectrogram of a file, as stored.
struct StoredCells {
  std::string cells_name;
  std::size_t rows = 0, bins = 0;
  std::vector<float> cells, decibels, flags;
  std::vector<double> known_from, known_to, position, frequency;
};

class StoredSpectrograms {
 public:
  explicit StoredSpectrograms(const std::string& path) : file_(path) {}

  std::size_t count() { return std::max(file_.length("stroke"), std::size_t{1}); }
  std::string sums() { return file_.text("sha256"); }
  // What the checksum of each spectrogram ends with.
  void add_attributes(const StoredCells& s, SpectrogramSum& sum) {
    for (const char* name : kSummedTexts) sum.add(file_.text(name));
    for (const char* name : kSummedNumbers) sum.add(file_.number(name));
    for (const char* name : kSummedCounts) sum.add(file_.number(name));
    for (const char* name : kSummedUnits) sum.add(file_.units(name));
    sum.add(file_.units(s.cells_name.c_str()));
    sum.add(file_.units((s.cells_name + "_db").c_str()));
  }
  Result<void> status(const std::string& path) const { return file_.status(path); }

  StoredCells read(std::size_t stroke) {
    StoredCells s;
    s.cells_name = file_.has("amplitude") ? "amplitude" : "density";
    s.position = file_.axis("position");
    s.frequency = file_.axis("spatial_frequency");
    s.rows = s.position.size();
    s.bins = s.frequency.size();
    s.cells = file_.cells(s.cells_name.c_str(), part(stroke, {s.rows, s.bins}));
    drop_absent_rows(s);
    read_derived(stroke, s);
    return s;
  }

 private:
  Part part(std::size_t stroke, std::vector<std::size_t> lengths) {
    Part part{std::vector<std::size_t>(lengths.size(), 0), std::move(lengths)};
    if (file_.length("stroke") == 0) return part;
    part.start.insert(part.start.begin(), stroke);
    part.count.insert(part.count.begin(), 1);
    return part;
  }

  // A stroke shorter than the file's longest ends in NaN.
  void drop_absent_rows(StoredCells& s) {
    const auto absent = [&] {
      return std::all_of(s.cells.end() - static_cast<std::ptrdiff_t>(s.bins), s.cells.end(),
                         [](float each) { return std::isnan(each); });
    };
    while (s.rows > 0 && !s.cells.empty() && file_.length("stroke") > 0 && absent()) {
      s.cells.resize(s.cells.size() - s.bins);
      --s.rows;
    }
    s.position.resize(s.rows);
  }

  void read_derived(std::size_t stroke, StoredCells& s) {
    const std::string decibels = s.cells_name + "_db";
    if (file_.has("known")) s.flags = file_.cells("known", part(stroke, {s.rows, s.bins}));
    if (file_.has(decibels.c_str()))
      s.decibels = file_.cells(decibels.c_str(), part(stroke, {s.bins, s.rows}));
    if (!file_.has("known_from") || !file_.has("known_to")) return;
    s.known_from = file_.values("known_from", part(stroke, {s.rows}));
    s.known_to = file_.values("known_to", part(stroke, {s.rows}));
  }

  NetcdfReader file_;
};

std::string sum_of(StoredSpectrograms& file, const StoredCells& s) {
  SpectrogramSum sum;
  sum.add(s.cells);
  sum.add(s.known_from);
  sum.add(s.known_to);
  sum.add(s.position);
  sum.add(s.frequency);
  file.add_attributes(s, sum);
  return sum.hexadecimal();
}

// The first cell with wrong decibels.
std::optional<std::size_t> wrong_decibels(const StoredCells& s) {
  std::vector<float> own(s.cells.size()), turned(s.cells.size());
  to_decibels(s.cells, s.cells_name == "amplitude" ? 20.0F : 10.0F, own);
  transpose(own, s.rows, s.bins, turned);
  for (std::size_t i = 0; i < turned.size() && i < s.decibels.size(); ++i) {
    const bool same = std::isnan(turned[i]) ? std::isnan(s.decibels[i])
                                            : std::abs(turned[i] - s.decibels[i]) <= kSameDecibels;
    if (!same) return i % s.rows * s.bins + i / s.rows;
  }
  return std::nullopt;
}

// Rounding may move a limit to either side of a bin: such a bin may be valid or not.
std::optional<std::size_t> wrong_flag(const StoredCells& s) {
  constexpr double kRounding = 1e-9;
  for (std::size_t p = 0; p < s.known_from.size(); ++p)
    for (std::size_t k = 0; k < s.bins && p * s.bins + k < s.flags.size(); ++k) {
      const double f = s.frequency[k], from = s.known_from[p], to = s.known_to[p];
      const bool all = std::isnan(from);
      const bool near = std::abs(f - from) <= kRounding * from || std::abs(f - to) <= kRounding * to;
      const bool known = all || (from <= f && f <= to);
      if (!near && (s.flags[p * s.bins + k] != 0) != known) return p * s.bins + k;
    }
  return std::nullopt;
}

void add_cell(const std::string& where, const StoredCells& s, std::optional<std::size_t> cell,
              const char* what, std::vector<Finding>& findings) {
  if (cell)
    findings.push_back({fmt::format("{}, position {}, bin {}", where, *cell / s.bins, *cell % s.bins), what});
}

std::string sum_of_line(const std::string& text, std::size_t n) {
  std::size_t start = 0;
  for (; n > 0 && start != std::string::npos; --n) {
    const std::size_t end = text.find('\n', start);
    start = end == std::string::npos ? end : end + 1;
  }
  return start == std::string::npos ? "" : text.substr(start, text.find('\n', start) - start);
}

}  // namespace

Result<std::vector<Finding>> check_spectrogram_cells(const std::string& path) {
  std::vector<Finding> findings;
  StoredSpectrograms file(path);
  const std::string sums = file.sums();
  if (sums.empty())
    findings.push_back({path, "has no checksum: its attribute sha256 is missing; make the file again"});
  const std::size_t count = file.count();
  for (std::size_t stroke = 0; stroke < count; ++stroke) {
    const StoredCells stored = file.read(stroke);
    TACTO_TRY(file.status(path));
    const std::string where = count == 1 ? path : fmt::format("{}, stroke {}", path, stroke + 1);
    if (!sums.empty() && sum_of(file, stored) != sum_of_line(sums, stroke))
      findings.push_back(
          {where, "its cells, known band, axes, units or attributes do not match its attribute sha256"});
    add_cell(where, stored, wrong_decibels(stored), "its decibels do not match its cell", findings);
    add_cell(where, stored, wrong_flag(stored), "`known` contradicts known_from and known_to", findings);
  }
  return findings;
}

}  // namespace tacto::schema
