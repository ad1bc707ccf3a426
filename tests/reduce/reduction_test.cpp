#include "reduce/reduction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/memory_forecast.hpp"
#include "reduce/support.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

constexpr PetscInt n_of_reduced_chain = 40;  // masses

/// Writes down what happens.
class Diary : public PhaseListener {
 public:
  std::vector<std::string> phases;

 private:
  void begun(const std::string& name) override { phases.push_back(name); }
};

Body chain_with_masters(std::vector<PetscInt> masters)
{
  linear::testing::Chain chain = linear::testing::free_chain(n_of_reduced_chain);
  return {.K = std::move(chain.K), .M = std::move(chain.M), .masters = std::move(masters)};
}

/// Eigenvalue k = 1, 2, ... of the chain whose first mass is held.
double held_eigenvalue(int k)
{
  return std::pow(
      2.0 * std::sin(0.5 * (2 * k - 1) * std::numbers::pi / (2 * n_of_reduced_chain - 1)), 2);
}

TEST(Reduction, CertifiesTheModesUnderASupport)
{
  PhaseListener silent;
  const ReductionOptions options{.basis = {.modes = 8}, .count = true};
  FactoredBody body = factored(chain_with_masters({n_of_reduced_chain - 1, 0}), options, silent);
  const HeldMasters first_mass(body.masters, {0});
  const Certificate found = reduction(body, options, first_mass, silent).certificate;
  ASSERT_GE(found.bounds.size(), 8u);
  EXPECT_EQ(found.range.missing(), 0);
  EXPECT_EQ(found.fixed_interface.missing(), 0);
  EXPECT_EQ(found.n_zero, 1) << "of the free chain";
  for (std::size_t i = 0; i < found.bounds.size(); ++i) {
    const double error = found.lambda[i] / held_eigenvalue(static_cast<int>(i) + 1) - 1.0;
    EXPECT_GE(error, -1e-12) << i;
    EXPECT_LE(error, found.bounds[i] + 1e-13) << i;
    // Bounds of pairs far below the modes that are left out are of the order of the errors.
    if (i < 5) {
      EXPECT_LE(found.bounds[i], 4.0 * error + 1e-9) << i;
    }
    EXPECT_LE(found.rounding[i], 1e-9) << i;
    EXPECT_NEAR(found.estimates[i] / (std::sqrt(1.0 + error) - 1.0), 1.0, i < 5 ? 0.5 : 1.0) << i;
  }
}

/// What a reduction to masters needs beside its factor where two chains hang together through
/// masters, of which each touches one chain, or both.
double forecast_MiB(int chains_of_a_master)
{
  constexpr PetscInt n_masters = 10, n_all = 2000 + n_masters;
  petsc::Matrix K = linear::testing::matrix(n_all, 14, [&](PetscInt i) {
    linear::testing::Row row{{i, 3.0}};
    const auto couple = [&](PetscInt a, PetscInt b) {  // row i is one of them
      if (i == a) row.emplace_back(b, -1.0);
      if (i == b) row.emplace_back(a, -1.0);
    };
    if (i - 2 >= n_masters) row.emplace_back(i - 2, -1.0);
    if (i >= n_masters && i + 2 < n_all) row.emplace_back(i + 2, -1.0);
    for (PetscInt m = 0; m < n_masters; ++m)
      for (int c = 0; c < chains_of_a_master; ++c) couple(m, n_masters + 20 * m + (m + c) % 2);
    return row;
  });
  petsc::Matrix M = linear::testing::diagonal(n_all, [](PetscInt) { return 1.0; });
  Body body{.K = std::move(K), .M = std::move(M), .masters = {}};
  for (PetscInt m = 0; m < n_masters; ++m) body.masters.push_back(m);
  const DofPartition dofs = partition(body.K, linear::testing::master_set(body.K, body.masters));
  const Blocks K_blocks = split(body.K, dofs), M_blocks = split(body.M, dofs);
  const ReductionOptions options{.basis = {.method = Method::guyan}, .count = false};
  return MemoryForecast(body, K_blocks, M_blocks, options).at_first({}).beside_MiB;
}

TEST(MemoryForecast, CountsConstraintModesWhereTheirMastersMoveSomething)
{
  constexpr double half_of_all_MiB = 0.5 * 10 * 2000 * 8.0 / 1048576.0;
  std::array<double, 2> both_and_one{forecast_MiB(2), forecast_MiB(1)};
  linear::sum_over_ranks(both_and_one, PETSC_COMM_WORLD);
  EXPECT_NEAR(both_and_one[0] - both_and_one[1], half_of_all_MiB, 0.02 * half_of_all_MiB);
}

