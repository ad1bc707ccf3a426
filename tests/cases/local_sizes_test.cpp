#include "cases/chosen_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace chladni::cases {
namespace {

constexpr double rate = 4.0;

/// Squares of 0.01 m with these shares of an error.
std::vector<ErrorShare> squares(const std::vector<double>& shares)
{
  std::vector<ErrorShare> found;
  for (const double share : shares) {
    found.push_back({.x = {0.01 * static_cast<double>(found.size()), 0.0, 0.0},
                     .area = 1e-4,
                     .size = 0.01,
                     .share = share});
  }
  return found;
}

/// The error with sizes, where it falls with their power.
double error_with(const LocalSizes& local, const std::vector<ErrorShare>& shares)
{
  double error = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i)
    error += shares[i].share * std::pow(local.sizes[i].size / shares[i].size, rate);
  return error;
}

TEST(LocalSizes, OfAnEvenErrorAreAllTheSame)
{
  const auto shares = squares({0.25, 0.25, 0.25, 0.25});
  const LocalSizes local = local_sizes(shares, 1.0 / 16.0, rate);
  for (const mesh::SizeAt& at : local.sizes) EXPECT_NEAR(at.size, 0.005, 1e-12);
  EXPECT_NEAR(local.n_elements, 4.0 * n_elements(shares), 1e-9);
}

TEST(LocalSizes, MeetTheWantedErrorWithFewerElementsThanEvenOnes)
{
  const auto shares = squares({0.9, 0.05, 0.03, 0.02});
  const double reduction = 0.1;
  const LocalSizes local = local_sizes(shares, reduction, rate);
  EXPECT_NEAR(error_with(local, shares) / reduction, 1.0, 0.1);  // sizes have two digits
  const double even = std::pow(reduction, -2.0 / rate) * n_elements(shares);
  EXPECT_LT(local.n_elements, 0.8 * even);
  EXPECT_LT(local.sizes[0].size, 0.7 * local.sizes[3].size);
}

TEST(LocalSizes, ChangeByNoMoreThanAMeshCanBeTrusted)
{
  const LocalSizes local = local_sizes(squares({1.0, 0.0}), 1e-12, rate);
  EXPECT_NEAR(local.sizes[0].size, 0.001, 1e-12);
  EXPECT_NEAR(local.sizes[1].size, 0.014, 1e-12);
}

}  // namespace
}  // namespace chladni::cases
