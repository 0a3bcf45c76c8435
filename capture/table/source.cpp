// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "capture/table/input_file.hpp"
#include "data-schema/base/column_unit.hpp"
#include "data-schema/exchange/mat_file.hpp"
#include "data-schema/exchange/xdf_file.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/wav/wav.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using std::string_view_literals::operator""sv;

constexpr std::size_t kPieceBytes = std::size_t{1} << 17;  // fits into the cache with its numbers

std::string table_format(const CsvLayout& layout) {
  const char* const delimiter = layout.delimiter == '\t'  ? "tab"
                                : layout.delimiter == ';' ? "semicolon"
                                                          : "comma";
  std::string format = fmt::format("table, {}, {} header", delimiter, layout.header ? "with" : "without");
  if (layout.lines_before > 0 && layout.header) format += fmt::format(" in line {}", layout.header_line);
  if (layout.lines_before > 0 && !layout.header) format += fmt::format(", from line {}", layout.data_line);
  if (layout.lines_before > 0) format += " (lines before it ignored)";
  if (layout.units_line > 0) format += fmt::format(", units in line {}", layout.units_line);
  return format;
}

Result<Source> open_table(const std::string& file, std::string_view head, bool whole, std::size_t skip) {
  auto layout = find_csv_layout(head, whole, file, skip);
  TACTO_TRY(layout);
  return Source{file, layout->columns, *layout, std::nullopt, 0, table_format(*layout), layout->units};
}

constexpr std::size_t kPieceSamples = 65536;

tl::unexpected<schema::Error> not_finite(const Source& source, std::uint64_t frame, std::size_t column,
                                         double value) {
  return fail(ErrorKind::malformed, std::isnan(value) ? "is NaN" : "is infinite",
              fmt::format("{}: sample {}, {}", source.file, frame, column_in_words(source.columns, column)),
              (source.mat || source.xdf) && std::isnan(value)
                  ? "unknown values are not filled in: --mask-outliers makes gaps of their rows"
                  : "import the part without it: unknown values are not filled in");
}

// Appends the chosen columns of a piece whose first frame is `first`.
Result<void> choose(const Source& source, std::span<const std::size_t> columns, std::uint64_t first,
                    std::span<const double> piece, std::vector<double>& rows) {
  const std::size_t channels = source.columns.size();
  rows.clear();
  for (std::size_t i = 0; i < piece.size(); i += channels)
    for (const std::size_t column : columns) {
      const double value = piece[i + column];
      if (!std::isfinite(value)) return not_finite(source, first + i / channels, column, value);
      rows.push_back(value);
    }
  return {};
}

// Columns "ch1", "ch2" ..., the header's rate, the width of integer codes. Errors: malformed, if libsndfile
// does not support the file; as WavReader::open().
Result<Source> open_audio(const std::string& file) {
  const auto reader = schema::WavReader::open(file);
  if (!reader) {
    schema::Error error = reader.error();
    if (error.remedy.empty())
      error.remedy =
          "import reads tables (CSV), MATLAB files, XDF files and the formats of libsndfile (WAV, FLAC ...)";
    return tl::unexpected(error);
  }
  const schema::WavInfo& info = reader->info();
  if (info.frames == 0) return fail(ErrorKind::malformed, "contains no samples", file);
  Source source{file, {}, std::nullopt, info.sample_rate_hz, info.code_bits, info.format};
  for (std::size_t i = 0; i < info.channels; ++i) source.columns.push_back(fmt::format("ch{}", i + 1));
  return source;
}

