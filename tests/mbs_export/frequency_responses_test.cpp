#include "mbs_export/responses/frequency_responses.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/eigen_every.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/responses/response_files.hpp"
#include "mbs_export/responses/response_options.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/mbs_export/bending_beam.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd;
using Complex = std::complex<double>;

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr int z = 2, ry = 4;

/// From below the first to above the third frequency of the cantilever, Omega = 3.5, 22, 62.
ResponseOptions cantilever_options(double loss_factor)
{
  return {.loads = {{.at = "C", .components = {z}}, {.at = "B", .components = {ry}}},
          .outputs = {{.at = "C", .components = {z, ry}}, {.at = "B", .components = {ry}}},
          .range = {.from_Hz = 0.1, .to_Hz = 15.0, .count = 73},
          .loss_factor = loss_factor};
}

/// Held at A, with all modes.
BodyOptions held_with(Damping damping)
{
  return {.fixed = {"A"}, .keep = {}, .interface_modes = {}, .damping = std::move(damping)};
}

ModalBody cantilever(Damping damping = {})
{
  return make_body(test::regression_beam(), held_with(std::move(damping)));
}

/// Tip displacement for a tip force of a cantilever with EI = (1 + i eta), L = rho A = 1:
/// (sin b cosh b - cos b sinh b) / (EI b^3 (1 + cos b cosh b)), b^4 = Omega^2 / EI.
Complex exact_tip_receptance(double Omega, double eta)
{
  const Complex EI(1.0, eta);
  const Complex b = std::pow(Complex(Omega * Omega) / EI, 0.25);
  return (std::sin(b) * std::cosh(b) - std::cos(b) * std::sinh(b)) /
         (EI * b * b * b * (1.0 + std::cos(b) * std::cosh(b)));
}

