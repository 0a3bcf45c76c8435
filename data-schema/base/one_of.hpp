// SPDX-License-Identifier: GPL-3.0-or-later
// A value of one of several kinds, which can be read only by handling every kind.
#pragma once

#include <concepts>
#include <utility>
#include <variant>

namespace tacto::schema {

template <class... Handlers>
struct Handling : Handlers... {
  using Handlers::operator()...;
};

/// As std::variant, without its ways to look for one kind and pass over the others (std::get, std::get_if):
/// code that does not handle a kind does not compile. A new kind is then an error at each place that has to
/// know it.
template <class... Kinds>
class OneOf {
 public:
  template <class Kind>
    requires(std::same_as<Kind, Kinds> || ...)
  OneOf(Kind kind) : value_(std::move(kind)) {}  // NOLINT(google-explicit-constructor): a kind is a value

  /// Calls the handler of the kind that it is, and gives its result.
  template <class... Handlers>
    requires(std::invocable<Handling<Handlers...>&, const Kinds&> && ...)
  decltype(auto) visit(Handlers... handlers) const {
    return std::visit(Handling<Handlers...>{std::move(handlers)...}, value_);
  }

  /// The same; handlers may change the value.
  template <class... Handlers>
    requires(std::invocable<Handling<Handlers...>&, Kinds&> && ...)
  decltype(auto) visit(Handlers... handlers) {
    return std::visit(Handling<Handlers...>{std::move(handlers)...}, value_);
  }

 private:
  std::variant<Kinds...> value_;
};

}  // namespace tacto::schema
