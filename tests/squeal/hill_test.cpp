#include "squeal/stability/hill.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/squeal/turning_discs.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Complex = std::complex<double>;

/// Damping that one side of the disc has more of.
Disc disc_with_damping_on_one_side()
{
  Disc disc = disc_of({turned_by(kirchhoff_2(), 0.2), turned_by(kirchhoff_3(), 0.3)});
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(4, 2);
  part.col(0) << 2.0, 0.5, 1.0, 0.0;
  part.col(1) << 0.0, 0.3, 1.0, -2.0;
  disc.C = part * part.transpose() + 0.3 * Eigen::MatrixXd::Identity(4, 4);
  return disc;
}

/// One mode of three diameters without its partner.
Disc disc_with_half_a_pair()
{
  return disc_on_ring(analytic_body({turned_by(kirchhoff_2(), 0.2), turned_by(kirchhoff_3(), 0.3)}),
                      "track", {.nodal_diameters = {}, .list = std::vector{1, 2, 4}});
}

/// The growth by integration over a rotation, to a thousandth.
void expect_floquet(const Disc& disc, const SquealOptions& options)
{
  ASSERT_FALSE(find_inertial_disc(disc));
  const Hill hill(disc, options);
  for (const double speed : {2.0 * pi, 6.0 * pi, 14.0 * pi}) {
    const double growth = rotation_growth(disc, options, speed).growth;
    const HillExponents at = hill.exponents(speed);
    EXPECT_NEAR(at.lambda[0].real(), growth, 1e-3 * std::abs(growth)) << speed / pi << " pi";
    EXPECT_LT(at.error, 1e-4);
    EXPECT_EQ(at.lambda.size(), disc.n_modes() + pad_system(options, ring_places(disc)).n_modes());
  }
}

TEST(Hill, FindsTheLeastStableMotionsAloneAsAmongAll)
{
  Disc damped = mistuned_disc();
  damped.C = Eigen::Vector4d(1.0, 1.0, 60.0, 60.0).asDiagonal();
  for (const Disc& disc :
       {damped, mistuned_disc(), disc_with_vanes(), disc_with_damping_on_one_side()}) {
    const Hill hill(disc, reference_options());
    for (const double speed : {2.0 * pi, 6.0 * pi, 14.0 * pi}) {
      const HillExponents all = hill.exponents(speed);
      for (Eigen::Index n = 1; n <= all.lambda.size(); ++n) {
        const HillExponents some = hill.exponents(speed, n);
        ASSERT_GE(some.lambda.size(), n);
        const Eigen::VectorXd differences = (some.lambda.head(n) - all.lambda.head(n)).real();
        EXPECT_LT(differences.cwiseAbs().maxCoeff(), some.error + all.error + 1e-9);
      }
    }
  }
  // The others are left out where it can be told that they decay faster.
  const Hill hill(damped, reference_options());
  EXPECT_LT(hill.exponents(6.0 * pi, 1).lambda.size(), hill.exponents(6.0 * pi).lambda.size());
}

TEST(Hill, GivesTheEigenvaluesOfAnAxisymmetricDisc)
{
  const Disc disc = disc_of({turned_by(kirchhoff_2(), 0.4), kirchhoff_3()});
  const Hill hill(disc, reference_options());
  for (const double speed : {pi, 4.0 * pi, 12.0 * pi}) {
    const HillExponents at = hill.exponents(speed);
    const Eigen::MatrixXd A = state_matrix(inertial_disc(disc), reference_options(), speed);
    const Eigen::VectorXcd expected = A.eigenvalues();
    for (const Complex lambda : at.lambda)
      EXPECT_LT((expected.array() - lambda).abs().minCoeff(), 1e-9);
    EXPECT_NEAR(at.lambda[0].real(), expected.real().maxCoeff(), 1e-9);
    EXPECT_NEAR(hill.frozen_growth(speed, hill.nu(speed)), expected.real().maxCoeff(), 1e-9);
    EXPECT_EQ(at.harmonics, 0);
  }
}

TEST(Hill, AgreesWithFloquetOnASplitPair)
{
  expect_floquet(disc_of({turned_by(kirchhoff_3(), 0.3, 0.0101)}), reference_options());
}

TEST(Hill, AgreesWithFloquetOnADiscWithVanes)
{
  expect_floquet(disc_with_vanes(), reference_options());
}

