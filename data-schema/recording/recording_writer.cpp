// SPDX-License-Identifier: GPL-3.0-or-later
#include <cassert>
#include <filesystem>

#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/recording_place.hpp"

namespace tacto::schema {
namespace fs = std::filesystem;

struct RecordingWriter::State {
  std::string stem;
  RecordingHeader header;
  PendingFiles pending;
  Existing existing = Existing::keep;
  std::string temporary_wav;
  std::optional<WavWriter> wav;

  template <class Sample>
  Result<void> write(std::span<const Sample> interleaved) {
    header.frames += interleaved.size() / header.channels.size();
    return wav->write(interleaved);
  }
  Result<void> describe();
};

RecordingWriter::RecordingWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;
RecordingWriter::~RecordingWriter() = default;

Result<RecordingWriter> RecordingWriter::create(const std::string& name, RecordingHeader header,
                                                bool replace) {
  auto state = std::make_unique<State>();
  state->stem = stem_of(name, "");
  TACTO_TRY(check_stem(state->stem));
  if (const auto free = check_free(state->stem); !replace && !free) return forward_error(free);
  const std::string wav = state->stem + ".wav";
  header.wav_file = fs::path(wav).filename().string();
  header.frames = 0;
  TACTO_TRY(check_storable(header));
  const auto temporary = state->pending.add(wav);
  TACTO_TRY(temporary);
  auto writer = WavWriter::create(*temporary, header.sample_rate_hz, header.channels.size(), header.format);
  TACTO_TRY(writer);
  state->temporary_wav = *temporary;
  state->header = std::move(header);
  if (replace) state->existing = Existing::replace;
  state->wav.emplace(std::move(*writer));
  return RecordingWriter(std::move(state));
}

Result<void> RecordingWriter::write(std::span<const double> interleaved) {
  return state_->write(interleaved);
}

Result<void> RecordingWriter::write(std::span<const std::int32_t> interleaved) {
  return state_->write(interleaved);
}

RecordingHeader& RecordingWriter::header() {
  return state_->header;
}

Result<void> RecordingWriter::State::describe() {
  const auto text = completed_sidecar(header, temporary_wav);
  return text ? pending.write(stem + ".json", *text) : forward_error(text);
}

Result<Recording> RecordingWriter::close() {
  assert(state_->wav);
  const auto closed = state_->wav->close_at(state_->header.sample_rate_hz);
  state_->wav.reset();
  TACTO_TRY(closed);
  TACTO_TRY(state_->describe());
  TACTO_TRY(state_->pending.commit(state_->existing));
  return Recording{state_->header, state_->stem};
}

}  // namespace tacto::schema
