// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/spectrogram/netcdf_file.hpp"

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <type_traits>

#include "data-schema/base/module.hpp"
#include "data-schema/netcdf/netcdf_functions.hpp"

namespace tacto::schema {
namespace {

// A damaged header can contain any length; spectrograms of tactograph stay far below this (2 GB of cells).
constexpr std::size_t kMostCells = std::size_t{1} << 29;

// A status that netCDF does not use: the module is not there.
constexpr int kNotLoaded = -10000;

struct Library {
  const NetcdfFunctions* functions = nullptr;
  Error fault;  // without functions
};

Library loaded() {
  const auto entry = function_in_module(kNetcdfModule, kNetcdfEntry);
  if (!entry) return {nullptr, entry.error()};
  return {reinterpret_cast<NetcdfEntry>(*entry)(), {}};
}

const Library& library() {
  static const Library once = loaded();
  return once;
}

int load_status() {
  return library().functions == nullptr ? kNotLoaded : NC_NOERR;
}

// netCDF is not safe in several threads at once: a call has the library to itself.
struct Locked {
  std::unique_lock<std::mutex> lock;
  const NetcdfFunctions* operator->() const { return library().functions; }
};

// Precondition: load_status() is NC_NOERR.
Locked nc() {
  static std::mutex one_at_a_time;
  return {std::unique_lock(one_at_a_time)};
}

}  // namespace

NetcdfWriter::NetcdfWriter(const std::string& path) {
  status_ = load_status();
  if (sound()) status_ = nc()->create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &file_);
}

NetcdfWriter::~NetcdfWriter() {
  if (file_ >= 0) nc()->abort(file_);
}

int NetcdfWriter::dimension(const char* name, std::optional<std::size_t> length) {
  int id = -1;
  if (sound()) status_ = nc()->def_dim(file_, name, length.value_or(NC_UNLIMITED), &id);
  return id;
}

void NetcdfWriter::describe(int variable, const std::string& units, const std::string& long_name) {
  if (sound() && !units.empty())
    status_ = nc()->put_att_text(file_, variable, "units", units.size(), units.data());
  if (sound()) status_ = nc()->put_att_text(file_, variable, "long_name", long_name.size(), long_name.data());
}

int NetcdfWriter::axis(const char* name, int dimension, const std::string& units,
                       const std::string& long_name) {
  int id = -1;
  if (sound()) status_ = nc()->def_var(file_, name, NC_DOUBLE, 1, &dimension, &id);
  describe(id, units, long_name);
  return id;
}

// Higher levels of deflation gain little and cost seconds. The library's own cache would need 16 MB a
// variable; rows come in order, so one block at a time is enough.
int NetcdfWriter::define(const char* name, int type, const Blocks& blocks, bool deflated) {
  constexpr int kShuffle = 1, kDeflate = 1, kLevel = 1;
  constexpr std::size_t kCacheBytes = std::size_t{1} << 20, kCacheSlots = 101;
  constexpr float kPreemption = 1;  // blocks written whole go first
  const int count = static_cast<int>(blocks.dimensions.size());
  int id = -1;
  if (sound())
    status_ = nc()->def_var(file_, name, static_cast<nc_type>(type), count, blocks.dimensions.data(), &id);
  if (sound()) status_ = nc()->def_var_chunking(file_, id, NC_CHUNKED, blocks.lengths.data());
  if (sound() && deflated) status_ = nc()->def_var_deflate(file_, id, kShuffle, kDeflate, kLevel);
  if (sound()) status_ = nc()->set_var_chunk_cache(file_, id, kCacheBytes, kCacheSlots, kPreemption);
  return id;
}

int NetcdfWriter::values(const char* name, const Blocks& blocks, const std::string& units,
                         const std::string& long_name) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  const int id = define(name, NC_DOUBLE, blocks, false);
  if (sound()) status_ = nc()->def_var_fill(file_, id, NC_FILL, &kAbsent);
  describe(id, units, long_name);
  return id;
}

