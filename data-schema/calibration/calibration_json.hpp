// SPDX-License-Identifier: GPL-3.0-or-later
// A calibration file as JSON and back. Internal to this folder.
#pragma once

#include "data-schema/calibration/calibration.hpp"
#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

/// Without kind and version.
Json calibration_body(const CalibrationFile& file);

/// From a document that fits its schema only; extra_json and newer_version stay empty.
CalibrationFile calibration_from(const Json& body);

}  // namespace tacto::schema
