#include "mbs_export/files/body_files.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <limits>
#include <random>

#include "bending_beam.hpp"
#include "common/files/seal.hpp"
#include "expect_equal.hpp"
#include "mbs_export/make_body.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using files::test::ScratchFolder, files::test::error_of, test::expect_equal;

/// Shear and moment at two points, the second one in turned axes.
ResultantModes two_points(Eigen::Index n_coordinates)
{
  ResultantModes resultants{.name = "spoke",
                            .kinds = {"Q_z", "M_y"},
                            .units = {"N", "N m"},
                            .elements = {7, 9},
                            .positions = ResultantModes::Rows(2, 3),
                            .axes = ResultantModes::Rows(2, 9),
                            .S = Eigen::MatrixXd::Random(4, n_coordinates)};
  resultants.positions << 0, 0, 0, 0.1, 0, 1.0 / 3.0;
  resultants.axes << 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, -1, 0, 0, 0, 0, 1;
  return resultants;
}

/// Everything that the format can hold: a wheel with damping, picture, resultants and provenance.
ReducedSystem complete_system()
{
  ReducedSystem system = test::wheel();
  system.C = 0.1 * system.K;
  system.picture.positions.resize(3, 3);
  system.picture.positions << 0, 0, 0, 1, 0, 0, 0, 1.0 / 3.0, 0;
  system.picture.cells = {{0, 1, 2, 2}};
  system.picture.transformation = Eigen::MatrixXd::Random(9, system.K.cols());
  system.resultants = {two_points(system.K.cols())};
  system.certificate = {
      .fixed = {"hub"},
      .frequencies = Eigen::Vector3d(10.0, 20.0, 30.0),
      .eta2 = Eigen::Vector3d(1e-6, 1e-5, 1e-4),
      .bounds = Eigen::Vector2d(2e-6, 3e-5),
      .fixed_interface = {.up_to = 40.0, .expected = 4, .found = 4},
      .range = {.up_to = 31.0, .expected = 4, .found = 3},
      .complete = {.up_to = 25.0, .expected = 2, .found = 2},
      .n_rigid = 6,
      .rigid_residual = 1e-12,
      .condition = 1e9,
      .responses = ResponseCheck{.up_to = 22.0, .error = 3e-4, .loads = {"rim.z", "hub.rx"}},
      .mesh_shape_errors = Eigen::MatrixXd::Random(6, 2).cwiseAbs(),
      .mesh_errors = Eigen::Vector2d(1e-4, 3e-4),
      .mesh_compliances = {.sets = {"rim"}, .growth = Eigen::Vector3d(1e-10, 2e-11, 3e-7)}};
  system.provenance = {.scene = "title = \"wheel\"\n",
                       .mesh_checksum = "cbf29ce484222325",
                       .versions = "PETSc 3.18",
                       .options = "-a 1",
                       .ranks = 3};
  return system;
}

/// As of three sectors with one node each, whose motion is that of the first sector.
ReducedSystem system_of_sectors()
{
  ReducedSystem system = complete_system();
  const Eigen::Index n = system.K.cols();
  const auto random = [](Eigen::Index cols) { return Eigen::MatrixXd::Random(3, cols).eval(); };
  system.picture.transformation.resize(0, 0);
  system.picture_of_sectors = {
      .n_sectors = 3,
      .n_coordinates = n,
      .harmonics = {{.order = 0, .x = random(2), .y = random(2), .columns = {5, 0}},
                    {.order = 1, .x = random(3), .y = random(3), .columns = {1, 2, n - 1}}},
      .T = Eigen::MatrixXd::Random(n, n)};
  system.sector_harmonics = {.n_sectors = 3, .order = std::vector<int>(std::size_t(n), 1)};
  return system;
}

TEST(ReducedFile, ReturnsWhatWasWrittenBitByBit)
{
  const ScratchFolder folder;
  for (const ReducedSystem& system :
       {complete_system(), system_of_sectors(), test::reduced_beam(30, 10)}) {
    write_reduced(folder.file("a.reduced.h5"), system);
    expect_equal(read_reduced(folder.file("a.reduced.h5")), system);
  }
}