int NetcdfWriter::cells(const char* name, const Blocks& blocks, bool deflated, const std::string& units,
                        const std::string& long_name) {
  constexpr float kAbsent = std::numeric_limits<float>::quiet_NaN();
  const int id = define(name, NC_FLOAT, blocks, deflated);
  if (sound()) status_ = nc()->def_var_fill(file_, id, NC_FILL, &kAbsent);
  describe(id, units, long_name);
  return id;
}

int NetcdfWriter::indices(const char* name, const Blocks& blocks, const std::string& long_name) {
  const int id = define(name, NC_INT, blocks, true);
  describe(id, "", long_name);
  return id;
}

int NetcdfWriter::shorts(const char* name, const Blocks& blocks, double scale, double offset,
                         const std::string& long_name) {
  const int id = define(name, NC_SHORT, blocks, true);
  describe(id, "", long_name);
  if (sound()) status_ = nc()->put_att_double(file_, id, "scale_factor", NC_DOUBLE, 1, &scale);
  if (sound()) status_ = nc()->put_att_double(file_, id, "add_offset", NC_DOUBLE, 1, &offset);
  return id;
}

int NetcdfWriter::flags(const char* name, const Blocks& blocks, const std::string& meanings,
                        const std::string& long_name) {
  constexpr signed char kValues[] = {0, 1};
  const int id = define(name, NC_BYTE, blocks, true);
  describe(id, "", long_name);
  if (sound()) status_ = nc()->put_att_schar(file_, id, "flag_values", NC_BYTE, 2, kValues);
  if (sound()) status_ = nc()->put_att_text(file_, id, "flag_meanings", meanings.size(), meanings.data());
  return id;
}

void NetcdfWriter::attribute(const char* name, const std::string& text) {
  if (sound()) status_ = nc()->put_att_text(file_, NC_GLOBAL, name, text.size(), text.data());
}

void NetcdfWriter::attribute(const char* name, double value) {
  if (sound()) status_ = nc()->put_att_double(file_, NC_GLOBAL, name, NC_DOUBLE, 1, &value);
}

void NetcdfWriter::attribute(const char* name, long long value) {
  if (sound()) status_ = nc()->put_att_longlong(file_, NC_GLOBAL, name, NC_INT64, 1, &value);
}

void NetcdfWriter::put(int variable, std::span<const double> values) {
  put(variable, {{0}, {values.size()}}, values);
}

void NetcdfWriter::put(int variable, const Part& part, std::span<const double> values) {
  if (sound())
    status_ = nc()->put_vara_double(file_, variable, part.start.data(), part.count.data(), values.data());
}

void NetcdfWriter::put(int variable, const Part& part, std::span<const float> values) {
  if (sound())
    status_ = nc()->put_vara_float(file_, variable, part.start.data(), part.count.data(), values.data());
}

void NetcdfWriter::put(int variable, const Part& part, std::span<const signed char> values) {
  if (sound())
    status_ = nc()->put_vara_schar(file_, variable, part.start.data(), part.count.data(), values.data());
}

Result<void> NetcdfWriter::close(const std::string& path) {
  if (sound()) {
    status_ = nc()->close(file_);
    file_ = -1;
  }
  if (sound()) return {};
  if (status_ == kNotLoaded) return tl::unexpected(library().fault);
  return fail(ErrorKind::cannot_write, fmt::format("netCDF: {}", nc()->strerror(status_)), path,
              "check whether the disk is full");
}

NetcdfReader::NetcdfReader(const std::string& path) {
  status_ = load_status();
  if (status_ == NC_NOERR) status_ = nc()->open(path.c_str(), NC_NOWRITE, &file_);
}

NetcdfReader::~NetcdfReader() {
  if (file_ >= 0) nc()->close(file_);
}

