#include "mbs_export/formats/formats.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>

#include "../bending_beam.hpp"
#include "../version_1.hpp"
#include "../wheel.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;

/// What MBDyn has after reading.
struct FemFile {
  Index n_nodes = 0, n_modes = 0;
  std::vector<std::string> labels;
  MatrixXd positions;           ///< [3 x n_nodes]
  std::vector<MatrixXd> modes;  ///< [6 x n_nodes] each
  MatrixXd M, K, C, invariant_3, invariant_4, invariant_5, invariant_8, invariant_9;
  double mass = 0.0;
  Vector3d centre;
  Eigen::Matrix3d inertia;
};

MatrixXd read_rows(std::istream& file, Index n_rows, Index n_cols)
{
  MatrixXd A(n_rows, n_cols);
  for (Index i = 0; i < n_rows; ++i)
    for (Index j = 0; j < n_cols; ++j) file >> A(i, j);
  return A;
}

void read_header(std::istream& file, FemFile& fem)
{
  std::string line, revision;
  std::getline(file, line);  // exactly one comment
  Index attached = -1, constraint = -1, rejected = -1;
  file >> revision >> fem.n_nodes >> fem.n_modes >> attached >> constraint >> rejected;
  EXPECT_EQ(revision, "REV0");
  EXPECT_EQ(attached + constraint + rejected, 0);
  fem.positions.resize(3, fem.n_nodes);
}

void read_modes(std::istream& file, FemFile& fem)
{
  std::string line;
  for (Index j = 0; j < fem.n_modes; ++j) {
    std::getline(file, line);
    EXPECT_TRUE(line.empty() || line.starts_with("**")) << line;
    fem.modes.emplace_back(read_rows(file, fem.n_nodes, 6).transpose());
    std::getline(file, line);  // the rest of the last line
  }
}

void read_group(std::istream& file, FemFile& fem, int number)
{
  const Index n = fem.n_modes;
  switch (number) {
    case 1:
      return read_header(file, fem);
    case 2:
      fem.labels.resize(std::size_t(fem.n_nodes));
      for (std::string& label : fem.labels) file >> label;
      return;
    case 5:
    case 6:
    case 7:
      fem.positions.row(number - 5) = read_rows(file, fem.n_nodes, 1).transpose();
      return;
    case 8:
      return read_modes(file, fem);
    case 9:
      fem.M = read_rows(file, n, n);
      return;
    case 10:
      fem.K = read_rows(file, n, n);
      return;
    case 12:
      file >> fem.mass;
      fem.centre = read_rows(file, 3, 1);
      fem.inertia = read_rows(file, 3, 3);
      return;
    case 13:
      fem.C = read_rows(file, n, n);
      return;
    case 14:
      fem.invariant_3 = read_rows(file, 3, n);
      return;
    case 15:
      fem.invariant_4 = read_rows(file, 3, n);
      return;
    case 16:
      fem.invariant_8 = read_rows(file, 3, 3 * n);
      return;
    case 17:
      fem.invariant_5 = read_rows(file, 3, n * n);
      return;
    case 18:
      fem.invariant_9 = read_rows(file, 3, 3 * n * n);
      return;
    default:
      FAIL() << "RECORD GROUP " << number << " unhandled";
  }
}

/// Line by line and number by number as MBDyn's struct/modal.cc does, with its first-group rule.
FemFile read_fem(const std::string& text, MbdynVersion version)
{
  std::istringstream file(text);
  FemFile fem;
  std::vector<int> seen;
  const std::string start = "** RECORD GROUP ";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("** END OF FILE")) break;
    if (!line.starts_with(start)) continue;
    const int number = std::stoi(line.substr(start.size()));
    EXPECT_TRUE(number == 1 || !seen.empty());
    EXPECT_EQ(std::ranges::count(seen, number), 0) << number << " already parsed";
    EXPECT_LE(number, version == MbdynVersion::v1_7 ? 13 : 18);
    seen.push_back(number);
    read_group(file, fem, number);
    EXPECT_TRUE(file.good()) << "group " << number;
  }
  return fem;
}