// Reads block by block: integer samples as codes of their own width, others unchanged. Errors: those of
// `take`; malformed, with the sample, for NaN and Inf, or a file without samples.
Result<void> read_audio(const Source& source, std::span<const std::size_t> columns, const RowHandler& take,
                        const std::function<void(double)>& progress) {
  auto reader = schema::WavReader::open(source.file);
  TACTO_TRY(reader);
  const std::size_t channels = source.columns.size();
  std::vector<double> piece(std::max<std::size_t>(kPieceSamples / channels, 1) * channels), rows;
  for (std::uint64_t done = 0;;) {
    const auto got = reader->read(std::span(piece));
    TACTO_TRY(got);
    if (*got == 0 && done == 0) return fail(ErrorKind::malformed, "contains no samples", source.file);
    if (*got == 0) return {};
    const auto chosen = choose(source, columns, done, std::span(piece).first(*got * channels), rows);
    if (!chosen) return chosen;
    if (const auto taken = take({rows, columns.size(), done}); !taken) return taken;
    done += *got;
    progress(static_cast<double>(done) / static_cast<double>(std::max(reader->info().frames, done)));
  }
}

Result<Source> open_sound(const std::string& file, std::size_t skip) {
  if (skip == 0) return open_audio(file);
  return fail(ErrorKind::usage, "has no lines to skip", file, "omit --skip: this is not a table");
}

Result<Source> open_mat(const std::string& file, std::size_t skip) {
  if (skip > 0)
    return fail(ErrorKind::usage, "has no lines to skip", file, "omit --skip: this is a MATLAB file");
  auto contents = schema::mat_contents(file);
  TACTO_TRY(contents);
  Source source{file, {}, std::nullopt, std::nullopt, 0, contents->format};
  for (const schema::MatColumn& column : contents->columns) {
    source.columns.push_back(column.name);
    source.units.push_back(schema::split_unit(column.array).unit);
  }
  source.mat = std::move(*contents);
  return source;
}

// Reads the selected columns whole, and passes them on in blocks of rows.
Result<void> read_mat_source(const Source& source, std::span<const std::size_t> columns,
                             const RowHandler& take, const std::function<void(double)>& progress) {
  std::vector<schema::MatColumn> chosen;
  for (const std::size_t column : columns) chosen.push_back(source.mat->columns[column]);
  const auto values = schema::read_mat(source.file, chosen);
  TACTO_TRY(values);
  const std::uint64_t all = chosen[0].rows;
  const std::uint64_t piece = std::max<std::uint64_t>(kPieceSamples / columns.size(), 1);
  std::vector<double> rows;
  for (std::uint64_t done = 0; done < all; done += piece) {
    rows.clear();
    for (std::uint64_t i = done; i < std::min(done + piece, all); ++i)
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const double value = (*values)[k][i];
        if (std::isinf(value) || (std::isnan(value) && !source.unknown_as_nan))
          return not_finite(source, i, columns[k], value);
        rows.push_back(value);
      }
    TACTO_TRY(take({rows, columns.size(), done}));
    progress(static_cast<double>(std::min(done + piece, all)) / static_cast<double>(all));
  }
  return {};
}

std::string streams_in_words(const std::vector<schema::XdfStream>& streams) {
  std::string words;
  for (const schema::XdfStream& stream : streams)
    words += fmt::format("{}{} '{}'", words.empty() ? "" : ", ", stream.id, stream.name);
  return words;
}

// The stream of a name or number; without one the only stream of numbers. No stream if there are several.
Result<std::optional<schema::XdfStream>> chosen_stream(const std::string& file, const std::string& wanted,
                                                       const std::vector<schema::XdfStream>& streams) {
  std::vector<const schema::XdfStream*> found;
  for (const schema::XdfStream& stream : streams)
    if (wanted.empty() ? stream.refusal.empty() : stream.name == wanted) found.push_back(&stream);
  for (const schema::XdfStream& stream : streams)
    if (found.empty() && wanted == std::to_string(stream.id)) found.push_back(&stream);
  const std::string all = streams_in_words(streams);
  if (wanted.empty() && found.size() != 1) return std::optional<schema::XdfStream>();
  if (found.empty())
    return fail(ErrorKind::usage, fmt::format("there is no stream '{}'", wanted), file,
                "the streams are: " + all);
  if (found.size() > 1)
    return fail(ErrorKind::usage, fmt::format("several streams have the name '{}'", wanted), file,
                "choose one by its number: " + all);
  if (!found[0]->refusal.empty())
    return fail(ErrorKind::unsuitable, found[0]->refusal, fmt::format("{}: stream '{}'", file, wanted),
                "import takes streams of numbers");
  return std::optional(*found[0]);
}

