// Responses whose errors the reduction tells: their sizes, and the choice that is left to a body.
#include "mbs_export/select_by_tolerance.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>

#include "mbs_export/files/body_files.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/response_error.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

constexpr double up_to_Hz = 2000.0;
constexpr double tolerance = 1e-2;

/// The wheel held at its hub, loaded normal to its plane all around the rim.
BodyOptions rim_options()
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.tolerance = Tolerance{.error = tolerance, .up_to_Hz = up_to_Hz};
  return options;
}

TEST(ResponseSizes, AreThoseOfTheLoadsOfTheTolerance)
{
  const ReducedSystem wheel = test::wheel();
  const ResponseSizes sizes = response_sizes(wheel, rim_options());
  ASSERT_FALSE(sizes.rows.empty());
  for (const int row : sizes.rows) EXPECT_EQ(wheel.masters[std::size_t(row)].component, 2);
  EXPECT_NEAR(sizes.Omega[sizes.Omega.size() - 1], 2.0 * std::numbers::pi * up_to_Hz, 1e-9);
  ASSERT_EQ(sizes.size.rows(), std::ssize(sizes.rows));
  ASSERT_EQ(sizes.size.cols(), sizes.Omega.size() - 1);
  EXPECT_GT(sizes.size.minCoeff(), 0.0);
}

/// |H e_j|, or the root sum of squares of what modes contribute if that is larger.
Eigen::VectorXd size_at(const ReferenceResponse& modes, double Omega)
{
  const Eigen::VectorXcd d = damped_stiffness(modes.omega, Omega);
  const Eigen::MatrixXcd H = modes.B.transpose() * d.cwiseInverse().asDiagonal() * modes.B;
  const Eigen::VectorXd weight = modes.B.rowwise().squaredNorm().array() / d.array().abs2();
  const Eigen::VectorXd squares = modes.B.cwiseAbs2().transpose() * weight;
  return H.colwise().norm().transpose().cwiseMax(squares.cwiseSqrt());
}

TEST(ResponseSizes, AreBelowThoseOfAllFrequenciesOfTheirBandAndNearTheLeast)
{
  constexpr int n = 40, n_loads = 3, n_between = 400;
  std::srand(5);
  for (const int n_rigid : {0, 2}) {
    Eigen::VectorXd omega = Eigen::VectorXd::LinSpaced(n, 200.0, 4.0 * up_to_Hz * std::numbers::pi);
    omega.head(n_rigid).setZero();
    const LoadedDofs loads{.dofs = {0, 1, 2}, .is_moment = {0, 0, 1}, .names = {}, .groups = {}};
    const ReferenceResponse modes =
        reference_modes(omega, Eigen::MatrixXd::Random(n, n_loads), loads);
    const ResponseSizes sizes = response_sizes(modes, {.error = tolerance, .up_to_Hz = up_to_Hz});
    for (Eigen::Index g = 0; g < sizes.size.cols(); ++g) {
      Eigen::VectorXd least = Eigen::VectorXd::Constant(n_loads, 1e300);
      for (int i = 1; i <= n_between; ++i) {
        const double share = i / double(n_between);
        least = least.cwiseMin(
            size_at(modes, (1.0 - share) * sizes.Omega[g] + share * sizes.Omega[g + 1]));
      }
      for (int j = 0; j < n_loads; ++j) {
        EXPECT_LE(sizes.size(j, g), (1.0 + 1e-12) * least[j]) << "band " << g << " load " << j;
        EXPECT_GE(sizes.size(j, g), 0.5 * least[j]) << "band " << g << " load " << j;
      }
    }
  }
}

/// A wheel whose reduction was certified.
ReducedSystem certified_wheel(double error)
{
  ReducedSystem wheel = test::wheel();
  wheel.certificate.fixed = {"hub"};
  wheel.certificate.responses = ResponseCheck{.up_to = 2.0 * std::numbers::pi * up_to_Hz,
                                              .error = error,
                                              .loads = response_sizes(wheel, rim_options()).names};
  return wheel;
}

double error_of_choice(const ModalBody& body)
{
  const SelectionTable& table = *body.selection;
  return std::min(table.modes_only.back().error, table.with_interface_modes.back().error);
}

TEST(CertifiedResponses, LeaveTheBodyTheRestOfTheTolerance)
{
  for (const double of_reduction : {1e-3, 0.7 * tolerance}) {
    const ModalBody body = make_body(certified_wheel(of_reduction), rim_options());
    EXPECT_EQ(body.selection->error, tolerance);
    EXPECT_EQ(body.selection->of_reduction, of_reduction);
    EXPECT_LE(error_of_choice(body) + of_reduction, tolerance);
  }
}

TEST(CertifiedResponses, AboveTheToleranceAreTold)
{
  const ModalBody body = make_body(certified_wheel(2.0 * tolerance), rim_options());
  EXPECT_EQ(body.selection->of_reduction, 2.0 * tolerance);
  EXPECT_LE(error_of_choice(body), tolerance);  // the best that a body can do
}

TEST(CertifiedResponses, AreOfOneSupportOneRangeAndTheirLoads)
{
  EXPECT_FALSE(make_body(test::wheel(), rim_options()).selection->of_reduction);
  ReducedSystem other_support = certified_wheel(1e-3);
  other_support.certificate.fixed = {};
  EXPECT_FALSE(make_body(other_support, rim_options()).selection->of_reduction);
  ReducedSystem other_loads = certified_wheel(1e-3);
  other_loads.certificate.responses->loads = {"rim.x"};
  EXPECT_FALSE(make_body(other_loads, rim_options()).selection->of_reduction);
  ReducedSystem lower_range = certified_wheel(1e-3);
  lower_range.certificate.responses->up_to *= 0.5;
  EXPECT_FALSE(make_body(lower_range, rim_options()).selection->of_reduction);
}

TEST(CertifiedResponses, AreKeptInTheBodyFile)
{
  const files::test::ScratchFolder folder;
  const ModalBody body = make_body(certified_wheel(1e-3), rim_options());
  write_body(folder.file("a.h5"), body);
  EXPECT_EQ(read_body(folder.file("a.h5")).selection->of_reduction, 1e-3);
}

}  // namespace
}  // namespace chladni::mbs_export
