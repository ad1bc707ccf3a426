#include "mbs_export/formats/formats.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <map>

#include "../version_1.hpp"
#include "../wheel.hpp"
#include "common/files/hdf5.hpp"
#include "common/files/hdf5_objects.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

/// With a picture: the sums of Exudyn over the nodes are exact here.
FloatingBody wheel_of_points()
{
  ReducedSystem wheel = test::wheel_of_points();
  const Index n = wheel.M.rows();
  wheel.picture.positions.setOnes(3, 3);
  wheel.picture.cells = {{0, 1, 2, 2}, {0, 1, 1, 1}};
  wheel.picture.transformation = MatrixXd::Zero(9, n);
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 5;
  return floating_body(wheel, options);
}

Matrix3d tilde(const Vector3d& a)
{
  Matrix3d S;
  S << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return S;
}

/// Skew matrices of each node and column, as Exudyn's ComputeSkewMatrix.
MatrixXd skew(const MatrixXd& A)
{
  MatrixXd S(A.rows(), 3 * A.cols());
  for (Index i = 0; i < A.rows(); i += 3)
    for (Index j = 0; j < A.cols(); ++j) S.block<3, 3>(i, 3 * j) = tilde(A.col(j).segment<3>(i));
  return S;
}

TEST(Exudyn, HasTheProductsThatItComputesOfPointMasses)
{
  const files::test::ScratchFolder folder;
  write_exudyn(folder.file("a.h5"), wheel_of_points());
  const files::Reader file(folder.file("a.h5"));
  const MatrixXd Psi = file.matrix("modeBasis", {48, 5});
  const VectorXd xRef = file.vector("xRef", 48);
  VectorXd m = VectorXd::Zero(48);
  const ReducedSystem wheel = test::wheel();
  for (Index i = 0; i < 13; ++i) m.segment<3>(3 * i).setConstant(wheel.M(6 * i, 6 * i));
  const MatrixXd M = m.asDiagonal(), Psi_tilde = skew(Psi), x_tilde = skew(xRef);
  const MatrixXd Phit = Matrix3d::Identity().replicate(16, 1);
  const auto expect_equal = [&](const std::string& name, const MatrixXd& exact) {
    const MatrixXd found = file.matrix(name, {exact.rows(), exact.cols()});
    EXPECT_LT((found - exact).norm(), 1e-14) << name;
    EXPECT_GT(exact.norm(), 1e-6) << name;  // or the comparison would tell nothing
  };
  expect_equal("Mtt", Phit.transpose() * M * Phit);
  expect_equal("inertiaLocal", x_tilde.transpose() * M * x_tilde);
  expect_equal("mPhitTPsi", Phit.transpose() * M * Psi);
  expect_equal("mPhitTPsiTilde", Phit.transpose() * M * Psi_tilde);
  expect_equal("mXRefTildePsi", x_tilde.transpose() * M * Psi);
  expect_equal("mXRefTildePsiTilde", x_tilde.transpose() * M * Psi_tilde);
  expect_equal("mPsiTildePsi", Psi_tilde.transpose() * M * Psi);
  expect_equal("mPsiTildePsiTilde", Psi_tilde.transpose() * M * Psi_tilde);
  const Vector3d centre = file.vector("chiU", 3);
  EXPECT_LT((centre - Phit.transpose() * M * xRef / 1.7).norm(), 1e-15);
  EXPECT_EQ(file.matrix("chiUtilde"), MatrixXd(tilde(centre)));
  EXPECT_NEAR(file.real("totalMass"), 1.7, 1e-15);
}

