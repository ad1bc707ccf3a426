#include "mbs_export/formats/formats.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

#include "../bending_beam.hpp"
#include "../version_1.hpp"
#include "../wheel.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

/// A block as its readers hold it: m1 of row, mode, column.
struct Block {
  Index order = -1, nrow = 0, ncol = 0, nq = 0, nqn = -1, structure = -1;
  MatrixXd m0;
  std::vector<MatrixXd> m1;

  MatrixXd at(const VectorXd& q) const
  {
    MatrixXd M = m0;
    for (std::size_t j = 0; j < m1.size(); ++j) M += q[Index(j)] * m1[j];
    return M;
  }
};

struct SidFile {
  Index n_nodes = 0, n_modes = 0;
  double mass = 0.0;
  std::vector<int> node_ids;
  std::vector<std::map<std::string, Block>> nodes;
  std::map<std::string, Block> blocks;
};

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// A line is `word = value` or a word.
struct Line {
  std::string word, value;
};

std::optional<Line> next_line(std::istream& file)
{
  std::string text;
  if (!std::getline(file, text)) return std::nullopt;
  EXPECT_LT(text.size(), 512u);  // the buffer of EMBSlib's reader
  const auto equals = text.find('=');
  if (equals == std::string::npos) return Line{trimmed(text), ""};
  return Line{trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1))};
}

double real(std::string text)
{
  EXPECT_EQ(text.find('E'), std::string::npos);
  EXPECT_LE(text.find('D'), 19u);  // characters of the mantissa that EMBSlib's reader holds
  std::ranges::replace(text, 'D', 'E');
  return std::stod(text);
}

/// The one to three indices of "m0( 1, 2)", from 0.
std::vector<Index> indices(const std::string& word)
{
  std::vector<Index> found;
  std::istringstream rest(word.substr(word.find('(') + 1));
  for (char separator = ','; separator == ',';) {
    Index i = 0;
    rest >> i >> separator;
    found.push_back(i - 1);
  }
  return found;
}

void set(Block& block, const Line& line, SidDialect dialect)
{
  const std::vector<Index> i = indices(line.word);
  if (block.m0.size() == 0) block.m0.setZero(block.nrow, block.ncol);
  if (line.word.starts_with("m0")) {
    block.m0(i[0], i[1]) = real(line.value);
    if (block.structure == 2) block.m0(i[1], i[0]) = block.m0(i[0], i[1]);
    return;
  }
  EXPECT_EQ(block.order, 1);
  const auto mode = std::size_t(dialect == SidDialect::simpack ? i[1] : i[2]);
  const Index column = dialect == SidDialect::simpack ? i[2] : i[1];
  if (block.m1.empty())
    block.m1.assign(std::size_t(block.nq), MatrixXd::Zero(block.nrow, block.ncol));
  block.m1.at(mode)(i[0], column) = real(line.value);
}

Block read_block(std::istream& file, const std::string& name, SidDialect dialect)
{
  Block block;
  std::map<std::string, Index*> sizes{{"order", &block.order}, {"nrow", &block.nrow},
                                      {"ncol", &block.ncol},   {"nq", &block.nq},
                                      {"nqn", &block.nqn},     {"structure", &block.structure}};
  while (const auto line = next_line(file)) {
    if (line->word == "end " + name) break;
    if (line->word.starts_with("m")) {
      EXPECT_GE(block.structure, 2);  // all six sizes come first, and 0 has no entries
      set(block, *line, dialect);
    } else {
      *sizes.at(line->word) = std::stoi(line->value);
    }
  }
  if (block.m0.size() == 0) block.m0.setZero(block.nrow, block.ncol);
  EXPECT_EQ(block.nqn, 0);
  return block;
}

void read_node(std::istream& file, SidFile& sid, SidDialect dialect)
{
  sid.nodes.emplace_back();
  while (const auto line = next_line(file)) {
    if (line->word == "end node") return;
    if (line->word == "rframe") continue;
    sid.nodes.back()[line->word] = read_block(file, line->word, dialect);
  }
}

/// Word by word, as the readers of EMBSlib and others do.
SidFile read_sid(const std::string& text, SidDialect dialect)
{
  std::istringstream file(text);
  SidFile sid;
  std::string first;
  std::getline(file, first);
  std::istringstream(first) >> sid.n_nodes >> sid.n_modes;
  EXPECT_EQ(next_line(file)->word, "part");
  EXPECT_EQ(next_line(file)->word, "new modal");
  while (const auto line = next_line(file)) {
    if (line->word == "end modal") break;
    if (line->word == "mass") sid.mass = real(line->value);
    if (line->word == "new node") {
      sid.node_ids.push_back(std::stoi(line->value));
      read_node(file, sid, dialect);
    }
    const bool other = line->word == "refmod" || line->word == "frame" ||
                       line->word == "new node" || line->word.starts_with("end ") ||
                       line->word.starts_with("ielastq") || line->word == "mass" ||
                       line->word == "nelastq";
    if (!other) sid.blocks[line->word] = read_block(file, line->word, dialect);
  }
  EXPECT_EQ(next_line(file)->word, "end part");
  return sid;
}

