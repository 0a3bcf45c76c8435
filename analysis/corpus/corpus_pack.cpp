// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_pack.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/corpus/corpus_status.hpp"
#include "analysis/corpus/corpus_unit.hpp"
#include "analysis/corpus/work_folder.hpp"
#include "data-schema/base/table_text.hpp"
#include "data-schema/corpus/subject_codes.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/version.hpp"
#include "data-schema/wav/riff_layout.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;

constexpr std::string_view kNumbersOnly[] = {"data", "ds64", "fmt ", "fact", "PEAK"};  // chunks of a WAV
constexpr const char *kCrate = "ro-crate-metadata.json", *kTable = "recordings.csv";

bool is_inside(const fs::path& path, const fs::path& folder) {
  const fs::path from = path.lexically_relative(folder);
  return !from.empty() && *from.begin() != "..";
}

// --force removes only what `pack` wrote: each file is in SHA256SUMS and unchanged. The first other one is
// named.
Result<void> check_replaceable(const fs::path& output) {
  const auto text = schema::read_file((output / kSums).string());
  TACTO_TRY(text);
  std::map<std::string, std::string> sums;  // by path
  std::istringstream lines(*text);
  for (std::string sum, path; lines >> sum && std::getline(lines >> std::ws, path);) sums[path] = sum;
  std::vector<std::string> paths;
  std::error_code failed;
  for (fs::recursive_directory_iterator at(output, failed), end; !failed && at != end; at.increment(failed))
    if (at->is_symlink(failed) || !at->is_directory(failed)) paths.push_back(at->path().string());
  if (failed)
    return schema::fail(ErrorKind::not_found, "cannot be listed: " + failed.message(), output.string());
  std::ranges::sort(paths);
  for (const std::string& path : paths) {
    const auto listed = sums.find(fs::path(path).lexically_relative(output).string());
    if (path == (output / kSums).string()) continue;
    const auto sum = listed == sums.end() ? std::string() : schema::sha256_of_file(path).value_or("");
    if (sum.empty() || sum != listed->second)
      return schema::fail(ErrorKind::usage, "is not a file that 'corpus pack' wrote, or was changed since",
                          path, "move it to another folder, or choose another output");
  }
  return {};
}

// Before any work is done. --force replaces a folder only if nothing but a former dataset is lost.
Result<void> check_output(const CorpusPackOptions& options, const schema::CorpusPlan& plan) {
  const fs::path output = schema::canonical_path(options.output);
  std::error_code failed;
  if (is_inside(schema::canonical_path(options.study), output))
    return schema::fail(ErrorKind::usage, "contains the study", options.output, "choose another folder");
  for (const schema::CorpusRecording& recording : plan.recordings)
    if (is_inside(path_of(options.study, recording), output))
      return schema::fail(ErrorKind::usage, "contains recordings of the plan", options.output,
                          "choose another folder");
  if (!fs::exists(output, failed)) return {};
  if (fs::is_directory(output, failed) && fs::is_empty(output, failed)) return {};
  if (!schema::is_file((output / kCrate).string()) || !schema::is_file((output / kSums).string()))
    return schema::fail(ErrorKind::usage, "exists, and is not a dataset that 'corpus pack' wrote",
                        options.output, "choose another folder");
  if (options.existing == schema::Existing::replace) return check_replaceable(output);
  return schema::fail(ErrorKind::usage, "exists already", options.output, "--force replaces it");
}

// Results of another recording than the one that is packed would be worse than none.
Result<void> check_unchanged(const CorpusPackOptions& options, const CorpusStatus& status) {
  for (const CorpusUnitStatus& each : status.units)
    if (each.unit.state == UnitState::done && std::ranges::binary_search(status.changed, each.recording))
      return schema::fail(ErrorKind::unsuitable, "has changed since 'corpus init'",
                          path_of(options.study, status.plan.recordings[each.recording]),
                          "restore it, or make a new plan with 'tactograph corpus init --force'");
  return {};
}

Result<std::string> written(const std::string& path, const std::string& text) {
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(path, text));
  TACTO_TRY(pending.commit(schema::Existing::keep, schema::Sync::by_caller));
  return path;
}

void replace_all(std::string& text, const std::string& before, const std::string& after) {
  for (std::size_t at = 0; (at = text.find(before, at)) != std::string::npos; at += after.size())
    text.replace(at, before.size(), after);
}

