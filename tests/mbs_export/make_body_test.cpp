#include "mbs_export/make_body.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "bending_beam.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/files/body_files.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double omega_1_free = 22.3732854528785649;  // rad/s, free beam of 300 elements

/// Rows of `attachment_modes` of the beam.
constexpr int w_A = 2, w_B = 6 + 2, theta_B = 6 + 4, w_C = 12 + 2;

InterfaceModes frm(const std::string& at, int component)
{
  return {.kind = InterfaceModes::Kind::frm, .at = at, .components = {component}, .omega0 = {}};
}

/// Displacement at `row` for a unit harmonic load at `load`: sum phi_row phi_load / (omega^2 -
/// Omega^2).
double receptance(const ModalBody& body, int row, int load, double Omega)
{
  const Eigen::ArrayXd gap = body.omega.array().square() - Omega * Omega;
  return (body.attachment_modes.row(row).array().transpose() *
          body.attachment_modes.row(load).array().transpose() / gap)
      .sum();
}

/// d receptance / d Omega^2 at the load itself.
double receptance_slope(const ModalBody& body, int row, double Omega)
{
  const Eigen::ArrayXd gap = body.omega.array().square() - Omega * Omega;
  return (body.attachment_modes.row(row).array().transpose() / gap).square().sum();
}

TEST(MakeBody, HoldsMastersThatNoModeMovesAlone)
{
  // A rotation without mass has no free mode of its own, so that these cannot hold all six masters.
  // What is left are the fixed-interface modes.
  ReducedSystem beam = test::reduced_beam(30, 8);
  beam.M.row(5).setZero();
  beam.M.col(5).setZero();
  BodyOptions options;
  options.fixed = {"A", "B", "C"};
  const ModalBody body = make_body(beam, options);
  ASSERT_EQ(body.n_modes(), 8);
  // Of the same K and M as these frequencies, whose condition is 1e8.
  EXPECT_LT(
      (body.omega.cwiseQuotient(beam.fixed_interface_frequencies).array() - 1.0).abs().maxCoeff(),
      1e-7);
  EXPECT_EQ(body.n_free_rigid, 0);
  EXPECT_EQ(body.attachment_modes.cwiseAbs().maxCoeff(), 0.0);
}

TEST(MakeBody, OfATolerancesRangeKeepsItsModesWhereAllIsHeld)
{
  const ReducedSystem& beam = test::regression_beam();
  BodyOptions options;
  options.fixed = {"A", "B", "C"};
  const double end =
      0.5 * (beam.fixed_interface_frequencies[4] + beam.fixed_interface_frequencies[5]);
  options.keep.tolerance = Tolerance{.error = 1e-3, .up_to_Hz = end / (2.0 * std::numbers::pi)};
  const ModalBody body = make_body(beam, options);
  ASSERT_EQ(body.n_modes(), 5);
  EXPECT_NEAR(body.omega[4] / beam.fixed_interface_frequencies[4], 1.0, 1e-7);
  EXPECT_FALSE(body.selection);
  options.keep.tolerance->up_to_Hz = 1e-3;
  EXPECT_EQ(make_body(beam, options).n_modes(), 1);
}

