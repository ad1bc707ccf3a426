// Free bodies on the fewest masters that hold them, and soft ones that only seem to be free.
#include <chladni_cms.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/reduce/pencils.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::Chain;
using testing::Body;

struct Wanted {
  CMSType type;
  std::vector<PetscInt> masters;
  PetscInt n_modes = 0;
};

struct Found {
  PetscInt n_zero;
  std::vector<double> f_Hz;
  Eigen::MatrixXd K_r;
};

Found solve(const Chain& pencil, const Wanted& wanted)
{
  CMS cms = nullptr;
  petsc::check(CMSCreate(PETSC_COMM_WORLD, &cms));
  petsc::check(CMSSetOperators(cms, pencil.K, pencil.M, nullptr));
  const petsc::IndexSet masters = linear::testing::master_set(pencil.K, wanted.masters);
  petsc::check(CMSSetInterface(cms, masters));
  petsc::check(CMSSetType(cms, wanted.type));
  if (wanted.n_modes > 0) petsc::check(CMSSetDimensions(cms, wanted.n_modes));
  petsc::check(CMSSolve(cms));
  CMSQuality quality;
  PetscInt n = 0;
  const PetscReal* f = nullptr;
  Mat K_r = nullptr;
  petsc::check(CMSGetQuality(cms, &quality));
  petsc::check(CMSGetFrequencies(cms, &n, &f));
  petsc::check(CMSGetReducedOperators(cms, &K_r, nullptr, nullptr));
  Found found{.n_zero = quality.n_zero, .f_Hz = {f, f + n}, .K_r = testing::whole(K_r)};
  petsc::check(CMSDestroy(&cms));
  return found;
}

/// The elastic frequencies of the whole model, Hz.
std::vector<double> exact_frequencies(const Chain& pencil, int n_zero)
{
  std::vector<double> f_Hz;
  const Eigen::VectorXd lambda = testing::exact_eigenvalues(pencil);
  for (Eigen::Index i = n_zero; i < lambda.size(); ++i)
    f_Hz.push_back(std::sqrt(lambda[i]) / (2.0 * std::numbers::pi));
  return f_Hz;
}

/// Six rigid motions, and the first frequencies those of the whole model.
void expect_free_body(const Chain& pencil, const Wanted& wanted, double tolerance)
{
  const Found found = solve(pencil, wanted);
  EXPECT_EQ(found.n_zero, 6);
  const std::vector<double> exact = exact_frequencies(pencil, 6);
  ASSERT_GE(found.f_Hz.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(found.f_Hz[i] / exact[i], 1.0, tolerance) << "mode " << i;
  EXPECT_GE(found.K_r.diagonal().minCoeff(), 0.0);
}

/// Node i + (n_x + 1) (j + (n_y + 1) k) of a block.
PetscInt node(const std::array<int, 3>& n, const std::array<int, 3>& at)
{
  return at[0] + (n[0] + 1) * (at[1] + (n[1] + 1) * at[2]);
}

/// x, y, z of one corner, y, z of the next, z of the third.
std::vector<PetscInt> isostatic_masters(const std::array<int, 3>& n)
{
  const PetscInt a = 3 * node(n, {0, 0, 0}), b = 3 * node(n, {n[0], 0, 0}),
                 c = 3 * node(n, {0, n[1], 0});
  return {a, a + 1, a + 2, b + 1, b + 2, c + 2};
}

/// x, y, z of three nodes in no symmetric position.
std::vector<PetscInt> three_points(const std::array<int, 3>& n)
{
  std::vector<PetscInt> masters;
  for (const auto& at : {std::array{0, 0, 0}, std::array{n[0], 1, 0}, std::array{1, n[1], n[2]}})
    for (PetscInt c = 0; c < 3; ++c) masters.push_back(3 * node(n, at) + c);
  return masters;
}

constexpr std::array bar{10, 2, 2};
constexpr std::array compact{6, 3, 3};

TEST(FreeBody, OnSixIsostaticMastersKeepsItsMotions)
{
  for (const auto& n : {bar, compact}) {
    const Body body = testing::solid_block(n, {0.1 * n[0], 0.1 * n[1], 0.1 * n[2]});
    expect_free_body(body.pencil, {CMSCRAIGBAMPTON, isostatic_masters(n), 60}, 1e-3);
  }
}

TEST(FreeBody, OnThreePointsKeepsItsMotions)
{
  for (const auto& n : {bar, compact}) {
    const Body body = testing::solid_block(n, {0.1 * n[0], 0.1 * n[1], 0.1 * n[2]});
    expect_free_body(body.pencil, {CMSCRAIGBAMPTON, three_points(n), 60}, 1e-3);
  }
}

TEST(FreeBody, KeepsItsMotionsByItsOwnModesToo)
{
  const Body body = testing::solid_block(compact, {0.6, 0.3, 0.3});
  expect_free_body(body.pencil, {CMSRUBIN, three_points(compact), 6}, 1e-9);
  expect_free_body(body.pencil, {CMSRUBIN, isostatic_masters(compact), 10}, 1e-9);
}

TEST(FreeBody, OnIsostaticMastersAloneHasNoStiffness)
{
  const Body body = testing::solid_block(bar, {1.0, 0.2, 0.2});
  const Found found = solve(body.pencil, {CMSGUYAN, isostatic_masters(bar), 0});
  EXPECT_EQ(found.n_zero, 6);
  EXPECT_EQ(found.K_r.cwiseAbs().maxCoeff(), 0.0);
}

TEST(FreeBody, OfAChainWithOneInnerMasterIsFree)
{
  const Chain chain = linear::testing::free_chain(40);
  const Found found = solve(chain, {CMSCRAIGBAMPTON, {17}, 20});
  EXPECT_EQ(found.n_zero, 1);
  EXPECT_EQ(found.K_r(0, 0), 0.0);
  const double exact = std::sin(0.5 * std::numbers::pi / 40) / std::numbers::pi;
  EXPECT_NEAR(found.f_Hz[0] / exact, 1.0, 1e-3);
}

TEST(FreeBody, OfTwoPiecesHasTheMotionsOfBoth)
{
  Chain pencil = linear::testing::free_chain(40);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(pencil.K, &first, &last));
  for (const PetscInt i : {19, 20}) {  // the spring between them is cut
    if (i < first || i >= last) continue;
    petsc::check(MatSetValue(pencil.K, i, i, 1.0, INSERT_VALUES));
    petsc::check(MatSetValue(pencil.K, i, 39 - i, 0.0, INSERT_VALUES));
  }
  linear::testing::finish(pencil.K);
  const Found found = solve(pencil, {CMSCRAIGBAMPTON, {5, 11, 33}, 8});
  EXPECT_EQ(found.n_zero, 2);
}

