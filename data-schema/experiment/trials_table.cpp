// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/experiment/trials_table.hpp"

#include <cassert>

#include "data-schema/json/json_schema.hpp"

namespace tacto::schema {

TrialsColumn trials_column(const std::string& name) {
  const auto& rules = schema_of("trials_table");
  assert(rules && rules->at("properties").contains(name));
  const Json& rule = rules->at("properties").at(name);
  return {text_or(rule, "description"), text_or(rule, "units")};
}

}  // namespace tacto::schema
