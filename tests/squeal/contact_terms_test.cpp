// What each term of the linear contact does to the reference disc, and what other readings of the
// contact kinematics would: numbers that squeal.json of the references prints. The program has one
// reading; the others are its own matrices with the terms by which they differ.
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <optional>
#include <vector>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Complex = std::complex<double>;
using Eigen::Matrix2d, Eigen::Vector2d;

constexpr double own_frequency_of_terms = 1749.7487734358904, source_frequency_of_terms = 1672.13;
constexpr int n = 3;

/// q'' + C q' + K q = 0 of a mass-normalised pair in the inertial frame.
struct SecondOrder {
  Matrix2d C, K;
};

/// From x' = A x with x = (omega q, p), p = q' + speed D q.
SecondOrder second_order(const Eigen::MatrixXd& A, double omega)
{
  const Matrix2d turn = -A.topLeftCorner<2, 2>(), by_rate = -A.bottomRightCorner<2, 2>();
  return {turn + by_rate, -omega * A.bottomLeftCorner<2, 2>() + by_rate * turn};
}

/// A of x' = A x again, with x = (omega q, q').
Eigen::MatrixXd first_order(const SecondOrder& at, double omega)
{
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A.topRightCorner<2, 2>() = omega * Matrix2d::Identity();
  A.bottomLeftCorner<2, 2>() = -at.K / omega;
  A.bottomRightCorner<2, 2>() = -at.C;
  return A;
}

SecondOrder sum(const SecondOrder& a, double factor, const SecondOrder& b)
{
  return {a.C + factor * b.C, a.K + factor * b.K};
}

/// The terms of the linear contact by SQUEAL, section 2.4, of the pair at the pad.
struct Term {
  double speed;
  PlatePair pair = kirchhoff_3();
  SquealOptions options = reference_options();
  double mu = options.friction.kinetic, k = options.pads[0].stiffness;
  double N_0h = options.pads[0].preload * options.thickness;
  double half_slip = mu * N_0h * options.thickness / 2.0, r_0 = ring_radius;
  Vector2d W{pair.U, 0.0}, W_x{pair.U_r, 0.0}, W_y{0.0, n*pair.U / r_0};

  SecondOrder of_K(const Matrix2d& K) const { return {Matrix2d::Zero(), K / pair.mass}; }

  SecondOrder pad_stiffness() const { return of_K(2.0 * k * W * W.transpose()); }
  /// As it is for beta = 1.
  SecondOrder slopes() const
  {
    return of_K(N_0h * (W_x * W_x.transpose() + W_y * W_y.transpose()));
  }
  /// As it is for beta = 2.
  SecondOrder preload() const { return of_K(2.0 * slopes().K * pair.mass); }
  SecondOrder circulatory() const
  {
    return of_K(-mu * options.thickness * k * W_y * W.transpose());
  }
  SecondOrder friction_squared() const { return of_K(mu * mu * N_0h * W_y * W_y.transpose()); }
  SecondOrder radial_stiffness() const
  {
    const Vector2d W_rphi{0.0, n * pair.U_r};
    return of_K(half_slip / r_0 * W_x * W_rphi.transpose());
  }
  SecondOrder radial_damping() const
  {
    return {half_slip / (r_0 * speed) * W_x * W_x.transpose() / pair.mass, Matrix2d::Zero()};
  }
  SecondOrder gyroscopic() const
  {
    return {2.0 * n * speed * Matrix2d{{0.0, 1.0}, {-1.0, 0.0}}, Matrix2d::Zero()};
  }
  SecondOrder centrifugal() const
  {
    return {Matrix2d::Zero(), -n * n * speed * speed * Matrix2d::Identity()};
  }
  /// As it is for chi = 1.
  SecondOrder normal_turned() const
  {
    const Vector2d W_yy{pair.U_r / r_0 - n * n * pair.U / (r_0 * r_0), 0.0},
        W_xy{0.0, n * (pair.U_r / r_0 - pair.U / (r_0 * r_0))};
    return of_K(-half_slip * (W_xy * W_x.transpose() + W_yy * W_y.transpose()));
  }
};

/// The reading of the contact kinematics with the factors beta and chi; the program's is (1, 0).
struct Reading {
  double beta, chi;
};
constexpr Reading linear_field{2.0, 1.0};

