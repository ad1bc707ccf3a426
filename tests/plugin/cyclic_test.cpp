#include <chladni_cms_cyclic.h>
#include <gtest/gtest.h>
#include <slepceps.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>

#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "mbs_export/files/body_files.hpp"
#include "tests/plugin/random_ring.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using testing::distributed, testing::RandomRing, testing::shared_out;

constexpr double two_pi = 2.0 * std::numbers::pi;

VectorXd eigenvalues(const MatrixXd& K, const MatrixXd& M)
{
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// A CMS of a sector, with two nodes in the middle and one of the low edge as masters.
struct SectorSolver {
  explicit SectorSolver(int n_sectors) : count(n_sectors), ring(n_sectors)
  {
    const RandomRing::Matrices sector = ring.sector();
    K = distributed(sector.K);
    M = distributed(sector.M);
    petsc::check(CMSCreate(PETSC_COMM_WORLD, &cms));
    petsc::check(CMSSetOperators(cms, K, M, nullptr));
    petsc::check(set_edges(RandomRing::low(), RandomRing::high()));
    petsc::check(set_masters({14, 12, 13, 3, 4, 5, 17}));
  }
  ~SectorSolver() { CMSDestroy(&cms); }
  SectorSolver(const SectorSolver&) = delete;
  SectorSolver& operator=(const SectorSolver&) = delete;

  PetscErrorCode set_edges(const std::vector<PetscInt>& low, const std::vector<PetscInt>& high)
  {
    return CMSSetCyclic(cms, count, shared_out(low), shared_out(high), 3, ring.rotation().data());
  }
  PetscErrorCode set_masters(const std::vector<PetscInt>& rows)
  {
    return CMSSetInterface(cms, shared_out(rows));
  }

  int count;
  RandomRing ring;
  petsc::Matrix K, M;
  CMS cms = nullptr;
};

std::string message_of(PetscErrorCode code)
{
  const char* specific = petsc::error_texts(PetscErrorMessage, code).specific;
  return specific != nullptr ? specific : "";
}

/// The motion of the whole ring of x and y of a sector.
MatrixXd unfolded(const RandomRing& ring, int count, int order, const MatrixXd& x,
                  const MatrixXd& y)
{
  MatrixXd whole = MatrixXd::Zero(3 * (1 + count * RandomRing::n_own), x.cols());
  for (int j = 0; j < count; ++j) {
    const double angle = two_pi * order * j / count;
    for (int a = 0; a < RandomRing::n_sector_nodes; ++a) {
      MatrixXd u = std::cos(angle) * x.middleRows<3>(3 * a);
      if (y.size() > 0) u -= std::sin(angle) * y.middleRows<3>(3 * a);
      whole.middleRows<3>(3 * ring.node(j, a)) = ring.turn(j) * u;
    }
  }
  return whole;
}

MatrixXd replicated(Mat A)
{
  petsc::Matrix dense;
  petsc::check(MatConvert(A, MATDENSE, MAT_INITIAL_MATRIX, dense.put()));
  return linear::replicate(dense);
}

TEST(CMSCyclic, HarmonicsHaveTheEigenvaluesOfTheWholeRingAndNoOthers)
{
  for (const int count : {2, 3, 6, 7}) {
    SectorSolver solver(count);
    std::vector<double> found;
    for (PetscInt order = 0; order <= count / 2; ++order) {
      petsc::check(CMSSetHarmonic(solver.cms, order));
      Mat K = nullptr, M = nullptr;
      petsc::check(CMSGetHarmonicOperators(solver.cms, &K, &M, nullptr));
      const VectorXd lambda = eigenvalues(replicated(K), replicated(M));
      found.insert(found.end(), lambda.begin(), lambda.end());
    }
    std::ranges::sort(found);
    const RandomRing::Matrices whole = solver.ring.whole();
    const VectorXd expected = eigenvalues(whole.K, whole.M);
    ASSERT_EQ(std::ssize(found), expected.size()) << count << " sectors";
    for (Eigen::Index i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(found[std::size_t(i)], expected[i], 1e-12 * expected.maxCoeff());
  }
}

TEST(CMSCyclic, ReducesTheWholeRingToMotionsOfAHarmonic)
{
  for (const int order : {0, 1, 2, 3}) {
    SectorSolver solver(6);
    petsc::check(CMSSetHarmonic(solver.cms, order));
    petsc::check(CMSSetDimensions(solver.cms, 6));
    petsc::check(CMSSolve(solver.cms));
    Mat K_r = nullptr, M_r = nullptr, T_x = nullptr, T_y = nullptr;
    petsc::check(CMSGetReducedOperators(solver.cms, &K_r, &M_r, nullptr));
    petsc::check(CMSGetHarmonicTransformation(solver.cms, &T_x, &T_y));
    const bool one_phase = order == 0 || order == 3;
    ASSERT_EQ(T_y == nullptr, one_phase);
    const MatrixXd x = linear::replicate(T_x),
                   y = T_y ? MatrixXd(linear::replicate(T_y)) : MatrixXd();
    const MatrixXd T = unfolded(solver.ring, 6, order, x, y);
    const RandomRing::Matrices whole = solver.ring.whole();
    const MatrixXd K = linear::replicate(K_r), M = linear::replicate(M_r);
    // Fixed-interface modes have residuals of 1e-7: the blocks with masters vanish to that.
    EXPECT_LT((T.transpose() * whole.K * T - K).cwiseAbs().maxCoeff(), 1e-6 * K.norm());
    EXPECT_LT((T.transpose() * whole.M * T - M).cwiseAbs().maxCoeff(), 1e-12 * M.norm());
    PetscInt n = 0;
    const PetscInt *rows = nullptr, *phases = nullptr;
    petsc::check(CMSGetHarmonicInterface(solver.cms, &n, &rows, &phases));
    ASSERT_EQ(n, one_phase ? 7 : 14);
    EXPECT_EQ(rows[0], 14);
    for (PetscInt i = 0; i < n; ++i) {
      const double moved = phases[i] == 0 ? x(rows[i], i) : y(rows[i], i);
      EXPECT_NEAR(moved, 1.0, 1e-12);
    }
  }
}

TEST(CMSCyclic, AHarmonicWithAllItsModesHasTheFrequenciesOfTheRing)
{
  const RandomRing ring(6);
  const RandomRing::Matrices whole = ring.whole();
  const VectorXd expected = eigenvalues(whole.K, whole.M);
  int n_zero = 0;
  for (const int order : {0, 1, 2, 3}) {
    SectorSolver solver(6);
    petsc::check(CMSSetHarmonic(solver.cms, order));
    Mat K_n = nullptr;
    PetscInt n_rows = 0, n_masters = 0, n = 0;
    petsc::check(CMSGetHarmonicOperators(solver.cms, &K_n, nullptr, nullptr));
    petsc::check(MatGetSize(K_n, &n_rows, nullptr));
    petsc::check(CMSSetUp(solver.cms));
    petsc::check(CMSGetDimensions(solver.cms, &n_masters, nullptr));
    petsc::check(CMSSetDimensions(solver.cms, n_rows - n_masters));
    petsc::check(CMSSolve(solver.cms));
    const PetscReal* f = nullptr;
    petsc::check(CMSGetFrequencies(solver.cms, &n, &f));
    ASSERT_GT(n, 4);
    for (PetscInt i = 0; i < n; ++i) {
      const double lambda = std::pow(two_pi * f[i], 2);
      EXPECT_LT((expected.array() / lambda - 1.0).abs().minCoeff(), 1e-9) << "harmonic " << order;
    }
    for (PetscInt i = 0; order != 0 && order != 3 && i + 1 < n; i += 2)
      EXPECT_NEAR(f[i + 1] / f[i], 1.0, 1e-12);  // pairs
    CMSQuality quality{};
    petsc::check(CMSGetQuality(solver.cms, &quality));
    n_zero += static_cast<int>(quality.n_zero);
  }
  EXPECT_EQ(n_zero, 3);  // translations
}

TEST(CMSCyclic, HoldsRowsOfTheSectorInBothPhases)
{
  for (const int order : {0, 1}) {
    SectorSolver solver(6);
    petsc::check(CMSSetHarmonic(solver.cms, order));
    petsc::check(CMSSetHeld(solver.cms, shared_out({3, 4, 5})));
    petsc::check(CMSSetDimensions(solver.cms, 12));
    petsc::check(CMSSetType(solver.cms, CMSMIXED));
    petsc::check(CMSSolve(solver.cms));
    Mat K_n = nullptr, M_n = nullptr;
    petsc::check(CMSGetHarmonicOperators(solver.cms, &K_n, &M_n, nullptr));
    PetscInt n_free = 0, n = 0;
    const PetscReal* f = nullptr;
    petsc::check(MatGetSize(K_n, &n_free, nullptr));
    // Rows 3, 4 and 5 follow the hub, of which harmonic 0 has z alone and harmonic 1 x and y.
    const int first = order == 0 ? 1 : 2, n_held = order == 0 ? 3 : 6;
    std::vector<int> kept;
    for (int i = 0; i < n_free; ++i)
      if (i < first || i >= first + n_held) kept.push_back(i);
    const VectorXd lambda = eigenvalues(replicated(K_n)(kept, kept), replicated(M_n)(kept, kept));
    petsc::check(CMSGetFrequencies(solver.cms, &n, &f));
    ASSERT_GT(n, 5);
    for (PetscInt i = 0; i < 5; ++i)
      EXPECT_NEAR(std::pow(two_pi * f[i], 2) / lambda[i], 1.0, 1e-9) << "harmonic " << order;
  }
}

TEST(CMSCyclic, AHubIsAMasterOfTheHarmonicsThatMoveIt)
{
  const std::vector<std::vector<PetscInt>> moves{{2}, {0, 1}, {}, {}};
  for (int order = 0; order <= 3; ++order) {
    SectorSolver solver(6);
    petsc::check(solver.set_masters({2, 1, 0, 15, 16, 17}));
    petsc::check(CMSSetHarmonic(solver.cms, order));
    petsc::check(CMSSetUp(solver.cms));
    PetscInt n = 0;
    const PetscInt* rows = nullptr;
    petsc::check(CMSGetHarmonicInterface(solver.cms, &n, &rows, nullptr));
    std::vector<PetscInt> of_hub;
    std::copy_if(rows, rows + n, std::back_inserter(of_hub), [](PetscInt row) { return row < 3; });
    std::ranges::sort(of_hub);
    EXPECT_EQ(of_hub, moves[std::size_t(order)]) << "harmonic " << order;
  }
}

/// The lowest eigenvalues of a harmonic that an EPS finds.
std::vector<double> lowest(CMS cms, const char* type, int n)
{
  Mat K = nullptr, M = nullptr;
  petsc::check(CMSGetHarmonicOperators(cms, &K, &M, nullptr));
  petsc::EigenSolver eps;
  ST st = nullptr;
  petsc::check(EPSCreate(PETSC_COMM_WORLD, eps.put()));
  petsc::check(EPSSetOperators(eps, K, M));
  petsc::check(EPSSetProblemType(eps, EPS_GHEP));
  petsc::check(EPSSetType(eps, type));
  petsc::check(EPSSetDimensions(eps, n, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc::check(EPSSetTarget(eps, -0.1));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  petsc::check(EPSSetTolerances(eps, 1e-12, PETSC_DEFAULT));
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetType(st, STSINVERT));
  KSP ksp = nullptr;
  PC pc = nullptr;
  petsc::check(STGetKSP(st, &ksp));
  petsc::check(KSPSetType(ksp, KSPPREONLY));
  petsc::check(KSPGetPC(ksp, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check(EPSSolve(eps));
  std::vector<double> lambda;
  for (int i = 0; i < n; ++i) {
    lambda.push_back(0.0);
    petsc::check(EPSGetEigenvalue(eps, i, &lambda.back(), nullptr));
  }
  return lambda;
}

/// Three sectors about the axis (1, 1, 1), whose turn takes x to y, y to z, z to x: a grounded
/// point on the axis (rows 0 to 2), a point at each edge, springs alike in all directions.
struct TiltedSector {
  TiltedSector()
  {
    MatrixXd graph(3, 3);
    graph << 1.0 / 3.0 + 1.5, -1.0, -0.5,  //
        -1.0, 3.0, -2.0,                   //
        -0.5, -2.0, 2.5;
    MatrixXd stiffness = MatrixXd::Zero(9, 9), mass = MatrixXd::Zero(9, 9), R(3, 3);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        stiffness.block<3, 3>(3 * a, 3 * b).diagonal().setConstant(graph(a, b));
    mass.diagonal() << VectorXd::Constant(3, 1.0 / 3.0), VectorXd::Constant(6, 0.5);
    R << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    K = distributed(stiffness);
    M = distributed(mass);
    R.transposeInPlace();  // row by row
    petsc::check(CMSCreate(PETSC_COMM_WORLD, &cms));
    petsc::check(CMSSetOperators(cms, K, M, nullptr));
    petsc::check(CMSSetInterface(cms, shared_out({0, 1, 2})));
    petsc::check(CMSSetCyclic(cms, 3, shared_out({0, 1, 2, 3, 4, 5}),
                              shared_out({0, 1, 2, 6, 7, 8}), 3, R.data()));
  }
  ~TiltedSector() { CMSDestroy(&cms); }
  TiltedSector(const TiltedSector&) = delete;
  TiltedSector& operator=(const TiltedSector&) = delete;

  petsc::Matrix K, M;
  CMS cms = nullptr;
};

/// With the point on the axis held, each direction is a ring of three masses 1, each tied by 1.5 to
/// the ground and by 2 to its neighbours: 1.5, 7.5, 7.5.
TEST(CMSCyclic, ANodeOnAnObliqueAxisIsHeldInAllItsRowsOrRefused)
{
  for (const PetscInt order : {0, 1}) {
    TiltedSector sector;
    petsc::check(CMSSetHarmonic(sector.cms, order));
    petsc::check(CMSSetType(sector.cms, CMSMIXED));
    petsc::check(CMSSetDimensions(sector.cms, 2));
    for (const std::vector<PetscInt>& some :
         {std::vector<PetscInt>{0}, {1}, {2}, {0, 1}, {1, 2}, {2, 0}}) {
      petsc::check(CMSSetHeld(sector.cms, shared_out(some)));
      const PetscErrorCode code = CMSSolve(sector.cms);
      ASSERT_NE(code, 0) << "harmonic " << order << ", first held " << some.front();
      EXPECT_NE(message_of(code).find("name all of them or none"), std::string::npos)
          << message_of(code);
    }
    petsc::check(CMSSetHeld(sector.cms, shared_out({2, 0, 1})));
    petsc::check(CMSSolve(sector.cms));
    PetscInt n = 0;
    const PetscReal* f = nullptr;
    petsc::check(CMSGetFrequencies(sector.cms, &n, &f));
    ASSERT_GE(n, 2) << "harmonic " << order;
    const double first = std::pow(two_pi * f[0], 2), last = std::pow(two_pi * f[n - 1], 2);
    EXPECT_NEAR(first, 1.5, 1e-9) << "harmonic " << order;
    EXPECT_LT(std::min(std::abs(last - 1.5), std::abs(last - 7.5)), 1e-9) << last;
    petsc::check(CMSSetInterface(sector.cms, shared_out({0, 2})));
    EXPECT_NE(CMSSolve(sector.cms), 0) << "harmonic " << order;
  }
}

/// The hub of a ring moves in no harmonic from 2 on: with it as the only node, all methods have no
/// master there.
TEST(CMSCyclic, WithoutMastersEveryMethodGivesItsModesAlone)
{
  for (const char* method : {CMSGUYAN, CMSCRAIGBAMPTON, CMSMIXED, CMSRUBIN}) {
    SectorSolver solver(6);
    petsc::check(solver.set_masters({0, 1, 2}));
    petsc::check(CMSSetHarmonic(solver.cms, 2));
    petsc::check(CMSSetType(solver.cms, method));
    petsc::check(CMSSetDimensions(solver.cms, 3));
    ASSERT_EQ(CMSSolve(solver.cms), 0) << method;
    PetscInt n_masters = -1, n_modes = -1;
    petsc::check(CMSGetDimensions(solver.cms, &n_masters, &n_modes));
    EXPECT_EQ(n_masters, 0) << method;
    if (method == std::string(CMSGUYAN)) {
      EXPECT_EQ(n_modes, 0);
    } else
      EXPECT_GE(n_modes, 3) << method;  // the partner of the last one too
  }
}

TEST(CMSCyclic, GivesMatricesThatEigensolversTake)
{
  SectorSolver solver(7);
  petsc::check(CMSRegisterEPS());
  petsc::check(CMSSetHarmonic(solver.cms, 2));
  Mat K = nullptr, M = nullptr;
  petsc::check(CMSGetHarmonicOperators(solver.cms, &K, &M, nullptr));
  const VectorXd expected = eigenvalues(replicated(K), replicated(M));
  for (const char* type : {"blocklanczos", EPSKRYLOVSCHUR}) {
    const std::vector<double> found = lowest(solver.cms, type, 6);
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(found[std::size_t(i)] / expected[i], 1.0, 1e-10) << type;
  }
}

TEST(CMSCyclic, RefusesEdgesThatDoNotMatch)
{
  using Rows = std::vector<PetscInt>;
  const auto refused = [](const std::string& words, auto change) {
    SectorSolver solver(6);
    change(solver);
    const PetscErrorCode code = CMSSolve(solver.cms);
    ASSERT_NE(code, 0) << words;
    EXPECT_NE(message_of(code).find(words), std::string::npos) << message_of(code);
  };
  Rows longer = RandomRing::high();
  longer.push_back(20);
  refused("the low edge has 12 rows and the high edge 13",
          [&](SectorSolver& s) { petsc::check(s.set_edges(RandomRing::low(), longer)); });
  refused("the edges have 2 rows, which the block size 3", [](SectorSolver& s) {
    petsc::check(s.set_edges({3, 4}, {21, 22}));
  });
  refused("row 6 is in both edges", [](SectorSolver& s) {
    petsc::check(s.set_edges({3, 4, 5, 6, 7, 8}, {6, 7, 8, 9, 10, 11}));
  });
  refused("row 3 is twice in the low edge", [](SectorSolver& s) {
    petsc::check(s.set_edges({3, 4, 3}, {21, 22, 23}));
  });
  refused("row 30 of the high edge is out of range; rows are 0 to 29", [](SectorSolver& s) {
    petsc::check(s.set_edges({3, 4, 5}, {21, 22, 30}));
  });
  refused("harmonic 4 of 6 sectors; give 0 to 3",
          [](SectorSolver& s) { petsc::check(CMSSetHarmonic(s.cms, 4)); });
  refused("harmonic -1 of 6 sectors",
          [](SectorSolver& s) { petsc::check(CMSSetHarmonic(s.cms, -1)); });
  refused("5 times the rotation is no whole turn", [](SectorSolver& s) {
    s.count = 5;
    petsc::check(s.set_edges(RandomRing::low(), RandomRing::high()));
  });
  refused("master 21 is in the high edge; give row 3 of the low edge", [](SectorSolver& s) {
    petsc::check(s.set_masters({14, 21}));
  });
  refused("harmonic 1 without sectors", [](SectorSolver& s) {
    petsc::check(CMSSetCyclic(s.cms, 0, nullptr, nullptr, 1, nullptr));
    petsc::check(CMSSetHarmonic(s.cms, 1));
  });
  refused("the rotation is not orthogonal", [](SectorSolver& s) {
    std::vector<double> R = s.ring.rotation();
    R[0] += 0.1;
    petsc::check(CMSSetCyclic(s.cms, 6, shared_out(RandomRing::low()),
                              shared_out(RandomRing::high()), 3, R.data()));
  });
}

TEST(CMSCyclic, NamesTheRowOfTheSectorThatNothingHolds)
{
  SectorSolver solver(6);
  MatrixXd K = solver.ring.sector().K;
  K.row(16).setZero();
  K.col(16).setZero();
  const petsc::Matrix without = distributed(K);
  petsc::check(CMSSetOperators(solver.cms, without, solver.M, nullptr));
  petsc::check(CMSSetHarmonic(solver.cms, 1));
  const std::string words = message_of(CMSSolve(solver.cms));
  EXPECT_NE(words.find("row 16 of K, in x is empty (empty rows: 2)"), std::string::npos) << words;
}

TEST(CMSCyclic, GivesTheRowsAskedForAndDamping)
{
  SectorSolver all(6), some(6);
  const std::vector<PetscInt> rows{29, 0, 14, 4};
  for (SectorSolver* solver : {&all, &some}) {
    petsc::check(CMSSetOperators(solver->cms, solver->K, solver->M, solver->K));
    petsc::check(CMSSetHarmonic(solver->cms, 1));
  }
  petsc::check(CMSSetOutput(some.cms, shared_out(rows)));
  petsc::check(CMSSolve(all.cms));
  petsc::check(CMSSolve(some.cms));
  for (const int phase : {0, 1}) {
    Mat whole = nullptr, chosen = nullptr;
    petsc::check(CMSGetHarmonicTransformation(all.cms, phase == 0 ? &whole : nullptr,
                                              phase == 1 ? &whole : nullptr));
    petsc::check(CMSGetHarmonicTransformation(some.cms, phase == 0 ? &chosen : nullptr,
                                              phase == 1 ? &chosen : nullptr));
    const MatrixXd T = linear::replicate(whole), T_some = linear::replicate(chosen);
    ASSERT_EQ(T_some.rows(), 4);
    for (int i = 0; i < 4; ++i)
      EXPECT_LT((T_some.row(i) - T.row(rows[std::size_t(i)])).norm(), 1e-12 * T.norm());
  }
  Mat K_r = nullptr, C_r = nullptr;
  petsc::check(CMSGetReducedOperators(all.cms, &K_r, nullptr, &C_r));
  const MatrixXd K = linear::replicate(K_r), C = linear::replicate(C_r);
  EXPECT_LT((C - K).norm(), 1e-6 * K.norm());  // residuals of the modes
}

TEST(CMSCyclic, ObeysItsPrefixAndWritesBothPhases)
{
  petsc::check(PetscOptionsInsertString(nullptr, "-wheel_cms_harmonic 2 -cms_harmonic 1"));
  SectorSolver solver(6);
  petsc::check(PetscObjectSetName(reinterpret_cast<PetscObject>(solver.cms), "wheel"));
  petsc::check(CMSSetOptionsPrefix(solver.cms, "wheel_"));
  petsc::check(CMSSetFromOptions(solver.cms));
  for (const char* name : {"-wheel_cms_harmonic", "-cms_harmonic"})
    petsc::check(PetscOptionsClearValue(nullptr, name));
  PetscInt order = 0;
  petsc::check(CMSGetHarmonic(solver.cms, &order));
  EXPECT_EQ(order, 2);
  petsc::check(CMSSolve(solver.cms));
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      fmt::format("cyclic_test_{}.reduced.h5", petsc::size(PETSC_COMM_WORLD));
  petsc::check(CMSWrite(solver.cms, path.c_str()));
  MPI_Barrier(PETSC_COMM_WORLD);
  const mbs_export::ReducedSystem system = mbs_export::read_reduced(path.string());
  EXPECT_EQ(system.title, "wheel, harmonic 2 of 6 sectors");
  ASSERT_EQ(system.masters.size(), 14U);
  std::set<std::pair<int, int>> different;
  for (const auto& master : system.masters) different.emplace(master.node, master.component);
  EXPECT_EQ(different.size(), 14U);
  MPI_Barrier(PETSC_COMM_WORLD);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace chladni::reduce
