// Slopes of a ring from the displacements of rings beside it or in the other face.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "squeal/brake/disc_ring.hpp"
#include "tests/squeal/linked_rings.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using mbs_export::ContactRing;
using mbs_export::ModalBody;

/// W = 1 + sin(40 (r - r_0)) of a pair of three diameters on rings at distances from r_0, without
/// rotations of their nodes.
ModalBody body_without_rotations(const std::vector<double>& distances)
{
  ModalBody body = analytic_body({kirchhoff_3()});
  const ContactRing track = body.rings.front();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    ContactRing beside = track;
    beside.name = "beside " + std::to_string(i + 1);
    beside.radius += distances[i];
    beside.W *= 1.0 + std::sin(40.0 * distances[i]);
    body.rings.push_back(beside);
  }
  for (ContactRing& ring : body.rings) {
    ring.W_r.setZero();
    ring.W_t.setZero();
  }
  return body;
}

TEST(SlopesFromDisplacements, ConvergeToThoseOfRotations)
{
  SquealOptions options = reference_options();
  options.slopes_from = {"beside 1", "beside 2"};
  const auto ring = [&](double h) {
    return disc_for(body_without_rotations({-h, h}), options).rings.front();
  };
  const Eigen::RowVectorXd W = ring(1e-3).W.cosine.row(3);
  const auto error = [&](double h) {
    return (ring(h).W_r.cosine.row(3) - 40.0 * W).norm() / (40.0 * W.norm());
  };
  EXPECT_LT(error(1e-3), 1e-3);
  EXPECT_NEAR(error(2e-3) / error(1e-3), 4.0, 0.1);  // second order, two rings beside it
  options.slopes_from = {"beside 2"};
  EXPECT_NEAR(error(2e-3) / error(1e-3), 4.0, 0.1);  // sin has no second derivative at r_0
  // Along the ring, dW/dtheta / r of the plate: as the rotations of a plate without shear are.
  const Disc exact = disc_of({kirchhoff_3()});
  EXPECT_LT((ring(1e-3).W_t.sine - exact.rings[0].W_t.sine).norm(), 1e-12);
  EXPECT_LT((ring(1e-3).W_t.cosine - exact.rings[0].W_t.cosine).norm(), 1e-12);
}

TEST(SlopesFromDisplacements, OfTwoFacesAreTheLeanOfTheLineBetweenThem)
{
  ModalBody body = linked_body(three_pairs(), {-0.01, 0.01});
  const SquealOptions faces = on_faces(brake_options());
  const Eigen::MatrixXd A = matrix_of_brake(body, faces);
  for (std::size_t i = 1; i < 3; ++i) {
    body.rings[i].W_r.setZero();
    body.rings[i].W_t.setZero();
  }
  EXPECT_LT((matrix_of_brake(body, faces) - A).norm(), 1e-13 * A.norm());
}

}  // namespace
}  // namespace chladni::squeal