TEST(FreeBody, IsNoneThatIsMerelySoft)
{
  // The first mode of the clamped beam has 2e-11 of the stiffness of its rows.
  constexpr int n = 400;
  const Chain beam = testing::euler_beam(n, 2);
  std::vector<PetscInt> translations;
  for (PetscInt i = 0; i < n; ++i) translations.push_back(2 * i);
  const Found found = solve(beam, {CMSGUYAN, translations, 0});
  EXPECT_EQ(found.n_zero, 0);
  const double exact = std::pow(1.875104068711961, 2) / (2.0 * std::numbers::pi);
  EXPECT_NEAR(found.f_Hz[0] / exact, 1.0, 1e-5);  // K has a condition of 1e10
}

TEST(FreeBody, IsNoneOnSoftSprings)
{
  Body body = testing::solid_block(bar, {1.0, 0.2, 0.2});
  const std::vector<PetscInt> masters = isostatic_masters(bar);
  constexpr double spring = 100.0;  // N/m under a body with entries of 1e10: 1e-11 of all rows
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(body.pencil.K, &first, &last));
  for (const PetscInt i : masters)
    if (i >= first && i < last) petsc::check(MatSetValue(body.pencil.K, i, i, spring, ADD_VALUES));
  linear::testing::finish(body.pencil.K);
  const Found found = solve(body.pencil, {CMSGUYAN, masters, 0});
  EXPECT_EQ(found.n_zero, 0);
  // As a rigid body on its springs: they are all that K_G has.
  const Eigen::MatrixXd springs = spring * Eigen::MatrixXd::Identity(6, 6);
  EXPECT_LT((found.K_r - springs).cwiseAbs().maxCoeff(), 1e-3 * spring);
}

TEST(FreeBody, OfALongBeamIsFreeByAsManyMotions)
{
  constexpr int n = 400;
  const Chain beam = testing::euler_beam(n, 0);
  std::vector<PetscInt> translations;
  for (PetscInt i = 0; i <= n; ++i) translations.push_back(2 * i);
  for (const std::vector<PetscInt>& masters :
       {translations, std::vector<PetscInt>{0, 1}, std::vector<PetscInt>{0, 2 * n}}) {
    const Found found = solve(beam, {CMSCRAIGBAMPTON, masters, 20});
    EXPECT_EQ(found.n_zero, 2) << masters.size() << " masters";
    const double exact = std::pow(4.730040744862704, 2) / (2.0 * std::numbers::pi);
    EXPECT_NEAR(found.f_Hz[0] / exact, 1.0, 1e-4) << masters.size() << " masters";
  }
}

TEST(FreeBody, OfAnySizeAndInAnyUnitsIsOne)
{
  struct Case {
    double length;
    testing::Solid solid;
  };
  // A grain of 1 mm, a part of 1 m, a ship of 100 m; the grain and the ship in mm, t, s.
  const testing::Solid mm_t_s{.young = 210e3, .poisson = 0.3, .density = 7850e-12};
  for (const Case& one :
       {Case{1e-3, {}}, Case{1.0, {}}, Case{100.0, {}}, Case{1.0, mm_t_s}, Case{1e5, mm_t_s}}) {
    const double l = one.length;
    const Body body = testing::solid_block(compact, {l, 0.5 * l, 0.4 * l}, one.solid);
    expect_free_body(body.pencil, {CMSCRAIGBAMPTON, three_points(compact), 60}, 1e-3);
    expect_free_body(body.pencil, {CMSRUBIN, three_points(compact), 6}, 1e-9);
    expect_free_body(body.pencil, {CMSRUBIN, isostatic_masters(compact), 6}, 1e-9);
  }
}

}  // namespace
}  // namespace chladni::reduce
