// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/pending_names.hpp"

#include <unistd.h>

namespace tacto::schema {

PendingName* PendingNames::keep(const std::string& path) {
  const std::lock_guard lock(mutex_);
  PendingName* name = nullptr;
  if (free_.empty()) {
    name = new PendingName;  // never deleted: a signal handler may read it at any time
    name->next = first_.load();
    first_.store(name);
  } else {
    name = free_.back();
    free_.pop_back();
  }
  name->path = path;
  name->there.store(true);
  return name;
}

void PendingNames::forget(PendingName* name) {
  const std::lock_guard lock(mutex_);
  name->there.store(false);
  free_.push_back(name);
}

void PendingNames::remove_all() const noexcept {
  for (const PendingName* name = first_.load(); name != nullptr; name = name->next)
    if (name->there.load()) unlink(name->path.c_str());
  // An outer folder is empty only when the inner ones are removed.
  for (bool removed = true; removed;) {
    removed = false;
    for (const PendingName* name = first_.load(); name != nullptr; name = name->next)
      removed |= name->there.load() && rmdir(name->path.c_str()) == 0;
  }
}

// Never destroyed: objects that outlive it may have pending files.
PendingNames& pending_names() {
  static PendingNames& names = *new PendingNames;
  return names;
}

}  // namespace tacto::schema
