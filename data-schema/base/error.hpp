// SPDX-License-Identifier: GPL-3.0-or-later
// Errors as values: what was wrong, where, and what to do. Libraries return them; only verbs print them.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace tacto::schema {

/// The kind of a failure; each has an exit code of its own (see exit_code).
enum class ErrorKind {
  internal,             ///< a bug in tactograph
  usage,                ///< the command line or an option's value
  not_found,            ///< a file or device that is not there, or may not be read
  malformed,            ///< a file whose content breaks its format
  unsuitable,           ///< well-formed data that the operation can't use (a stroke too short, say)
  unsupported_version,  ///< written by a newer major version
  cannot_write,         ///< an output folder or file that can't be written
  device,               ///< a device that failed or refused
  unstable,             ///< a scene that becomes unstable on its device
};

/// One failure. `where` is a file, with line, field or sample; `remedy` says what to do, and may be empty.
struct Error {
  ErrorKind kind = ErrorKind::internal;
  std::string what;
  std::string where;
  std::string remedy;
};

template <class T>
using Result = tl::expected<T, Error>;

/// An Error, ready to be returned from any function that gives a Result.
inline tl::unexpected<Error> fail(ErrorKind kind, std::string what, std::string where = {},
                                  std::string remedy = {}) {
  return tl::unexpected(Error{kind, std::move(what), std::move(where), std::move(remedy)});
}

/// Passes another function's error on, whatever its value type was.
template <class T>
tl::unexpected<Error> forward_error(const Result<T>& failed) {
  return tl::unexpected(failed.error());
}

/// TACTO_TRY(result) returns its error from the function around it, where it has one. Takes any expression
/// that gives a Result; a value that is needed afterwards is a variable: `const auto x = f(); TACTO_TRY(x);
/// use(*x);`.
#define TACTO_TRY(...)                                           \
  do {                                                           \
    if (const auto& tried_result = (__VA_ARGS__); !tried_result) \
      return ::tacto::schema::forward_error(tried_result);       \
  } while (false)

/// The process's exit code for a kind of error: 1 internal, 2 usage, 3 not found, ... in the order of
/// ErrorKind.
constexpr int exit_code(ErrorKind kind) {
  return static_cast<int>(kind) + 1;
}

/// "where: what (remedy)", on one line.
std::string message(const Error& error);

}  // namespace tacto::schema
