#include "squeal/assembly/assembly.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "assembly_parts.hpp"
#include "common/error.hpp"
#include "squeal/assembly/face.hpp"
#include "squeal/assembly/joints.hpp"
#include "squeal/models/assembly_brake.hpp"
#include "tests/squeal/turning_discs.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

Eigen::VectorXcd spectrum(const Eigen::MatrixXd& A)
{
  return A.eigenvalues();
}

Eigen::MatrixXd matrix_of(const AssemblyOptions& options,
                          const std::vector<mbs_export::ModalBody>& bodies)
{
  return AssemblyBrake(options, bodies).state_matrix(speed);
}

TEST(Assembly, OfRigidPlatesIsADiscBetweenPads)
{
  PadPair pad{.angle = 0.0, .stiffness = 6e6, .damping = 4.0, .preload = 2000.0};
  pad.grid = PadGrid{.sector = sector, .points = n_points};
  const auto at = [](std::size_t i) { return Suspension{stiffness[i], damping[i]}; };
  pad.body = PadBody{.mass = plate.mass,
                     .height = height,
                     .radial = at(0),
                     .tangential = at(1),
                     .axial = at(2),
                     .about_radial = RotarySuspension{plate.inertia[0], at(3)},
                     .about_tangential = RotarySuspension{plate.inertia[1], at(4)},
                     .about_axial = RotarySuspension{plate.inertia[2], at(5)}};
  SquealOptions options = reference_options();
  options.pads = {pad};
  std::vector<mbs_export::ModalBody> bodies = bodies_of_two_plates();
  Eigen::Matrix4d S_xy = Eigen::Matrix4d::Zero();  // of the Coriolis forces of each pair
  S_xy(0, 1) = S_xy(2, 3) = 0.2;
  for (const bool has_integrals : {false, true}) {
    if (has_integrals) bodies[0].mass_integrals = integrals_with(S_xy);
    const InertialDisc disc = inertial_disc(disc_on_ring(bodies[0], "track", {}));
    EXPECT_EQ(disc.G.isZero(0.0), !has_integrals);
    const Eigen::VectorXcd expected = spectrum(state_matrix(disc, options, speed));
    const Eigen::VectorXcd found = spectrum(matrix_of(two_plates(), bodies));
    ASSERT_EQ(found.size(), expected.size());
    // Rounding of eigenvalues of 1e4 1/s, of which pairs that touch keep half the digits.
    EXPECT_LT(largest_distance(expected, found), 1e-7);
    EXPECT_LT(largest_distance(found, expected), 1e-7);
  }
}

TEST(Assembly, DoesNotDependOnWhereTheBrakeStandsAroundTheDisc)
{
  AssemblyOptions turned = two_plates();
  const double angle = 1.1, c = std::cos(angle), s = std::sin(angle);
  for (PartOptions& part : turned.parts) {
    part.position = {c * part.position[0], s * part.position[0], part.position[2]};
    part.rotation[2] = angle;
  }
  // A joint has the axes of the brake: equal springs in all directions turn with it.
  AssemblyOptions still = two_plates();
  for (AssemblyOptions* options : {&turned, &still})
    for (JointOptions& joint : options->joints) {
      joint.stiffness = {2e7, 2e7, 5e6, 3e3, 3e3, 2e4};
      joint.damping = {20.0, 20.0, 30.0, 0.05, 0.05, 0.05};
    }
  const Eigen::VectorXcd expected = spectrum(matrix_of(still, bodies_of_two_plates()));
  EXPECT_LT(largest_distance(expected, spectrum(matrix_of(turned, bodies_of_two_plates()))), 1e-7);
}

/// K, C and D of z'' + (2 Omega D + C) z' + (Omega^2 D^2 + K + Omega C D) z = 0, out of A.
struct SecondOrder {
  Eigen::MatrixXd K, C;
};

