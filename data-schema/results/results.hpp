// SPDX-License-Identifier: GPL-3.0-or-later
// What a verb of analysis found, as NAME.results.json: figures for people, curves to draw, all of it for
// machines.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {

struct ResultFigure {
  std::string name, value;  ///< as people read them, with unit
};

struct ResultCurve {
  std::string name;  ///< for the legend
  std::vector<double> x, y;
  bool dashed = false;
};

struct ResultPicture {
  std::string title, x_label, y_label;  ///< labels with units
  bool logarithmic_x = false;
  std::vector<ResultCurve> curves;
};

struct Results {
  std::string verb;
  std::vector<std::string> inputs;  ///< files and devices, as they were named
  std::string device;
  std::string simulated;  ///< by what, where anything in it is simulated
  std::vector<ResultFigure> figures;
  std::vector<ResultPicture> pictures;
  std::string details_json;  ///< an object's text: what the verb prints with --json
  std::string created, creator;
  std::string extra_json;
  std::string newer_version;
};

/// NAME.results.json, by stem or in full, or another .json that is named in full. Errors: not_found;
/// malformed, with "FILE#/json/pointer" where a curve's x and y differ in length; unsupported_version.
Result<Results> read_results(const std::string& name);

/// The file's text. Points of curves that are not finite are left out. Errors: unsuitable, where the schema
/// does not allow it, or where details_json is no object.
Result<std::string> results_json(const Results& results);

/// Whether a file of this name may be written: there is none, or one of results, which `existing` says to
/// replace. Errors: usage.
Result<void> check_results_free(const std::string& path, Existing existing);

}  // namespace tacto::schema
