// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/json/named_document.hpp"
#include "data-schema/transducer/transducer_json.hpp"
#include "data-schema/transducer/transducer_plausible.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kTransducerKind = "transducer";

Result<void> check_numbers(const Transducer& transducer, const std::string& where, Numbers numbers) {
  if (numbers == Numbers::plausible)
    if (const auto plausible = check_plausible(transducer, where); !plausible) return plausible;
  return check_computable(transducer, where);
}

}  // namespace

std::vector<std::string_view> preset_names() {
  return preset_names(kTransducerKind);
}

Result<Transducer> read_transducer(const std::string& name, Numbers numbers) {
  const auto found = open_named(kTransducerKind, name);
  TACTO_TRY(found);
  TACTO_TRY(check_document_known(found->document, kTransducerKind, found->where));
  Transducer transducer = transducer_from(found->document.body);
  keep_unknown(found->document, transducer);
  TACTO_TRY(check_extras(transducer, found->where));
  TACTO_TRY(check_numbers(transducer, found->where, numbers));
  return transducer;
}

Result<void> write_transducer(const std::string& stem, const Transducer& transducer) {
  TACTO_TRY(check_extras(transducer, path_of_kind(kTransducerKind, stem)));
  return write_named(kTransducerKind, stem, transducer_body(transducer), transducer.extra_json);
}

}  // namespace tacto::schema
