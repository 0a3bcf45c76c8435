// SPDX-License-Identifier: GPL-3.0-or-later
// The description of a published folder: RO-Crate 1.1 (https://w3id.org/ro/crate/1.1), JSON-LD.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

struct Creator {
  std::string name, orcid;  ///< the ORCID as 0000-0002-1825-0097, or empty
};

/// DataCite's obligatory fields, as far as a person has to state them, and the licence.
struct Citation {
  std::string title;
  std::vector<std::string> creators;  ///< "Doe, Jane" or "Doe, Jane <0000-0002-1825-0097>"
  std::string publisher, year, licence;
};

/// Errors: usage: one that names all missing fields; a field that is wrong.
Result<void> check_citation(const Citation& citation);

struct CrateFile {
  std::string path;  ///< in the crate
  std::uint64_t bytes = 0;
  std::string description = {};  ///< may be empty
};

struct CrateFolder {
  std::string path, name;
  std::vector<CrateFile> files;
};

struct Crate {
  Citation citation;
  std::string description;
  std::string program;  ///< that made it
  std::string steps;    ///< what the program computed, with options
  std::vector<CrateFile> files;
  std::vector<CrateFolder> folders;
};

/// The text of ro-crate-metadata.json. Precondition: check_citation. Errors: as check_citation; unsuitable,
/// for text that is not UTF-8.
Result<std::string> ro_crate_json(const Crate& crate);

}  // namespace tacto::schema
