// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a verb of analysis, as NAME.results.json: figures for people, curves to draw, all details
// for programs.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {

struct ResultFigure {
  std::string name, value;  ///< for people, with unit
};

struct ResultCurve {
  std::string name;  ///< for the legend
  std::vector<double> x, y;
  bool dashed = false;
  bool marks = false;  ///< a mark at each point instead of a curve
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
  std::string details_json;  ///< the text of an object: the verb's output with --json
  std::string created, creator;
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
};

/// NAME.results.json, by stem or in full, or another .json that is named in full. Errors: not_found;
/// malformed, with "FILE#/json/pointer" where a curve's x and y differ in length; unsupported_version.
Result<Results> read_results(const std::string& name);

/// The file's text. Points of curves that are not finite are left out. Errors: unsuitable, where the schema
/// does not allow it, or where details_json is no object.
Result<std::string> results_json(const Results& results);

/// Checks that a file of this name may be written: it does not exist, or it contains results that `existing`
/// allows to replace. Errors: usage.
Result<void> check_results_free(const std::string& path, Existing existing);

}  // namespace tacto::schema
