// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/recording/recording.hpp"

namespace tacto::schema {
namespace {

constexpr QuantityName kQuantityNames[] = {
    {"tangential_force", Dimension::force, true},
    {"tangential_force_x", Dimension::force, true},
    {"net_force", Dimension::force, true},
    {"normal_force", Dimension::force},
    {"position", Dimension::length},
    {"speed", Dimension::speed},
    {"acceleration", Dimension::acceleration, true},
    {"displacement", Dimension::length, true},
    {"drive", Dimension::voltage},
    {"height", Dimension::length, true},
    {"signal", Dimension::none, true},
};

}  // namespace

std::span<const QuantityName> quantity_names() {
  return kQuantityNames;
}

std::vector<std::size_t> texture_channels(const RecordingHeader& header) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < header.channels.size(); ++i)
    if (const auto quantity = quantity_named(header.channels[i].quantity); quantity && quantity->of_texture)
      found.push_back(i);
  return found;
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
