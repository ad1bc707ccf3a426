#include "mbs_export/body_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bending_beam.hpp"
#include "damaged_numbers.hpp"
#include "mbs_export/contact_rings.hpp"
#include "mbs_export/hdf5.hpp"
#include "mbs_export/make_body.hpp"
#include "scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using test::ScratchFolder, test::error_of;

/// Everything that the format can hold.
ModalBody complete_body()
{
  ReducedSystem wheel = test::wheel();
  wheel.picture.positions.setOnes(2, 3);
  wheel.picture.cells = {{0, 1, 1, 1}};
  wheel.picture.transformation = Eigen::MatrixXd::Random(6, 78);
  wheel.provenance = {.scene = "scene", .mesh_checksum = "1", .versions = "2", .options = "3"};
  BodyOptions options;
  options.fixed = {"hub.x", "hub.y", "hub.z"};
  options.keep.count = 12;
  options.interface_modes = {
      {.kind = InterfaceModes::Kind::irm, .at = "rim", .components = {2}, .omega0 = {}}};
  options.damping = {.type = Damping::Type::modal, .ratios = {0.01}};
  return make_body(wheel, options);
}

TEST(BodyFile, ReturnsWhatWasWrittenBitByBit)
{
  const ScratchFolder folder;
  const ModalBody a = complete_body();
  write_body(folder.file("a.h5"), a);
  const ModalBody b = read_body(folder.file("a.h5"));
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.kinds, b.kinds);
  EXPECT_EQ(a.omega, b.omega);
  EXPECT_EQ(a.C, b.C);
  ASSERT_EQ(a.attachment_nodes.size(), b.attachment_nodes.size());
  EXPECT_EQ(a.attachment_nodes[3].position, b.attachment_nodes[3].position);
  EXPECT_EQ(a.sets[0].nodes, b.sets[0].nodes);
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.attachment_modes, b.attachment_modes);
  EXPECT_EQ(a.picture.transformation, b.picture.transformation);
  EXPECT_EQ(a.picture.cells, b.picture.cells);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.centre_of_mass, b.centre_of_mass);
  EXPECT_EQ(a.inertia, b.inertia);
  EXPECT_EQ(a.free_frequencies, b.free_frequencies);
  EXPECT_EQ(a.n_rigid, b.n_rigid);
  EXPECT_EQ(a.n_free_rigid, b.n_free_rigid);
  EXPECT_EQ(a.condition_Q_dd, b.condition_Q_dd);
  EXPECT_EQ(a.preparation.n_constrained_modes, b.preparation.n_constrained_modes);
  EXPECT_EQ(a.preparation.n_partners, b.preparation.n_partners);
  EXPECT_EQ(a.preparation.n_interface_dropped, b.preparation.n_interface_dropped);
  EXPECT_EQ(a.preparation.rigid_residual, b.preparation.rigid_residual);
  EXPECT_EQ(a.provenance.scene, b.provenance.scene);
}

TEST(BodyFile, ReturnsTheMassIntegralsBitByBit)
{
  const ScratchFolder folder;
  const ModalBody body = complete_body();
  write_body(folder.file("a.h5"), body);
  const auto a = *body.mass_integrals, b = read_body(folder.file("a.h5")).mass_integrals.value();
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.second, b.second);
  EXPECT_EQ(a.displacement, b.displacement);
  EXPECT_EQ(a.position_displacement, b.position_displacement);
  for (std::size_t i = 0; i < a.products.size(); ++i) EXPECT_EQ(a.products[i], b.products[i]);
}

TEST(BodyFile, ReturnsTheRingsBitByBit)
{
  const ScratchFolder folder;
  const ModalBody a = complete_body();
  write_body(folder.file("a.h5"), a);
  const ModalBody b = read_body(folder.file("a.h5"));
  ASSERT_EQ(b.rings.size(), 1u);
  const ContactRing &x = a.rings[0], &y = b.rings[0];
  EXPECT_EQ(x.name, y.name);
  EXPECT_EQ(x.radius, y.radius);
  EXPECT_EQ(x.height, y.height);
  EXPECT_EQ(x.nodes, y.nodes);
  EXPECT_EQ(x.angles, y.angles);
  EXPECT_EQ(x.W, y.W);
  EXPECT_EQ(x.W_r, y.W_r);
  EXPECT_EQ(x.W_t, y.W_t);
}

