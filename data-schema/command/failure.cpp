// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/failure.hpp"

#include <fmt/format.h>

#include <string_view>

#include "data-schema/report/report_text.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::cli {

int print_error(const schema::Error& error, bool json) {
  const int code = schema::exit_code(error.kind);
  if (!json) {
    write_message(fmt::format("tactograph: {}\n", on_one_line(schema::message(error))));
    return code;
  }
  Report object;
  object.add("what", error.what).add("where", error.where).add("remedy", error.remedy).add("exit_code", code);
  write_message(json_line(object));
  return code;
}

bool asks_for_json(int argc, const char* const* argv) {
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--"; ++i)
    if (std::string_view(argv[i]) == "--json") return true;
  return false;
}

}  // namespace tacto::cli
