// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/creation_time.hpp"

#include <charconv>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string_view>

namespace tacto::schema {
namespace {

// Up to the year 9999: later ones would not fit into the format.
constexpr std::time_t kLatest = 253402300799;

std::optional<std::time_t> given_time() {
  const char* const text = std::getenv("SOURCE_DATE_EPOCH");
  if (text == nullptr) return std::nullopt;
  const std::string_view digits(text);
  std::time_t seconds = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
  const bool whole = fault == std::errc() && end == digits.data() + digits.size();
  return whole && seconds >= 0 && seconds <= kLatest ? std::optional(seconds) : std::nullopt;
}

}  // namespace

std::string creation_time() {
  const std::time_t seconds = given_time().value_or(std::time(nullptr));
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace tacto::schema
