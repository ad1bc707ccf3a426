#include <chladni_cms.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "mbs_export/files/body_files.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::free_chain;
using linear::testing::master_set;

constexpr PetscInt chain_masses = 40;  // masses
constexpr double round_off = 1e-12;

/// A CMS of the free chain, or of what is made of it.
struct Solver {
  linear::testing::Chain chain = free_chain(chain_masses);
  petsc::IndexSet masters = master_set(chain.K, {0, chain_masses - 1});
  CMS cms = nullptr;
  bool monitor_was_refused = false;

  Solver() { petsc::check(CMSCreate(PETSC_COMM_WORLD, &cms)); }
  ~Solver() { CMSDestroy(&cms); }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// The code of the first step that fails; all ranks must come back.
  PetscErrorCode solve()
  {
    if (const PetscErrorCode code = CMSSetOperators(cms, chain.K, chain.M, nullptr)) return code;
    if (const PetscErrorCode code = CMSSetInterface(cms, masters)) return code;
    return CMSSolve(cms);
  }
};

/// What PETSc says of the error just returned.
std::string message(PetscErrorCode code)
{
  const char* specific = petsc::error_texts(PetscErrorMessage, code).specific;
  return specific != nullptr ? specific : "";
}

void expect_refused(Solver& solver, const std::string& words)
{
  const PetscErrorCode code = solver.solve();
  ASSERT_NE(code, 0);
  EXPECT_NE(message(code).find(words), std::string::npos) << message(code);
}

/// A(i, j) = value, set by the rank that owns row i.
void set_value(Mat A, PetscInt i, PetscInt j, double value)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  if (i >= first && i < last) petsc::check(MatSetValue(A, i, j, value, INSERT_VALUES));
  linear::testing::finish(A);
}

/// Options of the global database for as long as it lives.
class Options {
 public:
  explicit Options(const char* text) : text_(text)
  {
    petsc::check(PetscOptionsInsertString(nullptr, text));
  }
  ~Options()
  {
    std::istringstream words(text_);
    for (std::string word; words >> word;)
      if (word.starts_with("-cms_") || word.find("_cms_") != std::string::npos)
        PetscOptionsClearValue(nullptr, word.c_str());
  }
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

 private:
  std::string text_;
};

TEST(CMS, KeepsTheChainBetweenItsEnds)
{
  Solver solver;
  petsc::check(CMSSetType(solver.cms, CMSGUYAN));
  petsc::check(solver.solve());
  Mat K_r = nullptr, M_r = nullptr, C_r = nullptr;
  petsc::check(CMSGetReducedOperators(solver.cms, &K_r, &M_r, &C_r));
  EXPECT_EQ(C_r, nullptr);
  const Eigen::MatrixXd K = linear::replicate(K_r), M = linear::replicate(M_r);
  ASSERT_EQ(K.rows(), 2);
  EXPECT_NEAR(K(0, 1), -1.0 / (chain_masses - 1), round_off);  // springs in series
  EXPECT_NEAR(M(0, 0) + 2.0 * M(0, 1) + M(1, 1), chain_masses, 100 * round_off);
}

TEST(CMS, GivesTheTransformationThatItProjectsWith)
{
  Solver solver;
  petsc::check(CMSSetDimensions(solver.cms, 5));
  petsc::check(solver.solve());
  Mat T = nullptr, K_r = nullptr, M_r = nullptr;
  petsc::check(CMSGetTransformation(solver.cms, &T));
  petsc::check(CMSGetReducedOperators(solver.cms, &K_r, &M_r, nullptr));
  const auto expect_projection = [&](Mat A, Mat A_r) {
    petsc::Matrix AT;
    petsc::check(MatMatMult(A, T, MAT_INITIAL_MATRIX, petsc::automatic, AT.put()));
    const Eigen::MatrixXd projected = linear::inner_product(T, AT),
                          reduced = linear::replicate(A_r);
    for (PetscInt i = 0; i < reduced.rows(); ++i)
      for (PetscInt j = 0; j < reduced.cols(); ++j)
        EXPECT_NEAR(projected(i, j), reduced(i, j), 1e-10);  // tolerance of the modes
  };
  expect_projection(solver.chain.K, K_r);
  expect_projection(solver.chain.M, M_r);
}

TEST(CMS, KeepsTheOrderOfTheInterfaceWhicheverRankGivesIt)
{
  Solver solver;
  const bool first_rank = petsc::rank(PETSC_COMM_WORLD) == 0;
  const std::vector<PetscInt> order = {chain_masses - 1, 0, chain_masses / 2};
  petsc::IndexSet masters;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, first_rank ? 3 : 0, order.data(),
                               PETSC_COPY_VALUES, masters.put()));
  solver.masters = std::move(masters);
  petsc::check(CMSSetOutput(solver.cms, solver.masters));
  petsc::check(solver.solve());
  Mat T = nullptr;
  petsc::check(CMSGetTransformation(solver.cms, &T));
  const Eigen::MatrixXd rows = linear::replicate(T);
  ASSERT_EQ(rows.rows(), 3);
  for (PetscInt i = 0; i < 3; ++i)
    for (PetscInt j = 0; j < rows.cols(); ++j) EXPECT_EQ(rows(i, j), i == j ? 1.0 : 0.0);
  Mat K_r = nullptr;
  petsc::check(CMSGetReducedOperators(solver.cms, &K_r, nullptr, nullptr));
  const Eigen::MatrixXd K = linear::replicate(K_r);
  EXPECT_NEAR(K(0, 1), 0.0, round_off);  // the middle stands between the ends
  EXPECT_NEAR(K(0, 2), -1.0 / (chain_masses - 1 - chain_masses / 2), round_off);
  EXPECT_NEAR(K(1, 2), -1.0 / (chain_masses / 2), round_off);
}

