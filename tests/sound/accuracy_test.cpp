// The error that is printed for a tone against its true one.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <ostream>
#include <vector>

#include "sound/tone.hpp"
#include "tests/references/sound/thesis_disc.hpp"

namespace chladni::sound {
namespace {

using std::numbers::pi;

const std::vector<MidLine> hat = {{.from = {0.08, 0.0}, .to = {0.16, 0.0}, .thickness = 0.02},
                                  {.from = {0.08, 0.0}, .to = {0.08, 0.05}, .thickness = 0.02},
                                  {.from = {0.03, 0.05}, .to = {0.08, 0.05}, .thickness = 0.02}};

std::vector<MidLine> disc(double thickness)
{
  return {{.from = {testing::hub_radius, 0.0},
           .to = {testing::disc_radius, 0.0},
           .thickness = thickness}};
}

/// A body whose nodes lie on these lines, with a smooth motion of three nodal diameters.
mbs_export::ModalBody body_on(const std::vector<MidLine>& lines)
{
  constexpr int n_along = 13, n_around = 24;
  mbs_export::ModalBody body = testing::thesis_body();
  const auto n = static_cast<Eigen::Index>(lines.size() * n_along * n_around);
  body.picture.positions.resize(n, 3);
  body.picture.transformation = Eigen::MatrixXd::Zero(3 * n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const MidLine& line = lines[std::size_t(i / (n_along * n_around))];
    const double part = double(i / n_around % n_along) / (n_along - 1);
    const Eigen::Vector2d x = line.from + part * (line.to - line.from);
    const double phi = 2.0 * pi * double(i % n_around) / n_around, c = std::cos(phi),
                 s = std::sin(phi);
    const double u_r = -24.0 * x[0] * x[1], u_z = 40.0 * x[0] * x[0];
    body.picture.positions.row(i) << x[0] * c, x[0] * s, x[1];
    for (const int mode : {0, 1}) {
      const double wave = mode == 0 ? std::cos(3.0 * phi) : std::sin(3.0 * phi);
      body.picture.transformation.block<3, 1>(3 * i, mode) =
          wave * Eigen::Vector3d(u_r * c, u_r * s, u_z);
    }
  }
  return body;
}

struct AirCase {
  const char* name;
  std::vector<MidLine> lines;
  double frequency_Hz;
  AirOptions air;
};

std::ostream& operator<<(std::ostream& out, const AirCase& one)
{
  return out << one.name;
}

class ToneAccuracy : public ::testing::TestWithParam<AirCase> {};

TEST_P(ToneAccuracy, IsThatOfTheTone)
{
  const AirCase& one = GetParam();
  const ThickBody thick = thick_body(one.lines, Hub::closed);
  const SurfaceMotion motion(body_on(one.lines), thick, {0, 1}, {3});
  Vibration v{.speed = 1.0, .omega = 2.0 * pi * one.frequency_Hz, .modes = {0, 1}, .harmonics = {}};
  v.harmonics = Eigen::MatrixXcd(2, 1);
  v.harmonics << 1e-4, std::complex<double>(0.0, -5e-5);
  // The Fourier form with a finer mesh: a hundredth of what is left by any of the cases.
  const AirOptions fine{.order = 8, .edge_size = 2e-6};
  const Tone exact = tones({thick, motion, fine}, v, 1)[0];
  const Source source{thick, motion, one.air};
  const Tone tone = tones(source, v, 1)[0];
  const Accuracy found = accuracy(source, v, tone);
  Eigen::MatrixX3d e(60, 3);  // directions other than those of the estimate
  for (int i = 0; i < e.rows(); ++i) {
    const double z = -1.0 + (2.0 * i + 1.0) / double(e.rows()), r = std::sqrt(1.0 - z * z);
    e.row(i) << r * std::cos(2.4 * i), r * std::sin(2.4 * i), z;
  }
  const Eigen::VectorXcd p = far_field(exact, e);
  const double error = (far_field(tone, e) - p).norm() / p.norm();
  ASSERT_TRUE(found.pressure && found.power());
  EXPECT_LT(std::abs(found.balance), 0.25) << "the far field carries what leaves the surface";
  EXPECT_LT(error, 1.5 * *found.pressure) << *found.pressure;
  EXPECT_GT(error, 0.1 * *found.pressure) << *found.pressure;
  const double of_power = std::abs(near_power(tone) / near_power(exact) - 1.0);
  EXPECT_LT(of_power, 1.5 * *found.power()) << *found.power();
}

INSTANTIATE_TEST_SUITE_P(
    Air, ToneAccuracy,
    ::testing::Values(
        AirCase{"disc",
                disc(0.02),
                1700.0,
                {.method = Method::tetrahedra, .element_size = 0.05, .edge_size = 0.01}},
        AirCase{"thin disc",
                disc(0.008),
                1700.0,
                {.method = Method::tetrahedra, .element_size = 0.05, .edge_size = 0.008}},
        AirCase{"low tone",
                disc(0.02),
                900.0,
                {.method = Method::tetrahedra, .element_size = 0.08, .edge_size = 0.01}},
        AirCase{"hat",
                hat,
                1700.0,
                {.method = Method::tetrahedra, .element_size = 0.048, .edge_size = 0.016}},
        AirCase{"plane", disc(0.02), 1700.0, {.edge_size = 5e-4}},
        AirCase{"hat in the plane", hat, 1700.0, {.edge_size = 5e-4}}));

}  // namespace
}  // namespace chladni::sound