/// A over the speed, with `factor - 1` times a term more.
StateMatrixAt matrices(const Reading& reading, double f_Hz,
                       SecondOrder (Term::*term)() const = nullptr, double factor = 1.0)
{
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3(f_Hz)}));
  return [=](double speed) {
    const double omega = 2.0 * pi * f_Hz;
    const Term of{speed};
    SecondOrder at = second_order(state_matrix(disc, reference_options(), speed), omega);
    at = sum(at, reading.beta - 1.0, of.slopes());
    at = sum(at, reading.chi, of.normal_turned());
    if (term) at = sum(at, factor - 1.0, (of.*term)());
    return first_order(at, omega);
  };
}

std::optional<double> critical_by_pi(const StateMatrixAt& A)
{
  const auto found =
      critical_speed(stability_over_speed(A, {.from = 0.5 * pi, .to = 20.0 * pi, .count = 200}));
  return found ? std::optional(found->speed / pi) : std::nullopt;
}

struct ReadingRow {
  double beta, chi, f_Hz, critical_by_pi;
};
const ReadingRow reading_rows[] = {
    {1.0, 0.0, own_frequency_of_terms, 4.27189840736292},
    {1.0, 0.0, source_frequency_of_terms, 4.256745495510474},
    {2.0, 1.0, own_frequency_of_terms, 4.266012790204654},
    {2.0, 1.0, source_frequency_of_terms, 4.250896559537205},
    {1.0, 1.0, own_frequency_of_terms, 4.267436234145713},
    {1.0, 1.0, source_frequency_of_terms, 4.252325064344921},
    {2.0, 0.0, own_frequency_of_terms, 4.2704737718499635},
    {2.0, 0.0, source_frequency_of_terms, 4.255315786616032},
    {0.0, 0.0, own_frequency_of_terms, 4.273322567900462},
    {0.0, 0.0, source_frequency_of_terms, 4.2581747243380255},
    {0.0, 1.0, own_frequency_of_terms, 4.268859203369069},
    {0.0, 1.0, source_frequency_of_terms, 4.253753089354363},
};

TEST(ContactTerms, OfEachReadingOfTheKinematicsMeetTheCriticalSpeedOfTheReference)
{
  // Growth is known to 1e-11 of 1e4 1/s in two programs and rises by 0.6 per rad/s.
  for (const ReadingRow& row : reading_rows) {
    SCOPED_TRACE(testing::Message() << row.beta << ", " << row.chi << " at " << row.f_Hz);
    const auto found = critical_by_pi(matrices({row.beta, row.chi}, row.f_Hz));
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, row.critical_by_pi, 1e-11 * 1e3);
  }
}

struct EigenvalueRow {
  double f_Hz, speed_by_pi;
  Complex backward, forward;
};
const EigenvalueRow eigenvalue_rows[] = {
    {own_frequency_of_terms,
     1.0,
     {-1.37970579504817, 10994.072879180108},
     {-20.498221781226352, 11123.413091500383}},
    {own_frequency_of_terms,
     3.8,
     {-4.713808731874561, 10985.26327381264},
     {-1.0435406303025356, 11132.242719154921}},
    {own_frequency_of_terms,
     4.0,
     {-4.896635173121177, 10984.312242038928},
     {-0.5728467209467345, 11133.193895775745}},
    {own_frequency_of_terms,
     4.2,
     {-5.072101481575443, 10983.326109477402},
     {-0.1369288937292573, 11134.180152906714}},
    {own_frequency_of_terms,
     4.5,
     {-5.321825536660148, 10981.784166492},
     {0.4600638530456059, 11135.722252381056}},
    {own_frequency_of_terms,
     5.0,
     {-5.703578620767481, 10979.058187173558},
     {1.3279931055108276, 11138.448432266838}},
    {own_frequency_of_terms,
     6.0,
     {-6.349555180851726, 10973.091056573865},
     {2.7032339181400307, 11144.415822803356}},
    {own_frequency_of_terms,
     10.0,
     {-7.843968050234245, 10944.515456447374},
     {5.656175292606741, 11172.991787768311}},
    {own_frequency_of_terms,
     20.0,
     {-8.81362880741713, 10859.44764323244},
     {7.719732428602443, 11258.059679511227}},
    {source_frequency_of_terms,
     1.0,
     {-1.37388422305736, 10506.424755539525},
     {-20.50404335321648, 10641.611738175618}},
    {source_frequency_of_terms,
     3.8,
     {-4.732698075903019, 10497.953202220959},
     {-1.0246512862739385, 10650.104219529621}},
    {source_frequency_of_terms,
     4.0,
     {-4.9207363567230855, 10497.033869222862},
     {-0.5487455373450424, 10651.023703844112}},
    {source_frequency_of_terms,
     4.2,
     {-5.101718762251866, 10496.079764508006},
     {-0.10731161305073164, 10651.977938675072}},
    {source_frequency_of_terms,
     4.5,
     {-5.360207055937864, 10494.58626846425},
     {0.4984453723217133, 10653.471598144435}},
    {source_frequency_of_terms,
     5.0,
     {-5.757578118178759, 10491.941406373777},
     {1.3819926029251024, 10656.11666961291}},
    {source_frequency_of_terms,
     6.0,
     {-6.436803649228466, 10486.13415892388},
     {2.790482386515455, 10661.92418814293}},
    {source_frequency_of_terms,
     10.0,
     {-8.05033462483486, 10458.09869355595},
     {5.8625418672079945, 10689.960031228647}},
    {source_frequency_of_terms,
     20.0,
     {-9.150172473754889, 10373.74090260245},
     {8.056276094940193, 10774.317887201636}},
};