SecondOrder second_order(const Eigen::MatrixXd& A)
{
  const Eigen::Index n = A.rows() / 2;
  const Eigen::MatrixXd OmegaD = -A.topLeftCorner(n, n);
  const Eigen::VectorXd s = A.topRightCorner(n, n).diagonal();
  const Eigen::MatrixXd K = -A.bottomLeftCorner(n, n) * s.asDiagonal();
  const Eigen::MatrixXd C = -A.bottomRightCorner(n, n) - OmegaD;
  return {K + OmegaD * OmegaD + C * OmegaD, C + 2.0 * OmegaD};
}

Eigen::MatrixXd kernel(const Eigen::MatrixXd& B)
{
  return Eigen::FullPivLU<Eigen::MatrixXd>(B).kernel();
}

/// Eigenvalues of the brake whose points do not leave the faces: z = T y with B T = 0, and the
/// forces P n at the points do no work on L, L^T P = 0.
Eigen::VectorXcd rigid_contact(const Assembly& all, double mu)
{
  std::vector<Lining> soft = all.linings;
  for (Lining& lining : soft) lining.stiffness = lining.damping = 0.0;
  const SecondOrder rest = second_order(state_matrix(all, soft, speed));
  const Eigen::Index m = std::ssize(all.points);
  Eigen::MatrixXd B(m, all.n_coordinates()), P(all.n_coordinates(), m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const AssemblyPoint& point = all.points[static_cast<std::size_t>(i)];
    const Eigen::MatrixXd& S = point.S;  // w, g_r, g_t, then r, t, z
    B.row(i) = (S.col(0) - S.col(5)).transpose();
    // One newton more presses both apart and drags the disc back by mu, on the lever of its face.
    P.col(i) = -point.sigma * S.col(0) + mu * point.place.distance * S.col(2) + mu * S.col(4) +
               point.sigma * S.col(5);
  }
  const Eigen::MatrixXd T = kernel(B), L = kernel(P.transpose());
  const Eigen::PartialPivLU<Eigen::MatrixXd> mass(L.transpose() * T);
  const Eigen::Index k = T.cols();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * k, 2 * k);
  A.topRightCorner(k, k).setIdentity();
  A.bottomLeftCorner(k, k) = -mass.solve(L.transpose() * rest.K * T);
  A.bottomRightCorner(k, k) = -mass.solve(L.transpose() * rest.C * T);
  return A.eigenvalues();
}

TEST(Assembly, OnAStiffLiningTendsToRigidContact)
{
  AssemblyOptions options = two_plates();
  options.parts.pop_back();
  options.joints.pop_back();
  options.contacts.pop_back();
  options.contacts[0].damping = {0.0};
  const auto face = plate_body(plate, sector_points(ring_radius, sector, 2));
  const std::vector<mbs_export::ModalBody> bodies{analytic_body({kirchhoff_3(), kirchhoff_2()}),
                                                  face};
  const Assembly all = assembly(options, bodies);
  const Eigen::VectorXcd expected = rigid_contact(all, 0.6);
  ASSERT_EQ(expected.size(), 2 * (4 + 6 - 2));
  const auto distance = [&](double k) {
    std::vector<Lining> linings = all.linings;
    linings[0].stiffness = k;
    return largest_distance(expected, spectrum(state_matrix(all, linings, speed)));
  };
  // Its compliance 1/k is what parts both, so that the distance falls with it.
  const double far = distance(1e11), near = distance(1e12);
  EXPECT_LT(near, 5e-2);
  EXPECT_NEAR(far / near, 10.0, 0.5);
}

TEST(Assembly, JoinsRigidlyWhatStiffSpringsTendTo)
{
  AssemblyOptions options = two_plates();
  options.joints.push_back({.ends = {PartNodes{"upper", "centre"}, PartNodes{"lower", "centre"}},
                            .rigid = {0, 2, 4},
                            .span = 0.05});
  const auto bodies = bodies_of_two_plates();
  const Eigen::MatrixXd A = matrix_of(options, bodies);
  EXPECT_EQ(A.rows(), 2 * (4 + 12 - 3));
  const auto distance = [&](double k) {
    AssemblyOptions stiff = two_plates();
    JointOptions spring = options.joints.back();
    spring.rigid.clear();
    spring.stiffness = {k, 0.0, k, 0.0, 1e-3 * k, 0.0};
    stiff.joints.push_back(spring);
    return largest_distance(spectrum(A), spectrum(matrix_of(stiff, bodies)));
  };
  const double far = distance(1e11), near = distance(1e12);
  EXPECT_LT(near, 1.0);
  EXPECT_NEAR(far / near, 10.0, 0.5);
}

