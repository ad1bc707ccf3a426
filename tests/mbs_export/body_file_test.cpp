#include "mbs_export/files/body_files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bending_beam.hpp"
#include "common/files/hdf5.hpp"
#include "common/files/seal.hpp"
#include "damaged_numbers.hpp"
#include "expect_equal.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/modal_body.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "version_1.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using files::test::ScratchFolder, files::test::error_of, test::expect_equal;

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
  for (const ModalBody& body : {complete_body(), test::version_1_body()}) {
    write_body(folder.file("a.h5"), body);
    expect_equal(read_body(folder.file("a.h5")), body);
  }
}

TEST(BodyFile, SaysWhichNodeAndComponentEachRowOfItsModesIs)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  write_body(path, complete_body());
  {
    const files::Reader file(path);
    EXPECT_EQ(file.integers("modes/row_nodes")[75], 12);
    EXPECT_EQ(file.integers("modes/row_components")[75], 3);
    EXPECT_FALSE(file.text_attribute("/", "frame").empty());
  }
  const hid_t changed = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(changed, "modes/row_nodes", H5P_DEFAULT);
  H5Lcreate_hard(changed, "modes/row_components", changed, "modes/row_nodes", H5P_DEFAULT,
                 H5P_DEFAULT);
  H5Fclose(changed);
  files::seal_file(path);
  EXPECT_NE(error_of([&] { read_body(path); }).find("modes/row_nodes: expected all six"),
            std::string::npos);
}

TEST(BodyFile, IsReadWithDatasetsThatNobodyKnows)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  const ModalBody body = complete_body();
  write_body(path, body);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  for (const char* name : {"modes/of_somebody_else", "somebody_else"})
    H5Lcreate_hard(file, "modes/damping", file, name, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  files::seal_file(path);
  expect_equal(read_body(path), body);
}

TEST(BodyFile, CarriesTheCertificateOfTheReducedSystem)
{
  const ScratchFolder folder;
  ReducedSystem wheel = test::wheel();
  wheel.certificate.fixed = {"hub"};
  wheel.certificate.frequencies = Eigen::Vector2d(10.0, 20.0);
  wheel.certificate.eta2 = Eigen::Vector2d(1e-6, 1.0 / 3e5);
  write_body(folder.file("a.h5"), make_body(wheel, {}));
  const Certificate found = read_body(folder.file("a.h5")).certificate;
  EXPECT_EQ(found.fixed, wheel.certificate.fixed);
  EXPECT_EQ(found.frequencies, wheel.certificate.frequencies);
  EXPECT_EQ(found.eta2, wheel.certificate.eta2);
}

TEST(BodyFile, ShowsItsModesAsFieldsOfVtk)
{
  const ScratchFolder folder;
  const ModalBody body = complete_body();
  write_body(folder.file("a.h5"), body);
  const files::Reader file(folder.file("a.h5"));
  EXPECT_EQ(file.integers("VTKHDF/Connectivity"), (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(file.integers("VTKHDF/Offsets"), (std::vector<std::int64_t>{0, 2}));
  EXPECT_EQ(file.integers("VTKHDF/Types"), std::vector<std::int64_t>{3});  // a line
  EXPECT_EQ(file.matrix("VTKHDF/Points"), Eigen::MatrixXd(body.picture.positions));
  const std::string name =
      fmt::format("VTKHDF/PointData/mode 08, {:.6g} Hz", body.omega[7] / (2.0 * std::numbers::pi));
  const Eigen::MatrixXd rows = body.picture.transformation.col(7).reshaped(3, 2).transpose();
  // A view stores nothing, so that the reader, which trusts no claim of a file, refuses it.
  EXPECT_NE(error_of([&] { file.matrix(name); }), "");
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> field(2, 3);
  const hid_t raw = H5Fopen(folder.file("a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(raw, name.c_str(), H5P_DEFAULT);
  EXPECT_EQ(H5Dget_storage_size(dataset), 0u);
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, field.data()), 0);
  H5Dclose(dataset);
  H5Fclose(raw);
  EXPECT_EQ(Eigen::MatrixXd(field), rows);
}

TEST(BodyFile, HoldsTheFourierCoefficientsOfTheRings)
{
  const ScratchFolder folder;
  const ModalBody body = complete_body();
  write_body(folder.file("a.h5"), body);
  const files::Reader file(folder.file("a.h5"));
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
std::string error_of_damaged_body(const ScratchFolder& folder, const ModalBody& sound,
                                  Damage damage)
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
    const std::string text = error_of_damaged_body(folder, sound, damage);
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
    // Those of VTKHDF are views of the picture.
    const bool is_view = name.starts_with("VTKHDF/");
    const std::string named = is_view ? "picture/displacements" : name;
    EXPECT_NE(text.find(named + ": value "), std::string::npos) << name << ": '" << text << "'";
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