FloatingBody floating_wheel()
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 6;
  options.damping = {.type = Damping::Type::modal, .ratios = {0.02}};
  return floating_body(test::wheel(), options);
}

/// The deformed wheel as lumped masses with isotropic inertia: sums over them are exact.
struct Lumps {
  VectorXd m, J;
  MatrixXd x, u, theta;  ///< [3 x nodes]

  explicit Lumps(const VectorXd& motion)
  {
    const ReducedSystem wheel = test::wheel();
    const Index n = Index(wheel.attachment_nodes.size());
    m.resize(n), J.resize(n);
    x.resize(3, n), u.resize(3, n), theta.resize(3, n);
    for (Index i = 0; i < n; ++i) {
      m[i] = wheel.M(6 * i, 6 * i);
      J[i] = wheel.M(6 * i + 3, 6 * i + 3);
      x.col(i) = wheel.attachment_nodes[std::size_t(i)].position;
      u.col(i) = motion.segment<3>(6 * i);
      theta.col(i) = motion.segment<3>(6 * i + 3);
    }
  }
  /// sum m f(x, u)
  template <typename F>
  MatrixXd sum(const F& f) const
  {
    MatrixXd total = 0.0 * f(0);
    for (Index i = 0; i < m.size(); ++i) total += m[i] * f(i);
    return total;
  }
  Vector3d at(const MatrixXd& A, Index i) const { return A.col(i); }
};

const VectorXd q = (VectorXd(6) << 0.3, -0.2, 0.5, 0.1, -0.4, 0.7).finished();

TEST(SidFem, HasTheInertiaOfTheDeformedBodyToFirstOrder)
{
  const FloatingBody floating = floating_wheel();
  const SidFile sid = read_sid(sid_fem(floating, {}), SidDialect::simpack);
  ASSERT_EQ(sid.n_modes, 6);
  const Lumps w(floating.body.attachment_modes * q);
  const auto first = [&](Index i) -> MatrixXd { return w.at(w.x, i) + w.at(w.u, i); };
  EXPECT_LT((sid.blocks.at("mdCM").at(q) - w.sum(first)).norm(), 1e-13);
  // d/de of J = sum m (p . p I - p p^T), p = x + e u; the own inertia of the lumps is isotropic.
  const auto J = [&](Index i) -> MatrixXd {
    const Vector3d x = w.at(w.x, i), u = w.at(w.u, i);
    return (x.squaredNorm() + 2.0 * x.dot(u)) * Matrix3d::Identity() - x * x.transpose() -
           x * u.transpose() - u * x.transpose();
  };
  const Matrix3d exact = w.sum(J) + w.J.sum() * Matrix3d::Identity();
  const MatrixXd six = sid.blocks.at("J").at(q);
  const VectorXd expected =
      (VectorXd(6) << exact(0, 0), exact(1, 1), exact(2, 2), exact(0, 1), exact(0, 2), exact(1, 2))
          .finished();
  EXPECT_LT((six - expected).norm(), 1e-13);
}