TEST(MakeBody, WithAllModesBendsLikeABeam)
{
  BodyOptions options;
  options.fixed = {"A"};
  const ModalBody body = make_body(test::regression_beam(), options);
  EXPECT_EQ(body.n_modes(), 104);
  EXPECT_EQ(body.n_rigid, 2);
  EXPECT_EQ(body.n_free_rigid, 0);
  // Cantilever, L = EI = 1: w(a; b) = a^2 (3 b - a) / 6 for a <= b. Masters are exact in statics;
  // round-off as in omega_1^2, 1e-8.
  EXPECT_NEAR(receptance(body, w_C, w_C, 0.0) * 3.0, 1.0, 1e-7);
  EXPECT_NEAR(receptance(body, w_B, w_B, 0.0) * 81.0, 1.0, 1e-7);
  EXPECT_NEAR(receptance(body, w_B, w_C, 0.0) / (8.0 / 162.0), 1.0, 1e-7);
  EXPECT_NEAR(receptance(body, theta_B, theta_B, 0.0) * 3.0, 1.0, 1e-7);
  EXPECT_LT(body.attachment_modes.row(w_A).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MakeBody, WithAllModesReproducesTheReducedStaticResponse)
{
  const ReducedSystem wheel = test::wheel();
  BodyOptions options;
  options.fixed = {"hub"};
  const ModalBody body = make_body(wheel, options);
  const Index n = 6 * test::wheel_rim_nodes;
  const MatrixXd flexibility =
      Eigen::LLT<MatrixXd>(MatrixXd(wheel.K.topLeftCorner(n, n))).solve(MatrixXd::Identity(n, n));
  const MatrixXd modal = body.attachment_modes.topRows(n) *
                         body.omega.cwiseAbs2().cwiseInverse().asDiagonal() *
                         body.attachment_modes.topRows(n).transpose();
  // Displacements per load differ by 1e4 between forces and moments; each to round-off.
  EXPECT_LT((modal - flexibility).norm(), 1e-10 * flexibility.norm());
}

TEST(MakeBody, MatchesTheHighPrecisionBeamWithAndWithoutAFrequencyResponseMode)
{
  // 60-digit arithmetic, unit harmonic moment about -y at B of the clamped beam, three modes.
  BodyOptions options;
  options.fixed = {"A"};
  options.keep.count = 3;
  const double Omega = 3.0 * omega_1_free;
  const ModalBody plain = make_body(test::regression_beam(), options);
  // Ten digits: round-off of omega^2 near Omega, divided by the distance of the resonance.
  EXPECT_NEAR(-receptance(plain, w_B, theta_B, Omega) / 0.005866842723290715, 1.0, 1e-7);
  EXPECT_NEAR(receptance(plain, theta_B, theta_B, Omega) / -0.020402070775699166, 1.0, 1e-7);
  options.interface_modes = {frm("B", 4)};
  const ModalBody body = make_body(test::regression_beam(), options);
  ASSERT_EQ(body.n_modes(), 4);
  EXPECT_EQ(body.kinds.back(), ModeKind::interface);
  EXPECT_NEAR(-receptance(body, w_B, theta_B, Omega) / 0.005675273285675983, 1.0, 1e-7);
  EXPECT_NEAR(receptance(body, theta_B, theta_B, Omega) / 0.02628897230759531, 1.0, 1e-7);
  // Force at B of the supported beam, full solution -0.0007344801993152963.
  options.fixed = {"A.z", "C.z"};
  options.interface_modes = {frm("B", 2)};
  const ModalBody supported = make_body(test::regression_beam(), options);
  EXPECT_NEAR(receptance(supported, w_B, w_B, Omega) / -0.0007350817129847388, 1.0, 1e-7);
}

TEST(MakeBody, WithAFrequencyResponseModeIsExactAtItsFrequencyToFirstOrder)
{
  BodyOptions options;
  options.fixed = {"A"};
  const ModalBody complete = make_body(test::regression_beam(), options);
  options.keep.count = 2;
  options.interface_modes = {frm("B", 4)};
  for (const double Omega_0 : {0.0, 0.5 * omega_1_free, 2.0 * omega_1_free}) {
    options.interface_modes[0].omega0 = Omega_0;
    const ModalBody body = make_body(test::regression_beam(), options);
    ASSERT_EQ(body.n_modes(), 3);
    // Exact up to round-off; the slope would be wrong by several per cent without the mode.
    EXPECT_NEAR(receptance(body, theta_B, theta_B, Omega_0) /
                    receptance(complete, theta_B, theta_B, Omega_0),
                1.0, 1e-10);
    EXPECT_NEAR(
        receptance(body, w_C, theta_B, Omega_0) / receptance(complete, w_C, theta_B, Omega_0), 1.0,
        1e-10);
    EXPECT_NEAR(
        receptance_slope(body, theta_B, Omega_0) / receptance_slope(complete, theta_B, Omega_0),
        1.0, 1e-10);
    // At another load and frequency the small body differs: the claim above is not empty.
    EXPECT_GT(std::abs(receptance(body, w_C, w_C, 3.0 * omega_1_free) /
                           receptance(complete, w_C, w_C, 3.0 * omega_1_free) -
                       1.0),
              1e-5);
  }
}

TEST(MakeBody, WithSeveralFrequencyResponseModesIsExactAtEachOfTheirFrequencies)
{
  BodyOptions options;
  options.fixed = {"A"};
  const ModalBody complete = make_body(test::regression_beam(), options);
  options.keep.count = 2;
  const std::vector<double> frequencies{0.0, 0.5 * omega_1_free, 2.0 * omega_1_free};
  for (const double Omega_0 : frequencies) {
    options.interface_modes.push_back(frm("B", 4));
    options.interface_modes.back().omega0 = Omega_0;
  }
  const ModalBody body = make_body(test::regression_beam(), options);
  ASSERT_EQ(body.n_modes(), 2 + 3);
  for (const double Omega_0 : frequencies) {
    EXPECT_NEAR(receptance(body, theta_B, theta_B, Omega_0) /
                    receptance(complete, theta_B, theta_B, Omega_0),
                1.0, 1e-10);
  }
}

TEST(MakeBody, TellsThatAHubLeavesTheDiscFree)
{
  BodyOptions options;
  options.fixed = {"hub.x", "hub.y", "hub.z"};
  const ModalBody body = make_body(test::wheel(), options);
  EXPECT_EQ(body.n_rigid, 6);
  EXPECT_EQ(body.n_free_rigid, 3);
  EXPECT_EQ(std::ranges::count(body.kinds, ModeKind::rigid), 3);
  options.fixed = {};
  const ModalBody free = make_body(test::wheel(), options);
  EXPECT_EQ(free.n_free_rigid, 6);
  EXPECT_EQ(free.condition_Q_dd, 1.0);
  // Solved twice, the second time in modal coordinates: equal to round-off.
  EXPECT_LT((free.omega - free.free_frequencies).norm(), 1e-10 * free.omega.norm());
}

TEST(MakeBody, MovesRigidlyInItsRigidModes)
{
  const ModalBody body = make_body(test::wheel(), {});
  // Six rigid modes with unit modal mass carry the mass: unit acceleration along z of the free body
  // under a unit load is 1 / m at every node, plus rotation; at the hub on the axis only 1 / m.
  const int hub_z = 6 * test::wheel_rim_nodes + 2;
  EXPECT_NEAR(body.attachment_modes.row(hub_z).head(6).squaredNorm() * body.mass, 1.0, 1e-12);
}

TEST(MakeBody, KeepsThePairOfADoubleMode)
{
  BodyOptions options;
  options.fixed = {"hub"};
  const ModalBody all = make_body(test::wheel(), options);
  int cut = 0;  // the first mode whose successor has the same frequency
  while (all.omega[cut + 1] > (1 + 1e-6) * all.omega[cut]) ++cut;
  options.keep.count = cut + 1;
  const ModalBody body = make_body(test::wheel(), options);
  EXPECT_EQ(body.n_modes(), cut + 2);
  EXPECT_EQ(body.preparation.n_partners, 1);
  EXPECT_EQ(body.preparation.n_constrained_modes, 72);
}

TEST(MakeBody, GivesARingOfTheSetsThatAreOne)
{
  const ModalBody body = make_body(test::wheel(), {});
  EXPECT_EQ(find_ring(body, "rim").W.cols(), 78);
  EXPECT_NE(files::test::error_of([&] { find_ring(body, "hub"); }).find("there is 'rim'"),
            std::string::npos);
}

TEST(MakeBody, CarriesThePictureAlong)
{
  ReducedSystem wheel = test::wheel();
  wheel.picture.positions.resize(2, 3);
  wheel.picture.positions << 1, 2, 3, 4, 5, 6;
  wheel.picture.cells = {{0, 1, 1, 1}};
  // The second node of the picture is the hub, the first the mean of hub and rim node 3.
  wheel.picture.transformation = MatrixXd::Zero(6, 78);
  wheel.picture.transformation.block<3, 3>(0, 72).setIdentity();
  wheel.picture.transformation.topRows(3) *= 0.5;
  wheel.picture.transformation.block<3, 3>(0, 18) = 0.5 * MatrixXd::Identity(3, 3);
  wheel.picture.transformation.block<3, 3>(3, 72).setIdentity();
  const ModalBody body = make_body(wheel, {});
  const auto hub = body.attachment_modes.middleRows(72, 3);
  const auto rim = body.attachment_modes.middleRows(18, 3);
  EXPECT_LT((body.picture.transformation.topRows(3) - 0.5 * (hub + rim)).norm(), 1e-12);
  EXPECT_LT((body.picture.transformation.bottomRows(3) - hub).norm(), 1e-12);
}

TEST(MakeBody, CarriesTheResultantsAlong)
{
  const files::test::ScratchFolder folder;
  ReducedSystem wheel = test::wheel();
  wheel.resultants = {{.name = "hub",
                       .kinds = {"a", "b"},
                       .units = {"N", "N m"},
                       .elements = {5},
                       .positions = ResultantModes::Rows::Zero(1, 3),
                       .axes = ResultantModes::Rows(1, 9),
                       .S = MatrixXd::Zero(2, 78)}};
  wheel.resultants[0].axes << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  // Displacement along z and rotation about x of the hub, as if they were forces.
  wheel.resultants[0].S(0, 74) = 2.0;
  wheel.resultants[0].S(1, 75) = 3.0;
  BodyOptions options;
  options.keep.count = 20;
  const ModalBody body = make_body(wheel, options);
  ASSERT_EQ(body.resultants.size(), 1u);
  const MatrixXd& S = body.resultants[0].S;
  EXPECT_LT((S.row(0) - 2.0 * body.attachment_modes.row(74)).norm(), 1e-12);
  EXPECT_LT((S.row(1) - 3.0 * body.attachment_modes.row(75)).norm(), 1e-12);
  write_body(folder.file("a.h5"), body);
  const ModalBody again = read_body(folder.file("a.h5"));
  ASSERT_EQ(again.resultants.size(), 1u);
  EXPECT_EQ(again.resultants[0].S, S);
  EXPECT_EQ(again.resultants[0].units, body.resultants[0].units);
}

TEST(MakeBody, DampsAsTheSceneSays)
{
  ReducedSystem wheel = test::wheel();
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 1;
  EXPECT_EQ(make_body(wheel, options).C.size(), 0);
  options.damping = {.type = Damping::Type::modal, .ratios = {0.01}};
  const ModalBody modal = make_body(wheel, options);
  EXPECT_DOUBLE_EQ(modal.C(0, 0), 0.02 * modal.omega[0]);
  options.damping = {.type = Damping::Type::rayleigh, .alpha = 3.0, .beta = 1e-6};
  const ModalBody rayleigh = make_body(wheel, options);
  EXPECT_DOUBLE_EQ(rayleigh.C(0, 0), 3.0 + 1e-6 * rayleigh.omega[0] * rayleigh.omega[0]);
  // C_r = alpha M_r + beta K_r must give the same.
  options.damping = {.type = Damping::Type::matrix};
  EXPECT_NE(files::test::error_of([&] { make_body(wheel, options); }).find("none"),
            std::string::npos);
  wheel.C = 3.0 * wheel.M + 1e-6 * wheel.K;
  EXPECT_NEAR(make_body(wheel, options).C(0, 0) / rayleigh.C(0, 0), 1.0, 1e-9);
  options.damping = {.type = Damping::Type::modal, .ratios = std::vector(7, 0.01)};
  EXPECT_NE(files::test::error_of([&] { make_body(wheel, options); }).find("7 ratios"),
            std::string::npos);
}

TEST(MakeBody, RefusesLoadsThatCannotActOrDoNotExist)
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.interface_modes = {frm("hub", 2)};
  EXPECT_NE(files::test::error_of([&] { make_body(test::wheel(), options); }).find("hub.z is held"),
            std::string::npos);
  options.interface_modes = {frm("track", 2)};
  EXPECT_NE(files::test::error_of([&] { make_body(test::wheel(), options); }).find("'rim', 'hub'"),
            std::string::npos);
}

TEST(MakeBody, DropsInterfaceModesThatDependOnOthers)
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 10;
  options.interface_modes = {frm("rim", 2), frm("rim", 2)};
  const ModalBody body = make_body(test::wheel(), options);
  EXPECT_GE(body.preparation.n_interface_dropped, 12);
  EXPECT_EQ(body.n_modes() + body.preparation.n_interface_dropped - body.preparation.n_partners,
            10 + 24);
}

}  // namespace
}  // namespace chladni::mbs_export
