#pragma once
// Rows of docs/conformance.md: what was compared with whom, and how far apart the two are. script/conformance
// names a file in LAMBENT_CONFORMANCE; without it nothing is written.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace lambent::test {

inline void write_row(const std::string& row) {
  if (const char* path = std::getenv("LAMBENT_CONFORMANCE"))
    std::ofstream(path, std::ios::app) << row << "\n";
}

/// One comparison. It is the test's verdict, too: a row never says more than the test.
inline void conform(const std::string& system, const std::string& compared, const std::string& count,
                    double tolerance, double largest) {
  write_row(fmt::format("| {} | {} | {} | {:.2g} | {:.2g} | {} |", system, compared, count, tolerance,
                        largest, largest <= tolerance ? "agrees" : "**differs**"));
  EXPECT_LE(largest, tolerance) << system << ", " << compared << ", " << count;
}

/// A comparison that cannot be made here.
inline void not_compared(const std::string& system, const std::string& compared, const std::string& why) {
  write_row(fmt::format("| {} | {} | | | | not run: {} |", system, compared, why));
}

}  // namespace lambent::test