TEST(ContactTerms, OfTheLinearFieldHaveTheEigenvaluesOfTheReference)
{
  for (const EigenvalueRow& row : eigenvalue_rows) {
    SCOPED_TRACE(testing::Message() << row.f_Hz << " Hz at " << row.speed_by_pi);
    const Eigen::VectorXcd all =
        matrices(linear_field, row.f_Hz)(row.speed_by_pi * pi).eigenvalues();
    for (const Complex expected : {row.backward, row.forward}) {
      // Rounding of |lambda| = 1.1e4 in two programs.
      EXPECT_LT((all.array() - expected).abs().minCoeff(), 2e-10 * std::abs(expected));
    }
  }
}

struct TermRow {
  SecondOrder (Term::*term)() const;
  double factor;
  std::optional<double> critical_by_pi;  ///< absent: stability is lost nowhere
  double growth;                         ///< at 6 pi, 1/s
};
const TermRow term_rows[] = {
    {&Term::pad_stiffness, 0.0, 1.200074579342126, 7.057107494063684},
    {&Term::pad_stiffness, 2.0, 5.911831895787698, 0.10038100341028856},
    {&Term::preload, 0.0, 4.268859203368901, 2.6976060407223934},
    {&Term::preload, 2.0, 4.26316447626712, 2.7088682906449297},
    {&Term::circulatory, 0.0, std::nullopt, -0.4660404415563163},
    {&Term::circulatory, 2.0, 2.955056090844268, 8.524611915018932},
    {&Term::friction_squared, 0.0, 4.267264662437964, 2.7007447419911808},
    {&Term::friction_squared, 2.0, 4.264760550442309, 2.7057243957773256},
    {&Term::radial_stiffness, 0.0, 4.268462348807584, 2.696994736913223},
    {&Term::radial_stiffness, 2.0, 4.263567315756554, 2.7094733108633298},
    {&Term::radial_damping, 0.0, std::nullopt, 5.892256256042851},
    {&Term::radial_damping, 2.0, 6.280799772410404, -0.488341920273031},
    {&Term::gyroscopic, 0.0, std::nullopt, 0.00016616404703581714},
    {&Term::gyroscopic, 2.0, 3.140405034446929, 5.022586727908698},
    {&Term::centrifugal, 0.0, 4.266015116522773, 2.7032080640374434},
    {&Term::centrifugal, 2.0, 4.266010463890722, 2.7032597726879364},
};

TEST(ContactTerms, DecideTheStabilityAsInTheReference)
{
  for (const TermRow& row : term_rows) {
    SCOPED_TRACE(testing::Message() << "row " << &row - term_rows << ", factor " << row.factor);
    const StateMatrixAt A = matrices(linear_field, own_frequency_of_terms, row.term, row.factor);
    const auto critical = critical_by_pi(A);
    ASSERT_EQ(critical.has_value(), row.critical_by_pi.has_value());
    if (critical) {
      EXPECT_NEAR(*critical, *row.critical_by_pi, 1e-8);
    }
    const double growth = Eigen::VectorXcd(A(6.0 * pi).eigenvalues()).real().maxCoeff();
    EXPECT_NEAR(growth, row.growth, 1e-9);
  }
}

}  // namespace
}  // namespace chladni::squeal
