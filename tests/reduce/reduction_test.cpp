#include "reduce/reduction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/certify.hpp"
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
double forecast_MiB(int chains_of_a_master, const ReductionOptions& options = {
                                                .basis = {.method = Method::guyan}, .count = false})
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
  return MemoryForecast(body, K_blocks, M_blocks, options).at_first({}).beside_MiB;
}

TEST(MemoryForecast, CountsConstraintModesWhereTheirMastersMoveSomething)
{
  constexpr double half_of_all_MiB = 0.5 * 10 * 2000 * 8.0 / 1048576.0;
  std::array<double, 2> both_and_one{forecast_MiB(2), forecast_MiB(1)};
  linear::sum_over_ranks(both_and_one, PETSC_COMM_WORLD);
  EXPECT_NEAR(both_and_one[0] - both_and_one[1], half_of_all_MiB, 0.02 * half_of_all_MiB);
}

TEST(MemoryForecast, OfPartsHasBasesOfTheLargest)
{
  constexpr double column_MiB = 2000 * 8.0 / 1048576.0, M_MiB = 2000 * 12.0 / 1048576.0;
  std::array needed{forecast_MiB(1, {.basis = {.modes = 100}}),
                    forecast_MiB(1, {.basis = {.method = Method::mixed_interface, .modes = 100}})};
  linear::sum_over_ranks(needed, PETSC_COMM_WORLD);
  // 110 + 85 columns of Lanczos, 50 modes and their copy, 16 of its blocks
  EXPECT_NEAR(needed[0], (195 + 50 + 50 + 16) * column_MiB + M_MiB, 0.01 * needed[0]);
  // There the masters are in a part, and Psi and its copy are there.
  EXPECT_NEAR(needed[1], (195 + 50 + 50 + 16 + 2 * 5) * column_MiB + M_MiB, 0.01 * needed[1]);
}

/// The forecast for a chain of 2000 slaves and a master, of all ranks.
linear::FactorOptions forecast_of_chain(const ReductionOptions& options)
{
  linear::testing::Chain chain = linear::testing::free_chain(2001);
  const Body body{.K = std::move(chain.K), .M = std::move(chain.M), .masters = {0}};
  const DofPartition dofs = partition(body.K, linear::testing::master_set(body.K, body.masters));
  const Blocks K = split(body.K, dofs), M = split(body.M, dofs);
  linear::FactorOptions found = MemoryForecast(body, K, M, options).at_first({});
  std::array both{found.beside_MiB, found.second.beside_MiB};
  linear::sum_over_ranks(both, PETSC_COMM_WORLD);
  found.beside_MiB = both[0];
  found.second.beside_MiB = both[1];
  return found;
}

TEST(MemoryForecast, HasTheColumnsOfItsMostExpensivePhase)
{
  constexpr double column_MiB = 2000 * 8.0 / 1048576.0, entry_MiB = 12.0 / 1048576.0;
  constexpr double K_MiB = (3 * 2001 - 2) * entry_MiB, M_MiB = 2001 * entry_MiB;
  const auto expect = [&](const ReductionOptions& options, double columns, double more_MiB = 0.0) {
    const double found = forecast_of_chain(options).beside_MiB;
    EXPECT_NEAR(found, columns * column_MiB + more_MiB, 1e-6 * found);
  };
  const ReduceOptions modes{.modes = 200}, statics{.method = Method::guyan},
      mixed{.method = Method::mixed_interface, .modes = 200};
  // 32 motions, their residuals, half solutions and products, twice 16 of the workspace: 160
  // columns of the estimates. Block Lanczos has 85 + 2.2 n, n modes and 16 of its blocks.
  expect({.basis = statics}, 1 + 160);
  expect({.basis = modes}, 85 + 440 + 200 + 16);
  expect({.basis = mixed}, 85 + 440 + 200 + 16 + 1);
  // Scratch files hold all but what has to be at hand.
  expect({.basis = modes, .solver = {.scratch = "/tmp"}}, 160);
  expect({.basis = mixed, .solver = {.scratch = "/tmp"}}, 200 + 160);
  expect({.basis = modes, .solver = {.scratch = "/tmp"}, .count = true}, 160 + 100);
  expect({.basis = {.modes = 30}, .solver = {.scratch = "/tmp"}, .count = true}, 160 + 30);
  // What the caller has to do.
  expect({.basis = modes, .later = {.columns = 1000}}, 201 + 1000);
  expect({.basis = modes, .later = {.columns_for_each_kept = 9}}, 201 + 9 * 201);
  expect({.basis = modes, .later = {.of_a_part_for_each_kept = 9}}, 201 + 9 * 201);
  expect({.basis = modes, .later = {.columns = 1000, .matrices = 3}}, 201 + 1000, 3 * M_MiB);
  // A chain has too little work for a count, so that its matrices go.
  expect({.basis = statics, .count = {}, .keeps_matrices = false}, 161, -K_MiB - M_MiB);
  expect({.basis = statics, .count = {}}, 161);
  // A search begins with 50 modes; a tolerance tries models of them, in 12 matrices.
  expect({.basis = {.cutoff_Hz = 0.1}}, 85 + 110 + 50 + 16);
  const double trials_MiB = 12 * 51 * 51 * 8.0 / 1048576.0;
  expect({.basis = {.tolerance = ModesByTolerance{.tolerance = 1e-3, .up_to_Hz = 0.1}}},
         85 + 110 + 50 + 16 + 1, petsc::size(PETSC_COMM_WORLD) * trials_MiB);
  EXPECT_TRUE(forecast_of_chain({.basis = {.cutoff_Hz = 0.1}}).is_least);
  EXPECT_FALSE(forecast_of_chain({.basis = modes}).is_least);
  EXPECT_FALSE(forecast_of_chain({.basis = statics}).is_least);
  // A count has Psi, Phi, K - sigma M and the graphs of its order beside a second factor.
  EXPECT_EQ(forecast_of_chain({.basis = modes}).second.entries, 0.0);
  const linear::SecondFactor second = forecast_of_chain({.basis = modes, .count = true}).second;
  EXPECT_EQ(second.entries, 1.0);
  EXPECT_NEAR(second.beside_MiB, 201 * column_MiB + 3 * K_MiB, 1e-6 * second.beside_MiB);
}