/// The coordinates of a plate_body that turns about the origin by a unit of `theta`.
Eigen::VectorXd turned_about_origin(const PartOptions& options, const Part& part,
                                    const Eigen::Vector3d& theta)
{
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(options.rotation[0], Eigen::Vector3d::UnitX()).matrix();
  Eigen::VectorXd q(6);
  q << std::sqrt(plate.mass) * (R.transpose() * theta.cross(part.positions.col(0))),
      plate.inertia.cwiseSqrt().cwiseProduct(R.transpose() * theta);
  return q;
}

TEST(Joints, AreWithoutForceInTwoPartsThatTurnAsOne)
{
  const auto body = plate_body(plate, {});
  PartOptions upper = part_at("upper", 0.1, 0.4), lower = part_at("lower", 0.0, 1.3);
  upper.position[1] = 0.05;
  const std::vector<Part> parts{placed(upper, body), placed(lower, body)};
  JointOptions joint = suspension_of("upper");
  joint.ends[1] = {"lower", "centre"};
  joint.span = 0.2;
  const JoinedParts all = joined(parts, std::vector{joint});
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d theta = Eigen::Vector3d::Unit(axis);
    Eigen::VectorXd q(12);
    q << turned_about_origin(upper, parts[0], theta), turned_about_origin(lower, parts[1], theta);
    EXPECT_LT((all.K * q).norm(), 1e-12 * all.K.norm() * q.norm());
  }
  EXPECT_EQ(all.B.rows(), 0);
}

TEST(Joints, JoinEachNodeOnceWhereTwoHaveTheSameNearestOne)
{
  // The second node is nearest to two of the first part, and the third one to none.
  const auto at_x = [](const std::vector<double>& x) {
    std::vector<Eigen::Vector3d> nodes;
    for (const double one : x) nodes.emplace_back(one, 0.0, 0.0);
    return plate_body(plate, nodes);
  };
  const std::vector<Part> parts{placed(part_at("upper", 0.0), at_x({0.00, 0.02, 0.03})),
                                placed(part_at("lower", 0.0), at_x({0.00, 0.022, 0.06}))};
  JointOptions joint{
      .ends = {PartNodes{"upper", "face"}, PartNodes{"lower", "face"}}, .rigid = {2}, .span = 0.05};
  const Eigen::MatrixXd B = joined(parts, std::vector{joint}).B;
  // In z each row has the rotation about y of both nodes at the point between them: for a plate
  // that turns as one, the height of that point.
  ASSERT_EQ(B.rows(), 3);
  const double about_y = 1.0 / std::sqrt(plate.inertia[1]);
  const std::array<double, 3> between{0.0, 0.021, 0.045};
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(B(i, 4), -about_y * between[std::size_t(i)], 1e-12) << i;
    EXPECT_NEAR(B(i, 6 + 4), about_y * between[std::size_t(i)], 1e-12) << i;
  }
}

TEST(Joints, ThatAskForTheSameTwiceAskOnce)
{
  // Nodes of two plates that move alike in all components follow what their centres do.
  AssemblyOptions options = two_plates();
  options.joints.push_back({.ends = {PartNodes{"upper", "centre"}, PartNodes{"lower", "centre"}},
                            .rigid = {0, 1, 2, 3, 4, 5},
                            .span = 0.05});
  const auto bodies = bodies_of_two_plates();
  const Eigen::MatrixXd once = matrix_of(options, bodies);
  EXPECT_EQ(once.rows(), 2 * (4 + 12 - 6));
  options.joints.push_back(options.joints.back());
  for (PartNodes& nodes : options.joints.back().ends) nodes.set = "face";
  const Eigen::MatrixXd twice = matrix_of(options, bodies);
  ASSERT_EQ(twice.rows(), once.rows());
  EXPECT_LT(largest_distance(spectrum(once), spectrum(twice)), 1e-6);
}

