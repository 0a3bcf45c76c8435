// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/recording/recording.hpp"

namespace tacto::schema {
namespace {

constexpr QuantityName kQuantityNames[] = {
    {"tangential_force", Dimension::force},
    {"tangential_force_x", Dimension::force},
    {"net_force", Dimension::force},
    {"normal_force", Dimension::force},
    {"position", Dimension::length},
    {"speed", Dimension::speed},
    {"acceleration", Dimension::acceleration},
    {"displacement", Dimension::length},
    {"drive", Dimension::voltage},
    {"height", Dimension::length},
    {"signal", Dimension::none},
};

}  // namespace

std::span<const QuantityName> quantity_names() {
  return kQuantityNames;
}

Result<QuantityName> quantity_named(std::string_view name) {
  std::string known;
  for (const QuantityName& quantity : kQuantityNames) {
    if (quantity.name == name) return quantity;
    known += (known.empty() ? "" : ", ") + std::string(quantity.name);
  }
  return fail(ErrorKind::usage, fmt::format("'{}' is not a known quantity", name), {},
              "the quantities are: " + known);
}

}  // namespace tacto::schema