Result<Source> open_xdf(const std::string& file, std::size_t skip, const std::string& wanted) {
  if (skip > 0)
    return fail(ErrorKind::usage, "has no lines to skip", file, "omit --skip: this is an XDF file");
  auto contents = schema::xdf_contents(file);
  TACTO_TRY(contents);
  Source source{file, {}, std::nullopt, std::nullopt, 0, "XDF 1.0 (Lab Streaming Layer)"};
  auto stream = chosen_stream(file, wanted, contents->streams);
  TACTO_TRY(stream);
  source.xdf = std::move(*contents);
  source.xdf_stream = std::move(*stream);
  if (!source.xdf_stream) return source;
  source.columns = source.xdf_stream->labels;
  for (std::size_t k = 0; k < source.columns.size(); ++k) {
    const std::string& unit = source.xdf_stream->units[k];
    source.units.push_back(unit.empty() ? schema::split_unit(source.columns[k]).unit : unit);
  }
  return source;
}

Result<void> read_xdf_source(const Source& source, std::span<const std::size_t> columns,
                             const RowHandler& take, const std::function<void(double)>& progress) {
  std::uint64_t done = 0;
  const auto take_block = [&](std::span<const double> times_s,
                              std::span<const double> numbers) -> Result<void> {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (std::isinf(numbers[i]) || (std::isnan(numbers[i]) && !source.unknown_as_nan))
        return not_finite(source, done + i / columns.size(), columns[i % columns.size()], numbers[i]);
    TACTO_TRY(take({numbers, columns.size(), done}));
    done += times_s.size();
    return {};
  };
  TACTO_TRY(schema::read_xdf(source.file, *source.xdf_stream, columns, take_block, progress));
  if (done > 0) return {};
  return fail(ErrorKind::malformed, "contains no samples",
              fmt::format("{}: stream '{}'", source.file, source.xdf_stream->name), source.xdf->cut);
}

// A file of another program that import does not read.
struct ForeignFormat {
  std::string_view what;      // "a TDMS file of LabVIEW"
  std::string_view remedy;    // the export to use, until there is a reader for the format
  bool may_be_sound = false;  // libsndfile writes and reads audio in files of this kind
};

constexpr std::string_view kMatlab = "in MATLAB load it and save it again with save('trial.mat', '-v7')";
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
constexpr std::string_view kX3p = "with the ending .x3p, import takes it as a height profile";
constexpr std::string_view kUnpack = "unpack it, then import its contents";
constexpr std::string_view kExport = "export it as CSV in the program that made it, then import that";
constexpr std::string_view kDownload = "it is a web page: download the file itself";

struct Magic {
  std::string_view bytes;
  ForeignFormat format;
};

constexpr Magic kMagics[] = {
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
    {"bindata/"sv, {"an X3P height profile (ISO 25178-72)", kX3p}},
    {"main.xml"sv, {"an X3P height profile (ISO 25178-72)", kX3p}},
    {"xl/"sv, {"an Excel workbook", kSheet}},
    {"application/vnd.oasis.opendocument.spreadsheet"sv, {"an OpenDocument sheet", kSheet}},
    {".npy"sv, {"an archive of NumPy arrays", kHdf5}},
};

struct Ending {
  std::string_view ending;
  ForeignFormat format;
};

