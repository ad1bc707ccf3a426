#include <gtest/gtest.h>

#include <cmath>

#include "sound/levels.hpp"
#include "sound/tone.hpp"
#include "tests/references/sound/exact_fields.hpp"
#include "tests/references/sound/thesis_disc.hpp"

namespace chladni::sound {
namespace {

using testing::Multipole;

TEST(Space, OscillatingSphereConverges)
{
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const double h = i == 0 ? 0.06 : 0.035;
    const auto mesh =
        std::make_shared<const AirMesh>(mesh_space(testing::sphere(0.1), {.order = 2,
                                                                          .element_size = h,
                                                                          .edge_size = h,
                                                                          .inner_radius = 0.16,
                                                                          .shell_thickness = 0.08,
                                                                          .half_space = true}));
    Exterior exterior(mesh, {.medium = {}, .omega = 30.0 * 343.0, .n = 0}, {.alpha = 5.0});
    const Multipole exact{1, 0};  // along the axis, which is antisymmetric
    const Field field =
        solve(exterior, testing::normal_velocity(exact, exterior.wave(), exterior.surface()));
    error[i] = testing::mean_field_error(*mesh, field.wave, field.p.col(0), exact);
    EXPECT_NEAR(far_power(field)[0] / complex_power(field)(0, 0).real(), 1.0, 3.0 * error[i]);
  }
  // Order 3 in the mean square would divide it by 5.
  EXPECT_LT(error[1], 0.05);
  EXPECT_GT(error[0] / error[1], 3.0);
}

TEST(Space, DiscSoundsAsItsFourierForm)
{
  const mbs_export::ModalBody body = testing::thesis_body();
  const ThickBody thick = thick_body({{.from = {testing::hub_radius, 0.0},
                                       .to = {testing::disc_radius, 0.0},
                                       .thickness = testing::disc_thickness}},
                                     Hub::closed);
  const SurfaceMotion motion(body, thick, {0, 1}, {3});
  Vibration v{.speed = 1.0, .omega = body.omega[0], .modes = {0, 1}, .harmonics = {}};
  v.harmonics = Eigen::MatrixXcd(2, 1);
  v.harmonics << 1e-4, std::complex<double>(0.0, -5e-5);
  Eigen::MatrixX3d x(3, 3);
  x << 0.5, 0.0, 0.5, 0.3, 0.2, -0.3, 0.15, 0.05, 0.1;
  const AirOptions plane{}, space{.method = Method::tetrahedra, .element_size = 0.05};
  const Tone exact = tones({thick, motion, plane}, v, 1)[0];
  const Tone coarse = tones({thick, motion, space}, v, 1)[0];
  const Eigen::VectorXcd p = pressure_at(exact, x), q = pressure_at(coarse, x);
  // Elements of a quarter of the wavelength: about 5 %.
  EXPECT_LT((p - q).norm(), 0.1 * p.norm());
  EXPECT_GT((p - q).norm(), 1e-4 * p.norm()) << "these are two discretisations";
  EXPECT_NEAR(near_power(coarse) / near_power(exact), 1.0, 0.1);
}

TEST(Space, HolesLetTheSoundThrough)
{
  const mbs_export::ModalBody body = testing::thesis_body();
  const std::vector<MidLine> lines = {{.from = {testing::hub_radius, 0.0},
                                       .to = {testing::disc_radius, 0.0},
                                       .thickness = testing::disc_thickness}};
  Vibration v{.speed = 1.0, .omega = body.omega[0], .modes = {0, 1}, .harmonics = {}};
  v.harmonics = Eigen::MatrixXcd::Constant(2, 1, 1e-4);
  const AirOptions air{.element_size = 0.05, .edge_size = 0.01};
  double power[2];
  for (int i = 0; i < 2; ++i) {
    const ThickBody thick = i == 0 ? thick_body(lines, Hub::closed)
                                   : thick_body(lines, Hub::closed, {{0.14, 0.012, 6}});
    const SurfaceMotion motion(body, thick, {0, 1}, {3});
    AirOptions options = air;
    options.method = Method::tetrahedra;
    power[i] = near_power(tones({thick, motion, options}, v, 1)[0]);
  }
  EXPECT_LT(power[1], 0.98 * power[0]);
}

}  // namespace
}  // namespace chladni::sound