TEST(MemoryForecast, IsAskedAgainWhereASearchGoesOn)
{
  // A column is 16 kB: 85 + 2.2 n of the basis of Lanczos and n modes are 4 MiB for 60 modes, and
  // 45 MiB for 1000.
  linear::testing::Chain chain = linear::testing::free_chain(2000);
  const Body body{.K = std::move(chain.K), .M = std::move(chain.M), .masters = {0}};
  const DofPartition dofs = partition(body.K, linear::testing::master_set(body.K, body.masters));
  const Blocks K = split(body.K, dofs), M = split(body.M, dofs);
  ReductionOptions options{.basis = {.cutoff_Hz = 0.1}, .count = false};
  const MemoryForecast forecast(body, K, M, options);
  const linear::Factorization K_ss =
      linear::factorize(K.ss, {.factor = forecast.at_first({.memory_MiB = 20.0})});
  EXPECT_NO_THROW(forecast.require(K_ss.factor(), 60));
  try {
    forecast.require(K_ss.factor(), 1000);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the search goes on to 1000 modes"), std::string::npos)
        << error.what();
  }
}

TEST(Reduction, CountsWhereThatIsCheapAndNowhereElse)
{
  PhaseListener silent;
  ReductionOptions options{.basis = {.modes = 30}, .count = {}};  // nobody says
  FactoredBody body = factored(chain_with_masters({0, n_of_reduced_chain - 1}), options, silent);
  const Certificate found = reduction(body, options, HeldMasters(), silent).certificate;
  EXPECT_EQ(found.range.sigma > 0.0, found.count_share < 0.1);
  options.count = false;
  EXPECT_EQ(reduction(body, options, HeldMasters(), silent).certificate.range.sigma, 0.0);
}

TEST(Reduction, TellsItsPhasesInTheirOrder)
{
  Diary diary;
  const ReductionOptions options{.basis = {.modes = 4}, .count = true};
  FactoredBody body = factored(chain_with_masters({0, n_of_reduced_chain - 1}), options, diary);
  reduction(body, options, HeldMasters(), diary);
  EXPECT_EQ(diary.phases,
            (std::vector<std::string>{"partition", "factorization", "fixed-interface modes",
                                      "constraint modes", "projection", "error estimates",
                                      "condition", "count of eigenvalues"}));
}

TEST(Reduction, KeepsTheMatricesOnlyWhereTheyAreWanted)
{
  PhaseListener silent;
  for (const bool wanted : {true, false}) {
    const ReductionOptions options{.basis = {.modes = 4}, .keeps_matrices = wanted};
    FactoredBody body = factored(chain_with_masters({0}), options, silent);
    reduction(body, options, HeldMasters(), silent);
    EXPECT_EQ(body.K != nullptr, wanted);
    EXPECT_EQ(body.M != nullptr, wanted);
  }
}

TEST(Reduction, IsTheSameFromScratchFiles)
{
  PhaseListener silent;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path();
  for (const Method method : {Method::guyan, Method::craig_bampton, Method::mixed_interface}) {
    std::vector<ReducedModel> models;
    for (const std::filesystem::path& folder : {std::filesystem::path(), temporary}) {
      const bool has_modes = method != Method::guyan;
      const ReductionOptions options{
          .basis = {.method = method, .modes = has_modes ? std::optional(4) : std::nullopt},
          .solver = {.scratch = folder.string()}};
      FactoredBody body =
          factored(chain_with_masters({0, n_of_reduced_chain - 1}), options, silent);
      models.push_back(
          reduction(body, options, HeldMasters({0, n_of_reduced_chain - 1}, {0}), silent).model);
    }
    EXPECT_EQ(models[0].K, models[1].K);
    EXPECT_EQ(models[0].M, models[1].M);
  }
}

TEST(Reduction, NamesThePartThatCanMove)
{
  PhaseListener silent;
  Body body = chain_with_masters({0});
  const auto cut = [&](PetscInt i, PetscInt j, double value) {
    if (petsc::rank(PETSC_COMM_WORLD) == 0)
      petsc::check(MatSetValue(body.K, i, j, value, ADD_VALUES));
  };
  cut(20, 20, -1.0);  // the spring between masses 20 and 21
  cut(20, 21, 1.0);
  cut(21, 20, 1.0);
  cut(21, 21, -1.0);
  linear::testing::finish(body.K);
  body.name_of_dof = [](PetscInt dof) { return dof > 20 ? "the far end" : "the near end"; };
  try {
    factored(std::move(body), {}, silent);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("it moves most at the far end"), std::string::npos)
        << error.what();
  }
}

TEST(HeldMasters, RefusesWhatIsNoMaster)
{
  EXPECT_THROW(HeldMasters({3, 7}, {5}), Error);
}

TEST(HeldMasters, HoldNothingByARowThatNoMotionMoves)
{
  Eigen::MatrixXd R(4, 2);  // the third row is round-off, the last one small
  R << 1.0, 0.0, 0.0, 1.0, 1e-17, -3e-17, 1e-4, 0.0;
  EXPECT_EQ(at_rest(R, {2}).cols(), 2);
  EXPECT_EQ(at_rest(R, {2, 3}).cols(), 1);
  EXPECT_EQ(at_rest(R, {0, 1}).cols(), 0);
}

}  // namespace
}  // namespace chladni::reduce