constexpr Ending kEndings[] = {
    {".x3p", {"an X3P height profile (ISO 25178-72)", kX3p}},
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

// The kind of a file from its first bytes (some hundred are sufficient for most kinds). `file` is its name:
// its extension shows the kind of an archive, or a MATLAB 4 file. nullopt for text and anything else.
std::optional<ForeignFormat> foreign_format(const std::string& file, std::string_view head) {
  const std::string name = lower_case(file);
  if (head.starts_with("PK\x03\x04"sv)) return archived_format(name, head);
  for (const auto& [bytes, format] : kMagics)
    if (head.starts_with(bytes)) return format;
  const bool is_text = head.find('\0') == std::string_view::npos;
  if (name.ends_with(".mat") && !is_text) return ForeignFormat{"a MATLAB file (version 4)", kMatlab, true};
  return std::nullopt;
}

// libsndfile reads the numbers of any MATLAB file as audio. Only its own files have these two variables.
bool is_sound_in_mat(std::string_view head) {
  return head.find("samplerate") != std::string_view::npos && head.find("wavedata") != std::string_view::npos;
}

Result<Source> open_foreign(const std::string& file, const ForeignFormat& format, std::string_view head) {
  if (format.may_be_sound && is_sound_in_mat(head)) return open_audio(file);
  return fail(ErrorKind::unsuitable, fmt::format("is {}, which import does not read", format.what), file,
              std::string(format.remedy));
}

// Audio files have zero bytes near the beginning, text has none; UTF-16 has them too and is a table that the
// user has to convert.
bool is_binary(std::string_view head) {
  const bool utf16 = head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF");
  return !utf16 && head.find('\0') != std::string_view::npos;
}

bool is_json(const std::string& file, std::string_view head) {
  const auto first = head.find_first_not_of(" \t\r\n");
  return file.ends_with(".json") || (first != std::string_view::npos && head[first] == '{');
}

Result<void> refuse_own(const std::string& file, std::string_view head) {
  if (is_json(file, head))
    return fail(ErrorKind::unsuitable, "is JSON, not a table or a sound file", file,
                "a recording needs no import: see 'tactograph info'");
  if (file.ends_with(".texture.wav"))
    return fail(ErrorKind::unsuitable, "is already a texture", file, "see 'tactograph info'");
  if (file.ends_with(".wav") && schema::open_recording(file))
    return fail(ErrorKind::unsuitable, "is already a recording", file, "see 'tactograph info'");
  return {};
}

// Values in the order in which they were pushed. Each function is safe in every thread.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t most) : most_(most) {}

  // Waits while the queue is full. Returns false and drops the value if the queue is closed.
  bool push(T value) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || values_.size() < most_; });
    if (closed_) return false;
    values_.push_back(std::move(value));
    changed_.notify_all();
    return true;
  }

  // Waits for a value; returns none if the queue is closed and empty.
  std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !values_.empty(); });
    return taken();
  }

  // As pop(), without waiting.
  std::optional<T> try_pop() {
    const std::lock_guard lock(mutex_);
    return taken();
  }

  // Later values are dropped; those in the queue can still be popped.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::optional<T> taken() {
    if (values_.empty()) return std::nullopt;
    std::optional<T> value(std::move(values_.front()));
    values_.pop_front();
    changed_.notify_all();
    return value;
  }

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> values_;
  bool closed_ = false;
};

// Reads a table with three threads: one reads the file and computes its checksum, one parses, and the
// caller's thread receives the rows. Reads one table once, from its beginning to its end. The blocks of rows
// depend on the file alone, and an error follows the rows before it, as with one thread. Memory: a few pieces
// of the file and their numbers, for a file of any length.
class TableStages {
 public:
  // `sum`, if given, receives the file's bytes; it is complete after run() has returned without an error.
  TableStages(const Source& source, std::span<const std::size_t> columns, schema::Sha256* sum);
  TableStages(const TableStages&) = delete;
  TableStages& operator=(const TableStages&) = delete;
  ~TableStages() = default;

  // Calls `take` and `progress` in the caller's thread. To be called once. Errors: those of read_source().
  schema::Result<void> run(const RowHandler& take, const std::function<void(double)>& progress);

