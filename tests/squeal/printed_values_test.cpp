// Numbers that squeal.json of the references prints, each of them by the program's own matrices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>
#include <vector>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Complex = std::complex<double>;

/// Eigenvalues of the reference disc between its pads, one of each complex pair.
struct AtSpeed {
  double speed_by_pi;
  Complex backward, forward;
};

constexpr double own_frequency = 1749.7487734358904, frequency_of_source = 1672.13;

const AtSpeed of_own_frequency[] = {
    {1.0, {-1.3767159027745908, 10993.839721502281}, {-20.501211673499988, 11123.282526385383}},
    {3.8, {-4.702591403577643, 10985.036929126001}, {-1.0547579586001579, 11132.10534128414}},
    {4.0, {-4.885049116031235, 10984.08652512363}, {-0.5844327780382444, 11133.055890134701}},
    {4.2, {-5.060170443973704, 10983.10102370016}, {-0.14885993133037817, 11134.041516128418}},
    {4.5, {-5.309418991313538, 10981.560029442155}, {0.4476573076958907, 11135.582666876151}},
    {5.0, {-5.690481619084376, 10978.835622826096}, {1.3148961038300386, 11138.307274059955}},
    {6.0, {-6.335396210416758, 10972.871536302404}, {2.6890749477072187, 11144.271620518952}},
    {10.0, {-7.827926152220463, 10944.305738685662}, {5.640133394593029, 11172.837782951483}},
    {20.0, {-8.796861429369377, 10859.249962368058}, {7.702965050554597, 11257.893637671124}},
};

const AtSpeed of_frequency_of_the_source[] = {
    {1.0, {-1.3708959487514742, 10506.180783481992}, {-20.50703162752206, 10641.475254008654}},
    {3.8, {-4.721342390415921, 10497.715862217921}, {-1.0360069717642382, 10649.961103576345}},
    {4.0, {-4.9089926136662925, 10496.797151228011}, {-0.560489280403243, 10650.879965883814}},
    {4.2, {-5.089610346678154, 10495.843673634945}, {-0.11942002862613275, 10651.833573593805}},
    {4.5, {-5.347593242308092, 10494.351123580762}, {0.48583155869205047, 10653.326287074355}},
    {5.0, {-5.744224170439419, 10491.70783817858}, {1.3686386551815313, 10655.96978185479}},
    {6.0, {-6.422294187844036, 10485.903671463073}, {2.775972925130693, 10661.774219648141}},
    {10.0, {-8.033702965513946, 10457.878357638738}, {5.845910207888283, 10689.79991116121}},
    {20.0, {-9.132677388861449, 10373.533415533482}, {8.038781010045891, 10774.144918127357}},
};

/// A growing motion of the plate with all its modes.
struct Growing {
  double zeta, speed_by_pi;
  std::vector<std::pair<double, double>> motions;  ///< Hz, 1/s, by rising frequency
};
const Growing all_modes[] = {
    {0.0, 0.5, {}},
    {0.0, 1.0, {}},
    {0.0, 2.0, {}},
    {0.0, 4.0, {}},
    {0.0,
     6.0,
     {{616.3848583702329, 0.3848066355802409},
      {1774.7061551604304, 2.51585963828983},
      {3075.430850039616, 2.0999803891901534},
      {4706.334242986117, 0.7010589111736196}}},
    {0.0,
     10.0,
     {{616.7599563334372, 0.9509314366642729},
      {692.7735030859353, 0.1573901569919162},
      {897.4790580401009, 3.1631800259156413},
      {1779.1357381650037, 5.74211845214678},
      {3082.9569723573322, 4.234576802295537},
      {4716.196634166918, 2.552535676440645},
      {6662.713971534046, 1.1539625133121958},
      {8916.926657701782, 0.06419152881710594}}},
    {0.0,
     20.0,
     {{618.4042576500086, 1.934471971722351},
      {692.7568406113899, 1.071405822576137},
      {901.8293400968984, 8.033921986052562},
      {1792.510036247969, 8.048749793047971},
      {3102.5659903047754, 5.536062295521275},
      {4741.083638986492, 3.77441909452553},
      {6692.674848704118, 2.4945253652729593},
      {8951.912593717536, 1.5435748824651738},
      {11515.395176758822, 0.7625249671349636},
      {14380.622409084228, 0.25505420349481406}}},
    {0.0001, 0.5, {}},
    {0.0001, 1.0, {}},
    {0.0001, 2.0, {}},
    {0.0001, 4.0, {}},
    {0.0001,
     6.0,
     {{616.3848461230792, 0.006213649302982823},
      {1774.7060964302957, 1.4176230869738071},
      {3075.430776020845, 0.17974240762008156}}},
    {0.0001,
     10.0,
     {{616.759951798772, 0.5723871359677286},
      {897.479041664415, 2.6451265836355042},
      {1779.135697300451, 4.643746232696545},
      {3082.956923331056, 2.314304864775359}}},
    {0.0001,
     20.0,
     {{618.4042654278841, 1.556080462962775},
      {692.7567967578341, 0.6584754185192698},
      {901.8293294281831, 7.514928583930893},
      {1792.510005596424, 6.9501853729980345},
      {3102.5659573544644, 3.615762305772323},
      {4741.083597380719, 0.829167090794592}}},
    {0.0005, 0.5, {}},
    {0.0005, 1.0, {}},
    {0.0005, 2.0, {}},
    {0.0005, 4.0, {}},
    {0.0005, 6.0, {}},
    {0.0005,
     10.0,
     {{897.4788969012395, 0.5729128072299978}, {1779.1353603716527, 0.2502577358817827}}},
    {0.0005,
     20.0,
     {{618.4042392239862, 0.04251450073745165},
      {901.8292072023044, 5.438955284753106},
      {1792.5097092975045, 2.55592835873469}}},
    {0.001, 0.5, {}},
    {0.001, 1.0, {}},
    {0.001, 2.0, {}},
    {0.001, 4.0, {}},
    {0.001, 6.0, {}},
    {0.001, 10.0, {}},
    {0.001, 20.0, {{901.828875430115, 2.843989394416197}}},
};
/// Those with a frequency, by falling growth.
std::vector<Complex> oscillations(const Eigen::MatrixXd& A)
{
  std::vector<Complex> found;
  for (const Complex lambda : Eigen::VectorXcd(A.eigenvalues()))
    if (lambda.imag() > 0.0) found.push_back(lambda);
  std::ranges::sort(found, [](Complex a, Complex b) { return a.real() > b.real(); });
  return found;
}