std::string part_of(const std::string& path, std::uint64_t from, std::uint64_t bytes) {
  std::ifstream file(path, std::ios::binary);
  std::string part(bytes, '\0');
  file.seekg(static_cast<std::streamoff>(from));
  file.read(part.data(), static_cast<std::streamsize>(bytes));
  return part;
}

// What of a recording is in the dataset.
struct Packed {
  std::optional<schema::RecordingHeader> header;  ///< none: its files are left out
  std::string because;                            ///< of a failure
  bool damaged = false;                           ///< the recording is not what its checksums say
  std::vector<std::string> units;                 ///< folders
  std::size_t textures = 0;
  bool has_warnings = false;
};

class Packing {
 public:
  Packing(const CorpusPackOptions& options, const CorpusStatus& status, std::string folder)
      : options_(options),
        status_(status),
        folder_(std::move(folder)),
        recordings_(status.plan.recordings.size()) {}

  Result<CorpusPack> pack(const std::function<void(double)>& progress, const std::function<bool()>& stopped) {
    TACTO_TRY(collect());
    TACTO_TRY(make_folder(folder_ + "/recordings"));
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      if (stopped())
        return schema::fail(ErrorKind::unsuitable, "was stopped; nothing was written", options_.output);
      TACTO_TRY(pack_recording(i));
      progress(static_cast<double>(i + 1) / static_cast<double>(recordings_.size()));
    }
    TACTO_TRY(write_table());
    TACTO_TRY(write_crate());
    TACTO_TRY(write_sums());
    TACTO_TRY(sync_file_system(folder_));
    made_.recordings = recordings_.size();
    made_.files = sums_.size() + 1;
    return made_;
  }

 private:
  // Headers, units and the subjects of all recordings: a code may also be in the notes of another one.
  Result<void> collect() {
    for (const CorpusUnitStatus& each : status_.units) {
      Packed& packed = recordings_[each.recording];
      packed.because = each.unit.because;
      packed.has_warnings = packed.has_warnings || each.unit.has_warnings;
      packed.damaged = packed.damaged || each.unit.may_succeed;
      if (each.unit.state == UnitState::done) packed.units.push_back(each.folder);
    }
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      const std::string path = path_of(options_.study, status_.plan.recordings[i]);
      auto opened = schema::open_recording(path);
      if (!opened) continue;
      if (!options_.with_subjects && !codes_.add(opened->header.subject))
        return schema::fail(
            ErrorKind::unsuitable,
            fmt::format("has a subject whose code is not ASCII, '{}': not all of its spellings "
                        "would be found",
                        opened->header.subject),
            path,
            "change the code, then 'tactograph corpus init --force', or publish with "
            "--with-subjects");
      if (!recordings_[i].damaged) recordings_[i].header = std::move(opened->header);
    }
    return {};
  }

  Result<void> pack_recording(std::size_t i) {
    Packed& packed = recordings_[i];
    const fs::path source = path_of(options_.study, status_.plan.recordings[i]);
    const std::string number = fmt::format("{:05}", i + 1), before = source.stem().string();
    // The subject of a damaged sidecar is unknown.
    const bool renamed = codes_.in(before) || (!packed.header && !options_.with_subjects);
    const schema::NewStem stem{before, renamed ? number : before};
    names_.push_back(stem.after);
    replace_all(packed.because, before, stem.after);
    if (!packed.header) {
      ++made_.left_out;
      return {};
    }
    if (renamed) ++made_.renamed;
    schema::CrateFolder folder{"recordings/" + number + "/", stem.after, {}};
    const std::string wav = (source.parent_path() / packed.header->wav_file).string();
    TACTO_TRY(make_folder(folder_ + "/" + folder.path));
    TACTO_TRY(pack_file(source.string(), stem, folder));
    TACTO_TRY(pack_file(wav, stem, folder));
    for (const std::string& unit : packed.units) {
      std::vector<std::string> paths;
      std::error_code failed;
      for (fs::directory_iterator at(unit, failed), end; !failed && at != end; at.increment(failed))
        if (at->path().filename() != kSums) paths.push_back(at->path().string());
      if (failed) return schema::fail(ErrorKind::not_found, "cannot be listed: " + failed.message(), unit);
      std::ranges::sort(paths);
      for (const std::string& path : paths) {
        if (path.ends_with(".texture.json")) ++packed.textures;
        TACTO_TRY(pack_file(path, stem, folder));
      }
    }
    crate_.folders.push_back(std::move(folder));
    return {};
  }

  Result<void> pack_file(const std::string& source, const schema::NewStem& stem,
                         schema::CrateFolder& folder) {
    const std::string name = fs::path(source).filename().string();
    const std::string path =
        folder.path + (name == kWarnings ? name : schema::with_new_stem(name, stem, codes_));
    if (codes_.empty() || name.ends_with(".wav")) {
      TACTO_TRY(check_wav_text(source));
      std::error_code failed;
      if (!fs::copy_file(source, folder_ + "/" + path, failed))
        return unwritable(folder_ + "/" + path, failed.value());
    } else if (name.ends_with(".json")) {
      const auto text = schema::without_subjects(source, stem, codes_);
      TACTO_TRY(text);
      TACTO_TRY(written(folder_ + "/" + path, *text));
    } else if (name == kWarnings) {
      auto text = schema::read_file(source);
      TACTO_TRY(text);
      replace_all(*text, stem.before, stem.after);
      TACTO_TRY(written(folder_ + "/" + path, codes_.without(*text)));
    } else {
      return schema::fail(ErrorKind::internal, "is of a kind in which subjects cannot be hidden", source);
    }
    return add_file(path, folder.files);
  }

  // The parts of a WAV before and after its samples may hold text of another program; a chunk "JUNK" is often
  // one that was removed by renaming it.
  Result<void> check_wav_text(const std::string& source) const {
    if (codes_.empty()) return {};
    const auto layout = schema::riff_layout(source);
    if (!layout) return schema::fail(ErrorKind::malformed, "is not a WAV", source);
    constexpr std::uint64_t kHead = 8;  // of a chunk: name, size
    const std::uint64_t file_end = layout->data_at + layout->present_bytes;
    for (std::uint64_t at = 12; at < file_end;) {  // after the words RIFF and WAVE
      const std::string head = part_of(source, at, std::min(kHead, file_end - at)), name = head.substr(0, 4);
      std::uint64_t bytes = 0;
      for (std::size_t i = head.size(); i-- > 4;) bytes = bytes << 8 | static_cast<unsigned char>(head[i]);
      if (name == "data" && layout->wide) bytes = layout->data_bytes_64;
      const bool is_chunk = head.size() == kHead && bytes <= file_end - at - kHead;  // else other bytes
      const std::uint64_t from = is_chunk ? at + kHead : at, end = is_chunk ? from + bytes : file_end;
      if (std::ranges::find(kNumbersOnly, name) == std::end(kNumbersOnly) &&
          codes_.in(part_of(source, from, end - from)))
        return schema::fail(ErrorKind::unsuitable, "has the code of a subject beside its samples", source,
                            "remove that text, or publish with --with-subjects");
      at = end + bytes % 2;
    }
    return {};
  }

  Result<void> add_file(const std::string& path, std::vector<schema::CrateFile>& files,
                        const std::string& description = {}) {
    auto sum = schema::sha256_of_file(folder_ + "/" + path);
    TACTO_TRY(sum);
    std::error_code failed;
    files.push_back({path, fs::file_size(folder_ + "/" + path, failed), description});
    sums_.emplace(path, std::move(*sum));
    return {};
  }

  std::string row(std::size_t i) const {
    const Packed& packed = recordings_[i];
    const auto text = [&](const std::string& value) { return schema::csv_cell(codes_.without(value)); };
    std::string line = fmt::format("{},{}", i + 1, schema::csv_cell(names_[i]));
    if (options_.with_subjects) line += "," + (packed.header ? schema::csv_cell(packed.header->subject) : "");
    if (packed.header) {
      const schema::RecordingHeader& header = *packed.header;
      std::vector<std::string> quantities;
      for (const schema::Channel& channel : header.channels) quantities.push_back(channel.quantity);
      line += fmt::format(",{},{},{},{},{},{},{},{},{},{}", text(header.surface), text(header.finger),
                          header.recorded, header.created, schema::csv_number(schema::duration_s(header)),
                          schema::csv_number(header.sample_rate_hz), fmt::join(quantities, " "),
                          text(header.device), text(header.simulated), header.sha256);
    } else {
      line += std::string(10, ',');
    }
    return line + fmt::format(",{},{},{}\n", packed.textures, packed.has_warnings ? "yes" : "no",
                              text(packed.because));
  }

  Result<void> write_table() {
    std::string text = "recording,name,";
    if (options_.with_subjects) text += "subject,";
    text +=
        "surface,finger,recorded,created,duration_s,sample_rate_hz,quantities,device,simulated,wav_sha256,"
        "textures,"
        "warnings,failure\n";
    for (std::size_t i = 0; i < recordings_.size(); ++i) text += row(i);
    TACTO_TRY(written(folder_ + "/" + kTable, text));
    return add_file(kTable, crate_.files, "All recordings, one a line; their folders are recordings/NUMBER/");
  }

  Result<void> write_crate() {
    crate_.files.push_back({kSums, 0, "SHA-256 of all other files, for sha256sum -c"});
    crate_.citation = options_.citation;
    crate_.program = status_.plan.creator;
    std::vector<std::string> steps;
    for (const schema::CorpusStep& step : status_.plan.steps)
      steps.push_back(codes_.without(step.options.empty() ? step.step : step.step + " " + step.options));
    crate_.steps = fmt::format("tactograph {}", fmt::join(steps, "; tactograph "));
    crate_.description =
        fmt::format("{} recordings of a finger on surfaces, and what {} computed of them: {}.",
                    recordings_.size(), crate_.program, crate_.steps);
    // The size of the checksums: each line has 64 digits, two blanks, the name and the line's end.
    std::uint64_t& bytes = crate_.files.back().bytes;
    constexpr std::size_t kBesideName = 67;
    for (const auto& [path, sum] : sums_) bytes += path.size() + kBesideName;
    bytes += std::string_view(kCrate).size() + kBesideName;
    const auto text = schema::ro_crate_json(crate_);
    TACTO_TRY(text);
    TACTO_TRY(written(folder_ + "/" + kCrate, *text));
    sums_.emplace(kCrate, schema::sha256_of(*text));
    return {};
  }

  Result<void> write_sums() {
    std::string text;
    for (const auto& [path, sum] : sums_) text += fmt::format("{}  {}\n", sum, path);
    TACTO_TRY(written(folder_ + "/" + kSums, text));
    return {};
  }

  const CorpusPackOptions& options_;
  const CorpusStatus& status_;
  std::string folder_;
  std::vector<Packed> recordings_;
  std::vector<std::string> names_;
  schema::SubjectCodes codes_;
  schema::Crate crate_;
  std::map<std::string, std::string> sums_;  // by path
  CorpusPack made_;
};