TEST(CMS, ReducesDampingWithTheSameTransformation)
{
  Solver solver;
  petsc::check(CMSSetDimensions(solver.cms, 4));
  petsc::check(CMSSetOperators(solver.cms, solver.chain.K, solver.chain.M, solver.chain.K));
  petsc::check(CMSSetInterface(solver.cms, solver.masters));
  petsc::check(CMSSolve(solver.cms));
  Mat K_r = nullptr, C_r = nullptr;
  petsc::check(CMSGetReducedOperators(solver.cms, &K_r, nullptr, &C_r));
  const Eigen::MatrixXd K = linear::replicate(K_r), C = linear::replicate(C_r);
  EXPECT_LT((C - K).cwiseAbs().maxCoeff(), 1e-10);
}

/// The frequencies of the free chain, mode k = 1, 2, ...
double free_lambda(int k)
{
  return std::pow(2.0 * std::sin(0.5 * k * std::numbers::pi / chain_masses), 2);
}

/// G(i, i + 1) = 1 = -G(i + 1, i): gyroscopic forces; with damping besides, a diagonal.
petsc::Matrix gyroscopic(Mat like, double damping)
{
  petsc::Matrix G;
  PetscInt first = 0, last = 0;
  petsc::check(MatDuplicate(like, MAT_DO_NOT_COPY_VALUES, G.put()));
  petsc::check(MatGetOwnershipRange(G, &first, &last));
  for (PetscInt i = first; i < last; ++i) {
    petsc::check(MatSetValue(G, i, i, damping, INSERT_VALUES));
    if (i > 0) petsc::check(MatSetValue(G, i, i - 1, -1.0, INSERT_VALUES));
    if (i + 1 < chain_masses) petsc::check(MatSetValue(G, i, i + 1, 1.0, INSERT_VALUES));
  }
  linear::testing::finish(G);
  return G;
}

TEST(CMS, ProjectsGyroscopicForces)
{
  for (const double damping : {0.0, 0.3}) {
    Solver solver;
    const petsc::Matrix G = gyroscopic(solver.chain.K, damping);
    petsc::check(CMSSetDimensions(solver.cms, 4));
    petsc::check(CMSSetOperators(solver.cms, solver.chain.K, solver.chain.M, G));
    petsc::check(CMSSetInterface(solver.cms, solver.masters));
    petsc::check(CMSSolve(solver.cms));
    Mat T = nullptr, C_r = nullptr;
    petsc::check(CMSGetTransformation(solver.cms, &T));
    petsc::check(CMSGetReducedOperators(solver.cms, nullptr, nullptr, &C_r));
    petsc::Matrix GT;
    petsc::check(MatMatMult(G, T, MAT_INITIAL_MATRIX, petsc::automatic, GT.put()));
    const Eigen::MatrixXd C = linear::replicate(C_r), projected = linear::inner_product(T, GT);
    double largest = 0.0;
    for (PetscInt i = 0; i < C.rows(); ++i) {
      for (PetscInt j = 0; j < C.cols(); ++j) {
        EXPECT_NEAR(C(i, j), projected(i, j), round_off);
        if (damping == 0.0) {
          EXPECT_NEAR(C(i, j), -C(j, i), round_off);
        }
        if (i != j) largest = std::max(largest, std::abs(C(i, j)));
      }
    }
    EXPECT_GT(largest, 0.01);
    const PetscErrorCode code = CMSWrite(solver.cms, "/tmp/never-written.reduced.h5");
    EXPECT_NE(message(code).find("gyroscopic"), std::string::npos) << message(code);
  }
}

TEST(CMS, BoundsTheErrorsOfItsFrequencies)
{
  Solver solver;
  petsc::check(CMSSetDimensions(solver.cms, 8));
  petsc::check(CMSSetSylvester(solver.cms, PETSC_TRUE));
  petsc::check(solver.solve());
  PetscInt n_modes = 0, n_bounds = 0;
  const PetscReal *f = nullptr, *eta2 = nullptr, *bounds = nullptr;
  petsc::check(CMSGetFrequencies(solver.cms, &n_modes, &f));
  petsc::check(CMSGetErrors(solver.cms, &n_modes, &eta2));
  petsc::check(CMSGetErrorBounds(solver.cms, &n_bounds, &bounds));
  ASSERT_GE(n_bounds, 3);
  for (PetscInt i = 0; i < n_bounds; ++i) {
    const double lambda = std::pow(2.0 * std::numbers::pi * f[i], 2);
    const double error = lambda / free_lambda(i + 1) - 1.0;
    EXPECT_GE(bounds[i], error - 1e-11);        // round-off of the frequencies
    EXPECT_LT(eta2[i], 1.001 * error + 1e-11);  // a lower estimate ...
    if (i < 4) {
      EXPECT_GT(eta2[i], 0.5 * error - 1e-11);  // ... and far from the cut-off a good one
    }
  }
}