TEST(SidFem, HasTheForcesOfAMovingFrame)
{
  const FloatingBody floating = floating_wheel();
  const SidFile sid = read_sid(sid_fem(floating, {}), SidDialect::simpack);
  const Lumps w(floating.body.attachment_modes * q);
  const Vector3d omega(0.7, -1.1, 0.4);
  for (Index mode = 0; mode < 6; ++mode) {
    const Lumps v(floating.body.attachment_modes.col(mode));
    // int phi . (omega x (omega x (x + u))) dm; a lump adds what its points r do, of which
    // int r r^T dm = J / 2 and phi = theta x r.
    const auto centrifugal = [&](Index i) -> MatrixXd {
      const Vector3d pull = omega.cross(omega.cross(Vector3d(w.at(w.x, i) + w.at(w.u, i))));
      return MatrixXd::Constant(1, 1, v.at(v.u, i).dot(pull));
    };
    double own = 0.0, own_coriolis = 0.0;
    for (Index i = 0; i < w.m.size(); ++i) {
      for (int a = 0; a < 3; ++a) {
        const Vector3d e = Vector3d::Unit(a);
        const Vector3d phi = v.at(v.theta, i).cross(e), u = w.at(w.theta, i).cross(e);
        own += 0.5 * w.J[i] * phi.dot(omega.cross(omega.cross(Vector3d(u + e))));
        own_coriolis += 0.5 * w.J[i] * 2.0 * phi.dot(omega.cross(u));
      }
    }
    const VectorXd squares =
        (VectorXd(6) << omega[0] * omega[0], omega[1] * omega[1], omega[2] * omega[2],
         omega[0] * omega[1], omega[1] * omega[2], omega[0] * omega[2])
            .finished();
    const double found = sid.blocks.at("Oe").at(q).row(mode).dot(squares);
    EXPECT_NEAR(found, w.sum(centrifugal)(0, 0) + own, 1e-13);
    // int phi . 2 omega x u' dm with u' = q
    const auto coriolis = [&](Index i) -> MatrixXd {
      return MatrixXd::Constant(1, 1, 2.0 * v.at(v.u, i).dot(omega.cross(w.at(w.u, i))));
    };
    VectorXd Ge = VectorXd::Zero(3);
    for (Index j = 0; j < 6; ++j)
      Ge += q[j] * sid.blocks.at("Ge").m0.row(mode).segment<3>(3 * j).transpose();
    EXPECT_NEAR(Ge.dot(omega), w.sum(coriolis)(0, 0) + own_coriolis, 1e-13);
    // int phi . (omega' x (x + u)) dm
    const auto euler = [&](Index i) -> MatrixXd {
      const Vector3d p = w.at(w.x, i) + w.at(w.u, i);
      return MatrixXd::Constant(1, 1, v.at(v.u, i).dot(omega.cross(p)));
    };
    double own_euler = 0.0;
    for (Index i = 0; i < w.m.size(); ++i) own_euler += w.J[i] * v.at(v.theta, i).dot(omega);
    EXPECT_NEAR(sid.blocks.at("Cr").at(q).row(mode).dot(omega),
                w.sum(euler)(0, 0) + own_euler + 0.5 * own_coriolis, 1e-13);
  }
}

TEST(SidFem, HasTheStiffeningInTheFirstOrderOfTheCoefficientsOfItsLoads)
{
  FloatingBody floating = floating_wheel();
  const Index n = floating.body.n_modes();
  const SidFile without = read_sid(sid_fem(floating, {}), SidDialect::simpack);
  Stiffening stiffening;
  for (std::size_t i = 0; i < stiffening_loads.size(); ++i) {
    const VectorXd v = VectorXd::LinSpaced(n, 1.0, 2.0 + double(i));
    stiffening.loads.push_back(stiffening_loads[i]);
    stiffening.K.emplace_back(v * v.transpose());
  }
  floating.body.stiffening = stiffening;
  const SidFile with = read_sid(sid_fem(floating, {}), SidDialect::simpack);
  // xx, yy, zz, xy, yz, xz of the angular velocity, then its rate and the acceleration
  const std::array<const char*, 3> blocks{"Oe", "Cr", "Ct"};
  const std::array<Index, 3> first{0, 6, 9};
  for (std::size_t b = 0; b < 3; ++b) {
    const MatrixXd added = with.blocks.at(blocks[b]).at(q) - without.blocks.at(blocks[b]).at(q);
    for (Index c = 0; c < added.cols(); ++c) {
      const VectorXd expected = stiffening.K[std::size_t(first[b] + c)] * q;
      EXPECT_LT((added.col(c) - expected).norm(), 1e-13 * expected.norm()) << blocks[b] << c;
    }
  }
}

TEST(SidFem, HasTheTorqueOfAVibratingBodyInASpinningFrame)
{
  const FloatingBody floating = floating_wheel();
  const SidFile sid = read_sid(sid_fem(floating, {}), SidDialect::simpack);
  const Lumps w(floating.body.attachment_modes * q);
  const Vector3d omega(0.7, -1.1, 0.4);
  // int x x (2 omega x u') dm with u' = q; of the lumps themselves J (omega x theta')
  const auto torque = [&](Index i) -> MatrixXd {
    return 2.0 * w.at(w.x, i).cross(omega.cross(w.at(w.u, i)));
  };
  Vector3d exact = w.sum(torque);
  for (Index i = 0; i < w.m.size(); ++i) exact += w.J[i] * omega.cross(w.at(w.theta, i));
  Matrix3d Gr = Matrix3d::Zero();
  for (Index j = 0; j < 6; ++j) Gr += q[j] * sid.blocks.at("Gr").m0.middleCols<3>(3 * j);
  EXPECT_LT((Gr * omega - exact).norm(), 1e-13);
}