TEST(ShareOfCounts, IsTwoFactorsAndAHalfEachAgainstTheOtherWork)
{
  const auto others = [](double entries, double n_slaves, double n_masters, double n_modes) {
    const double share =
        share_of_counts({.operations = 1e3, .entries = entries}, n_slaves, n_masters, n_modes);
    return 5e3 * (1.0 / share - 1.0) - 1e3;  // beside the factor
  };
  EXPECT_NEAR(others(0, 0, 7, 9), 0.0, 1e-9);
  EXPECT_NEAR(others(1e3, 0, 10, 0), 4e3 * 5, 1e-7) << "half a solution for each master";
  EXPECT_NEAR(others(1e3, 0, 0, 10), 4e3 * 42, 1e-6) << "3.2 in Lanczos and one for each mode";
  EXPECT_NEAR(others(0, 1e3, 10, 0), 1e3 * 100, 1e-6) << "Psi^T M Psi";
  EXPECT_NEAR(others(0, 1e3, 0, 10), 1e3 * 2 * 32 * 32, 1e-6) << "orthogonal vectors";
  EXPECT_NEAR(others(0, 1e3, 10, 10), 1e3 * (100 + 200 + 2 * 32 * 32), 1e-6);
}

TEST(CountPlan, KnowsBeforeTheModesWhetherACountIsOutOfTheQuestion)
{
  PhaseListener silent;
  const FactoredBody body = factored(chain_with_masters({0}), {}, silent);
  const auto is_possible = [&](const ReduceOptions& basis, std::optional<bool> count) {
    return CountPlan(body, {.basis = basis, .count = count}).is_possible();
  };
  const ReduceOptions statics{.method = Method::guyan}, modes{.modes = 3}, search{.cutoff_Hz = 1.0};
  for (const ReduceOptions& basis : {statics, modes, search})
    for (const bool count : {true, false}) EXPECT_EQ(is_possible(basis, count), count);
  EXPECT_FALSE(is_possible(statics, {})) << "two counts take longer than the one factor of a chain";
  EXPECT_FALSE(is_possible(modes, {}));
  EXPECT_TRUE(is_possible(search, {})) << "the number of modes decides";
}

TEST(CertifiedRange, IsThatOfTheToleranceOrOfTheOptionOrOfTheBasis)
{
  const auto model = [](std::vector<double> omega) {
    return ReducedModel{.K = {}, .M = {}, .n_masters = 0, .omega = std::move(omega), .R = {}};
  };
  const double lambda = std::pow(2.0 * std::numbers::pi * 3.0, 2);
  const SpectrumRange of_tolerance =
      certified_range({.tolerance = ModesByTolerance{.tolerance = 1e-3, .up_to_Hz = 3.0},
                       .certified_up_to_Hz = 4.0},
                      model({1.0}));
  EXPECT_NEAR(of_tolerance.lambda_max / lambda, 1.0 + 1e-9, 1e-14);
  EXPECT_GT(of_tolerance.most, 1000000);
  const SpectrumRange of_option = certified_range({.certified_up_to_Hz = 3.0}, model({1.0}));
  EXPECT_NEAR(of_option.lambda_max / lambda, 1.0 + 1e-9, 1e-14);
  EXPECT_EQ(of_option.most, 100);
  const SpectrumRange of_basis = certified_range({}, model({1.0, 5.0}));
  EXPECT_NEAR(of_basis.lambda_max / 25.0, 1.0 + 1e-9, 1e-14)
      << "copies of the last one belong to it";
  EXPECT_EQ(of_basis.most, 100);
  const SpectrumRange of_statics = certified_range({.method = Method::guyan}, model({}));
  EXPECT_EQ(of_statics.most, 20);
  EXPECT_GT(of_statics.lambda_max, 1e300);

  const SupportedModes modes{
      .pairs = {.X = Eigen::MatrixXd::Identity(3, 3), .lambda = {1.0, 2.0, 3.0}}};
  const auto n_leading = [&](double lambda_max, PetscInt most) {
    const ReducedPairs found = leading_pairs(modes, {.lambda_max = lambda_max, .most = most});
    EXPECT_EQ(found.X.cols(), std::ssize(found.lambda));
    return found.lambda.size();
  };
  EXPECT_EQ(n_leading(2.0, 100), 2u);
  EXPECT_EQ(n_leading(1.9, 100), 1u);
  EXPECT_EQ(n_leading(0.1, 100), 1u) << "the first one in any case";
  EXPECT_EQ(n_leading(9.0, 100), 3u);
  EXPECT_EQ(n_leading(9.0, 2), 2u);
  EXPECT_TRUE(leading_pairs({}, {}).lambda.empty());
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