TEST(CMS, CountsRigidMotionAndAllEigenvaluesBelow)
{
  Solver solver;
  petsc::check(CMSSetDimensions(solver.cms, 8));
  petsc::check(CMSSetSylvester(solver.cms, PETSC_TRUE));
  petsc::check(solver.solve());
  CMSQuality quality{};
  petsc::check(CMSGetQuality(solver.cms, &quality));
  EXPECT_EQ(quality.n_zero, 1);
  EXPECT_LT(quality.rigid_residual, 1e-9);
  EXPECT_EQ(quality.modes.expected, 8);
  EXPECT_EQ(quality.modes.missing, 0);
  EXPECT_EQ(quality.complete.missing, 0);
  const double lambda = std::pow(2.0 * std::numbers::pi * quality.complete.upto, 2);
  int below = 0;
  while (free_lambda(below) < lambda) ++below;
  EXPECT_EQ(quality.complete.expected, below);
}

/// The tolerance is one of frequencies, and the estimate that chooses is an upper one: eta^2 / 2
/// over 1 - lambda / lambda_left_out.
TEST(CMS, TakesAsManyModesAsTheToleranceNeeds)
{
  constexpr double tolerance = 1e-4;
  Solver solver;
  const double up_to = 1.0001 * std::sqrt(free_lambda(10)) / (2.0 * std::numbers::pi);
  PetscInt chain_masses = 0, n_in_range = 0, n_modes = 0;
  const PetscReal *f = nullptr, *eta2 = nullptr;
  const auto largest_estimate = [&] {
    Mat K_r = nullptr;
    petsc::check(CMSGetReducedOperators(solver.cms, &K_r, nullptr, nullptr));
    petsc::check(CMSGetFrequencies(solver.cms, &chain_masses, &f));
    petsc::check(CMSGetErrors(solver.cms, &chain_masses, &eta2));
    petsc::Vector diagonal;
    PetscReal lambda_left_out = 0.0;
    petsc::check(MatCreateVecs(K_r, diagonal.put(), nullptr));
    petsc::check(MatGetDiagonal(K_r, diagonal));
    petsc::check(VecMax(diagonal, nullptr, &lambda_left_out));
    double largest = 0.0;
    for (PetscInt i = 0; i < std::min(n_in_range, chain_masses); ++i) {
      const double lambda = std::pow(2.0 * std::numbers::pi * f[i], 2);
      largest = std::max(largest, 0.5 * eta2[i] / (1.0 - lambda / lambda_left_out));
    }
    return largest;
  };
  petsc::check(CMSSetTolerance(solver.cms, tolerance, up_to));
  petsc::check(solver.solve());
  petsc::check(CMSGetFrequencies(solver.cms, &n_in_range, &f));
  ASSERT_GE(n_in_range, 9);
  for (PetscInt i = 0; i < n_in_range; ++i) {
    const double exact = std::sqrt(free_lambda(i + 1)) / (2.0 * std::numbers::pi);
    EXPECT_LE(f[i] / exact - 1.0, tolerance) << i;
  }
  EXPECT_LE(largest_estimate(), tolerance);
  petsc::check(CMSGetDimensions(solver.cms, nullptr, &n_modes));
  petsc::check(CMSSetDimensions(solver.cms, n_modes - 2));
  petsc::check(solver.solve());
  EXPECT_GT(largest_estimate(), tolerance);
}

TEST(CMS, ObeysTheOptionsOfItsPrefix)
{
  const Options options(
      "-left_cms_type guyan -cms_nmodes 3 -right_cms_nmodes 6 "
      "-right_cms_modes_solver krylov-schur");
  for (const auto& [prefix, n_modes] : {std::pair{"left_", 0}, {"", 3}, {"right_", 6}}) {
    Solver solver;
    petsc::check(CMSSetOptionsPrefix(solver.cms, prefix));
    petsc::check(CMSSetFromOptions(solver.cms));
    petsc::check(solver.solve());
    PetscInt n_found = 0;
    petsc::check(CMSGetDimensions(solver.cms, nullptr, &n_found));
    EXPECT_EQ(n_found, n_modes) << prefix;
  }
  const Options wrong("-wrong_cms_modes_solver by-magic");
  Solver solver;
  petsc::check(CMSSetOptionsPrefix(solver.cms, "wrong_"));
  const PetscErrorCode code = CMSSetFromOptions(solver.cms);
  EXPECT_NE(message(code).find("-wrong_cms_modes_solver by-magic"), std::string::npos);
}

TEST(CMS, IsNotTouchedByOptionsOfAnotherPrefix)
{
  for (const char* option :
       {"-cms_modes_solver by-magic", "-cms_lanczos_block_size 0", "-cms_lanczos_subspace -3",
        "-cms_lanczos_tolerance -1", "-cms_memory 1e-9", "-cms_scratch /no/such/folder",
        "-cms_pc_factor_mat_solver_type no_such_package", "-cms_pc_type jacobi",
        "-cms_sylvester_pc_type jacobi"}) {
    const Options options(option);
    for (const std::string prefix : {"left_", ""}) {
      Solver solver;
      petsc::check(CMSSetOptionsPrefix(solver.cms, prefix.c_str()));
      petsc::check(CMSSetSylvester(solver.cms, PETSC_TRUE));
      PetscErrorCode code = CMSSetFromOptions(solver.cms);
      if (code == 0) code = solver.solve();
      EXPECT_EQ(code == 0, prefix == "left_") << option << ": " << message(code);
    }
  }
}

