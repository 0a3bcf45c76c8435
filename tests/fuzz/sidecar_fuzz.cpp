// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as each of the JSON files, and as a journal of events. The check must find no error in a file
// that a reader accepts, except for samples and checksum.
#include "data-schema/calibration/calibration.hpp"
#include "data-schema/check/check.hpp"
#include "data-schema/corpus/corpus_plan.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/recording_events.hpp"
#include "data-schema/texture/description.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace tacto;

namespace {

template <class Value>
void sound(const std::string& path, const schema::Result<Value>& read) {
  if (!read) {
    tests::demand(!read.error().what.empty());
    return;
  }
  const auto files = schema::stored_files(path);
  tests::demand(files.has_value());
  for (const auto& file : *files) {
    const auto checked = schema::check_file(file);
    tests::demand(checked && checked->findings.empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = tests::fuzzed_file("x.json", data, size);
  sound(path, schema::read_transducer(path));
  sound(path, schema::read_device(path));
  sound(path, schema::read_hand(path));
  sound(path, schema::read_calibration(path));
  sound(path, schema::read_formants(path));
  sound(path, schema::read_descriptions(path));
  sound(path, schema::read_corpus_plan(path));
  (void)schema::open_recording(path);
  (void)schema::read_texture(path);
  if (const auto files = schema::stored_files(path))
    for (const auto& file : *files) (void)schema::check_file(file);
  (void)schema::read_events(path);
  return 0;
}