TEST(Assembly, GivesItsLiningsTheValuesOfASquareMetreTimesTheirArea)
{
  // Two circles of points, which enclose the sector between them.
  std::vector<Eigen::Vector3d> face = sector_points(0.12, sector, 4);
  for (const Eigen::Vector3d& x : sector_points(0.14, sector, 4)) face.push_back(x);
  AssemblyOptions options = two_plates();
  options.rings = {"inner", "outer"};
  for (FaceContact& contact : options.contacts) contact.shares = NodeShares::by_area;
  options.contacts[1].stiffness = {1e9, true};
  options.contacts[1].damping = {2e3, true};
  options.contacts[1].preload = {1e6, true};
  const auto plates = plate_body(plate, face);
  const Assembly all = assembly(options, std::vector{disc_with_two_rings(), plates, plates});
  // The outermost points are half a part from the ends of the sector.
  const double area = 0.75 * sector * (0.14 * 0.14 - 0.12 * 0.12) / 2.0;
  EXPECT_NEAR(all.linings[1].area, area, 1e-12);
  EXPECT_NEAR(all.linings[1].stiffness, 1e9 * area, 1e-3);
  EXPECT_NEAR(all.linings[1].damping, 2e3 * area, 1e-9);
  EXPECT_NEAR(all.linings[1].preload, 1e6 * area, 1e-6);
  EXPECT_EQ(all.linings[0].stiffness, 6e6);
}

/// A body's motion between its rings is that of the polynomial through the four that are nearest.
TEST(Faces, TakeACubicOfTheRadiusFromFourRings)
{
  DiscFaces disc{.rings = {}, .planes = {-half_disc, half_disc}};
  for (const double radius : {0.11, 0.12, 0.13, 0.145, 0.16})
    disc.rings.push_back({.name = "", .radius = radius, .height = 0.0});
  std::vector<Eigen::Vector3d> face;
  const std::vector<double> radii{0.112, 0.125, 0.138, 0.155};
  for (const double r : radii) face.emplace_back(r - ring_radius, 0.0, 0.0);
  const Part part = placed(part_at("upper", half_disc + height), plate_body(plate, face));
  const std::vector<FaceNode> nodes = face_nodes(lining_of("upper"), part, disc, "contact[1]");
  ASSERT_EQ(nodes.size(), 4u);
  EXPECT_EQ(nodes[0].ring_parts[4], 0.0);  // the farthest of five
  EXPECT_EQ(nodes[3].ring_parts[0], 0.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_LE((nodes[i].ring_parts.array() != 0.0).count(), 4) << i;
    for (const int power : {0, 1, 2, 3}) {
      double sum = 0.0;
      for (std::size_t j = 0; j < disc.rings.size(); ++j)
        sum += nodes[i].ring_parts[Eigen::Index(j)] * std::pow(disc.rings[j].radius, power);
      EXPECT_NEAR(sum / std::pow(radii[i], power), 1.0, 1e-12) << i << " " << power;
    }
  }
}