TEST(CMS, ObeysADatabaseOfItsOwn)
{
  const Options global("-cms_nmodes 9 -cms_modes_solver by-magic -cms_pc_type jacobi");
  PetscOptions own = nullptr;
  petsc::check(PetscOptionsCreate(&own));
  petsc::check(PetscOptionsInsertString(own, "-cms_nmodes 4 -cms_sylvester"));
  {
    Solver solver;
    petsc::check(PetscObjectSetOptions(reinterpret_cast<PetscObject>(solver.cms), own));
    petsc::check(CMSSetFromOptions(solver.cms));
    petsc::check(solver.solve());
    PetscInt n_modes = 0;
    petsc::check(CMSGetDimensions(solver.cms, nullptr, &n_modes));
    EXPECT_EQ(n_modes, 4);
  }
  for (const char* option : {"-cms_modes_solver", "-cms_pc_type", "-cms_sylvester_pc_type"}) {
    petsc::check(PetscOptionsSetValue(own, option, "jacobi"));
    Solver solver;
    petsc::check(PetscObjectSetOptions(reinterpret_cast<PetscObject>(solver.cms), own));
    PetscErrorCode code = CMSSetFromOptions(solver.cms);
    if (code == 0) code = solver.solve();
    EXPECT_NE(message(code).find(std::string(option) + " jacobi"), std::string::npos)
        << message(code);
    petsc::check(PetscOptionsClearValue(own, option));
  }
  petsc::check(PetscOptionsDestroy(&own));
}

std::string all_options()
{
  char* text = nullptr;
  petsc::check(PetscOptionsGetAll(nullptr, &text));
  std::string all = text;
  petsc::check(PetscFree(text));
  return all;
}

TEST(CMS, LeavesTheGlobalDatabaseAlone)
{
  const Options options(
      "-left_cms_pc_factor_mat_solver_type mumps -left_cms_lanczos_block_size 4 "
      "-cms_lanczos_block_size 5");
  Solver solver;
  petsc::check(CMSSetOptionsPrefix(solver.cms, "left_"));
  std::vector<std::string> seen{all_options()};
  petsc::check(CMSMonitorSet(
      solver.cms,
      [](CMS, const char[], PetscReal, void* context) -> PetscErrorCode {
        static_cast<std::vector<std::string>*>(context)->push_back(all_options());
        return 0;
      },
      &seen));
  petsc::check(CMSSetFromOptions(solver.cms));
  petsc::check(solver.solve());
  seen.push_back(all_options());
  for (const std::string& all : seen) EXPECT_EQ(all, seen.front());
}

TEST(CMS, TakesASolverThatIsChosenAfterTheFirstSolution)
{
  Solver solver;
  petsc::check(solver.solve());
  const Options options("-cms_modes_solver krylov-schur -cms_eps_max_it 0");
  petsc::check(CMSSetFromOptions(solver.cms));
  EXPECT_NE(CMSSolve(solver.cms), 0);  // no iterations, no modes
}

TEST(CMS, IsFreedWithTheLastReference)
{
  Solver solver;
  CMS other = solver.cms;
  petsc::check(PetscObjectReference(reinterpret_cast<PetscObject>(solver.cms)));
  petsc::check(CMSDestroy(&other));
  EXPECT_EQ(other, nullptr);
  petsc::check(solver.solve());  // still there
  bool freed = false;
  PetscContainer witness = nullptr;
  petsc::check(PetscContainerCreate(PETSC_COMM_WORLD, &witness));
  petsc::check(PetscContainerSetPointer(witness, &freed));
  petsc::check(PetscContainerSetUserDestroy(witness, [](void* pointer) -> PetscErrorCode {
    *static_cast<bool*>(pointer) = true;
    return 0;
  }));
  petsc::check(PetscObjectCompose(reinterpret_cast<PetscObject>(solver.cms), "witness",
                                  reinterpret_cast<PetscObject>(witness)));
  petsc::check(PetscContainerDestroy(&witness));
  petsc::check(CMSDestroy(&solver.cms));
  EXPECT_TRUE(freed);
}

TEST(CMS, SolvesAgainAfterReset)
{
  Solver solver;
  petsc::check(CMSSetDimensions(solver.cms, 3));
  petsc::check(solver.solve());
  petsc::check(CMSReset(solver.cms));
  petsc::check(CMSSetDimensions(solver.cms, 6));
  petsc::check(CMSSolve(solver.cms));
  PetscInt n_modes = 0;
  petsc::check(CMSGetDimensions(solver.cms, nullptr, &n_modes));
  EXPECT_EQ(n_modes, 6);
}

TEST(CMS, TellsTheMonitorOfEachPhase)
{
  Solver solver;
  std::vector<std::string> phases;
  petsc::check(CMSMonitorSet(
      solver.cms,
      [](CMS, const char phase[], PetscReal, void* context) -> PetscErrorCode {
        static_cast<std::vector<std::string>*>(context)->emplace_back(phase);
        return 0;
      },
      &phases));
  petsc::check(solver.solve());
  EXPECT_EQ(phases, (std::vector<std::string>{"checks of the input", "factorization",
                                              "fixed-interface modes", "constraint modes",
                                              "projection", "error estimates"}));
}