std::string NetcdfReader::text_of(int variable, const char* name) {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  if (status_ != NC_NOERR || nc()->inq_att(file_, variable, name, &type, &length) != NC_NOERR ||
      type != NC_CHAR)
    return {};
  std::string text(length, '\0');
  status_ = nc()->get_att_text(file_, variable, name, text.data());
  return text;
}

std::string NetcdfReader::text(const char* name) {
  return text_of(NC_GLOBAL, name);
}

std::string NetcdfReader::units(const char* name) {
  int id = -1;
  const bool there = status_ == NC_NOERR && nc()->inq_varid(file_, name, &id) == NC_NOERR;
  return there ? text_of(id, "units") : "";
}

double NetcdfReader::number(const char* name, const char* variable) {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  double value = std::numeric_limits<double>::quiet_NaN();
  int of = NC_GLOBAL;
  if (status_ != NC_NOERR) return value;
  // One call a statement: each has the library to itself until its end.
  if (variable != nullptr && nc()->inq_varid(file_, variable, &of) != NC_NOERR) return value;
  if (nc()->inq_att(file_, of, name, &type, &length) != NC_NOERR) return value;
  if (length == 1 && type != NC_CHAR) status_ = nc()->get_att_double(file_, of, name, &value);
  return value;
}

std::size_t NetcdfReader::length(const char* name) {
  int id = -1;
  std::size_t length = 0;
  if (status_ != NC_NOERR || nc()->inq_dimid(file_, name, &id) != NC_NOERR) return 0;
  status_ = nc()->inq_dimlen(file_, id, &length);
  if (status_ == NC_NOERR && length > kMostCells) status_ = NC_EDIMSIZE;
  return status_ == NC_NOERR ? length : 0;
}

int NetcdfReader::variable(const char* name) {
  int id = -1;
  if (status_ == NC_NOERR) status_ = nc()->inq_varid(file_, name, &id);
  return id;
}

std::vector<double> NetcdfReader::axis(const char* name) {
  std::vector<double> values(length(name));
  const int id = variable(name);
  if (status_ == NC_NOERR) status_ = nc()->get_var_double(file_, id, values.data());
  return values;
}

bool NetcdfReader::has(const char* name) const {
  int id = -1;
  return status_ == NC_NOERR && nc()->inq_varid(file_, name, &id) == NC_NOERR;
}

template <class Number>
std::vector<Number> NetcdfReader::read(const char* name, const Part& part) {
  const int id = variable(name);
  int dimensions = 0;
  if (status_ == NC_NOERR) status_ = nc()->inq_varndims(file_, id, &dimensions);
  if (status_ == NC_NOERR && dimensions != static_cast<int>(part.count.size())) status_ = NC_EDIMSIZE;
  const std::size_t size =
      std::reduce(part.count.begin(), part.count.end(), std::size_t{1}, std::multiplies<>());
  if (status_ == NC_NOERR && size > kMostCells) status_ = NC_EDIMSIZE;
  if (status_ != NC_NOERR) return {};
  std::vector<Number> values(size);
  if constexpr (std::is_same_v<Number, float>)
    status_ = nc()->get_vara_float(file_, id, part.start.data(), part.count.data(), values.data());
  else
    status_ = nc()->get_vara_double(file_, id, part.start.data(), part.count.data(), values.data());
  return values;
}

std::vector<float> NetcdfReader::cells(const char* name, const Part& part) {
  return read<float>(name, part);
}

std::vector<double> NetcdfReader::values(const char* name, const Part& part) {
  return read<double>(name, part);
}

Result<void> NetcdfReader::status(const std::string& path) const {
  if (status_ == NC_NOERR) return {};
  if (status_ == kNotLoaded) return tl::unexpected(library().fault);
  return fail(ErrorKind::malformed, fmt::format("netCDF: {}", nc()->strerror(status_)), path);
}

}  // namespace tacto::schema