/// A solid pad on a solid disc, whose nodes have no rotations and touch.
TEST(Faces, OfSolidsLieOnTheRingsOfTheirSide)
{
  DiscFaces disc{.rings = {}, .planes = {-half_disc, half_disc}};
  for (const double z : {-half_disc, half_disc})
    for (const double radius : {0.11, 0.15})
      disc.rings.push_back({.name = "", .radius = radius, .height = z});
  std::vector<Eigen::Vector3d> face;
  for (const double r : {0.12, 0.13, 0.14}) face.emplace_back(r - ring_radius, 0.0, 0.0);
  mbs_export::ModalBody pad = plate_body(plate, face);
  for (Eigen::Index row = 0; row < pad.attachment_modes.rows(); ++row)
    if (row % 6 > 2) pad.attachment_modes.row(row).setZero();
  FaceContact lining = lining_of("upper");
  lining.height = 0.0;
  for (const double sigma : {-1.0, 1.0}) {
    const Part part = placed(part_at("upper", sigma * half_disc), pad);
    const std::vector<FaceNode> nodes = face_nodes(lining, part, disc, "contact[1]");
    ASSERT_EQ(nodes.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const double part_of_outer = double(i + 1) / 4.0;  // linear in r between two rings
      const Eigen::Index first = sigma > 0.0 ? 2 : 0;
      Eigen::Vector4d parts = Eigen::Vector4d::Zero();
      parts.segment<2>(first) << 1.0 - part_of_outer, part_of_outer;
      EXPECT_LT((nodes[i].ring_parts - parts).norm(), 1e-12);
      EXPECT_EQ(nodes[i].place.distance, 0.0);
      EXPECT_EQ(nodes[i].sigma, sigma);
    }
  }
  const auto said = [&](double z) -> std::string {
    try {
      face_nodes(lining, placed(part_at("upper", z), pad), disc, "contact[1]");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(said(half_disc + 1e-3).find("is away from it by up to 0.001 m"), std::string::npos);
  lining.height = height;
  EXPECT_NE(said(half_disc + height).find("with height = 0"), std::string::npos)
      << "points below nodes without tilts";
}

TEST(Assembly, VariesWhatAllLiningsHave)
{
  const AssemblyBrake brake(two_plates(), bodies_of_two_plates());
  AssemblyOptions other = two_plates();
  other.friction.kinetic = 0.3;
  for (FaceContact& contact : other.contacts) {
    contact.stiffness = {7e6};
    contact.preload = {1500.0};
    contact.damping = {9.0};
  }
  std::unique_ptr<Brake> varied = brake.with(MapParameter::friction, 0.3);
  varied = varied->with(MapParameter::stiffness, 7e6);
  varied = varied->with(MapParameter::preload, 1500.0);
  varied = varied->with(MapParameter::damping, 9.0);
  const Eigen::MatrixXd A = matrix_of(other, bodies_of_two_plates());
  EXPECT_LT((varied->state_matrix(speed) - A).norm(), 1e-12 * A.norm());
  EXPECT_GT((brake.state_matrix(speed) - A).norm(), 1e-6 * A.norm());
  EXPECT_EQ(varied->parameters().size(), 4u);
  try {
    brake.with({"thickness"}, 0.01);
    ADD_FAILURE() << "thickness varies";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"thickness\" cannot vary in an assembly"),
              std::string::npos)
        << error.what();
  }
  EXPECT_THROW(brake.motion(speed), Error);
}

TEST(Assembly, SaysWhatDoesNotFit)
{
  AssemblyOptions options = two_plates();
  options.parts[1].position[2] += 2.5e-3;
  EXPECT_NE(error_of(options).find("contact[1].face: \"upper.face\" (upper.body.h5) does not touch "
                                   "the disc: with height = 0.01 m its face is away from it by up "
                                   "to 0.0025 m"),
            std::string::npos)
      << error_of(options);
  options = two_plates();
  options.parts[2].position[2] += 1e-3;
  EXPECT_NE(error_of(options).find("reaches into it by up to 0.001 m"), std::string::npos);
  options = two_plates();
  options.parts[1].position[0] += 0.02;
  EXPECT_NE(error_of(options).find("beyond the rings of the disc"), std::string::npos);
  options = two_plates();
  options.joints[1].ends[0].set = "ear";
  EXPECT_NE(error_of(options).find("joint[2].between: part \"lower\" (lower.body.h5) has no "
                                   "attachment nodes \"ear\"; it has: \"centre\", \"face\""),
            std::string::npos)
      << error_of(options);
  options = two_plates();
  options.joints.push_back(
      {.ends = {PartNodes{"upper", "centre"}, PartNodes{"lower", "centre"}}, .rigid = {2}});
  EXPECT_NE(error_of(options).find("joint[3].between: nodes of \"upper.centre\" and "
                                   "\"lower.centre\" are 0.04 m apart"),
            std::string::npos)
      << error_of(options);
  options = two_plates();
  options.contacts[0].shares = NodeShares::by_area;
  EXPECT_NE(error_of(options).find("enclose no area"), std::string::npos);
}