 private:
  struct Piece {
    std::shared_ptr<const char[]> bytes;
    std::size_t size = 0;
  };
  // The rows that end in one piece.
  struct Rows {
    NumberStore numbers;
    std::uint64_t first_row = 0;
    std::deque<CsvReader::Landmark> landmarks;
    char decimal_mark = 0;
    std::size_t bytes = 0;  // of the piece
  };

  void read_pieces(InputFile input);
  void parse_pieces();
  schema::Result<void> parse();
  bool hand_over(std::size_t bytes);
  schema::Result<void> take_all(const RowHandler& take, const std::function<void(double)>& progress,
                                std::size_t file_bytes);
  void close_all();
  struct CloseAll {
    void operator()(TableStages* stages) const { stages->close_all(); }
  };
  schema::Result<void> run_stages(InputFile input, const RowHandler& take,
                                  const std::function<void(double)>& progress);

  const Source& source_;
  const std::size_t columns_;
  schema::Sha256* const sum_;
  CsvReader reader_;  // of the thread that parses
  BoundedQueue<schema::Result<Piece>> pieces_;
  BoundedQueue<schema::Result<Rows>> rows_;
  BoundedQueue<NumberStore> spare_;
  std::exception_ptr reading_failed_, parsing_failed_;  // out of memory; thrown again in the caller's thread
};

constexpr std::size_t kWaiting = 4;  // pieces between two threads

TableStages::TableStages(const Source& source, std::span<const std::size_t> columns, schema::Sha256* sum)
    : source_(source),
      columns_(columns.size()),
      sum_(sum),
      reader_(*source.csv, {columns.begin(), columns.end()}, source.file),
      pieces_(kWaiting),
      rows_(kWaiting),
      spare_(2 * kWaiting) {}

// The checksum is computed after the piece was passed on, so that the parser does not wait for it.
void TableStages::read_pieces(InputFile input) try {
  for (;;) {
    auto bytes = std::make_shared_for_overwrite<char[]>(kPieceBytes);
    const auto got = input.read({bytes.get(), kPieceBytes});
    if (!got) {
      pieces_.push(schema::forward_error(got));
      break;
    }
    if (*got == 0 || !pieces_.push(Piece{bytes, *got})) break;
    if (sum_ != nullptr) sum_->add({bytes.get(), *got});
  }
  pieces_.close();
} catch (...) {
  reading_failed_ = std::current_exception();
  close_all();
}

void TableStages::parse_pieces() try {
  if (const auto parsed = parse(); !parsed) rows_.push(schema::forward_error(parsed));
  rows_.close();
  pieces_.close();  // after an error the rest is not needed
} catch (...) {
  parsing_failed_ = std::current_exception();
  close_all();
}

Result<void> TableStages::parse() {
  std::size_t skipped = source_.csv->data_offset;
  while (const auto piece = pieces_.pop()) {
    TACTO_TRY(*piece);
    std::string_view bytes((*piece)->bytes.get(), (*piece)->size);
    const std::size_t passed = std::min(skipped, bytes.size());
    bytes.remove_prefix(passed);
    skipped -= passed;
    TACTO_TRY(reader_.feed(bytes));
    if (!hand_over((*piece)->size)) return {};
  }
  TACTO_TRY(reader_.finish());
  hand_over(0);
  return {};
}

// Returns false if the caller receives no further rows.
bool TableStages::hand_over(std::size_t bytes) {
  Rows rows;
  rows.numbers = spare_.try_pop().value_or(NumberStore{});
  rows.first_row = reader_.first_row();
  rows.landmarks = reader_.landmarks();
  rows.decimal_mark = reader_.decimal_mark();
  rows.bytes = bytes;
  reader_.exchange_rows(rows.numbers);
  return rows_.push(std::move(rows));
}

