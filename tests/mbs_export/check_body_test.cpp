#include "mbs_export/check_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bending_beam.hpp"
#include "mbs_export/make_body.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

/// The names of the checks with this verdict, in one text.
std::string names(const std::vector<Check>& checks, Verdict verdict)
{
  std::string text;
  for (const Check& check : checks)
    if (check.verdict == verdict) text += "[" + check.name + "]";
  return text;
}

double value_of(const std::vector<Check>& checks, const std::string& name)
{
  const auto found = std::ranges::find(checks, name, &Check::name);
  return found == checks.end() ? std::nan("") : found->value;
}

ModalBody held_wheel()
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 12;
  options.damping = {.type = Damping::Type::modal, .ratios = {0.01}};
  return make_body(test::wheel(), options);
}

/// The verdict on a system after `damage` was done to it.
template <class System, class Run, class Damage>
void expect(const System& sound, Run run, const std::string& name, Verdict verdict, Damage damage)
{
  System system = sound;
  damage(system);
  const std::string found = names(run(system), verdict);
  EXPECT_NE(found.find("[" + name + "]"), std::string::npos) << name << " is not in " << found;
}

TEST(CheckReduced, FindsNothingWrongWithSoundSystems)
{
  for (const ReducedSystem& system : {test::wheel(), test::reduced_beam(30, 5)}) {
    const std::vector<Check> checks = check_reduced(system);
    EXPECT_EQ(worst(checks), Verdict::pass)
        << names(checks, Verdict::warn) << names(checks, Verdict::fail);
  }
}

TEST(CheckReduced, CountsRigidModesAndMasslessDirections)
{
  ReducedSystem wheel = test::wheel();
  EXPECT_EQ(value_of(check_reduced(wheel), "rigid modes"), 6);
  EXPECT_EQ(value_of(check_reduced(test::reduced_beam(30, 5)), "rigid modes"), 2);
  EXPECT_EQ(value_of(check_reduced(wheel), "massless directions"), 0);
  wheel.mass_integrals = {};              // they would not be those of the next mass
  wheel.M(5, 5) = wheel.M(11, 11) = 0.0;  // two rotations of the rim, which K resists
  const std::vector<Check> checks = check_reduced(wheel);
  EXPECT_EQ(value_of(checks, "massless directions"), 2);
  EXPECT_EQ(worst(checks), Verdict::pass) << names(checks, Verdict::fail);
}

TEST(CheckReduced, WarnsOfAnAsymmetryOfTenDigitsAndFailsOfEight)
{
  for (const auto& [size, verdict] :
       {std::pair{0.5e-10, Verdict::pass}, {0.5e-8, Verdict::warn}, {2e-8, Verdict::fail}}) {
    expect(test::wheel(), check_reduced, "symmetry of K", verdict, [of = size](ReducedSystem& s) {
      s.K(0, 8) = s.K(8, 0) + of * std::sqrt(s.K(0, 0) * s.K(8, 8));
    });
  }
}

/// The limits of docs/reference/file_formats.md.
void expect_limits(const std::vector<Check>& checks, const std::map<std::string, double>& limits)
{
  for (const auto& [name, limit] : limits) {
    const auto found = std::ranges::find(checks, name, &Check::name);
    ASSERT_NE(found, checks.end()) << name;
    EXPECT_EQ(found->limit, limit) << name;
  }
}

TEST(CheckReduced, HasTheLimitsOfTheReference)
{
  ReducedSystem wheel = test::wheel();
  wheel.C = wheel.H = 1e-5 * wheel.K;
  expect_limits(check_reduced(wheel), {{"symmetry of K", 1e-8},
                                       {"symmetry of H", 1e-8},
                                       {"definiteness of K", 1e-8},
                                       {"definiteness of M", 1e-8},
                                       {"their stiffness", 1e-12},
                                       {"condition of K", 1e8},
                                       {"condition of M", 1e8},
                                       {"rigid-body energy", 1e-6},
                                       {"grounding", 0.0},
                                       {"rigid modes", 6.0},
                                       {"mass of rigid motions", 1e-6},
                                       {"inertia", 1e-6},
                                       {"orthogonality of modes", 1e-8},
                                       {"mass integrals", 1e-8},
                                       {"momentum of coordinates", 1e-8}});
  expect_limits(check_reduced(test::reduced_beam(30, 5)),
                {{"fixed-interface modes", 1e-8}, {"mass of these modes", 1e-8}});
  expect_limits(check_body(held_wheel()), {{"frequencies", 1e-6},
                                           {"rigid-body energy", 1e-6},
                                           {"held displacements", 1e-7},
                                           {"condition of Q_dd", 1e6},
                                           {"symmetry of C", 1e-8},
                                           {"definiteness of C", 1e-8},
                                           {"ring rim", 1e-9}});
  expect_limits(check_body(make_body(test::wheel(), {})),
                {{"shape of rigid modes", 1e-6}, {"orthogonality of modes", 1e-6}});
}

