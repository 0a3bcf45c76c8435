// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/error.hpp"

namespace tacto::schema {

std::string message(const Error& error) {
  // "sim:" ends with the colon.
  const char* const between = error.where.empty() ? "" : error.where.ends_with(':') ? " " : ": ";
  std::string text = error.where + between + error.what;
  if (!error.remedy.empty()) text += "; " + error.remedy;
  return text;
}

}  // namespace tacto::schema
