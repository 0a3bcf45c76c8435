// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a table with three threads: one reads the file and computes its checksum, one parses, and the
// caller's thread receives the rows.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "capture/table/csv_reader.hpp"
#include "capture/table/input_file.hpp"
#include "capture/table/source.hpp"
#include "data-schema/base/bounded_queue.hpp"

namespace tacto::capture {

/// Reads one table once, from its beginning to its end. The blocks of rows depend on the file alone, and an
/// error follows the rows before it, as with one thread. Memory: a few pieces of the file and their numbers,
/// for a file of any length.
class TableStages {
 public:
  /// `sum`, if given, receives the file's bytes; it is complete after run() has returned without an error.
  TableStages(const Source& source, std::span<const std::size_t> columns, schema::Sha256* sum);
  TableStages(const TableStages&) = delete;
  TableStages& operator=(const TableStages&) = delete;
  ~TableStages() = default;

  /// Calls `take` and `progress` in the caller's thread. To be called once. Errors: those of read_source().
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
  schema::BoundedQueue<schema::Result<Piece>> pieces_;
  schema::BoundedQueue<schema::Result<Rows>> rows_;
  schema::BoundedQueue<NumberStore> spare_;
  std::exception_ptr reading_failed_, parsing_failed_;  // out of memory; thrown again in the caller's thread
};

}  // namespace tacto::capture
