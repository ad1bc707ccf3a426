#include "reduce/reduction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "reduce/held_masters.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::reduce {
namespace {

constexpr PetscInt n = 40;  // masses

/// Writes down what happens.
class Diary : public PhaseListener {
 public:
  std::vector<std::string> phases;

 private:
  void begun(const std::string& name) override { phases.push_back(name); }
};

Body chain_with_masters(std::vector<PetscInt> masters)
{
  linear::testing::Chain chain = linear::testing::free_chain(n);
  return {.K = std::move(chain.K), .M = std::move(chain.M), .masters = std::move(masters)};
}

/// Eigenvalue k = 1, 2, ... of the chain whose first mass is held.
double held_eigenvalue(int k)
{
  return std::pow(2.0 * std::sin(0.5 * (2 * k - 1) * std::numbers::pi / (2 * n - 1)), 2);
}

TEST(Reduction, CertifiesTheModesUnderASupport)
{
  PhaseListener silent;
  const ReductionOptions options{.basis = {.modes = 8}, .count = true};
  FactoredBody body = factored(chain_with_masters({n - 1, 0}), options, silent);
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
  }
}

TEST(Reduction, CountsWhereThatIsCheapAndNowhereElse)
{
  PhaseListener silent;
  ReductionOptions options{.basis = {.modes = 30}, .count = {}};  // nobody says
  FactoredBody body = factored(chain_with_masters({0, n - 1}), options, silent);
  const Certificate found = reduction(body, options, HeldMasters(), silent).certificate;
  EXPECT_EQ(found.range.sigma > 0.0, found.count_share < 0.1);
  options.count = false;
  EXPECT_EQ(reduction(body, options, HeldMasters(), silent).certificate.range.sigma, 0.0);
}

TEST(Reduction, TellsItsPhasesInTheirOrder)
{
  Diary diary;
  const ReductionOptions options{.basis = {.modes = 4}, .count = true};
  FactoredBody body = factored(chain_with_masters({0, n - 1}), options, diary);
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
      FactoredBody body = factored(chain_with_masters({0, n - 1}), options, silent);
      models.push_back(reduction(body, options, HeldMasters({0, n - 1}, {0}), silent).model);
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

}  // namespace
}  // namespace chladni::reduce
