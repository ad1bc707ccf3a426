#include "files/hdf5_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace chladni::files {
namespace {

/// The extents; none when the values could not come from what the file stores of them. Compressed
/// ones can be larger than that, by a factor of about 1000 at most.
std::optional<std::vector<Eigen::Index>> plausible_shape(hid_t dataset, hid_t type,
                                                         hsize_t file_size)
{
  const Handle space{H5Dget_space(dataset), H5Sclose};
  const Handle creation{H5Dget_create_plist(dataset), H5Pclose};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0 || H5Sget_simple_extent_type(space.get()) == H5S_NULL) return std::nullopt;
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  const hsize_t value_size = H5Tget_size(type);
  if (value_size == 0) return std::nullopt;
  const bool is_empty = std::ranges::find(shape, hsize_t{0}) != shape.end();
  hsize_t rest = std::min<hsize_t>(H5Dget_storage_size(dataset), file_size) / value_size;
  if (H5Pget_nfilters(creation.get()) > 0) rest *= 1024;
  for (const hsize_t extent : shape) {
    if (extent > (is_empty ? file_size : rest)) return std::nullopt;
    if (extent > 0) rest /= extent;
  }
  if (rest == 0 && !is_empty) return std::nullopt;
  return std::vector<Eigen::Index>(shape.begin(), shape.end());
}

bool matches(const std::vector<Eigen::Index>& shape, const std::vector<Eigen::Index>& expected)
{
  if (shape.size() != expected.size()) return false;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (expected[i] != any && shape[i] != expected[i]) return false;
  return true;
}

std::string describe(const std::vector<Eigen::Index>& shape)
{
  std::vector<std::string> extents;
  for (const Eigen::Index n : shape) extents.push_back(n == any ? "any" : fmt::to_string(n));
  return extents.empty() ? "a single value" : fmt::format("[{}]", fmt::join(extents, " x "));
}

}  // namespace

const char* class_name(H5T_class_t type)
{
  switch (type) {
    case H5T_FLOAT:
      return "floating-point numbers";
    case H5T_INTEGER:
      return "integers";
    case H5T_STRING:
      return "text";
    default:
      return "values of another kind";
  }
}

Dataset open_dataset(const Source& source, const std::string& name, const Expected& expected)
{
  const Reader& reader = source.reader;
  if (!reader.contains(name)) reader.fail(name, "is missing");
  Handle id{H5Dopen2(source.file, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!id.valid()) reader.fail(name, "is not a readable dataset");
  const Handle type{H5Dget_type(id.get()), H5Tclose};
  const H5T_class_t found = H5Tget_class(type.get());
  if (found != expected.type)
    reader.fail(name,
                fmt::format("holds {}, expected {}", class_name(found), class_name(expected.type)));
  const auto shape = plausible_shape(id.get(), type.get(), source.size);
  if (!shape) reader.fail(name, "claims more values than the file can hold");
  if (!matches(*shape, expected.shape))
    reader.fail(
        name, fmt::format("has shape {}, expected {}", describe(*shape), describe(expected.shape)));
  return {std::move(id), *shape};
}

}  // namespace chladni::files
