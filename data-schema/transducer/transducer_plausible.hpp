// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether numbers can belong to a transducer.
#pragma once

#include <string>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {

/// Checks that every number is within orders of magnitude of all benders and stacks that are made (the ranges
/// and their sources are in the .cpp). `where` is the file, or FILE#/member. Errors: unsuitable, with the
/// member, its value and range.
Result<void> check_plausible(const Transducer& transducer, const std::string& where);

/// Checks that all computed values stay finite, also in the device's single precision. --implausible does not
/// turn this check off. Errors: unsuitable, with the member, or the response.
Result<void> check_computable(const Transducer& transducer, const std::string& where);

}  // namespace tacto::schema