TEST(CMS, IsNotChangedByItsMonitor)
{
  Solver solver;
  petsc::check(CMSMonitorSet(
      solver.cms,
      [](CMS cms, const char*, PetscReal, void* refused) -> PetscErrorCode {
        const auto is_refused = [](PetscErrorCode code) {
          return code == PETSC_ERR_ORDER && message(code).find("by a monitor") != std::string::npos;
        };
        CMS same = cms;
        *static_cast<bool*>(refused) = is_refused(CMSReset(cms)) && is_refused(CMSSolve(cms)) &&
                                       is_refused(CMSSetDimensions(cms, 3)) &&
                                       is_refused(CMSSetSylvester(cms, PETSC_TRUE)) &&
                                       is_refused(CMSDestroy(&same));
        return 0;
      },
      &solver.monitor_was_refused));
  ASSERT_EQ(solver.solve(), 0);
  EXPECT_TRUE(solver.monitor_was_refused);
}

TEST(CMS, CountsWhenThatIsAskedForAfterASolution)
{
  Solver solver;
  PetscInt n_bounds = 0;
  const PetscReal* bounds = nullptr;
  ASSERT_EQ(solver.solve(), 0);
  ASSERT_EQ(CMSGetErrorBounds(solver.cms, &n_bounds, &bounds), 0);
  EXPECT_EQ(n_bounds, 0);
  ASSERT_EQ(CMSSetSylvester(solver.cms, PETSC_TRUE), 0);
  ASSERT_EQ(CMSSolve(solver.cms), 0);
  ASSERT_EQ(CMSGetErrorBounds(solver.cms, &n_bounds, &bounds), 0);
  EXPECT_GT(n_bounds, 0);
}

TEST(CMS, SaysThatTheMonitorFailed)
{
  Solver solver;
  constexpr int users_code = 77;
  petsc::check(CMSMonitorSet(
      solver.cms,
      [](CMS, const char[], PetscReal, void*) -> PetscErrorCode {
        const bool last = petsc::rank(PETSC_COMM_WORLD) == petsc::size(PETSC_COMM_WORLD) - 1;
        return last ? users_code : 0;
      },
      nullptr));
  const PetscErrorCode code = solver.solve();
  EXPECT_EQ(static_cast<int>(code), users_code);
  EXPECT_NE(message(code).find("the monitor of CMSMonitorSet() returned error 77"),
            std::string::npos)
      << message(code);
}

TEST(CMS, TellsHowFarItIsAndEndsWhereThatFails)
{
  Solver solver;
  constexpr int users_code = 78;
  static std::vector<std::string> phases;
  petsc::check(CMSProgressSet(
      solver.cms,
      [](CMS, const char phase[], PetscReal fraction, void*) -> PetscErrorCode {
        EXPECT_GE(fraction, 0.0);
        EXPECT_LE(fraction, 1.0);
        phases.emplace_back(phase);
        const bool last = petsc::rank(PETSC_COMM_WORLD) == petsc::size(PETSC_COMM_WORLD) - 1;
        return last && std::string_view(phase) == "fixed-interface modes" ? users_code : 0;
      },
      nullptr));
  const PetscErrorCode code = solver.solve();
  EXPECT_EQ(static_cast<int>(code), users_code);
  EXPECT_FALSE(phases.empty());
  EXPECT_NE(message(code).find("returned error 78 in the phase \"fixed-interface modes\""),
            std::string::npos)
      << message(code);
}

TEST(CMS, KeepsTheCodeOfAnErrorOfPetsc)
{
  Solver solver;
  const Options options("-cms_pc_factor_mat_solver_type no_such_package");
  const PetscErrorCode code = solver.solve();
  EXPECT_EQ(static_cast<int>(code), PETSC_ERR_MISSING_FACTOR);
  EXPECT_NE(message(code).find("no_such_package"), std::string::npos) << message(code);
}

/// Time of an event in a stage of the log, and how often it was there.
PetscEventPerfInfo logged(const char* stage_name, const char* event_name)
{
  PetscLogStage stage = 0;
  PetscLogEvent event = 0;
  PetscEventPerfInfo info;
  petsc::check(PetscLogStageGetId(stage_name, &stage));
  petsc::check(PetscLogEventGetId(event_name, &event));
  petsc::check(PetscLogEventGetPerfInfo(stage, event, &info));
  return info;
}

TEST(CMS, LogsWhatItsEventsName)
{
  petsc::check(PetscLogDefaultBegin());
  const auto n_times = [](const char* stage, const char* event) {
    return logged(stage, event).count;
  };
  const int set_ups = n_times("CMS set-up", "CMSSetUp");
  const int solves = n_times("CMS solve", "CMSSolve");
  const double before = logged("CMS set-up", "CMSSetUp").time;
  const double inside_before =
      logged("CMS set-up", "CMSFactor").time + logged("CMS set-up", "CMSCheck").time;
  Solver solver;
  petsc::check(solver.solve());
  EXPECT_EQ(n_times("CMS set-up", "CMSSetUp"), set_ups + 1);
  EXPECT_EQ(n_times("CMS solve", "CMSSolve"), solves + 1);
  EXPECT_GE(logged("CMS set-up", "CMSSetUp").time - before,
            logged("CMS set-up", "CMSFactor").time + logged("CMS set-up", "CMSCheck").time -
                inside_before);
}