TEST(Assembly, RefusesAPartThatFrictionDragsAway)
{
  for (const std::size_t loose : {0, 1}) {
    AssemblyOptions options = two_plates();
    options.joints[loose].stiffness = {0.0, 0.0, 5e6, 3e3, 2e3, 0.0};
    JointOptions thread = suspension_of("upper");  // by which it hardly moves the other one
    thread.ends[1] = PartNodes{"lower", "centre"};
    thread.stiffness = {1e-3, 1e-3, 0.0, 0.0, 0.0, 1e-3};
    thread.damping = {};
    thread.span = 0.05;
    options.joints.push_back(thread);
    const std::string part = loose == 0 ? "upper" : "lower";
    EXPECT_NE(error_of(options).find("part \"" + part + "\" (" + part + ".body.h5) is not held"),
              std::string::npos)
        << error_of(options);
    // A spring that lets it move at a part of 1e-4 of the first frequency of the disc is none.
    const double slowest = 1e-4 * bodies_of_two_plates()[0].omega.minCoeff();
    for (const double share : {0.9, 1.1}) {
      options.joints[loose].stiffness = {
          plate.mass * std::pow(share * slowest, 2), 2e7, 5e6, 3e3, 2e3, 2e4};
      EXPECT_EQ(error_of(options).empty(), share > 1.0) << error_of(options);
    }
  }
}

TEST(NodeAreas, SumToTheSectorAndAreThoseOfTheTrapezoidalRule)
{
  // Circles 0.10, 0.12, 0.15 and rays 0, 0.1, 0.3: each node has the part of its circle and its ray
  // up to the middle between neighbours.
  const std::vector<double> r{0.10, 0.12, 0.15}, angle{0.0, 0.1, 0.3};
  Eigen::VectorXd radii(9), angles(9);
  for (Eigen::Index i = 0; i < 9; ++i) {
    radii[i] = r[static_cast<std::size_t>(i / 3)];
    angles[i] = angle[static_cast<std::size_t>(i % 3)];
  }
  const Eigen::VectorXd areas = node_areas(radii, angles);
  EXPECT_NEAR(areas.sum(), 0.3 * (0.15 * 0.15 - 0.1 * 0.1) / 2.0, 1e-15);
  EXPECT_NEAR(areas[4], 0.15 * (0.135 * 0.135 - 0.11 * 0.11) / 2.0, 1e-15);
  EXPECT_NEAR(areas[0], 0.05 * (0.11 * 0.11 - 0.1 * 0.1) / 2.0, 1e-15);
  EXPECT_NEAR(areas[8], 0.1 * (0.15 * 0.15 - 0.135 * 0.135) / 2.0, 1e-15);
}

TEST(Assembly, SharesParametersThatDifferByRoundingAlone)
{
  AssemblyOptions options = two_plates();
  options.contacts[1].stiffness.value *= 1.0 + 1e-13;
  const AssemblyBrake equal(options, bodies_of_two_plates());
  EXPECT_EQ(equal.parameters().size(), 4u);
  options.contacts[1].stiffness.value *= 1.1;
  const AssemblyBrake other(options, bodies_of_two_plates());
  EXPECT_EQ(other.parameters().size(), 3u);
  EXPECT_EQ(other.assembly().notes.back().find("linings differ in stiffness:"), 0u);
  EXPECT_EQ(equal.assembly().notes.back().find("linings differ"), std::string::npos);
}

TEST(NodeAreas, OfARectangleAreThoseOfTheTrapezoidalRule)
{
  // 30 x 100 mm about (0.11, 0): 4 x 11 nodes.
  Eigen::VectorXd radii(44), angles(44);
  for (Eigen::Index i = 0; i < 44; ++i) {
    const double x = 0.095 + 0.01 * double(i / 11), y = -0.05 + 0.01 * double(i % 11);
    radii[i] = std::hypot(x, y);
    angles[i] = std::atan2(y, x);
  }
  const Eigen::VectorXd areas = node_areas(radii, angles);
  EXPECT_NEAR(areas.sum(), 0.03 * 0.1, 1e-12);
  EXPECT_NEAR(areas[0], 0.25e-4, 1e-12);
  EXPECT_NEAR(areas[5], 0.5e-4, 1e-12);
  EXPECT_NEAR(areas[16], 1e-4, 1e-12);
}

}  // namespace
}  // namespace chladni::squeal