TEST(Exudyn, NumbersThePictureBehindTheAttachmentNodes)
{
  const files::test::ScratchFolder folder;
  write_exudyn(folder.file("a.h5"), wheel_of_points());
  const files::Reader file(folder.file("a.h5"));
  files::IntegerMatrix triangle(1, 3);
  triangle << 13, 14, 15;  // and none of the line
  EXPECT_EQ(file.integer_matrix("trigList"), triangle);
  EXPECT_EQ(file.text("type"), "ObjectFFRFreducedOrderInterface");
  EXPECT_EQ(file.integer("fileVersion"), 1);
  EXPECT_EQ(file.integer("infoList/item_0"), 5);
  EXPECT_EQ(file.integer("infoList/item_1"), 16);
  EXPECT_EQ(file.integer("infoList/item_5"), 12);
}

/// An object of the file as Exudyn's loader takes it: its Python type, its extents and its bytes.
struct Entry {
  std::string datatype;
  std::vector<hsize_t> shape;
  std::vector<char> bytes;

  bool operator==(const Entry&) const = default;
};

std::string datatype_of(hid_t object)
{
  const files::Handle attribute{H5Aopen(object, "datatype", H5P_DEFAULT), H5Aclose};
  if (!attribute.valid()) return "";
  const files::Handle type{H5Aget_type(attribute.get()), H5Tclose};
  EXPECT_GT(H5Tis_variable_str(type.get()), 0);  // what else would come as bytes
  char* text = nullptr;
  H5Aread(attribute.get(), type.get(), static_cast<void*>(&text));
  std::string datatype = text;
  H5free_memory(text);
  return datatype;
}

herr_t add_entry(hid_t file, const char* name, const H5O_info_t* info, void* entries)
{
  const files::Handle object{H5Oopen(file, name, H5P_DEFAULT), H5Oclose};
  Entry entry{.datatype = datatype_of(object.get()), .shape = {}, .bytes = {}};
  if (info->type == H5O_TYPE_DATASET) {
    const files::Handle type{H5Dget_type(object.get()), H5Tclose};
    const files::Handle space{H5Dget_space(object.get()), H5Sclose};
    entry.shape.resize(std::size_t(H5Sget_simple_extent_ndims(space.get())));
    H5Sget_simple_extent_dims(space.get(), entry.shape.data(), nullptr);
    entry.bytes.resize(H5Tget_size(type.get()) *
                       std::size_t(H5Sget_simple_extent_npoints(space.get())));
    H5Dread(object.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, entry.bytes.data());
  }
  (*static_cast<std::map<std::string, Entry>*>(entries))[name] = std::move(entry);
  return 0;
}

std::map<std::string, Entry> entries_of(const std::string& path)
{
  std::map<std::string, Entry> entries;
  const files::Handle file{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  EXPECT_TRUE(file.valid()) << path;
  files::visit_objects(file.get(), H5_ITER_INC, add_entry, &entries);
  return entries;
}

TEST(Exudyn, IsTheSameDictionaryAsBefore)
{
  const files::test::ScratchFolder folder;
  write_exudyn(folder.file("a.h5"), test::version_1_floating());
  const auto found = entries_of(folder.file("a.h5"));
  const auto golden = entries_of(CHLADNI_SOURCE_DIR "/tests/data/three_nodes.exudyn.hdf5");
  EXPECT_EQ(found.size(), golden.size());
  for (const auto& [name, entry] : golden) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_TRUE(found.at(name) == entry) << name;
  }
  EXPECT_EQ(golden.at("modeBasis").datatype, "ndarray");
  EXPECT_EQ(golden.at("infoList").datatype, "list");
  EXPECT_EQ(golden.at("infoList/item_0").datatype, "int");
  EXPECT_EQ(golden.at("rigidBodyNodeType").datatype, "str");
}

TEST(Exudyn, NeedsMassIntegralsAndLeavesNothingWithoutThem)
{
  const files::test::ScratchFolder folder;
  FloatingBody floating = wheel_of_points();
  floating.body.mass_integrals.reset();
  const std::string text =
      files::test::error_of([&] { write_exudyn(folder.file("a.h5"), floating); });
  EXPECT_NE(text.find("reduce the scene again"), std::string::npos) << text;
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.h5")));
}

}  // namespace
}  // namespace chladni::mbs_export::formats