TEST(CMS, TakesOtherTypesOfMatrices)
{
  Solver solver;
  petsc::Matrix K;
  petsc::check(MatConvert(solver.chain.K, MATDENSE, MAT_INITIAL_MATRIX, K.put()));
  petsc::check(MatSetOption(solver.chain.M, MAT_SYMMETRIC, PETSC_TRUE));
  petsc::check(MatConvert(solver.chain.M, MATSBAIJ, MAT_INPLACE_MATRIX, solver.chain.M.put()));
  solver.chain.K = std::move(K);
  petsc::check(CMSSetType(solver.cms, CMSGUYAN));
  petsc::check(solver.solve());
  Mat K_r = nullptr;
  petsc::check(CMSGetReducedOperators(solver.cms, &K_r, nullptr, nullptr));
  EXPECT_NEAR(linear::replicate(K_r)(0, 1), -1.0 / (chain_masses - 1), round_off);
}

/// The frequencies with operators of a type.
std::vector<double> frequencies_by(const char* type)
{
  Solver solver;
  petsc::check(MatConvert(solver.chain.K, type, MAT_INPLACE_MATRIX, solver.chain.K.put()));
  petsc::check(MatConvert(solver.chain.M, type, MAT_INPLACE_MATRIX, solver.chain.M.put()));
  petsc::check(CMSSetDimensions(solver.cms, 8));
  petsc::check(CMSSetSylvester(solver.cms, PETSC_TRUE));
  petsc::check(solver.solve());
  PetscInt n_modes = 0;
  const PetscReal* f = nullptr;
  petsc::check(CMSGetFrequencies(solver.cms, &n_modes, &f));
  return {f, f + n_modes};
}

TEST(CMS, TakesTheVariantsOfAij)
{
  const std::vector<double> plain = frequencies_by(MATAIJ);
  for (const char* type : {MATAIJPERM, MATAIJSELL, MATBAIJ}) {
    const std::vector<double> found = frequencies_by(type);
    ASSERT_EQ(found.size(), plain.size()) << type;
    for (std::size_t i = 0; i < plain.size(); ++i)
      EXPECT_NEAR(found[i], plain[i], 1e-12 * plain[i]) << type;  // round-off
  }
}

/// Rows whose columns fall, and of each entry two parts that MatMult adds up.
TEST(CMS, AddsUpEntriesThatStandTwiceInAnyOrder)
{
  if (petsc::size(PETSC_COMM_WORLD) > 1) return;  // on several ranks PETSc takes no such rows
  Solver plain;
  ASSERT_EQ(plain.solve(), 0);
  PetscInt n_modes = 0, n_again = 0;
  const PetscReal *f = nullptr, *again = nullptr;
  ASSERT_EQ(CMSGetFrequencies(plain.cms, &n_modes, &f), 0);
  Solver twice;
  std::vector<PetscInt> first_of_row{0}, columns;
  std::vector<double> values;
  linear::for_local_entries(twice.chain.K, [&](PetscInt row, PetscInt column, double value) {
    const auto at = columns.begin() + (row < std::ssize(first_of_row) ? first_of_row[row] : 0);
    const auto place = at - columns.begin();
    columns.insert(at, {column, column});
    values.insert(values.begin() + place, {0.25 * value, 0.75 * value});
    first_of_row.resize(std::size_t(row) + 2);
    first_of_row.back() = static_cast<PetscInt>(columns.size());
  });
  petsc::Matrix K;
  ASSERT_EQ(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, chain_masses, chain_masses,
                                      first_of_row.data(), columns.data(), values.data(), K.put()),
            0);
  twice.chain.K = std::move(K);
  ASSERT_EQ(twice.solve(), 0);
  ASSERT_EQ(CMSGetFrequencies(twice.cms, &n_again, &again), 0);
  ASSERT_EQ(n_again, n_modes);
  for (PetscInt i = 0; i < n_modes; ++i) EXPECT_NEAR(again[i], f[i], 1e-12 * f[i]) << i;
}

TEST(CMS, RefusesAnUnsymmetricOperator)
{
  Solver solver;
  set_value(solver.chain.K, 17, 18, -1.1);
  expect_refused(solver, "K is not symmetric: row and column 17");
}

TEST(CMS, RefusesAValueThatIsNotFinite)
{
  Solver solver;
  set_value(solver.chain.M, chain_masses - 2, chain_masses - 2,
            std::numeric_limits<double>::quiet_NaN());
  expect_refused(solver, "M[38, 38] = nan is not finite");
}

TEST(CMS, RefusesANegativeDiagonal)
{
  Solver solver;
  set_value(solver.chain.K, 3, 3, -2.0);
  expect_refused(solver, "K[3, 3] = -2 is negative");
}

TEST(CMS, RefusesAnIndefiniteStiffness)
{
  Solver solver;
  set_value(solver.chain.K, 0, 0, 0.0);  // the end spring pushes: K_ss is as it was
  expect_refused(solver, "K is indefinite");
}

