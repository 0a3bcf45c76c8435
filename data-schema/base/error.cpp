// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/error.hpp"

namespace tacto::schema {

std::string message(const Error& error) {
  std::string text = error.where.empty() ? error.what : error.where + ": " + error.what;
  if (!error.remedy.empty()) text += "; " + error.remedy;
  return text;
}

}  // namespace tacto::schema
