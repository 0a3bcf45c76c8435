// SPDX-License-Identifier: GPL-3.0-or-later
// The kind and place of an error, for tests, which do not depend on its sentences.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::tests {

/// The result is an error of that kind at that place.
template <class Value>
testing::AssertionResult fails(const schema::Result<Value>& result, schema::ErrorKind kind,
                               const std::string& where) {
  if (result) return testing::AssertionFailure() << "no error";
  if (result.error().kind == kind && result.error().where == where) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "kind " << static_cast<int>(result.error().kind) << " at '"
                                     << result.error().where << "': " << schema::message(result.error());
}

}  // namespace tacto::tests