TEST(CMS, RefusesAnIndefiniteMass)
{
  Solver solver;
  petsc::check(MatSetOption(solver.chain.M, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  set_value(solver.chain.M, 0, chain_masses - 1, -30.0);
  set_value(solver.chain.M, chain_masses - 1, 0, -30.0);
  expect_refused(solver, "M is indefinite");
}

TEST(CMS, RefusesAPartThatNoMasterHolds)
{
  Solver solver;
  set_value(solver.chain.K, 20, 21, 0.0);
  set_value(solver.chain.K, 21, 20, 0.0);
  set_value(solver.chain.K, 20, 20, 1.0);
  set_value(solver.chain.K, 21, 21, 1.0);
  solver.masters = master_set(solver.chain.K, {0, 1});
  expect_refused(solver, "K_ss is not positive definite");
}

TEST(CMS, NamesARowWithoutStiffness)
{
  for (const bool is_master : {false, true}) {
    Solver solver;
    for (const PetscInt i : {16, 17}) {
      set_value(solver.chain.K, i, i + 1, 0.0);
      set_value(solver.chain.K, i + 1, i, 0.0);
    }
    set_value(solver.chain.K, 17, 17, 0.0);
    if (!is_master) {
      expect_refused(solver, "row 17 of K is empty (empty rows: 1)");
      continue;
    }
    solver.masters = master_set(solver.chain.K, {0, 17, chain_masses - 1});
    petsc::check(solver.solve());  // its mass moves freely
    set_value(solver.chain.M, 17, 17, 0.0);
    expect_refused(solver, "row 17 of K is empty (empty rows: 1)");
  }
}

TEST(CMS, RefusesMastersWithoutSense)
{
  struct Mistake {
    std::vector<PetscInt> masters;
    const char* words;
  };
  for (const Mistake& mistake :
       {Mistake{{0, chain_masses}, "master 40 is out of range; rows are 0 to 39"},
        {{-1, 3}, "master -1"},
        {{5, 7, 5}, "master 5 is given twice"},
        {{}, "0 masters"}}) {
    Solver solver;
    const bool last_rank = petsc::rank(PETSC_COMM_WORLD) == petsc::size(PETSC_COMM_WORLD) - 1;
    petsc::IndexSet masters;
    petsc::check(ISCreateGeneral(PETSC_COMM_WORLD,
                                 last_rank ? static_cast<PetscInt>(mistake.masters.size()) : 0,
                                 mistake.masters.data(), PETSC_COPY_VALUES, masters.put()));
    solver.masters = std::move(masters);
    expect_refused(solver, mistake.words);
  }
}

TEST(CMS, RefusesAToleranceThatItsMethodCannotKeep)
{
  for (const char* method : {CMSGUYAN, CMSRUBIN}) {
    Solver solver;
    petsc::check(CMSSetType(solver.cms, method));
    petsc::check(CMSSetTolerance(solver.cms, 1e-3, 0.1));
    expect_refused(solver, std::string("the method ") + method + ", which cannot keep one");
    Solver later;  // whose factor is there already
    ASSERT_EQ(later.solve(), 0);
    petsc::check(CMSSetTolerance(later.cms, 1e-3, 0.1));
    petsc::check(CMSSetType(later.cms, method));
    EXPECT_NE(CMSSolve(later.cms), 0);
  }
}

TEST(CMS, RefusesMoreModesThanExist)
{
  Solver solver;
  petsc::check(CMSSetDimensions(solver.cms, chain_masses));
  expect_refused(solver, "40 modes asked of 38 slaves");
}

TEST(CMS, RefusesOperatorsOfDifferentSizes)
{
  Solver solver;
  solver.chain.M = std::move(free_chain(chain_masses + 1).M);
  expect_refused(solver, "M is 41 x 41, but K has 40 rows");
}

TEST(CMS, RefusesSettingsWithoutSense)
{
  const Solver solver;
  EXPECT_NE(CMSSetDimensions(solver.cms, 0), 0);
  EXPECT_NE(CMSSetCutoff(solver.cms, -1.0), 0);
  EXPECT_NE(CMSSetTolerance(solver.cms, 2.0, 10.0), 0);
  const PetscErrorCode code = CMSSetType(solver.cms, "hurty");
  EXPECT_NE(message(code).find("-cms_type guyan, craig-bampton, mixed-interface, rubin or auto"),
            std::string::npos);
  EXPECT_NE(message(CMSSetType(solver.cms, "macneal")).find("give -cms_type rubin"),
            std::string::npos);
  const Options options("-cms_nmodes 3 -cms_cutoff 5");
  EXPECT_NE(CMSSetFromOptions(solver.cms), 0);
}

TEST(CMS, SaysWhatIsToBeCalledFirst)
{
  const Solver solver;
  const PetscErrorCode nothing_set = CMSSolve(solver.cms);
  EXPECT_NE(message(nothing_set).find("call CMSSetOperators() first"), std::string::npos);
  petsc::check(CMSSetOperators(solver.cms, solver.chain.K, solver.chain.M, nullptr));
  const PetscErrorCode no_interface = CMSSolve(solver.cms);
  EXPECT_NE(message(no_interface).find("call CMSSetInterface() first"), std::string::npos);
  Mat K = nullptr;
  const PetscErrorCode not_solved = CMSGetReducedOperators(solver.cms, &K, nullptr, nullptr);
  EXPECT_NE(message(not_solved).find("Call CMSSolve() first"), std::string::npos);
}

/// A name for a file, the same on all ranks.
std::string common_path()
{
  int process = getpid();
  MPI_Bcast(&process, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return std::filesystem::temp_directory_path() / fmt::format("cms_{}.reduced.h5", process);
}

/// What a viewer of HDF5 files writes.
mbs_export::ReducedSystem written_file(CMS cms)
{
  const std::string path = common_path();
  PetscViewer viewer = nullptr;
  petsc::check(PetscViewerCreate(PETSC_COMM_WORLD, &viewer));
  petsc::check(PetscViewerSetType(viewer, PETSCVIEWERHDF5));
  petsc::check(PetscViewerFileSetMode(viewer, FILE_MODE_WRITE));
  petsc::check(PetscViewerFileSetName(viewer, path.c_str()));
  petsc::check(CMSView(cms, viewer));
  petsc::check(PetscViewerDestroy(&viewer));
  mbs_export::ReducedSystem file = mbs_export::read_reduced(path);
  MPI_Barrier(PETSC_COMM_WORLD);
  if (petsc::rank(PETSC_COMM_WORLD) == 0) std::filesystem::remove(path);
  return file;
}

TEST(CMS, WritesTheReducedFileThroughAViewer)
{
  Solver solver;
  petsc::check(PetscObjectSetName(reinterpret_cast<PetscObject>(solver.cms), "chain"));
  petsc::check(solver.solve());
  const mbs_export::ReducedSystem file = written_file(solver.cms);
  EXPECT_EQ(file.title, "chain");
  EXPECT_EQ(file.n_masters(), 2);
  EXPECT_EQ(file.attachment_nodes[1].number, chain_masses - 1);
  EXPECT_GT(file.certificate.eta2.size(), 0);
}

TEST(CMS, WithoutANameWritesTheSameTitleInEachRun)
{
  Solver solver;
  petsc::check(solver.solve());
  EXPECT_EQ(written_file(solver.cms).title, "CMS");
}

TEST(CMS, SaysThatItKeepsThePartnerOfTheLastMode)
{
  Solver solver;
  solver.chain = free_chain(2 * chain_masses + 1);  // held in its middle: two equal halves
  solver.masters = master_set(solver.chain.K, {0, chain_masses, 2 * chain_masses});
  petsc::check(CMSSetDimensions(solver.cms, 5));
  petsc::check(solver.solve());
  const std::string path = std::filesystem::temp_directory_path() /
                           fmt::format("chladni-{}.txt", petsc::size(PETSC_COMM_WORLD));
  PetscViewer viewer = nullptr;
  petsc::check(PetscViewerASCIIOpen(PETSC_COMM_WORLD, path.c_str(), &viewer));
  petsc::check(CMSView(solver.cms, viewer));
  petsc::check(PetscViewerDestroy(&viewer));
  if (petsc::rank(PETSC_COMM_WORLD) != 0) return;
  std::ifstream file(path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  std::filesystem::remove(path);
  EXPECT_NE(text.find(": 6 (5 asked; 1 more of the same frequency)"), std::string::npos) << text;
}

TEST(CMS, KeepsTheGeometryOfItsInterfaceForTheFile)
{
  Solver solver;
  petsc::check(CMSSetInterface(solver.cms, solver.masters));
  PetscInt n_own = 0;
  const PetscInt* own = nullptr;
  petsc::check(ISGetLocalSize(solver.masters, &n_own));
  petsc::check(ISGetIndices(solver.masters, &own));
  std::vector<PetscInt> nodes(own, own + n_own), components(n_own, 2);
  std::vector<PetscReal> positions;
  for (const PetscInt node : nodes) positions.insert(positions.end(), {0.1 * node, 0.0, 1.0});
  petsc::check(ISRestoreIndices(solver.masters, &own));
  EXPECT_NE(CMSSetInterfaceGeometry(solver.cms, n_own + 1, nodes.data(), components.data(),
                                    positions.data()),
            0);
  petsc::check(CMSSetInterfaceGeometry(solver.cms, n_own, nodes.data(), components.data(),
                                       positions.data()));
  petsc::check(CMSSetOperators(solver.cms, solver.chain.K, solver.chain.M, nullptr));
  petsc::check(CMSSolve(solver.cms));
  const std::string path = common_path();
  petsc::check(CMSWrite(solver.cms, path.c_str()));
  const mbs_export::ReducedSystem file = mbs_export::read_reduced(path);
  EXPECT_EQ(file.masters[1].component, 2);
  EXPECT_EQ(file.attachment_nodes[1].position, Eigen::Vector3d(0.1 * (chain_masses - 1), 0.0, 1.0));
  MPI_Barrier(PETSC_COMM_WORLD);
  if (petsc::rank(PETSC_COMM_WORLD) == 0) std::filesystem::remove(path);
}

TEST(CMS, LeavesTheOldFileWhereItCannotWriteANewOne)
{
  Solver solver;
  petsc::check(solver.solve());
  const PetscErrorCode code = CMSWrite(solver.cms, "/no/such/folder/chain.reduced.h5");
  ASSERT_NE(code, 0);
  EXPECT_NE(message(code).find("/no/such/folder/chain.reduced.h5"), std::string::npos);
}

}  // namespace
}  // namespace chladni::reduce