TEST(Hill, AgreesWithFloquetOnAMistunedDisc)
{
  expect_floquet(mistuned_disc(), reference_options());
}

TEST(Hill, AgreesWithFloquetWhereDampingChangesAroundTheCircumference)
{
  expect_floquet(disc_with_damping_on_one_side(), reference_options());
}

TEST(Hill, AgreesWithFloquetOnHalfAPair)
{
  expect_floquet(disc_with_half_a_pair(), reference_options());
}

TEST(Hill, AgreesWithFloquetOnADiscWithCoriolisForces)
{
  const Disc disc = disc_with_coriolis(0.0101);
  expect_floquet(disc, reference_options());
  // They count: without them the growth is another one.
  Disc without = disc;
  without.G.setZero();
  const auto growth = [](const Disc& of) {
    return Hill(of, reference_options()).exponents(6.0 * pi).lambda[0].real();
  };
  EXPECT_GT(std::abs(growth(disc) - growth(without)), 0.02 * std::abs(growth(disc)));
}

TEST(Hill, GivesTheEigenvaluesOfAnAxisymmetricDiscWithCoriolisForces)
{
  const Disc disc = disc_with_coriolis(0.0);
  ASSERT_TRUE(find_inertial_disc(disc));
  for (const double speed : {pi, 6.0 * pi}) {
    const Eigen::VectorXcd expected =
        state_matrix(inertial_disc(disc), reference_options(), speed).eigenvalues();
    for (const Complex lambda : Hill(disc, reference_options()).exponents(speed).lambda)
      EXPECT_LT((expected.array() - lambda).abs().minCoeff(), 1e-8) << speed;
  }
}

TEST(Hill, AgreesWithFloquetWherePadsMoveToo)
{
  SquealOptions options = reference_options();
  options.pads[0].body = PadBody{.mass = 0.4, .height = 0.01, .axial = Suspension{4e6, 20.0}};
  options.pads.push_back({.angle = 1.9, .stiffness = 4e6, .damping = 2.0, .preload = 1500.0});
  expect_floquet(disc_of({turned_by(kirchhoff_3(), 0.3, 0.0101)}), options);
}

TEST(Hill, SolvesTheLadderOfItsEquations)
{
  // (lambda + i k 6 speed) x_k = sum_j A_(k-j) x_j for |k| <= 12, as one dense matrix.
  const Disc disc = split_disc();
  const double speed = 3.0 * pi;
  const int K = 12, N = 64, m = 2 * static_cast<int>(disc.n_modes());
  TurningBrake brake(disc, nearest_pairs(disc), reference_options(), speed);
  std::vector<Eigen::MatrixXcd> A(static_cast<std::size_t>(2 * K + 1),
                                  Eigen::MatrixXcd::Zero(m, m));
  for (int s = 0; s < N; ++s)
    for (int k = -K; k <= K; ++k) {
      A[static_cast<std::size_t>(k + K)] +=
          std::polar(1.0 / N, -2.0 * pi * k * s / N) * brake.at(2.0 * pi * s / (6.0 * N));
    }
  Eigen::MatrixXcd ladder = Eigen::MatrixXcd::Zero(m * (2 * K + 1), m * (2 * K + 1));
  for (int k = -K; k <= K; ++k)
    for (int j = std::max(-K, k - K); j <= std::min(K, k + K); ++j) {
      auto block = ladder.block(m * (k + K), m * (j + K), m, m);
      block = A[static_cast<std::size_t>(k - j + K)];
      if (k == j) block.diagonal().array() -= Complex(0.0, 6.0 * k * speed);
    }
  const Eigen::VectorXcd expected = ladder.eigenvalues();
  for (const Complex lambda : Hill(disc, reference_options()).exponents(speed).lambda)
    EXPECT_LT((expected.array() - lambda).abs().minCoeff(), 1e-6);
}

TEST(Hill, ConvergesInItsHarmonics)
{
  // What a coarse tolerance leaves is below its own estimate, and a finer one takes more harmonics.
  const Disc disc = mistuned_disc();
  const HillExponents fine = Hill(disc, reference_options(), 1e-8).exponents(6.0 * pi);
  const HillExponents coarse = Hill(disc, reference_options(), 1.0).exponents(6.0 * pi);
  EXPECT_GT(fine.harmonics, coarse.harmonics);
  EXPECT_LT(fine.error, 1e-7);
  const double change = (fine.lambda - coarse.lambda).real().cwiseAbs().maxCoeff();
  EXPECT_GT(change, 0.0);
  EXPECT_LT(change, coarse.error);
}