TEST(CheckParts, HaveTheirClosedForms)
{
  using namespace check_parts;
  for (const auto& [value, verdict] : {std::pair{0.99e-2, Verdict::pass},
                                       {1.01e-2, Verdict::warn},
                                       {1.0, Verdict::warn},
                                       {1.01, Verdict::fail},
                                       {std::nan(""), Verdict::fail}})
    EXPECT_EQ(bounded("", value, 1.0, "").verdict, verdict) << value;
  EXPECT_NEAR(asymmetry(Eigen::Matrix2d{{4.0, 0.5}, {0.2, 9.0}}), 0.3 / 6.0, 1e-14);
  EXPECT_NEAR(asymmetry(Eigen::Matrix2d{{4.0, -0.5}, {0.5, -9.0}}), 1.0 / 6.0, 1e-14);
  EXPECT_EQ(asymmetry(Eigen::Matrix2d{{1e14, 0.0}, {0.9, 1e-6}}), 0.0) << "of round-off";
  EXPECT_GT(asymmetry(Eigen::Matrix2d{{1e14, 0.0}, {1.1, 1e-6}}), 1e-4);
  EXPECT_EQ(unit_diagonal(Eigen::Matrix3d{{4, 6, 1}, {6, 9, 1}, {1, 1, -1}}),
            (Eigen::Matrix3d{{1, 1, 1.0 / 6}, {1, 1, 1.0 / 9}, {1.0 / 6, 1.0 / 9, -1.0 / 9}}));
  EXPECT_EQ(relative_eigenvalues(Eigen::Vector3d(-4, 2, 1).asDiagonal()),
            Eigen::Vector3d(-1.0, 0.25, 0.5));
  const auto excess = [](double a, double b, double c) {
    return check_inertia(Eigen::Vector3d(a, b, c).asDiagonal()).value;
  };
  EXPECT_EQ(excess(1, 2, 3), 0.0) << "of a plate";
  EXPECT_DOUBLE_EQ(excess(1, 2, 4), 0.25);
  EXPECT_DOUBLE_EQ(excess(-1, 2, 2), 0.5);
  EXPECT_EQ(excess(0, 0, 0), 1.0);
  Eigen::Matrix3d skew = Eigen::Vector3d(2, 2, 2).asDiagonal();
  skew(0, 1) = 0.4;  // a symmetric part of 0.2 makes 2.2 the largest
  EXPECT_DOUBLE_EQ(check_inertia(skew).value, 0.2 / 2.2);
  const std::vector<AttachmentNode> nodes{{.number = 1, .position = {1, 0, 0}},
                                          {.number = 2, .position = {1, 6, 0}},
                                          {.number = 3, .position = {1, 3, 0}}};
  EXPECT_DOUBLE_EQ(characteristic_length(nodes), std::sqrt(6.0));
  EXPECT_EQ(characteristic_length({nodes[1]}), 1.0);
  Stiffening stiffening{};
  stiffening.K = {Eigen::Matrix2d{{2, 1}, {1, 0}}, Eigen::Matrix2d{{0, 0}, {0, 0}},
                  Eigen::Matrix2d{{8, 1}, {1.5, -10}}};
  EXPECT_DOUBLE_EQ(check_stiffening(stiffening).value, 0.05);
  EXPECT_EQ(check_stiffening(stiffening).limit, 1e-10);
}

TEST(CheckReduced, FailsEachPropertyThatIsSpoiled)
{
  const auto fails = [&, wheel = test::wheel()](const std::string& name, auto damage) {
    expect(wheel, check_reduced, name, Verdict::fail, damage);
  };
  fails("symmetry of K", [](ReducedSystem& s) { s.K(0, 8) += 1e-3 * s.K(0, 0); });
  fails("symmetry of M", [](ReducedSystem& s) { s.M(0, 8) += 1e-3 * s.M(0, 0); });
  fails("symmetry of C", [](ReducedSystem& s) { (s.C = s.K)(0, 8) += 1e-3 * s.K(0, 0); });
  fails("definiteness of K", [](ReducedSystem& s) { s.K(7, 7) *= 0.1; });
  fails("definiteness of M", [](ReducedSystem& s) { s.M(7, 7) *= -0.1; });
  fails("rigid-body energy", [](ReducedSystem& s) { s.K(2, 2) += 1e3; });
  fails("mass of rigid motions", [](ReducedSystem& s) { s.M(7, 7) *= 1.01; });
  fails("mass, kg", [](ReducedSystem& s) { s.M.setZero(); });
  fails("inertia", [](ReducedSystem& s) { s.M(77, 77) += 1.0; });  // the hub about z alone
  fails("their stiffness", [](ReducedSystem& s) {
    s.M(5, 5) = 0.0;
    s.K.row(5).setZero();
    s.K.col(5).setZero();
  });
}