TEST(SidFem, ReturnsEveryDigitAndItsNodes)
{
  const FloatingBody floating = floating_wheel();
  const SidFile sid = read_sid(sid_fem(floating, {}), SidDialect::simpack);
  EXPECT_EQ(sid.mass, floating.body.mass);
  ASSERT_EQ(sid.nodes.size(), 13u);
  EXPECT_EQ(sid.node_ids.front(), 100);
  EXPECT_EQ(sid.node_ids.back(), 1);  // the reference node has the number -1 in the mesh
  const MatrixXd& modes = floating.body.attachment_modes;
  EXPECT_EQ(sid.nodes[3].at("phi").m0, MatrixXd(modes.middleRows(18, 3)));
  EXPECT_EQ(sid.nodes[3].at("psi").m0, MatrixXd(modes.middleRows(21, 3)));
  EXPECT_EQ(VectorXd(sid.nodes[3].at("origin").m1[2]), VectorXd(modes.col(2).segment<3>(18)));
  // A vector that turns with the node: AP b = b + theta x b.
  const Vector3d b(1, 2, 3), theta = modes.col(2).segment<3>(21);
  const Vector3d turned = sid.nodes[3].at("AP").m1[2] * b;
  EXPECT_EQ(turned, Vector3d(theta.cross(b)));
  EXPECT_EQ(sid.blocks.at("Ke").m0, MatrixXd(floating.body.omega.cwiseAbs2().asDiagonal()));
  EXPECT_EQ(sid.blocks.at("De").m0, floating.body.C);
  EXPECT_EQ(sid.blocks.at("Me").m0, MatrixXd(MatrixXd::Identity(6, 6)));
}

TEST(SidFem, SaysTheSameInBothDialects)
{
  const FloatingBody floating = floating_wheel();
  const SidFile a = read_sid(sid_fem(floating, {}), SidDialect::simpack);
  const SidFile b = read_sid(sid_fem(floating, {.dialect = SidDialect::welib}), SidDialect::welib);
  const MatrixXd six = a.blocks.at("J").at(q), J = b.blocks.at("J").at(q);
  EXPECT_DOUBLE_EQ(six(3, 0), J(1, 0));
  EXPECT_DOUBLE_EQ(six(4, 0), J(2, 0));
  EXPECT_DOUBLE_EQ(six(5, 0), J(2, 1));
  EXPECT_LT((J - J.transpose()).norm(), 1e-15);
  const MatrixXd Oe_a = a.blocks.at("Oe").at(q), Oe_b = b.blocks.at("Oe").at(q);
  EXPECT_EQ(VectorXd(Oe_a.col(4)), VectorXd(Oe_b.col(5)));
  EXPECT_EQ(VectorXd(Oe_a.col(5)), VectorXd(Oe_b.col(4)));
  EXPECT_GT((Oe_a - Oe_b).norm(), 1e-6);
  EXPECT_EQ(a.blocks.at("Cr").at(q), b.blocks.at("Cr").at(q));
}

/// Columns of Gr or Ge by mode and axis, from those by axis and mode.
MatrixXd by_mode(const MatrixXd& by_axis)
{
  MatrixXd A(by_axis.rows(), by_axis.cols());
  const Index n = by_axis.cols() / 3;
  for (Index mode = 0; mode < n; ++mode)
    for (Index c = 0; c < 3; ++c) A.col(3 * mode + c) = by_axis.col(c * n + mode);
  return A;
}

TEST(SidFem, HasGyroscopicColumnsByModeOrByAxis)
{
  const FloatingBody floating = floating_wheel();
  const SidFile a =
      read_sid(sid_fem(floating, {.gyroscopic = SidGyroscopic::by_mode}), SidDialect::simpack);
  const SidFile b =
      read_sid(sid_fem(floating, {.gyroscopic = SidGyroscopic::by_axis}), SidDialect::simpack);
  for (const std::string name : {"Gr", "Ge"}) {
    EXPECT_EQ(a.blocks.at(name).m0, by_mode(b.blocks.at(name).m0)) << name;
    EXPECT_GT((a.blocks.at(name).m0 - b.blocks.at(name).m0).norm(), 1e-6) << name;
  }
  // No mode has a gyroscopic force on itself: what tells the orders apart in a file.
  for (Index mode = 0; mode < 6; ++mode)
    for (Index c = 0; c < 3; ++c) EXPECT_EQ(b.blocks.at("Ge").m0(mode, 6 * c + mode), 0.0);
  EXPECT_EQ(a.blocks.at("Oe").m0, b.blocks.at("Oe").m0);
}

TEST(SidFem, IsTheSameTextAsBefore)
{
  EXPECT_EQ(sid_fem(test::version_1_floating(), {}),
            files::test::bytes_of(CHLADNI_SOURCE_DIR "/tests/data/three_nodes.SID_FEM"));
}

TEST(SidFem, NeedsMassIntegrals)
{
  ReducedSystem wheel = test::wheel();
  wheel.mass_integrals.reset();
  const std::string text = files::test::error_of([&] { sid_fem(floating_body(wheel, {}), {}); });
  EXPECT_NE(text.find("reduce the scene again"), std::string::npos) << text;
}

}  // namespace
}  // namespace chladni::mbs_export::formats