/// `disc_with_vanes` as a mesh makes it that does not repeat itself: other harmonics in its shapes.
Disc disc_with_vanes_on_a_mesh(double noise)
{
  return with_shapes(disc_with_vanes(), [&](Harmonics& f) {
    const Eigen::RowVectorXd of_mode = f.cosine.row(2) + f.cosine.row(3);
    f.cosine.row(4) += noise * of_mode;
    f.sine.row(6) -= noise * of_mode;
  });
}

TEST(Hill, LeavesOutHarmonicsThatMoveNoExponent)
{
  // 1e-5 of shapes that do not repeat themselves with the vanes couple states by some 1e-2 1/s,
  // which moves nothing by 1e-5 1/s: the period is that of the vanes, and the answer is that of all
  // harmonics.
  const Disc disc = disc_with_vanes_on_a_mesh(1e-5);
  for (const double speed : {2.0 * pi, 6.0 * pi}) {
    const HillExponents at = Hill(disc, reference_options()).exponents(speed);
    const HillExponents all = Hill(disc, reference_options(), 1e-9).exponents(speed);
    EXPECT_EQ(at.nu, 12);
    EXPECT_LT(all.nu, 12);
    EXPECT_LT((at.lambda - all.lambda).real().cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_LT((at.lambda - all.lambda).real().cwiseAbs().maxCoeff(), at.error);
  }
  // A hundred times more is kept.
  const Disc worse = disc_with_vanes_on_a_mesh(1e-2);
  EXPECT_LT(Hill(worse, reference_options()).exponents(6.0 * pi).nu, 12);
}

TEST(Hill, FindsEveryExponentAtLowSpeed)
{
  // One mode of a pair is damped by 60 1/s more than the other: over a rotation of 2 s the motions
  // of their group decay by factors that no product of matrices holds beside each other.
  Disc disc = mistuned_disc();
  disc.C = Eigen::Vector4d(1.0, 1.0, 1.0, 60.0).asDiagonal();
  const HillExponents at = Hill(disc, reference_options()).exponents(pi);
  EXPECT_GE(at.coupled, 2);
  EXPECT_LT(at.error, 1e-4);
  const int n = 64;
  TurningBrake brake(disc, nearest_pairs(disc), reference_options(), pi);
  double trace = 0.0;
  for (int s = 0; s < n; ++s) trace += brake.at(2.0 * pi * s / n).trace() / n;
  EXPECT_EQ(at.lambda.size(), 4);
  EXPECT_NEAR(2.0 * at.lambda.real().sum(), trace, 1e-4);
  // Each lies on the ladder of harmonics; a finer tolerance finds the same ones.
  const HillExponents finer = Hill(disc, reference_options(), 1e-7).exponents(pi);
  EXPECT_LT((finer.lambda - at.lambda).real().cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT(at.lambda[3].real(), at.lambda[0].real() - 15.0);
}

TEST(Hill, KnowsWhereFrozenAnglesMislead)
{
  // 1 % of split: the standing disc grows at some angle by several times what the turning one does.
  const Disc disc = split_disc();
  const Hill hill(disc, reference_options());
  const double speed = 6.0 * pi, frozen = hill.frozen_growth(speed, hill.nu(speed));
  EXPECT_GT(frozen, 4.0 * hill.exponents(speed).lambda[0].real());
  // No angle is missed by more than a few per cent.
  TurningBrake brake(disc, nearest_pairs(disc), reference_options(), speed);
  double largest = 0.0;
  for (int s = 0; s < 300; ++s) {
    const Eigen::MatrixXd A = brake.at(2.0 * pi * s / 300);
    largest = std::max(largest, A.eigenvalues().real().maxCoeff());
  }
  EXPECT_NEAR(frozen, largest, 0.03 * largest);
}

TEST(Hill, EstimatesThoseMotionsAloneThatCannotGrow)
{
  Disc damped = mistuned_disc();
  damped.C = Eigen::Vector4d(1.0, 1.0, 60.0, 60.0).asDiagonal();
  int n_estimates = 0;
  for (const Disc& disc : {damped, mistuned_disc(), disc_with_vanes()}) {
    const Hill hill(disc, reference_options());
    for (const double speed : {2.0 * pi, 14.0 * pi}) {
      const HillExponents all = hill.exponents(speed), some = hill.followable(speed);
      ASSERT_EQ(some.lambda.size(), all.lambda.size());
      for (Eigen::Index j = 0; j < all.lambda.size(); ++j) {
        // Half of the second order leaves room for the third and those beyond it.
        EXPECT_NEAR(some.lambda[j].real(), all.lambda[j].real(),
                    some.doubt[j] + some.error + all.error + 1e-9);
        n_estimates += some.doubt[j] > 0.0 ? 1 : 0;
        if (some.doubt[j] > 0.0) {
          EXPECT_LT(some.lambda[j].real() + some.doubt[j], 0.0);
        }
      }
    }
  }
  EXPECT_GT(n_estimates, 0);
}

TEST(TurningBrake, MultipliesByItsMatrix)
{
  SquealOptions options = reference_options();
  options.pads[0].body = PadBody{.mass = 0.4, .height = 0.01, .axial = Suspension{4e6, 20.0}};
  const Disc disc = disc_with_damping_on_one_side();
  TurningBrake brake(disc, nearest_pairs(disc), options, 6.0 * pi);
  for (const double phi : {0.0, 0.7, 2.9}) {
    const Eigen::MatrixXd A = brake.at(phi), X = Eigen::MatrixXd::Random(A.rows(), 3);
    EXPECT_LT((brake.times(phi, X) - A * X).norm(), 1e-12 * (A * X).norm());
  }
}

TEST(Hill, FindsMotionsAndLeftVectorsThatSolveTheEquations)
{
  // Omega dr/dphi = A r - lambda r, -Omega dl/dphi = A^T l - lambda l, differentiated by Fourier.
  for (const Disc& disc : {mistuned_disc(), disc_with_vanes(), split_disc()}) {
    const Hill hill(disc, reference_options(), 1e-9);
    const double speed = 9.0 * pi;
    const FloquetMotions motions = hill.motions(speed, 3);
    const double growth = hill.exponents(speed).lambda[0].real();
    ASSERT_GE(motions.lambda.size(), 1);
    EXPECT_NEAR(motions.lambda[0].real(), growth, 1e-7);
    TurningBrake brake = hill.brake(reference_options(), speed);
    for (std::size_t j = 0; j < motions.right.size(); ++j) {
      const Complex lambda = motions.lambda[Eigen::Index(j)];
      const Eigen::Index N = motions.right[j].cols();
      const auto rates = [&](const Eigen::MatrixXcd& x) -> Eigen::MatrixXcd {
        AngleHarmonics c = harmonics_of(x);
        for (Eigen::Index k = 0; k < N; ++k)
          c.col(k) *= Complex(0.0, motions.step * double(order_of(k, N)));
        return samples_of(c);
      };
      const Eigen::MatrixXcd &r = motions.right[j], &l = motions.left[j];
      const Eigen::MatrixXcd dr = rates(r), dl = rates(l);
      Complex product = 0.0;
      for (Eigen::Index s = 0; s < N; ++s) {
        const Eigen::MatrixXd A = brake.at(2.0 * pi * double(s) / double(N * motions.nu));
        EXPECT_LT((A * r.col(s) - lambda * r.col(s) - dr.col(s)).norm(), 1e-4 * r.col(s).norm());
        EXPECT_LT((A.transpose() * l.col(s) - lambda * l.col(s) + dl.col(s)).norm(),
                  1e-4 * l.col(s).norm());
        product += (l.col(s).transpose() * r.col(s)).value() / double(N);
      }
      EXPECT_LT(std::abs(product - 1.0), 1e-12);
    }
  }
}

TEST(NearestPairs, AreOrthogonalAndOfOneHarmonic)
{
  const TurningCoordinates pairs = nearest_pairs(disc_with_half_a_pair());
  EXPECT_EQ(pairs.d, (std::vector{2, 2, 0}));
  EXPECT_LT((pairs.R * pairs.R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  const TurningCoordinates full = nearest_pairs(split_disc());
  EXPECT_EQ(full.d, (std::vector{3, 3}));
}

}  // namespace
}  // namespace chladni::squeal