Result<void> publish(const std::string& made, const std::string& output, const std::string& aside) {
  std::error_code failed;
  const bool replaces = fs::exists(output, failed) && !fs::is_empty(output, failed);
  if (replaces && std::rename(output.c_str(), aside.c_str()) != 0) return unwritable(output, errno);
  if (std::rename(made.c_str(), output.c_str()) == 0) return sync_file_system(output);
  const int why = errno;
  if (replaces) std::rename(aside.c_str(), output.c_str());
  return unwritable(output, why);
}

}  // namespace

Result<CorpusPack> pack_corpus(const CorpusPackOptions& options, const std::function<void(double)>& progress,
                               const std::function<bool()>& stopped) {
  TACTO_TRY(schema::check_citation(options.citation));
  const auto plan = schema::read_corpus_plan(corpus_plan_path(options.study));
  TACTO_TRY(plan);
  TACTO_TRY(check_output(options, *plan));
  const auto status = corpus_status(options.study, true);
  TACTO_TRY(status);
  TACTO_TRY(check_unchanged(options, *status));
  if (status->missing > 0)
    return schema::fail(ErrorKind::unsuitable, fmt::format("lacks results of {} recordings", status->missing),
                        options.study, "'tactograph corpus run' makes them");
  fs::path output = schema::canonical_path(options.output);
  if (!output.has_filename()) output = output.parent_path();  // "published/"
  const WorkFolder work(output.string() + ".part");
  work.remove_ended();
  TACTO_TRY(work.make());
  auto made = Packing(options, *status, work.of("dataset")).pack(progress, stopped);
  TACTO_TRY(made);
  TACTO_TRY(publish(work.of("dataset"), output.string(), work.of("before")));
  return made;
}

}  // namespace tacto::analysis