void expect_pair(const AtSpeed& expected, double f_Hz)
{
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3(f_Hz)}));
  auto found = oscillations(state_matrix(disc, reference_options(), expected.speed_by_pi * pi));
  ASSERT_EQ(found.size(), 2u);
  std::ranges::sort(found, {}, [](Complex lambda) { return lambda.imag(); });
  // Rounding of |lambda| = 1.1e4 in two programs.
  EXPECT_LT(std::abs(found[0] - expected.backward), 2e-10 * std::abs(found[0]));
  EXPECT_LT(std::abs(found[1] - expected.forward), 2e-10 * std::abs(found[1]));
}

TEST(PrintedValues, OfTheReferencePairAreItsEigenvaluesAtAllSpeeds)
{
  for (const AtSpeed& expected : of_own_frequency) {
    SCOPED_TRACE(expected.speed_by_pi);
    expect_pair(expected, own_frequency);
  }
  for (const AtSpeed& expected : of_frequency_of_the_source) {
    SCOPED_TRACE(expected.speed_by_pi);
    expect_pair(expected, frequency_of_source);
  }
}

/// Plate modes with a modal damping ratio.
InertialDisc plate_of_pairs(const std::vector<PlatePair>& modes, double zeta)
{
  auto body = analytic_body(modes);
  body.C = (2.0 * zeta * body.omega).asDiagonal();
  return inertial_disc(disc_on_ring(body, "track", {}));
}

TEST(PrintedValues, OfAllPlateModesAreWhatGrowsAtEachDamping)
{
  // Growth is known to rounding of the highest mode, 1e5 1/s, and more is no growth.
  constexpr double rounding = 1e-8;
  for (const Growing& expected : all_modes) {
    SCOPED_TRACE(testing::Message() << "zeta " << expected.zeta << " at " << expected.speed_by_pi);
    auto found = oscillations(state_matrix(plate_of_pairs(kirchhoff_modes(), expected.zeta),
                                           reference_options(), expected.speed_by_pi * pi));
    std::erase_if(found, [](Complex lambda) { return !(lambda.real() > 1e-6); });
    std::ranges::sort(found, {}, [](Complex lambda) { return lambda.imag(); });
    ASSERT_EQ(found.size(), expected.motions.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto [f_Hz, growth] = expected.motions[i];
      EXPECT_NEAR(found[i].imag() / (2.0 * pi), f_Hz, rounding);
      EXPECT_NEAR(found[i].real(), growth, rounding);
    }
  }
}

/// How the squeal of the three nodal diameters depends on the modes beside it.
struct Subset {
  std::size_t n;  ///< lowest modes; 1: the pair alone
  double growth, f_Hz;
};
const Subset subsets[] = {{1, 2.6890749477072187, 1773.665915564318},
                          {4, 2.452560363532852, 1775.0869253079727},
                          {8, 2.5399047314009713, 1774.7916092024725},
                          {16, 2.5248346959819643, 1774.720642175268},
                          {19, 2.51585963828983, 1774.7061551604304}};

TEST(PrintedValues, OfThePairAmongItsNeighboursAreThoseOfEachSubset)
{
  for (const Subset& expected : subsets) {
    SCOPED_TRACE(expected.n);
    std::vector<PlatePair> modes = kirchhoff_modes();
    ASSERT_GE(modes.size(), expected.n);
    modes.resize(expected.n);
    if (expected.n == 1) modes = {kirchhoff_3()};
    const auto found =
        oscillations(state_matrix(plate_of_pairs(modes, 0.0), reference_options(), 6.0 * pi));
    const auto nearest = std::ranges::min(found, {}, [&](Complex lambda) {
      return std::abs(lambda.imag() / (2.0 * pi) - expected.f_Hz);
    });
    EXPECT_NEAR(nearest.imag() / (2.0 * pi), expected.f_Hz, 1e-8);
    EXPECT_NEAR(nearest.real(), expected.growth, 1e-8);
  }
}

TEST(PrintedValues, OfAMindlinPlateAreItsGrowth)
{
  const auto found = oscillations(
      state_matrix(inertial_disc(disc_of({mindlin_3()})), reference_options(), 6.0 * pi));
  EXPECT_NEAR(found.front().real(), 2.6853400625840216, 1e-9);
}

}  // namespace
}  // namespace chladni::squeal