/// Largest difference over the largest value of a column.
double relative_difference(const VectorXcd& a, const VectorXcd& b)
{
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TEST(FrequencyResponses, AreThoseOfTheExactCantilever)
{
  for (const double eta : {0.0, 0.02}) {
    const FrequencyResponses found = frequency_responses(cantilever(), cantilever_options(eta));
    VectorXcd exact(found.Omega.size());
    for (Index f = 0; f < exact.size(); ++f) exact[f] = exact_tip_receptance(found.Omega[f], eta);
    // A frequency of 300 elements is off by 1e-9, and next to a resonance its shift counts most.
    EXPECT_LT(relative_difference(found.H[0].col(0), exact), 1e-6) << "eta = " << eta;
  }
}

TEST(FrequencyResponses, AreReciprocal)
{
  const FrequencyResponses found = frequency_responses(cantilever(), cantilever_options(0.01));
  ASSERT_EQ(found.outputs[2].name, "B.ry");
  EXPECT_LT(relative_difference(found.H[0].col(2), found.H[1].col(0)), 1e-12);
}

/// The reduced matrices of the cantilever: rows of the masters B, C and of the modes.
struct FreeRows {
  MatrixXd K, M, C;
};

FreeRows free_rows(const ReducedSystem& reduced, const MatrixXd& C)
{
  const auto rows = Eigen::seqN(2, reduced.K.rows() - 2);
  return {reduced.K(rows, rows), reduced.M(rows, rows), C(rows, rows)};
}

TEST(FrequencyResponses, SolveTheEquationOfADamperBetweenTheModes)
{
  // Few modes: round-off of the first eigenvalue, 12, is that of the largest one, (12 pi)^4 and
  // more, and the resonance divides it by eta.
  ReducedSystem reduced = test::reduced_beam(60, 12);
  reduced.C = MatrixXd::Zero(reduced.K.rows(), reduced.K.cols());
  reduced.C(2, 2) = 0.7;  // of w at B
  const ModalBody body = make_body(reduced, held_with({.type = Damping::Type::matrix}));
  const FrequencyResponses found = frequency_responses(body, cantilever_options(0.01));
  const FreeRows rows = free_rows(reduced, reduced.C);
  VectorXcd direct(found.Omega.size());
  for (Index f = 0; f < direct.size(); ++f) {
    const double Omega = found.Omega[f];
    const MatrixXcd D = Complex(1.0, 0.01) * rows.K + Complex(0.0, Omega) * rows.C -
                        Complex(Omega * Omega) * rows.M;
    direct[f] = D.partialPivLu().solve(VectorXcd::Unit(D.rows(), 2))[2];  // w at C
  }
  EXPECT_LT(relative_difference(found.H[0].col(0), direct), 1e-7);
}

TEST(FrequencyResponses, OfProportionalDampingAreThoseOfItsMatrix)
{
  ReducedSystem reduced = test::regression_beam();
  reduced.C = 0.3 * reduced.M + 1e-4 * reduced.K;
  const ResponseOptions options = cantilever_options(0.0);
  const FrequencyResponses by_matrix =
      frequency_responses(make_body(reduced, held_with({.type = Damping::Type::matrix})), options);
  const FrequencyResponses by_factors = frequency_responses(
      cantilever({.type = Damping::Type::rayleigh, .alpha = 0.3, .beta = 1e-4}), options);
  for (std::size_t l = 0; l < 2; ++l)
    for (Index o = 0; o < 3; ++o)
      EXPECT_LT(relative_difference(by_matrix.H[l].col(o), by_factors.H[l].col(o)), 1e-8);
}

TEST(FrequencyResponses, DifferByPowersOfTheFrequency)
{
  ResponseOptions options = cantilever_options(0.02);
  const FrequencyResponses receptance = frequency_responses(cantilever(), options);
  options.quantity = ResponseQuantity::mobility;
  const FrequencyResponses mobility = frequency_responses(cantilever(), options);
  options.quantity = ResponseQuantity::accelerance;
  const FrequencyResponses accelerance = frequency_responses(cantilever(), options);
  const VectorXcd rate = Complex(0.0, 1.0) * receptance.Omega;
  const VectorXcd u = receptance.H[1].col(1);
  // Sums over the modes whose terms have the factor or get it afterwards: n rounding errors.
  const double rounding =
      static_cast<double>(cantilever().n_modes()) * std::numeric_limits<double>::epsilon();
  EXPECT_LT(relative_difference(mobility.H[1].col(1), rate.cwiseProduct(u)), rounding);
  EXPECT_LT(relative_difference(accelerance.H[1].col(1), rate.cwiseProduct(rate.cwiseProduct(u))),
            rounding);
  EXPECT_EQ(unit_of(accelerance.quantity, accelerance.outputs[1], accelerance.loads[1]),
            "(rad/s^2)/(N m)");
}

TEST(FrequencyResponses, HaveNoBoundWhereNothingDamps)
{
  const ModalBody body = cantilever();
  ResponseOptions options = cantilever_options(0.0);
  options.range.from_Hz = body.omega[1] / two_pi;
  try {
    frequency_responses(body, options);
    FAIL() << "the second frequency is in the range";
  } catch (const ResponseOptionError& error) {
    EXPECT_EQ(error.key(), "from_Hz");
    EXPECT_NE(error.why().find("mode 2"), std::string::npos) << error.why();
  }
  options.loss_factor = 1e-6;
  EXPECT_GT(frequency_responses(body, options).H[0].row(0).cwiseAbs().maxCoeff(), 1e3);
}

TEST(FrequencyResponses, OfAFreeBodyBeginAboveZero)
{
  const ModalBody body = make_body(test::regression_beam(), {});
  ResponseOptions options = cantilever_options(0.1);
  EXPECT_NO_THROW(frequency_responses(body, options));
  options.range.from_Hz = 0.0;
  EXPECT_THROW(frequency_responses(body, options), ResponseOptionError);
}

/// Of these options with one thing changed: the key that is refused.
template <class Change>
std::string refused(const Change& change)
{
  ResponseOptions options = cantilever_options(0.01);
  change(options);
  try {
    frequency_responses(cantilever(), options);
  } catch (const ResponseOptionError& error) {
    return error.key();
  }
  return "";
}

TEST(FrequencyResponses, RefusePlacesThatAreNone)
{
  EXPECT_EQ(refused([](ResponseOptions& o) { o.loads[1].at = "D"; }), "loads[2].at");
  EXPECT_EQ(refused([](ResponseOptions& o) { o.loads[0].at = "A"; }), "loads[1].dofs");
  EXPECT_EQ(refused([](ResponseOptions& o) { o.outputs[1].components = {0}; }), "outputs[2].dofs");
  EXPECT_EQ(refused([](ResponseOptions& o) { o.outputs[1] = o.outputs[0]; }), "outputs[2].dofs");
  EXPECT_EQ(refused([](ResponseOptions& o) { o.section_forces = {"beam"}; }), "section_forces[1]");
}

TEST(AngularFrequencies, AddOrMultiplyFromOneToTheNext)
{
  const Eigen::VectorXd linear = angular_frequencies({.from_Hz = 1.0, .to_Hz = 4.0, .count = 4});
  EXPECT_NEAR(linear[1], two_pi * 2.0, 1e-14);
  const Eigen::VectorXd multiplied = angular_frequencies(
      {.from_Hz = 1.0, .to_Hz = 8.0, .count = 4, .spacing = Spacing::logarithmic});
  EXPECT_NEAR(multiplied[2], two_pi * 4.0, 1e-13);
  EXPECT_EQ(multiplied[3], two_pi * 8.0);
}

class ResponseFile : public ::testing::Test {
 protected:
  files::test::ScratchFolder folder_;
  std::string path_ = folder_.file("beam.response.h5");

  static FrequencyResponses responses()
  {
    FrequencyResponses found = frequency_responses(cantilever(), cantilever_options(0.01));
    SectionForceResponses forces;
    forces.points = {.name = "beam",
                     .kinds = {"M_y", "Q_z"},
                     .units = {"N m", "N"},
                     .elements = {7},
                     .positions = ResultantModes::Rows::Zero(1, 3),
                     .axes = Eigen::Matrix<double, 1, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1},
                     .S = {}};
    for (std::size_t l = 0; l < found.loads.size(); ++l)
      forces.r.push_back(MatrixXcd::Random(found.Omega.size(), 2));
    found.section_forces.push_back(forces);
    return found;
  }
};

