#pragma once
// Whatever bytes of a picture's file are damaged or missing: a picture or an InputError, never a crash.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>
#include <string_view>

#include "lambent/diagnostics.h"

namespace lambent::test {

/// `decode(bytes)` of every beginning of `good` must throw InputError; of `good` with some bytes changed it
/// may.
template <class Decode> void expect_damage_is_an_error(const std::string& good, const Decode& decode) {
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_THROW(decode(std::string_view(good).substr(0, length)), InputError) << length;
  EXPECT_TRUE(rc::check([&] {
    std::string bytes = good;
    const int damages = *rc::gen::inRange(1, 10);
    for (int i = 0; i < damages; ++i)
      bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] = *rc::gen::arbitrary<char>();
    try {
      decode(std::string_view(bytes));
    } catch (const InputError&) {
    }
  }));
}

}  // namespace lambent::test
