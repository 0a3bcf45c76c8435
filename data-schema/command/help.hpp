// SPDX-License-Identifier: GPL-3.0-or-later
// The texts of `tactograph help TOPIC`, beside the help of verbs.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tacto::cli {

/// What each exit code means, from 0 on (schema::exit_code).
inline constexpr std::string_view kExitCodes[] = {"done",
                                                  "internal error",
                                                  "command line",
                                                  "file or device not found",
                                                  "malformed file",
                                                  "data that cannot be used for this",
                                                  "file of a newer version",
                                                  "cannot write",
                                                  "device failed",
                                                  "unstable"};

/// A topic of a folder, for example the keys of `sim:`.
struct HelpTopic {
  std::string_view name, summary;
  std::string (*text)();
};

/// The topics given, and those of every command (words, files, units, exit-codes).
std::vector<const HelpTopic*> all_topics(std::span<const HelpTopic* const> topics);

/// All topics, as lines "name  summary".
std::string topics_text(std::span<const HelpTopic* const> topics);

/// Names of all topics.
std::vector<std::string> topic_names(std::span<const HelpTopic* const> topics);

/// The text of the topic; empty if there is no such topic.
std::string topic_text(std::string_view name, std::span<const HelpTopic* const> topics);

}  // namespace tacto::cli