TEST(CheckReduced, FailsResultantsThatRigidMotionsCause)
{
  ReducedSystem wheel = test::wheel();
  wheel.resultants = {{.name = "rim",
                       .kinds = {"force"},
                       .units = {"N"},
                       .elements = {1, 2},
                       .positions = {},
                       .axes = {},
                       .S = wheel.K.topRows(2)}};  // forces on the first node
  EXPECT_LT(value_of(check_reduced(wheel), "resultants rim"), 1e-12);
  expect(wheel, check_reduced, "resultants rim", Verdict::fail,
         [](ReducedSystem& s) { s.resultants[0].S(1, 1) *= 1.01; });
}

/// Two wheels at one place, seen as one of 26 nodes, and springs between their nodes.
/// @param stiffness  N/m
ReducedSystem two_wheels(double stiffness)
{
  const ReducedSystem one = test::wheel();
  ReducedSystem two = one;
  const Eigen::Index n = one.K.rows();
  two.mass_integrals.reset();
  two.K = two.M = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  two.K.topLeftCorner(n, n) = two.K.bottomRightCorner(n, n) = one.K;
  two.M.topLeftCorner(n, n) = two.M.bottomRightCorner(n, n) = one.M;
  for (const AttachmentNode& node : one.attachment_nodes) two.attachment_nodes.push_back(node);
  for (const MasterDof& dof : one.masters)
    two.masters.push_back({dof.node + test::wheel_rim_nodes + 1, dof.component});
  for (std::size_t i = 0; i < one.masters.size(); ++i) {
    if (one.masters[i].component > 2) continue;
    const auto a = Eigen::Index(i), b = n + a;
    two.K(a, a) += stiffness;
    two.K(b, b) += stiffness;
    two.K(a, b) -= stiffness;
    two.K(b, a) -= stiffness;
  }
  return two;
}

TEST(CheckReduced, TakesBodiesOnSoftSprings)
{
  const double soft = 1e-11 * test::wheel().K.diagonal().maxCoeff();
  const std::vector<Check> checks = check_reduced(two_wheels(soft));
  EXPECT_EQ(value_of(checks, "rigid modes"), 6.0);
}

TEST(CheckReduced, FailsAMechanismBeyondTheRigidMotions)
{
  const auto cut_free = [](ReducedSystem& s) {  // node 0 may turn about x without resistance
    s.K.row(3).setZero();
    s.K.col(3).setZero();
  };
  expect(test::wheel(), check_reduced, "rigid modes", Verdict::fail,
         [](ReducedSystem& s) { s = two_wheels(0.0); });
  expect(test::wheel(), check_reduced, "orthogonality of modes", Verdict::fail,
         [&](ReducedSystem& s) {
           cut_free(s);
           s.M(3, 3) = 0.0;
         });
}

TEST(CheckReduced, WarnsOfGroundAndOfIllConditionedMatrices)
{
  const auto warns = [&, wheel = test::wheel()](const std::string& name, auto damage) {
    expect(wheel, check_reduced, name, Verdict::warn, damage);
  };
  warns("grounding", [](ReducedSystem& s) { s.K(2, 2) += 1e8; });
  warns("condition of M", [](ReducedSystem& s) { s.M(5, 5) = 1e-11; });
  warns("condition of K", [](ReducedSystem& s) {
    // Two pairs of rim nodes nearly glued in their rotation about z: how one pair turns against the
    // other is soft beside that.
    const double stiffness = 1e8 * s.K(5, 5);
    for (const int row : {5, 29}) {
      s.K(row, row) += stiffness;
      s.K(row + 6, row + 6) += stiffness;
      s.K(row, row + 6) -= stiffness;
      s.K(row + 6, row) -= stiffness;
    }
  });
}

TEST(CheckReduced, FailsFixedInterfaceModesThatAreNotWhatTheFormatSays)
{
  const auto finds = [&, beam = test::reduced_beam(30, 5)](const char* name, Verdict verdict,
                                                           auto damage) {
    expect(beam, check_reduced, name, verdict, damage);
  };
  finds("fixed-interface modes", Verdict::fail,
        [](ReducedSystem& s) { s.fixed_interface_frequencies[2] *= 1.001; });
  finds("fixed-interface modes", Verdict::fail,
        [](ReducedSystem& s) { s.K(1, 8) = s.K(8, 1) = 1e-3 * s.K(8, 8); });
  finds("mass of these modes", Verdict::fail, [](ReducedSystem& s) { s.M(8, 8) *= 1.001; });
  // Less than 1 is what MacNeal's method of version 0.2 left.
  finds("mass of these modes", Verdict::warn, [](ReducedSystem& s) { s.M(8, 8) *= 0.9; });
}