TEST_F(ResponseFile, HoldsWhatWasWritten)
{
  const FrequencyResponses written = responses();
  write_responses(path_, written);
  const FrequencyResponses read = read_responses(path_);
  EXPECT_EQ(read.title, written.title);
  EXPECT_EQ(read.quantity, written.quantity);
  EXPECT_EQ(read.Omega, written.Omega);
  EXPECT_EQ(read.outputs[1].name, "C.ry");
  EXPECT_EQ(read.outputs[1].component, ry);
  EXPECT_EQ(read.loads[1].position, written.loads[1].position);
  for (std::size_t l = 0; l < 2; ++l) {
    EXPECT_EQ(read.H[l], written.H[l]);
    EXPECT_EQ(read.section_forces[0].r[l], written.section_forces[0].r[l]);
  }
}

TEST_F(ResponseFile, RefusesFrequenciesThatDoNotAscend)
{
  FrequencyResponses wrong = responses();
  std::swap(wrong.Omega[3], wrong.Omega[4]);
  write_responses(path_, wrong);
  EXPECT_THROW(read_responses(path_), Error);
}

TEST(ResponseCsv, HasARowForEachFrequencyWithAllDigits)
{
  const FrequencyResponses found = frequency_responses(cantilever(), cantilever_options(0.01));
  const std::string csv = csv_of(found);
  EXPECT_EQ(std::ranges::count(csv, '\n'), found.Omega.size() + 1);
  EXPECT_TRUE(csv.starts_with("\"frequency, Hz\",\"C.z / C.z re, m/N\",\"C.z / C.z im, m/N\""));
  const std::string number = fmt::format("{}", found.H[0](0, 0).real());
  EXPECT_NE(csv.find(number), std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