/// What reading says after `damage` was done to the system before it was written.
template <class Damage>
std::string error_after(const ScratchFolder& folder, Damage damage)
{
  ReducedSystem system = complete_system();
  damage(system);
  write_reduced(folder.file("bad.h5"), system);
  return error_of([&] { read_reduced(folder.file("bad.h5")); });
}

void expect_mention(const std::string& text, const std::string& part)
{
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
}

TEST(ReducedFile, IsRefusedWhenItsContentMakesNoSense)
{
  using System = ReducedSystem;
  const ScratchFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  expect_mention(error_after(folder, [&](System& s) { s.K(3, 4) = s.K(4, 3) = nan; }), "stiffness");
  expect_mention(error_after(folder, [&](System& s) { s.M(3, 3) = infinity; }), "mass");
  expect_mention(error_after(folder, [](System& s) { s.K(0, 1) += 1.0 + s.K(0, 0); }),
                 "stiffness: is not symmetric");
  expect_mention(error_after(folder, [](System& s) { s.M(2, 2) = -1.0; }), "negative diagonal");
  expect_mention(error_after(folder, [](System& s) { s.K.conservativeResize(70, 78); }),
                 "stiffness: has shape [70 x 78], expected [78 x 78]");
  expect_mention(error_after(folder, [](System& s) { s.C.conservativeResize(70, 70); }), "damping");
  expect_mention(error_after(folder, [](System& s) { s.masters[5].node = 13; }),
                 "masters/node: has the index 13, expected 0 .. 12");
  expect_mention(error_after(folder, [](System& s) { s.masters[5].component = 6; }), "component");
  expect_mention(error_after(folder, [](System& s) { s.masters[5] = s.masters[4]; }), "twice");
  expect_mention(error_after(folder, [](System& s) { s.sets[0].nodes[0] = -1; }), "sets/rim");
  expect_mention(error_after(folder, [](System& s) { s.picture.cells[0][2] = 3; }),
                 "picture/cells");
  expect_mention(error_after(folder, [](System& s) { s.picture.transformation.resize(9, 5); }),
                 "picture/displacements");
  expect_mention(error_after(folder, [](System& s) { s.resultants[0].units.pop_back(); }),
                 "resultants/spoke/units: has 1 values for 2 kinds");
  expect_mention(error_after(folder, [](System& s) { s.resultants[0].axes(1, 0) = 0.1; }),
                 "resultants/spoke/axes: is not orthonormal in row 1");
  expect_mention(error_after(folder, [](System& s) { s.resultants[0].elements.push_back(3); }),
                 "resultants/spoke/elements");
  expect_mention(error_after(folder, [](System& s) { s.resultants[0].S.resize(4, 5); }),
                 "resultants/spoke/modes: has shape [4 x 5], expected [4 x 78]");
  expect_mention(error_after(folder, [](System& s) { s.provenance.ranks = -1; }), "ranks");
  expect_mention(error_after(folder, [](System& s) { s.certificate.bounds.setOnes(4); }),
                 "certificate/bounds: has 4 values for 3 modes");
  expect_mention(error_after(folder, [](System& s) { s.certificate.range.found = -1; }),
                 "certificate/counts/found");
  expect_mention(
      error_after(folder, [](System& s) { s.fixed_interface_frequencies.setConstant(1, -1.0); }),
      "fixed_interface_frequencies");
  EXPECT_EQ(error_after(folder, [](System& s) { s.K(0, 1) *= 1.0 + 1e-13; }), "");
}

