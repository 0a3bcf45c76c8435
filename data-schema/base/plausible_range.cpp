// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/plausible_range.hpp"

#include <fmt/format.h>

namespace tacto::schema {

std::string place_of_member(const std::string& where, const std::string& member) {
  return where + (where.find('#') == std::string::npos ? "#/" : "/") + member;
}

Result<void> check_range(const PlausibleRange& range, double value, const std::string& member,
                         const std::string& where, const std::string& remedy) {
  if (range.contains(value)) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("{} is {:g}: a plausible value is from {:g} to {:g}", member, value, range.lowest,
                          range.highest),
              place_of_member(where, member), remedy);
}

}  // namespace tacto::schema
