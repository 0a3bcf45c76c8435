// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/table_stages.hpp"

#include <algorithm>
#include <string_view>

namespace tacto::capture {
namespace {

using schema::Result;

constexpr std::size_t kTablePieceBytes = std::size_t{1} << 17;  // fits the cache together with its numbers
constexpr std::size_t kWaiting = 4;                             // pieces between two threads

}  // namespace

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
    auto bytes = std::make_shared_for_overwrite<char[]>(kTablePieceBytes);
    const auto got = input.read({bytes.get(), kTablePieceBytes});
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

}  // namespace tacto::capture
