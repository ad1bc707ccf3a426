#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "common/confinement/helper_process.hpp"
#include "common/error.hpp"
#include "generated.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {
namespace {

using testing::block_about_z;
using testing::hat_options;
using testing::radius;

std::string error_of_generator(const auto& generate)
{
  try {
    generate();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// The message of a hat disc with one change.
std::string hat_error(const std::function<void(HatDiscOptions&)>& change)
{
  HatDiscOptions options = hat_options(Pattern::structured, 2);
  change(options);
  return error_of_generator([&] { hat_disc(options); });
}

TEST(HatDisc, NamesTheLengthsThatDoNotFit)
{
  EXPECT_EQ(hat_error([](auto& o) { o.hub_radius = 0.09; }),
            "hat_disc: hub_radius = 0.09 m must be less than top_radius = 0.07 m");
  EXPECT_EQ(hat_error([](auto& o) { o.foot = 0.06; }),
            "hat_disc: foot = 0.06 m must be less than height = 0.05 m");
  EXPECT_NE(hat_error([](auto& o) { o.rings[0].radius = 0.158; }).find("ring \"track\""),
            std::string::npos);
  EXPECT_NE(hat_error([](auto& o) { o.edge_row = 0.05; }).find("edge_row"), std::string::npos);
  EXPECT_NE(hat_error([](auto& o) { o.rings[1].nodes = 37; }).find("asks for 1332 structured"),
            std::string::npos);
  EXPECT_NE(hat_error([](auto& o) {
              o.bolts = {.count = 5, .circle_radius = 0.05, .hole_radius = 0.006};
            }).find("pattern"),
            std::string::npos);
}

TEST(Pad, NamesTheLengthsThatDoNotFit)
{
  const auto error = [](double outer_radius, double angle, double size) {
    return error_of_generator([&] {
      pad({.inner_radius = 0.1,
           .outer_radius = outer_radius,
           .angle = angle,
           .element_size = size});
    });
  };
  EXPECT_NE(error(0.05, 1.0, 0.01).find("inner_radius < outer_radius"), std::string::npos);
  EXPECT_NE(error(0.15, 4.0, 0.01).find("angle"), std::string::npos);
  EXPECT_NE(error(0.15, 1.0, 0.1).find("element_size"), std::string::npos);
}

TEST(Rings, AskForZWhereTheHatStandsAboveTheirCircle)
{
  Mesh mesh = hat_disc(hat_options(Pattern::structured, 1));
  const auto ring = [&](std::optional<double> z) {
    return error_of_generator([&] {
      Mesh copy = mesh;
      const RingOptions options{.name = "seat", .radius = 0.08, .nodes = 12, .z = z};
      add_rings(copy, std::span(&options, 1));
    });
  };
  EXPECT_NE(ring(std::nullopt).find("say which with z"), std::string::npos);
  EXPECT_EQ(ring(0.01), "no error");
}

/// Eight nodes on the unit circle, of which the third is off it.
Mesh circle_with_a_node_off(double off)
{
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const double angle = std::numbers::pi / 4.0 * i, r = i == 2 ? 1.0 + off : 1.0;
    mesh.node_numbers.push_back(i + 1);
    mesh.positions.push_back({r * std::cos(angle), r * std::sin(angle), 0.0});
  }
  return mesh;
}

TEST(Rings, MoveNodesOntoTheirCircleAndSayHowFar)
{
  const RingOptions ring{.name = "seat", .radius = 1.0, .nodes = 8};
  Mesh rounded = circle_with_a_node_off(2e-7);
  add_rings(rounded, std::span(&ring, 1));
  EXPECT_DOUBLE_EQ(std::hypot(rounded.positions[2][0], rounded.positions[2][1]), 1.0);
  ASSERT_EQ(rounded.notes.size(), 1U);
  EXPECT_NE(rounded.notes[0].find("2e-07 m"), std::string::npos) << rounded.notes[0];
  Mesh exact = circle_with_a_node_off(0.0);
  add_rings(exact, std::span(&ring, 1));
  EXPECT_TRUE(exact.notes.empty());
}

TEST(Rings, SayHowManyOfTheirNodesAreThere)
{
  const RingOptions ring{.name = "seat", .radius = 1.0, .nodes = 8};
  Mesh mesh = circle_with_a_node_off(0.01);
  const std::string error = error_of_generator([&] { add_rings(mesh, std::span(&ring, 1)); });
  EXPECT_NE(error.find("7 of its 8 nodes are there"), std::string::npos) << error;
  EXPECT_NE(error.find("angle 90 degrees"), std::string::npos) << error;
}

TEST(RingsOnFaces, AreMeansOfTheFacesUnderTheirNodes)
{
  for (const auto& [shape, order] : {std::pair{Shape::hexahedron, 1},
                                     {Shape::hexahedron, 2},
                                     {Shape::hexahedron, 3},
                                     {Shape::wedge, 2}}) {
    for (const double width : {0.0, 0.3}) {
      Mesh mesh = block_about_z(order, shape);
      const int n = mesh.n_nodes();
      const std::int64_t last = std::ranges::max(mesh.node_numbers);
      const RingOptions ring{
          .name = "seat", .radius = 0.6, .nodes = 8, .z = 0.1, .on = RingOn::face, .width = width};
      add_rings(mesh, std::span(&ring, 1));
      ASSERT_EQ(mesh.face_nodes.size(), 8u);
      EXPECT_EQ(find_group(mesh, "seat").nodes.size(), 8u);
      EXPECT_EQ(mesh.node_numbers.back(), last + 8);
      // Sides of 0.5 m over the order, halved: midpoints of a grid that is about as fine.
      const double side = 2.0 * std::numbers::pi * 0.6 / 8.0, fine = 0.25 / order;
      const double n_r = std::ceil(0.3 / fine), n_t = std::ceil(side / fine);
      for (int k = 0; k < 8; ++k) {
        const FaceNode& at = mesh.face_nodes[std::size_t(k)];
        EXPECT_EQ(at.node, n + k);
        const double angle = std::numbers::pi / 4.0 * k, c = std::cos(angle), s = std::sin(angle);
        double sum = 0.0, radial = 0.0, across = 0.0;
        Vector mean{};
        for (std::size_t i = 0; i < at.nodes.size(); ++i) {
          const Vector& x = mesh.positions[std::size_t(at.nodes[i])];
          const double w = at.weights[i], by_r = x[0] * c + x[1] * s - 0.6,
                       by_t = x[1] * c - x[0] * s;
          EXPECT_NE(w, 0.0);
          sum += w;
          for (std::size_t d = 0; d < 3; ++d) mean[d] += w * x[d];
          radial += w * by_r * by_r;
          across += w * by_t * by_t;
        }
        EXPECT_NEAR(sum, 1.0, 1e-12);
        EXPECT_LT(norm(minus(mean, {0.6 * c, 0.6 * s, 0.1})), 1e-12);
        EXPECT_LT(norm(minus(mesh.positions[std::size_t(at.node)], mean)), 1e-12);
        if (order == 1) continue;
        // Faces of a higher order hold squares; their mean over midpoints of n rows.
        const double part = width > 0.0 ? 1.0 : 0.0;
        EXPECT_NEAR(radial, part * 0.3 * 0.3 / 12.0 * (1.0 - 1.0 / (n_r * n_r)), 1e-12);
        EXPECT_NEAR(across, part * side * side / 12.0 * (1.0 - 1.0 / (n_t * n_t)), 1e-12);
      }
    }
  }
}

TEST(RingsOnFaces, NeedAPlaneFaceOfSolidsAllAround)
{
  const auto said = [](const RingOptions& ring, Mesh mesh = block_about_z(2, Shape::hexahedron)) {
    return error_of_generator([&] { add_rings(mesh, std::span(&ring, 1)); });
  };
  RingOptions ring{.name = "seat", .radius = 0.6, .nodes = 8, .on = RingOn::face};
  EXPECT_NE(
      said(ring).find("radius 0.6 m, angle 0 degrees it needs a face, but the faces there are "
                      "at z = -0.1, 0.1 m; say which"),
      std::string::npos)
      << said(ring);
  ring.z = 0.1 + 0.5e-6;
  EXPECT_EQ(said(ring), "no error");
  ring.z = 0.1 + 0.7e-6;  // a millionth of the radius is no other plane
  EXPECT_NE(said(ring).find("at z = -0.1, 0.1 m"), std::string::npos) << said(ring);
  ring.z = 0.1;
  ring.radius = 1.1;
  EXPECT_NE(said(ring).find("angle 0 degrees it needs a face at z = 0.1 m, but there is no face"),
            std::string::npos)
      << said(ring);
  ring.radius = 0.9;
  ring.width = 0.29;  // three rows of points, 0.097 m apart
  EXPECT_EQ(said(ring), "no error");
  ring.width = 0.31;  // beyond the edge
  EXPECT_NE(said(ring).find("there is no face of solids"), std::string::npos) << said(ring);
  EXPECT_NE(said(ring, circle_with_a_node_off(0.0)).find("the mesh has none"), std::string::npos);
}

/// Another program in the place of the mesher.
class OtherMesher {
 public:
  explicit OtherMesher(const char* program) { setenv("CHLADNI_MESHER", program, 1); }
  ~OtherMesher() { unsetenv("CHLADNI_MESHER"); }
  OtherMesher(const OtherMesher&) = delete;
  OtherMesher& operator=(const OtherMesher&) = delete;
};

TEST(Mesher, ThatGivesNoAnswerIsASentence)
{
  const auto triangles = [] {
    rectangle({.length = 1.0, .width = 1.0, .element_size = 0.5, .pattern = Pattern::triangles});
  };
  const OtherMesher crashing("/bin/false");
  const std::string error = error_of_generator(triangles);
  EXPECT_NE(error.find("Gmsh crashed on the mesh that [mesh] describes (exit code 1)"),
            std::string::npos)
      << error;
  // Rows and columns need none.
  EXPECT_EQ(
      error_of_generator([] { rectangle({.length = 1.0, .width = 1.0, .element_size = 0.5}); }),
      "no error");
}

TEST(Mesher, ThatIsNotThereIsAnError)
{
  const OtherMesher missing("/no/such/mesher");
  const std::string error = error_of_generator([] {
    rectangle({.length = 1.0, .width = 1.0, .element_size = 0.5, .pattern = Pattern::triangles});
  });
  EXPECT_NE(error.find("CHLADNI_MESHER names /no/such/mesher"), std::string::npos) << error;
}

TEST(Mesher, AskedByAnotherVersionSaysSo)
{
  Packer question;
  question(std::string("0.0.1"));
  const confinement::Outcome outcome =
      confinement::run({.program = confinement::helper(confinement::mesher),
                        .question = question.bytes(),
                        .most_seconds = 60.0,
                        .most_bytes = 1 << 20});
  Unpacker answer(outcome.answer);
  bool is_there = true;
  std::string message;
  answer.all(is_there, message);
  EXPECT_FALSE(is_there);
  EXPECT_NE(message.find("but Chladni 0.0.1 asks it; install both together"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace chladni::mesh
