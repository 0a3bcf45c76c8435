// SPDX-License-Identifier: GPL-3.0-or-later
// The physical value of a stored number or of a converter's code.
#pragma once

namespace tacto::schema {

constexpr double physical_value(double stored, double scale, double offset) {
  return stored * scale + offset;
}

}  // namespace tacto::schema
