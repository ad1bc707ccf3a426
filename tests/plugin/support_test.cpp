// A support of a CMS: what the frequencies mean, and modes of the mixed interface.
#include <chladni_cms.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"
#include "mbs_export/files/body_files.hpp"
#include "tests/linear/chain.hpp"

namespace chladni {
namespace {

using linear::testing::free_chain;
using linear::testing::master_set;

constexpr PetscInt n_masses = 40;  // masses

/// A CMS of the free chain with both ends as masters, of which the first is held.
struct HeldChain {
  linear::testing::Chain chain = free_chain(n_masses);
  petsc::IndexSet masters = master_set(chain.K, {0, n_masses - 1});
  petsc::IndexSet held = master_set(chain.K, {0});
  CMS cms = nullptr;

  explicit HeldChain(CMSType type)
  {
    petsc::check(CMSCreate(PETSC_COMM_WORLD, &cms));
    petsc::check(CMSSetType(cms, type));
    petsc::check(CMSSetOperators(cms, chain.K, chain.M, nullptr));
    petsc::check(CMSSetInterface(cms, masters));
    petsc::check(CMSSetHeld(cms, held));
  }
  ~HeldChain() { CMSDestroy(&cms); }
  HeldChain(const HeldChain&) = delete;
  HeldChain& operator=(const HeldChain&) = delete;
};

/// sqrt(lambda) / (2 pi) of the chain with one end held, k = 1, 2, ...
double exact_Hz(int k)
{
  return std::sin((2 * k - 1) * std::numbers::pi / (2.0 * (2 * n_masses - 1))) / std::numbers::pi;
}

/// The largest relative error of the frequencies that are certified.
double largest_error_of_cms(CMS cms, PetscInt& n_found)
{
  const PetscReal* f = nullptr;
  petsc::check(CMSGetFrequencies(cms, &n_found, &f));
  double largest = 0.0;
  for (PetscInt i = 0; i < n_found; ++i)
    largest = std::max(largest, std::abs(f[i] / exact_Hz(i + 1) - 1.0));
  return largest;
}

TEST(CMSHeld, IsTheSupportOfFrequenciesAndErrors)
{
  HeldChain held(CMSCRAIGBAMPTON);
  petsc::check(CMSSetDimensions(held.cms, 12));
  petsc::check(CMSSolve(held.cms));
  PetscInt n_found = 0;
  const PetscReal *f = nullptr, *eta2 = nullptr;
  petsc::check(CMSGetFrequencies(held.cms, &n_found, &f));
  petsc::check(CMSGetErrors(held.cms, &n_found, &eta2));
  ASSERT_GE(n_found, 8);
  for (PetscInt i = 0; i < 6; ++i) {
    const double error = std::pow(f[i] / exact_Hz(i + 1), 2) - 1.0;
    EXPECT_NEAR(eta2[i], error, 0.2 * error + 1e-11) << "mode " << i + 1;
  }
}

TEST(CMSHeld, MayBeTakenAway)
{
  HeldChain held(CMSMIXED);
  petsc::check(CMSSetDimensions(held.cms, 6));
  petsc::check(CMSSetHeld(held.cms, nullptr));
  petsc::check(CMSSolve(held.cms));
  PetscInt n_found = 0;
  const PetscReal* f = nullptr;
  petsc::check(CMSGetFrequencies(held.cms, &n_found, &f));
  ASSERT_GE(n_found, 6);
  for (PetscInt i = 0; i < 6; ++i) {
    const double free = std::sin(0.5 * (i + 1) * std::numbers::pi / n_masses) / std::numbers::pi;
    EXPECT_NEAR(f[i] / free, 1.0, 1e-10);
  }
}

TEST(CMSMixed, HasTheFrequenciesOfTheFullModelUnderTheSupport)
{
  HeldChain mixed(CMSMIXED);
  petsc::check(CMSSetDimensions(mixed.cms, 6));
  petsc::check(CMSSolve(mixed.cms));
  PetscInt n_found = 0, n_masters = 0, n_modes = 0;
  EXPECT_LT(largest_error_of_cms(mixed.cms, n_found), 1e-10);
  EXPECT_EQ(n_found, 6);
  petsc::check(CMSGetDimensions(mixed.cms, &n_masters, &n_modes));
  EXPECT_EQ(n_masters, 2);
  EXPECT_EQ(n_modes, 6);
}

TEST(CMSAuto, TakesTheModesOfTheRange)
{
  HeldChain chosen(CMSAUTO);
  petsc::check(CMSSetTolerance(chosen.cms, 1e-4, 0.5 * (exact_Hz(7) + exact_Hz(8))));
  petsc::check(CMSSolve(chosen.cms));
  PetscInt n_found = 0;
  EXPECT_LT(largest_error_of_cms(chosen.cms, n_found), 1e-4);
  EXPECT_EQ(n_found, 7);
}

TEST(CMSAuto, NeedsATolerance)
{
  HeldChain chosen(CMSAUTO);
  petsc::check(CMSSetDimensions(chosen.cms, 6));
  EXPECT_NE(CMSSolve(chosen.cms), 0);
}

TEST(CMSHeld, MustBeMasters)
{
  HeldChain held(CMSCRAIGBAMPTON);
  const petsc::IndexSet slave = master_set(held.chain.K, {5});
  petsc::check(CMSSetHeld(held.cms, slave));
  const PetscErrorCode code = CMSSolve(held.cms);
  ASSERT_NE(code, 0);
  const std::string text = petsc::error_texts(PetscErrorMessage, code).specific;
  EXPECT_NE(text.find("row 5 cannot be held: it is no master"), std::string::npos) << text;
}

TEST(CMSHeld, IsNamedInTheFile)
{
  HeldChain held(CMSMIXED);
  petsc::check(CMSSetDimensions(held.cms, 6));
  petsc::check(CMSSolve(held.cms));
  const std::string path = std::filesystem::temp_directory_path() /
                           fmt::format("held_{}.reduced.h5", petsc::size(PETSC_COMM_WORLD));
  petsc::check(CMSWrite(held.cms, path.c_str()));
  on_first_rank(PETSC_COMM_WORLD, [&] {
    const mbs_export::ReducedSystem system = mbs_export::read_reduced(path);
    EXPECT_EQ(system.certificate.fixed, std::vector<std::string>{"held_x.x"});
    EXPECT_EQ(system.certificate.frequencies.size(), 6);
    std::filesystem::remove(path);
  });
}

}  // namespace
}  // namespace chladni
