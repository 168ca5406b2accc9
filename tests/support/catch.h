// Catch2 version 2 (Debian 12) or 3 for all tests; only this file knows which.
// A guard by name, since this header is in a precompiled header: GCC recognises `#pragma once` by the text of the file,
// and a compiler cache may return a precompiled header that was made from a text with other comments.
#ifndef COPSE_TESTS_SUPPORT_CATCH_H
#define COPSE_TESTS_SUPPORT_CATCH_H

#if __has_include(<catch2/catch_test_macros.hpp>)
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_adapters.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
using Catch::Approx;
#define COPSE_CATCH 3
#else
#include <catch2/catch.hpp>
#define COPSE_CATCH 2
#endif

#include <string>

namespace copse::test {

using Catch::Matchers::EndsWith;
using Catch::Matchers::Equals;
using Catch::Matchers::StartsWith;

/// Matches text that has `part` in it; version 3 has another name for it.
inline auto Contains(const std::string& part) {
#if COPSE_CATCH == 3
  return Catch::Matchers::ContainsSubstring(part);
#else
  return Catch::Matchers::Contains(part);
#endif
}

}  // namespace copse::test

#endif
