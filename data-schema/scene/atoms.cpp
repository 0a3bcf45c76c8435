// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/atoms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

struct AtomColumn {
  std::string_view name;
  double Atom::*member;
};
constexpr AtomColumn kAtomColumns[] = {{"x_m", &Atom::x_m},
                                       {"y_m", &Atom::y_m},
                                       {"z_m", &Atom::z_m},
                                       {"sigma_m", &Atom::sigma_m},
                                       {"epsilon_j", &Atom::epsilon_j},
                                       {"charge_c", &Atom::charge_c}};

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of UTF-8; spreadsheets write it

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    cells.push_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  return cells;
}

std::optional<double> finite_number(std::string_view cell) {
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') cell.remove_prefix(1);  // from_chars() refuses it
  double value = 0;
  const auto [end, failed] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = failed == std::errc() && end == cell.data() + cell.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Reads the lines of one file, from the first to the last.
class AtomReader {
 public:
  explicit AtomReader(const std::string& path) : path_(path) {}

  Result<std::vector<Atom>> read(std::string_view text) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      ++line_;
      TACTO_TRY(take(trimmed(text.substr(at, end - at))));
      at = end + 1;
    }
    if (atoms_.empty()) return fault("it has no atoms", "the first line names the columns");
    return std::move(atoms_);
  }

 private:
  tl::unexpected<Error> fault(std::string what, std::string remedy) const {
    return fail(ErrorKind::malformed, std::move(what),
                fmt::format("{}, line {}", path_, std::max<std::size_t>(line_, 1)), std::move(remedy));
  }

  Result<void> take(std::string_view line) {
    if (line.empty() || line.front() == '#') return {};
    return columns_.empty() ? take_header(cells_of(line)) : take_atom(cells_of(line));
  }

  Result<void> take_header(const std::vector<std::string_view>& cells) {
    for (const std::string_view cell : cells) TACTO_TRY(take_column(cell));
    for (const AtomColumn& column : kAtomColumns)
      if (std::ranges::count(columns_, column.member) == 0)
        return fault(fmt::format("the column {} is missing", column.name), names());
    return {};
  }

  Result<void> take_column(std::string_view cell) {
    const auto known = std::ranges::find(kAtomColumns, cell, &AtomColumn::name);
    if (known == std::end(kAtomColumns)) return unknown_column(std::string(cell.substr(0, 64)));
    if (std::ranges::count(columns_, known->member) > 0)
      return fault(fmt::format("the column {} appears twice", known->name), "keep one of the two");
    columns_.push_back(known->member);
    return {};
  }

  tl::unexpected<Error> unknown_column(const std::string& cell) const {
    std::vector<std::string> known;
    for (const AtomColumn& column : kAtomColumns) known.emplace_back(column.name);
    const std::string nearest = nearest_word(cell, known);
    return fault(fmt::format("the column '{}' is not known", cell),
                 nearest.empty() ? names() : fmt::format("did you mean '{}'?", nearest));
  }

  static std::string names() { return "the columns are x_m, y_m, z_m, sigma_m, epsilon_j, charge_c"; }

  Result<void> take_atom(const std::vector<std::string_view>& cells) {
    if (cells.size() != columns_.size())
      return fault(fmt::format("it has {} cells, the header has {}", cells.size(), columns_.size()),
                   "separate the cells by commas");
    if (atoms_.size() == kMostAtoms)
      return fault(fmt::format("it has more than {} atoms", kMostAtoms), "take a part of them");
    Atom atom;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = finite_number(cells[i]);
      if (!value) return fault(fmt::format("'{}' is no finite number", cells[i].substr(0, 64)), "correct it");
      atom.*columns_[i] = *value;
    }
    return keep(atom);
  }

  Result<void> keep(const Atom& atom) {
    if (!(atom.sigma_m > 0)) return fault(fmt::format("sigma_m is {:g}", atom.sigma_m), "above 0");
    if (!(atom.epsilon_j >= 0)) return fault(fmt::format("epsilon_j is {:g}", atom.epsilon_j), "0 or above");
    if (const double force_n = atom.epsilon_j / atom.sigma_m; !(force_n <= kMostAtomForce_n))
      return fault(fmt::format("epsilon_j / sigma_m is {:g} N", force_n),
                   fmt::format("at most {:g} N", kMostAtomForce_n));
    for (const double place_m : {atom.x_m, atom.y_m, atom.z_m})
      if (!(std::abs(place_m) <= kFarthestAtom_m))
        return fault(fmt::format("a place is {:g} m", place_m),
                     fmt::format("within {:g} m of the origin", kFarthestAtom_m));
    atoms_.push_back(atom);
    return {};
  }

  const std::string& path_;
  std::size_t line_ = 0;
  std::vector<double Atom::*> columns_;
  std::vector<Atom> atoms_;
};

}  // namespace

Result<std::vector<Atom>> read_atoms(const std::string& path) {
  const auto text = read_file(path);
  TACTO_TRY(text);
  return AtomReader(path).read(*text);
}

}  // namespace tacto::schema
