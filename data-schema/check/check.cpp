// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/check/check.hpp"

#include <algorithm>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/corpus/corpus_plan.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/experiment/protocol.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/results/results.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "data-schema/volume/volume.hpp"
#include "data-schema/wiring/wiring.hpp"

namespace tacto::schema {
namespace {

// Errors that end the check: a missing or a newer file cannot be checked.
bool ends_the_check(const Error& error) {
  return error.kind == ErrorKind::not_found || error.kind == ErrorKind::unsupported_version ||
         error.kind == ErrorKind::internal;
}

Result<Checked> judged(const Error& error) {
  if (ends_the_check(error)) return tl::unexpected(error);
  return Checked{{finding_of(error)}, {}};
}

// Checks that a schema cannot express: the reader does them.
template <class Value>
std::vector<Finding> check_by_reading(const Result<Value>& read) {
  if (read) return {};
  return {finding_of(read.error())};
}

// The transducer of a tray is named as in a scene: a preset, or from the folder of the file.
std::vector<Finding> check_device_file(const std::string& path) {
  const auto device = read_device(path);
  if (!device) return check_by_reading(device);
  if (device->transducer.empty() || std::ranges::count(preset_names(), device->transducer) > 0) return {};
  const auto transducer = read_transducer(texture_in_scene(path, device->transducer));
  if (transducer) return {};
  return {{path + "#/transducer", message(transducer.error())}};
}

Result<Checked> check_document(const StoredFile& file, const Progress& progress) {
  const auto violations = violations_of(file.path);
  if (!violations) return judged(violations.error());
  Checked checked;
  for (const auto& [pointer, what] : *violations)
    checked.findings.push_back({file.path + "#" + pointer, what});
  if (!checked.findings.empty()) return checked;
  const auto document = open_document(file.path, kind_name(file.kind));
  if (!document) return judged(document.error());
  checked.newer_version = document->newer_version;
  checked.unknown_members = document->unknown_members;
  if (file.kind == FileKind::recording) checked.findings = check_recording(file.path, *document, progress);
  if (file.kind == FileKind::scene) checked.findings = check_scene(file.path, *document);
  if (file.kind == FileKind::transducer) checked.findings = check_by_reading(read_transducer(file.path));
  if (file.kind == FileKind::device) checked.findings = check_device_file(file.path);
  if (file.kind == FileKind::hand) checked.findings = check_by_reading(read_hand(file.path));
  if (file.kind == FileKind::protocol) checked.findings = check_by_reading(read_protocol(file.path));
  if (file.kind == FileKind::protocol_key) checked.findings = check_by_reading(read_protocol_key(file.path));
  if (file.kind == FileKind::wiring) checked.findings = check_by_reading(read_wiring(file.path));
  if (file.kind == FileKind::corpus) checked.findings = check_by_reading(read_corpus_plan(file.path));
  if (file.kind == FileKind::results) checked.findings = check_by_reading(read_results(file.path));
  if (file.kind == FileKind::texture) checked.findings = check_texture(file.path, *document, progress);
  // Its reader refuses what it does not know; then nothing is ignored.
  std::erase_if(checked.unknown_members, [&](const std::string& member) {
    return std::ranges::any_of(checked.findings,
                               [&](const Finding& each) { return each.where.ends_with("#/" + member); });
  });
  return checked;
}

template <class Value>
Result<Checked> judged_preset(const Result<Value>& read) {
  return read ? Checked{} : judged(read.error());
}

Result<Checked> check_preset(const StoredFile& preset) {
  if (preset.kind == FileKind::device) return judged_preset(read_device(preset.path));
  if (preset.kind == FileKind::hand) return judged_preset(read_hand(preset.path));
  return judged_preset(read_transducer(preset.path));
}

bool is_preset(const StoredFile& file) {
  const bool has_presets =
      file.kind == FileKind::transducer || file.kind == FileKind::device || file.kind == FileKind::hand;
  return has_presets && !file.path.ends_with(".json");
}

}  // namespace

Result<Checked> check_file(const StoredFile& file, const Progress& progress) {
  if (is_preset(file)) return check_preset(file);
  if (file.kind == FileKind::session) {
    auto checked = check_session(file.path);
    return checked ? checked : judged(checked.error());
  }
  if (file.kind == FileKind::session_table) {
    const auto table = read_session_table(file.path);
    return table ? Checked{{}, table->newer_version, {}} : judged(table.error());
  }
  if (file.kind == FileKind::height_map) {
    const auto map = read_height_map(file.path);
    return map ? Checked{{}, map->newer_version, {}} : judged(map.error());
  }
  if (file.kind == FileKind::mesh) {
    const auto mesh = read_mesh(file.path);
    return mesh ? Checked{{}, mesh->newer_version, {}} : judged(mesh.error());
  }
  if (file.kind == FileKind::volume) {
    const auto volume = read_volume(file.path);
    return volume ? Checked{{}, volume->newer_version, {}} : judged(volume.error());
  }
  if (file.kind != FileKind::spectrogram) return check_document(file, progress);
  auto checked = check_spectrogram(file.path);
  return checked ? checked : judged(checked.error());
}

}  // namespace tacto::schema
