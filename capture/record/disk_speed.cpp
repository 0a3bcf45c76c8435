// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/disk_speed.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::size_t kSyncs = 20, kTrialBytes = 1 << 20, kPieces = 16;

// A file whose name is removed as soon as it is open.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& folder) {
    std::string name = folder + "/.tactograph-doctor-XXXXXX";
    handle_ = mkstemp(name.data());
    if (handle_ >= 0) unlink(name.c_str());
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    if (handle_ >= 0) close(handle_);
  }

  bool is_open() const { return handle_ >= 0; }
  bool write_synced(const std::vector<char>& bytes) const {
    return write_all(bytes) && fdatasync(handle_) == 0;
  }
  bool write_all(const std::vector<char>& bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const auto written = write(handle_, bytes.data() + done, bytes.size() - done);
      if (written <= 0) return false;
      done += static_cast<std::size_t>(written);
    }
    return true;
  }
  bool sync() const { return fsync(handle_) == 0; }

 private:
  int handle_;
};

tl::unexpected<schema::Error> refused(const std::string& folder) {
  return schema::fail(ErrorKind::cannot_write, std::string("cannot be written to: ") + std::strerror(errno),
                      folder, "record to another folder, or check the owner of this one");
}

template <class Job>
double seconds_of(Job job) {
  const auto begun = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace

Result<DiskSpeed> measure_disk(const std::string& folder, std::size_t block_bytes) {
  const ScratchFile file(folder);
  if (!file.is_open()) return refused(folder);
  bool written = true;
  const std::vector<char> block(block_bytes, 'x'), piece(kTrialBytes, 'x');
  std::vector<double> syncs_s;
  for (std::size_t i = 0; i < kSyncs; ++i)
    syncs_s.push_back(seconds_of([&] { written = written && file.write_synced(block); }));
  const double all_s = seconds_of([&] {
    for (std::size_t i = 0; i < kPieces; ++i) written = written && file.write_all(piece);
    written = written && file.sync();
  });
  if (!written) return refused(folder);
  std::ranges::sort(syncs_s);
  std::error_code unknown;
  const auto space = std::filesystem::space(folder, unknown);
  return DiskSpeed{unknown ? 0 : static_cast<double>(space.available), kPieces * kTrialBytes / all_s,
                   syncs_s[kSyncs / 2], syncs_s.back()};
}

}  // namespace tacto::capture