BodyOptions held_hub()
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 10;
  options.damping = {.type = Damping::Type::modal, .ratios = {0.02}};
  return options;
}

TEST(MbdynFem, ReturnsEveryDigitOfABody)
{
  const FloatingBody floating = floating_body(test::wheel(), held_hub());
  const ModalBody& body = floating.body;
  const FemFile fem = read_fem(mbdyn_fem(floating, MbdynVersion::develop), MbdynVersion::develop);
  ASSERT_EQ(fem.n_nodes, test::wheel_rim_nodes + 1);
  ASSERT_EQ(fem.n_modes, body.n_modes());
  EXPECT_EQ(fem.labels.front(), "100");
  EXPECT_EQ(fem.labels.back(), "-1");
  for (Index node = 0; node < fem.n_nodes; ++node)
    EXPECT_EQ(Vector3d(fem.positions.col(node)), body.attachment_nodes[std::size_t(node)].position);
  for (Index j = 0; j < fem.n_modes; ++j) {
    EXPECT_EQ(Eigen::VectorXd(fem.modes[std::size_t(j)].reshaped()),
              Eigen::VectorXd(body.attachment_modes.col(j)));
  }
  EXPECT_EQ(fem.M, MatrixXd(MatrixXd::Identity(fem.n_modes, fem.n_modes)));
  EXPECT_EQ(fem.K, MatrixXd(body.omega.cwiseAbs2().asDiagonal()));
  EXPECT_EQ(fem.C, body.C);
  EXPECT_EQ(fem.mass, body.mass);
  EXPECT_EQ(fem.centre, body.centre_of_mass);
  EXPECT_EQ(fem.inertia, body.inertia);
}

TEST(MbdynFem, TakesAnUnsymmetricDampingMatrixByRows)
{
  FloatingBody floating = floating_body(test::wheel(), held_hub());
  floating.body.C(0, 3) = 0.125;
  EXPECT_EQ(read_fem(mbdyn_fem(floating, MbdynVersion::develop), MbdynVersion::develop).C,
            floating.body.C);
}

TEST(MbdynFem, HasTheMomentaOfTheNodesThatItHolds)
{
  // All mass of the wheel sits in its nodes, so the sums over what the file itself says of them are
  // exact: Inv3 = sum m U, Inv4 = sum (m f x U + J V).
  const FemFile fem =
      read_fem(mbdyn_fem(floating_body(test::wheel(), held_hub()), MbdynVersion::develop),
               MbdynVersion::develop);
  double largest = 0.0;
  for (Index j = 0; j < fem.n_modes; ++j) {
    Vector3d invariant_3 = Vector3d::Zero(), invariant_4 = Vector3d::Zero();
    for (Index node = 0; node < fem.n_nodes; ++node) {
      const bool hub = node == test::wheel_rim_nodes;
      const double m = hub ? test::hub_mass : test::rim_node_mass;
      const double J = hub ? test::hub_inertia : test::rim_node_inertia;
      const Vector3d f = fem.positions.col(node), U = fem.modes[std::size_t(j)].col(node).head(3),
                     V = fem.modes[std::size_t(j)].col(node).tail(3);
      invariant_3 += m * U;
      invariant_4 += m * f.cross(U) + J * V;
    }
    // Round-off of sums of 13 terms of at most 1 sqrt(kg).
    EXPECT_LT((fem.invariant_3.col(j) - invariant_3).norm(), 1e-13);
    EXPECT_LT((fem.invariant_4.col(j) - invariant_4).norm(), 1e-13);
    largest = std::max(largest, invariant_3.norm());
  }
  EXPECT_GT(largest, 0.1);  // a held body couples, or the test would tell nothing
}

Matrix3d tilde_matrix(const Vector3d& a)
{
  Matrix3d S;
  S << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return S;
}