TEST(CheckBody, FindsNothingWrongWithSoundBodies)
{
  BodyOptions sliding;  // four rigid motions stay
  sliding.fixed = {"hub.x", "hub.y"};
  for (const ModalBody& body :
       {held_wheel(), make_body(test::wheel(), {}), make_body(test::wheel(), sliding),
        make_body(test::reduced_beam(30, 5), {})}) {
    const std::vector<Check> checks = check_body(body);
    EXPECT_EQ(worst(checks), Verdict::pass)
        << names(checks, Verdict::warn) << names(checks, Verdict::fail);
  }
}

TEST(CheckBody, TellsByHowMuchAFrequencyIsTooLow)
{
  ModalBody wheel = held_wheel();
  wheel.free_frequencies = 0.5 * wheel.omega;
  wheel.free_frequencies[4] = 1.25 * wheel.omega[4];
  EXPECT_NEAR(value_of(check_body(wheel), "frequencies"), 0.2, 1e-12);
}

TEST(CheckBody, FailsEachPropertyThatIsSpoiled)
{
  const auto fails = [&, wheel = held_wheel()](const std::string& name, auto damage) {
    expect(wheel, check_body, name, Verdict::fail, damage);
  };
  fails("rigid modes", [](ModalBody& b) { b.kinds[0] = ModeKind::rigid; });
  fails("free rigid motions", [](ModalBody& b) { b.kinds[0] = ModeKind::rigid; });
  fails("rigid modes when free", [](ModalBody& b) { b.n_rigid = 5; });
  fails("frequencies", [](ModalBody& b) { b.free_frequencies *= 1e3; });
  fails("rigid-body energy", [](ModalBody& b) { b.preparation.rigid_residual = 1e-3; });
  fails("held displacements", [](ModalBody& b) { b.attachment_modes(74, 3) = 1e-3; });
  fails("condition of Q_dd", [](ModalBody& b) { b.preparation.condition_directions = 1e9; });
  fails("mass, kg", [](ModalBody& b) { b.mass = -1.0; });
  fails("inertia", [](ModalBody& b) { b.inertia(2, 2) *= 3.0; });
  fails("symmetry of C", [](ModalBody& b) { b.C(0, 1) = b.C(0, 0); });
  fails("ring rim", [](ModalBody& b) { b.rings[0].W(3, 2) *= 1.0001; });
  fails("ring rim", [](ModalBody& b) { b.rings[0].W_t *= -1.0; });
  fails("ring rim", [](ModalBody& b) { b.attachment_nodes[4].position.z() += 0.01; });
  expect(held_wheel(), check_body, "definiteness of C", Verdict::warn,
         [](ModalBody& b) { b.C(0, 0) *= -1.0; });
}

TEST(CheckBody, WarnsOfARingWithoutSlopes)
{
  ModalBody body = held_wheel();
  body.rings[0].W_t.setZero();
  body.rings[0].W_r.setZero();
  EXPECT_NE(names(check_body(body), Verdict::warn).find("[slopes of ring rim]"), std::string::npos);
}

TEST(CheckBody, TakesNoOffenceAtMetresAgainstRadians)
{
  ModalBody body = held_wheel();
  body.condition_Q_dd = 1e9;
  EXPECT_EQ(worst(check_body(body)), Verdict::pass);
  body.preparation.condition_directions = {};  // a file that knows no better
  EXPECT_EQ(names(check_body(body), Verdict::warn), "[condition of Q_dd]");
}

TEST(CheckBody, FailsRigidModesThatAreNoRigidMotionsOrOfAnotherBody)
{
  const auto fails = [&, wheel = make_body(test::wheel(), {})](const std::string& name,
                                                               auto damage) {
    expect(wheel, check_body, name, Verdict::fail, damage);
  };
  fails("shape of rigid modes", [](ModalBody& b) { b.attachment_modes(8, 1) += 0.01; });
  fails("shape of rigid modes", [](ModalBody& b) { b.attachment_nodes[2].position.x() += 0.01; });
  fails("orthogonality of modes", [](ModalBody& b) { b.mass *= 1.001; });
  fails("orthogonality of modes", [](ModalBody& b) { b.attachment_modes.col(5) *= 1.001; });
}

}  // namespace
}  // namespace chladni::mbs_export