TEST(ReducedFile, IsRefusedWhenThePictureOfSectorsMakesNoSense)
{
  const ScratchFolder folder;
  const auto error = [&](auto damage) {
    return error_after(folder, [&](ReducedSystem& s) {
      s = system_of_sectors();
      damage(*s.picture_of_sectors);
    });
  };
  using Motions = SectorMotions;
  EXPECT_EQ(error([](Motions&) {}), "");
  expect_mention(error([](Motions& m) { m.n_sectors = 4; }),
                 "picture/sectors/count: is 4, of a picture of 3 nodes");
  expect_mention(error([](Motions& m) { m.n_sectors = 1; }), "picture/sectors/count: is 1");
  expect_mention(error([](Motions& m) { m.harmonics[1].order = 2; }),
                 "picture/sectors/harmonics: has 2, expected 0 .. 1");
  expect_mention(error([](Motions& m) { std::swap(m.harmonics[0], m.harmonics[1]); }),
                 "picture/sectors/harmonics: has 0, expected 1 .. 1");
  expect_mention(error([](Motions& m) { m.harmonics[0].columns[1] = m.n_coordinates; }),
                 "picture/sectors/coordinates: has the index 78, expected 0 .. 77");
  expect_mention(error([](Motions& m) {
                   for (auto& h : m.harmonics)
                     h = {.order = 0, .x = h.x.leftCols(0), .y = h.y.leftCols(0), .columns = {}};
                 }),
                 "picture/sectors/harmonics: is empty");
  expect_mention(error([](Motions& m) { m.T.resize(3, 3); }),
                 "picture/sectors/transformation: has shape [3 x 3], expected [78 x 78]");
}

TEST(ReducedFile, IsNotWrittenWithANameThatNoFileCanHold)
{
  const ScratchFolder folder;
  ReducedSystem system = complete_system();
  system.sets[0].name = "rim/outer";
  expect_mention(error_of([&] { write_reduced(folder.file("b.h5"), system); }), "rim/outer");
  EXPECT_FALSE(std::filesystem::exists(folder.file("b.h5")));
}

TEST(ReducedFile, IsRefusedWithoutOneOfItsDatasets)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  for (const char* name : {"attachment/node_numbers", "attachment/sets/hub", "masters/component",
                           "matrices/mass", "fixed_interface_frequencies", "provenance/scene"}) {
    write_reduced(path, complete_system());
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, name, H5P_DEFAULT);
    H5Fclose(file);
    files::seal_file(path);
    expect_mention(error_of([&] { read_reduced(path); }), std::string(name) + ": is missing");
  }
}

TEST(ReducedFile, IsRefusedInAnotherFormatOrVersion)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  write_body(path, make_body(test::wheel(), {}));
  expect_mention(error_of([&] { read_reduced(path); }),
                 "has format 'chladni-body', expected 'chladni-reduced'");
  write_reduced(path, complete_system());
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(file, "version", H5P_DEFAULT);
  const std::int64_t version = 2;
  H5Awrite(attribute, H5T_NATIVE_INT64, &version);
  H5Aclose(attribute);
  H5Fclose(file);
  files::seal_file(path);
  expect_mention(error_of([&] { read_reduced(path); }), "version 2");
}

/// Cut short or with 20 other bytes.
std::string damaged(const std::string& whole, std::mt19937& random)
{
  std::string bytes = whole;
  if (random() % 2 == 0)
    bytes.resize(random() % whole.size());
  else
    for (int k = 0; k < 20; ++k) bytes[random() % whole.size()] = static_cast<char>(random());
  return bytes;
}

/// How many of n damaged files are refused; all others are read.
int n_refused_of(int n, const std::string& whole)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  std::mt19937 random(1);
  int n_refused = 0;
  for (int i = 0; i < n; ++i) {
    std::ofstream(path, std::ios::binary) << damaged(whole, random);
    n_refused += !error_of([&] { read_reduced(path); }).empty();
  }
  return n_refused;
}

TEST(ReducedFile, IsRefusedWhateverBytesAreDamaged)
{
  const ScratchFolder folder;
  write_reduced(folder.file("a.h5"), test::reduced_beam(6, 2));
  EXPECT_EQ(n_refused_of(300, files::test::bytes_of(folder.file("a.h5"))), 300);
}

// Here libhdf5 sees the damage.
TEST(ReducedFile, WithoutSealIsReadOrRefusedWhateverBytesAreDamaged)
{
  const ScratchFolder folder;
  write_reduced(folder.file("a.h5"), test::reduced_beam(6, 2));
  const std::string bytes = files::test::bytes_of(folder.file("a.h5")).substr(files::seal_size);
  EXPECT_GT(n_refused_of(300, bytes), 150);  // all that are cut short, and more
}

}  // namespace
}  // namespace chladni::mbs_export