TEST(MbdynFem, HasTheInvariantsThatItsReaderMakesOfPointMasses)
{
  // The reader's loop over the nodes of group 11, for masses without inertia of their own.
  const FemFile fem =
      read_fem(mbdyn_fem(floating_body(test::wheel_of_points(), held_hub()), MbdynVersion::develop),
               MbdynVersion::develop);
  const Index n = fem.n_modes;
  MatrixXd I5 = MatrixXd::Zero(3, n * n), I8 = MatrixXd::Zero(3, 3 * n),
           I9 = MatrixXd::Zero(3, 3 * n * n);
  for (Index node = 0; node < fem.n_nodes; ++node) {
    const double m = node == test::wheel_rim_nodes ? test::hub_mass : test::rim_node_mass;
    for (Index j = 0; j < n; ++j) {
      const Vector3d U_j = fem.modes[std::size_t(j)].col(node).head(3);
      I8.middleCols<3>(3 * j) -= m * tilde_matrix(fem.positions.col(node)) * tilde_matrix(U_j);
      for (Index k = 0; k < n; ++k) {
        const Vector3d U_k = fem.modes[std::size_t(k)].col(node).head(3);
        I5.col(j * n + k) += m * U_j.cross(U_k);
        I9.middleCols<3>(3 * (j * n + k)) += m * tilde_matrix(U_j) * tilde_matrix(U_k);
      }
    }
  }
  // Round-off of sums of 13 terms of at most 1.
  EXPECT_LT((fem.invariant_5 - I5).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((fem.invariant_8 - I8).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((fem.invariant_9 - I9).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_GT(std::min({I5.norm(), I8.norm(), I9.norm()}), 0.1);  // or nothing was compared
}

TEST(MbdynFem, ChangesTheInertiaAsTheDeformedPointsDo)
{
  // MBDyn's inertia about the origin, I7 + sum (I8_j + I8_j^T) q_j - sum I9_jk q_j q_k.
  const FloatingBody floating = floating_body(test::wheel_of_points(), held_hub());
  const FemFile fem = read_fem(mbdyn_fem(floating, MbdynVersion::develop), MbdynVersion::develop);
  const Index n = fem.n_modes;
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(n, 0.01, 0.1);
  Matrix3d exact = Matrix3d::Zero(), I7 = Matrix3d::Zero();
  for (Index node = 0; node < fem.n_nodes; ++node) {
    const double m = node == test::wheel_rim_nodes ? test::hub_mass : test::rim_node_mass;
    const Vector3d x = fem.positions.col(node);
    Vector3d moved = x;
    for (Index j = 0; j < n; ++j) moved += q[j] * fem.modes[std::size_t(j)].col(node).head(3);
    exact -= m * tilde_matrix(moved) * tilde_matrix(moved);
    I7 -= m * tilde_matrix(x) * tilde_matrix(x);
  }
  Matrix3d found = I7;
  for (Index j = 0; j < n; ++j) {
    const Matrix3d I8_j = fem.invariant_8.middleCols<3>(3 * j);
    found += q[j] * (I8_j + I8_j.transpose());
    for (Index k = 0; k < n; ++k)
      found -= q[j] * q[k] * fem.invariant_9.middleCols<3>(3 * (j * n + k));
  }
  EXPECT_LT((found - exact).norm(), 1e-13 * exact.norm());
  EXPECT_GT((found - I7).norm(), 1e-3 * exact.norm());
}

TEST(MbdynFem, OfAFreeBodyHasNoRigidModesAndNoMomentum)
{
  BodyOptions options;
  options.keep.count = 20;
  const FloatingBody floating = floating_body(test::wheel(), options);
  EXPECT_EQ(floating.body.n_modes(), 14);  // without the six rigid ones
  EXPECT_GT(floating.body.omega[0], 0.0);
  EXPECT_LT(coupling(floating), 1e-10);  // orthogonality to rigid motions, to round-off
  const FemFile fem = read_fem(mbdyn_fem(floating, MbdynVersion::v1_7), MbdynVersion::v1_7);
  EXPECT_EQ(fem.n_modes, 14);
  EXPECT_EQ(fem.C, MatrixXd(MatrixXd::Zero(14, 14)));
}

TEST(MbdynFem, IsRefusedWhereTheReaderWouldLoseTheCoupling)
{
  const FloatingBody floating = floating_body(test::wheel(), held_hub());
  const std::string text = files::test::error_of([&] { mbdyn_fem(floating, MbdynVersion::v1_7); });
  EXPECT_NE(text.find("mbdyn-develop"), std::string::npos) << text;
}

TEST(FloatingBody, NeedsAllSixRigidMotions)
{
  const std::string text =
      files::test::error_of([] { floating_body(test::reduced_beam(30, 5), {}); });
  EXPECT_NE(text.find("2 of the 6"), std::string::npos) << text;
}

TEST(MbdynFem, HasTheStiffeningOfEachLoadByItsNumber)
{
  FloatingBody floating = test::version_1_floating();
  const Index n = floating.body.n_modes();
  MatrixXd K(n, n), L = MatrixXd::Identity(n, n);
  for (Index i = 0; i < K.size(); ++i) K(i) = 1.0 / double(3 + i);
  floating.body.stiffening = {
      .fixed = {}, .loads = {"omega_zz", "acceleration_y"}, .K = {K + K.transpose(), L}};
  const std::string text = mbdyn_fem(floating, MbdynVersion::develop);
  const std::size_t group = text.find("** RECORD GROUP 19");
  ASSERT_NE(group, std::string::npos);
  std::istringstream file(text.substr(text.find('\n', group)));
  int count = 0, first = 0, second = 0;
  file >> count >> first;
  EXPECT_EQ(read_rows(file, n, n), MatrixXd(K + K.transpose()));
  file >> second;
  EXPECT_EQ(read_rows(file, n, n), L);
  EXPECT_EQ(count, 2);
  EXPECT_EQ(first, 3);    // omega_z^2, after omega_x^2 and omega_y^2
  EXPECT_EQ(second, 11);  // after six products and three angular accelerations
  // The older reader knows no such group.
  EXPECT_EQ(mbdyn_fem(test::version_1_floating(), MbdynVersion::develop).find("GROUP 19"),
            std::string::npos);
}

TEST(MbdynFem, IsTheSameTextAsBefore)
{
  // The three masses of MBDyn's manual on the y axis with two modes, as a body of its own.
  FloatingBody floating{};
  ModalBody& body = floating.body;
  body.attachment_nodes = {{1001, {0, -2, 0}}, {1002, {0, 0, 0}}, {1003, {0, 2, 0}}};
  body.kinds = {ModeKind::constrained, ModeKind::constrained};
  body.omega = Eigen::Vector2d(1.0, 10.0);
  body.attachment_modes = MatrixXd::Zero(18, 2);
  body.attachment_modes.col(0)[2] = body.attachment_modes.col(0)[14] = 1.0;
  body.attachment_modes.col(1)[2] = 1.0;
  body.attachment_modes.col(1)[14] = -1.0;
  body.mass = 3.0;
  body.centre_of_mass.setZero();
  body.inertia = Vector3d(11.0, 3.0, 11.0).asDiagonal();
  floating.momentum = MatrixXd::Zero(3, 2);
  floating.momentum(2, 0) = 2.0;
  floating.angular_momentum = MatrixXd::Zero(3, 2);
  floating.angular_momentum(0, 1) = -4.0;
  EXPECT_EQ(mbdyn_fem(floating, MbdynVersion::develop),
            files::test::bytes_of(CHLADNI_SOURCE_DIR "/tests/data/three_masses.fem"));
}

TEST(MbdynFem, WithAllInvariantsIsTheSameTextAsBefore)
{
  EXPECT_EQ(mbdyn_fem(test::version_1_floating(), MbdynVersion::develop),
            files::test::bytes_of(CHLADNI_SOURCE_DIR "/tests/data/three_nodes.fem"));
}

}  // namespace
}  // namespace chladni::mbs_export::formats
