#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "squeal/brake/radiation.hpp"
#include "squeal/results/result_fields.hpp"

namespace chladni::squeal::test {

/// Results of every analysis for two modes, with the fewest values that each may have or a few:
/// what tests/data/version_1.squeal.h5 holds.
SquealResults version_1_results();

/// What tests/data/version_1.radiation.h5 holds.
Radiation version_1_radiation();

/// Results after they were written and read.
SquealResults returned(const SquealResults& written);

/// All members that a file stores are equal.
template <files::Stored T>
void expect_equal(const std::optional<T>& read, const std::optional<T>& written)
{
  ASSERT_TRUE(read);
  ASSERT_TRUE(written);
  EXPECT_EQ(files::difference(*read, *written), "");
}

}  // namespace chladni::squeal::test
