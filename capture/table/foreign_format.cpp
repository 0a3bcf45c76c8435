// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/foreign_format.hpp"

#include <algorithm>
#include <cctype>

namespace tacto::capture {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::string_view kMatlab =
    "in MATLAB: writematrix([t f x], 'trial.csv'), or writetable(T, 'trial.csv'); then import the CSV";
constexpr std::string_view kLabview =
    "in LabVIEW write a text file (.lvm or CSV); or in Python: "
    "nptdms.TdmsFile.read('trial.tdms').as_dataframe().to_csv('trial.csv'); then import that";
constexpr std::string_view kSheet = "save the sheet as CSV, then import that";
constexpr std::string_view kProfile =
    "in Gwyddion or the microscope's program export the profile as text: position and height in two columns; "
    "then import that with --channel position=1*1mm --channel height=2*1um";
constexpr std::string_view kHdf5 =
    "write its columns as CSV, in Python: numpy.savetxt('trial.csv', numpy.column_stack([t, f]), "
    "delimiter=','); "
    "then import that";
constexpr std::string_view kUnpack = "unpack it, then import its contents";
constexpr std::string_view kExport = "export it as CSV in the program that made it, then import that";
constexpr std::string_view kDownload = "it is a web page: download the file itself";

struct Magic {
  std::string_view bytes;
  ForeignFormat format;
};

constexpr Magic kMagics[] = {
    {"MATLAB 7.3 MAT-file"sv, {"a MATLAB file (version 7.3, HDF5)", kMatlab}},
    {"MATLAB 5.0 MAT-file"sv, {"a MATLAB file (version 5)", kMatlab, true}},
    {"\x89HDF\r\n\x1a\n"sv, {"an HDF5 or netCDF-4 file", kHdf5}},
    {"CDF\x01"sv, {"a netCDF file", kHdf5}},
    {"CDF\x02"sv, {"a netCDF file", kHdf5}},
    {"CDF\x05"sv, {"a netCDF file", kHdf5}},
    {"TDSm"sv, {"a TDMS file of LabVIEW", kLabview}},
    {"TDSh"sv, {"the index of a TDMS file of LabVIEW, without data", kLabview}},
    {"\x93NUMPY"sv, {"an array of NumPy", kHdf5}},
    {"PAR1"sv, {"a Parquet table", kExport}},
    {"ARROW1"sv, {"an Arrow (Feather) table", kExport}},
    {"SQLite format 3\0"sv, {"an SQLite database", kExport}},
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv,
     {"an old Excel workbook (.xls) or another Office document", kSheet}},
    {"GWYP"sv, {"a Gwyddion file", kProfile}},
    {"GWYO"sv, {"a Gwyddion file", kProfile}},
    {"DIGITAL SURF"sv, {"a SUR profile of MountainsMap", kProfile}},
    {"DSCOMPRESSED"sv, {"a SUR profile of MountainsMap", kProfile}},
    {"aBCR-1.0"sv, {"an SDF height profile", kProfile}},
    {"bBCR-1.0"sv, {"an SDF height profile", kProfile}},
    {"aISO-1.0"sv, {"an SDF height profile", kProfile}},
    {"\x88\x1B\x03\x6F"sv, {"a height map of Zygo MetroPro", kProfile}},
    {"\x88\x1B\x03\x70"sv, {"a height map of Zygo MetroPro", kProfile}},
    {"\x88\x1B\x03\x71"sv, {"a height map of Zygo MetroPro", kProfile}},
    {"\x1F\x8B"sv, {"a gzip archive", kUnpack}},
    {"BZh"sv, {"a bzip2 archive", kUnpack}},
    {"\xFD"
     "7zXZ\0"sv,
     {"an xz archive", kUnpack}},
    {"\x28\xB5\x2F\xFD"sv, {"a Zstandard archive", kUnpack}},
    {"7z\xBC\xAF\x27\x1C"sv, {"a 7-Zip archive", kUnpack}},
    {"%PDF-"sv, {"a PDF document", kExport}},
    {"\x89PNG"sv, {"a picture (PNG)", kExport}},
    {"\xFF\xD8\xFF"sv, {"a picture (JPEG)", kExport}},
    {"<!DOCTYPE html"sv, {"HTML", kDownload}},
    {"<!doctype html"sv, {"HTML", kDownload}},
    {"<html"sv, {"HTML", kDownload}},
};

// The kind of a ZIP archive is recognised from the names of its files, which are not compressed.
constexpr Magic kArchived[] = {
    {"bindata/"sv, {"an X3P height profile (ISO 25178-72)", kProfile}},
    {"main.xml"sv, {"an X3P height profile (ISO 25178-72)", kProfile}},
    {"xl/"sv, {"an Excel workbook", kSheet}},
    {"application/vnd.oasis.opendocument.spreadsheet"sv, {"an OpenDocument sheet", kSheet}},
    {".npy"sv, {"an archive of NumPy arrays", kHdf5}},
};

struct Ending {
  std::string_view ending;
  ForeignFormat format;
};

constexpr Ending kEndings[] = {
    {".x3p", {"an X3P height profile (ISO 25178-72)", kProfile}},
    {".plux", {"a height map of Sensofar", kProfile}},
    {".xlsx", {"an Excel workbook", kSheet}},
    {".xlsm", {"an Excel workbook", kSheet}},
    {".ods", {"an OpenDocument sheet", kSheet}},
    {".npz", {"an archive of NumPy arrays", kHdf5}},
};

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

ForeignFormat archived_format(const std::string& name, std::string_view head) {
  for (const auto& [ending, format] : kEndings)
    if (name.ends_with(ending)) return format;
  for (const auto& [entry, format] : kArchived)
    if (head.find(entry) != std::string_view::npos) return format;
  return {"a ZIP archive", kUnpack};
}

}  // namespace

std::optional<ForeignFormat> foreign_format(const std::string& file, std::string_view head) {
  const std::string name = lower_case(file);
  if (head.starts_with("PK\x03\x04"sv)) return archived_format(name, head);
  for (const auto& [bytes, format] : kMagics)
    if (head.starts_with(bytes)) return format;
  const bool is_text = head.find('\0') == std::string_view::npos;
  if (name.ends_with(".mat") && !is_text) return ForeignFormat{"a MATLAB file (version 4)", kMatlab, true};
  return std::nullopt;
}

}  // namespace tacto::capture