Result<void> TableStages::take_all(const RowHandler& take, const std::function<void(double)>& progress,
                                   std::size_t file_bytes) {
  std::size_t done = 0;
  while (auto next = rows_.pop()) {
    TACTO_TRY(*next);
    Rows& rows = **next;
    if (rows.numbers.count > 0)
      TACTO_TRY(take({rows.numbers.span(), columns_, rows.first_row, &rows.landmarks, rows.decimal_mark}));
    done += rows.bytes;
    if (rows.bytes > 0) progress(static_cast<double>(done) / static_cast<double>(std::max(file_bytes, done)));
    rows.numbers.count = 0;
    spare_.push(std::move(rows.numbers));
  }
  return {};
}

void TableStages::close_all() {
  pieces_.close();
  rows_.close();
}

Result<void> TableStages::run_stages(InputFile input, const RowHandler& take,
                                     const std::function<void(double)>& progress) {
  const std::size_t file_bytes = input.size();
  const std::jthread reading(&TableStages::read_pieces, this, std::move(input));
  const std::jthread parsing(&TableStages::parse_pieces, this);
  const std::unique_ptr<TableStages, CloseAll> closing(this);  // wakes threads that wait, so that they end
  return take_all(take, progress, file_bytes);
}

Result<void> TableStages::run(const RowHandler& take, const std::function<void(double)>& progress) {
  auto input = InputFile::open(source_.file);
  TACTO_TRY(input);
  const auto done = run_stages(std::move(*input), take, progress);
  for (const auto& failed : {reading_failed_, parsing_failed_})
    if (failed) std::rethrow_exception(failed);
  return done;
}

}  // namespace

std::string RowBlock::place_of(std::uint64_t row) const {
  if (landmarks == nullptr) return fmt::format("sample {}", row);
  return fmt::format("line {}", line_of_row(*landmarks, row));
}

std::string columns_in_words(const std::vector<std::string>& columns) {
  std::string list;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", i + 1);
    if (!columns[i].empty()) list += fmt::format(" '{}'", columns[i]);
  }
  return list;
}

Result<Source> open_source(const std::string& file, std::size_t skip, const std::string& stream) {
  auto input = InputFile::open(file);
  TACTO_TRY(input);
  std::string head(kLayoutBytes, '\0');
  const auto got = input->read(head);
  TACTO_TRY(got);
  const bool whole = *got < head.size();
  head.resize(*got);
  TACTO_TRY(refuse_own(file, head));
  if (schema::is_mat(head) && !is_sound_in_mat(head)) return open_mat(file, skip);
  if (schema::is_mat(head)) return open_audio(file);
  if (schema::is_xdf(head)) return open_xdf(file, skip, stream);
  if (const auto foreign = foreign_format(file, head)) return open_foreign(file, *foreign, head);
  if (is_binary(head)) return open_sound(file, skip);
  if (lower_case(file).ends_with(".mat"))
    return fail(
        ErrorKind::malformed, "is no MATLAB file of version 5 or 7.3", file,
        "if it was cut, copy it again; in MATLAB or Octave save it with -v7; a table of text needs another "
        "ending, such as .txt");
  return open_table(file, head, whole, skip);
}

namespace {

// Other readers read the file themselves, so its bytes are read once more for the sum.
Result<void> add_file(const std::string& file, schema::Sha256& sum) {
  auto input = InputFile::open(file);
  TACTO_TRY(input);
  std::string piece(kPieceBytes, '\0');
  for (;;) {
    const auto got = input->read(piece);
    TACTO_TRY(got);
    if (*got == 0) return {};
    sum.add(std::string_view(piece).substr(0, *got));
  }
}

}  // namespace

Result<void> read_source(const Source& source, std::span<const std::size_t> columns, const RowHandler& take,
                         const std::function<void(double)>& progress, schema::Sha256* sum) {
  if (source.csv) return TableStages(source, columns, sum).run(take, progress);
  const auto read = source.mat          ? read_mat_source(source, columns, take, progress)
                    : source.xdf_stream ? read_xdf_source(source, columns, take, progress)
                                        : read_audio(source, columns, take, progress);
  return read && sum != nullptr ? add_file(source.file, *sum) : read;
}

}  // namespace tacto::capture