TEST(BodyFile, HoldsTheFourierCoefficientsOfTheRings)
{
  const ScratchFolder folder;
  const ModalBody body = complete_body();
  write_body(folder.file("a.h5"), body);
  const hdf5::Reader file(folder.file("a.h5"));
  const ContactRing& ring = body.rings[0];
  EXPECT_EQ(file.matrix("rings/rim/displacement_cosine"),
            fourier_coefficients(ring.angles, ring.W).cosine);
  EXPECT_EQ(file.matrix("rings/rim/radial_slope_sine"),
            fourier_coefficients(ring.angles, ring.W_r).sine);
  EXPECT_EQ(file.text_attribute("rings/rim/circumferential_slope_cosine", "unit"),
            "rad per unit of q");
}

TEST(BodyFile, HoldsABodyWithoutRingPictureAndDamping)
{
  const ScratchFolder folder;
  write_body(folder.file("a.h5"), make_body(test::reduced_beam(30, 5), {}));
  const ModalBody body = read_body(folder.file("a.h5"));
  EXPECT_TRUE(body.rings.empty());
  EXPECT_TRUE(body.fixed.empty());
  EXPECT_EQ(body.C.size(), 0);
  EXPECT_EQ(body.picture.positions.size(), 0);
  EXPECT_EQ(body.n_free_rigid, 2);
}

/// What reading says after `damage` was done to the body before it was written.
template <class Damage>
std::string error_after(const ScratchFolder& folder, const ModalBody& sound, Damage damage)
{
  ModalBody body = sound;
  damage(body);
  write_body(folder.file("bad.h5"), body);
  return error_of([&] { read_body(folder.file("bad.h5")); });
}

TEST(BodyFile, IsRefusedWhenItsContentMakesNoSense)
{
  const ScratchFolder folder;
  const ModalBody sound = complete_body();
  const auto expect = [&](const std::string& part, auto damage) {
    const std::string text = error_after(folder, sound, damage);
    EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
  };
  expect("modes/frequencies", [](ModalBody& b) { b.omega[8] = b.omega[7] - 1.0; });
  expect("modes/frequencies", [](ModalBody& b) { b.omega[0] = -1.0; });
  expect("modes/kinds", [](ModalBody& b) { b.kinds.pop_back(); });
  expect("modes/damping", [](ModalBody& b) { b.C.conservativeResize(3, 3); });
  expect("modes/attachment_displacements",
         [](ModalBody& b) { b.attachment_modes.conservativeResize(77, Eigen::NoChange); });
  expect("finite", [](ModalBody& b) { b.mass = std::numeric_limits<double>::infinity(); });
  expect("rings/rim/radius", [](ModalBody& b) { b.rings[0].radius = 0.0; });
  expect("rings/rim/nodes", [](ModalBody& b) { b.rings[0].nodes[4] = 99; });
  expect("rings/rim/angles", [](ModalBody& b) { b.rings[0].angles.reverseInPlace(); });
  expect("rings/rim/radial_slope", [](ModalBody& b) { b.rings[0].W_r(2, 2) = std::nan(""); });
  expect("free_body/rigid_modes", [](ModalBody& b) { b.n_rigid = 1000; });
}

TEST(BodyFile, IsRefusedWithANumberThatIsNoneInAnyDataset)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  write_body(path, complete_body());
  const std::vector<std::string> names = test::real_datasets(path);
  EXPECT_GT(names.size(), 25u);
  for (const std::string& name : names) {
    const double before = test::replace_last(path, name, std::nan(""));
    const std::string text = error_of([&] { read_body(path); });
    EXPECT_NE(text.find(name + ": value "), std::string::npos) << name << ": '" << text << "'";
    EXPECT_NE(text.find("nan"), std::string::npos) << text;
    test::replace_last(path, name, before);
  }
  EXPECT_EQ(error_of([&] { read_body(path); }), "");
}

TEST(BodyFile, IsRefusedWhenTheHarmonicsOfARingAreNotThoseOfItsNodes)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  for (const std::string part : {"displacement_cosine", "radial_slope_sine"}) {
    write_body(path, complete_body());
    test::replace_last(path, "rings/rim/" + part, 1.0);
    const std::string text = error_of([&] { read_body(path); });
    EXPECT_NE(text.find(part + ": is not the Fourier"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace chladni::mbs_export
