#include "common/files/hdf5_objects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace chladni::files {

namespace {

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

/// Takes what the values need from what the file may still take.
void take_memory(const Source& source, const std::string& name, const Dataset& dataset)
{
  constexpr std::size_t of_each_text = sizeof(std::string);
  const bool is_text = H5Tget_class(dataset.type.get()) == H5T_STRING;
  const std::uint64_t needed =
      dataset.n_bytes() + (is_text ? dataset.n_values() * of_each_text : 0);
  if (needed > source.memory_left) {
    source.reader.fail(
        name, fmt::format("claims {} values, which with those read before take more than the {} "
                          "MiB that a file of {} bytes may take",
                          dataset.n_values(), most_memory(source.size) >> 20, source.size));
  }
  source.memory_left -= needed;
}

/// @throws chladni::Error, as Reader::fail, where its values are not here.
void require_own_values(const Source& source, const std::string& name, hid_t creation)
{
  const std::string foreign = foreign_part(creation);
  if (!foreign.empty()) source.reader.fail(name, foreign);
  if (is_view(creation)) source.reader.fail(name, "is a view of other datasets; read those");
}

}  // namespace

std::optional<Handle> memory_type(hid_t dataset)
{
  Handle type{H5Dget_type(dataset), H5Tclose};
  switch (H5Tget_class(type.get())) {
    case H5T_FLOAT:
      return Handle{H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
    case H5T_INTEGER:
      return Handle{H5Tcopy(H5T_NATIVE_INT64), H5Tclose};
    case H5T_STRING:
      if (H5Tis_variable_str(type.get()) != 0) return std::nullopt;
      return type;
    default:
      return std::nullopt;
  }
}

std::optional<std::vector<Eigen::Index>> plausible_shape(hid_t dataset, hid_t creation,
                                                         hsize_t file_size)
{
  const Handle type{H5Dget_type(dataset), H5Tclose};
  const Handle space{H5Dget_space(dataset), H5Sclose};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0 || H5Sget_simple_extent_type(space.get()) == H5S_NULL) return std::nullopt;
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  const hsize_t value_size = H5Tget_size(type.get());
  if (value_size == 0) return std::nullopt;
  const bool is_empty = std::ranges::find(shape, hsize_t{0}) != shape.end();
  const hsize_t stored = std::min<hsize_t>(H5Dget_storage_size(dataset), file_size);
  hsize_t rest = (H5Pget_nfilters(creation) > 0 ? 1030 * stored : stored) / value_size;
  for (const hsize_t extent : shape) {
    if (extent > (is_empty ? file_size : rest)) return std::nullopt;
    if (extent > 0) rest /= extent;
  }
  if (rest == 0 && !is_empty) return std::nullopt;
  return std::vector<Eigen::Index>(shape.begin(), shape.end());
}

std::size_t Dataset::n_values() const
{
  std::size_t n = 1;
  for (const Eigen::Index extent : shape) n *= static_cast<std::size_t>(extent);
  return n;
}

std::size_t Dataset::n_bytes() const
{
  return n_values() * H5Tget_size(type.get());
}

bool read_values(const Dataset& dataset, void* values)
{
  return H5Dread(dataset.id.get(), dataset.type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
}

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
  if (found != expected.type) {
    reader.fail(name,
                fmt::format("holds {}, expected {}", class_name(found), class_name(expected.type)));
  }
  std::optional<Handle> held = memory_type(id.get());
  if (!held) reader.fail(name, "holds text of variable length, expected fixed length");
  const Handle creation{H5Dget_create_plist(id.get()), H5Pclose};
  require_own_values(source, name, creation.get());
  const auto shape = plausible_shape(id.get(), creation.get(), source.size);
  if (!shape) reader.fail(name, "claims more values than the file can hold");
  if (!matches(*shape, expected.shape)) {
    reader.fail(
        name, fmt::format("has shape {}, expected {}", describe(*shape), describe(expected.shape)));
  }
  Dataset dataset{std::move(id), *shape, std::move(*held)};
  take_memory(source, name, dataset);
  return dataset;
}

namespace {

constexpr std::array readable_filters{H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE,
                                      H5Z_FILTER_FLETCHER32};
constexpr auto only_here = "only what a file holds itself is read";

std::string external_storage(hid_t creation)
{
  if (H5Pget_external_count(creation) <= 0) return "";
  std::array<char, 256> name{};
  off_t offset = 0;
  hsize_t size = 0;
  H5Pget_external(creation, 0, name.size() - 1, name.data(), &offset, &size);
  return fmt::format("has its values in another file, '{}' (external storage); {}",
                     shown(name.data()), only_here);
}

std::string foreign_view(hid_t creation)
{
  if (H5Pget_layout(creation) != H5D_VIRTUAL) return "";
  std::size_t n = 0;
  H5Pget_virtual_count(creation, &n);
  for (std::size_t i = 0; i < n; ++i) {
    std::array<char, 256> name{};
    H5Pget_virtual_filename(creation, i, name.data(), name.size());
    if (std::string(name.data()) == ".") continue;
    return fmt::format("shows values of another file, '{}' (a virtual dataset); {}",
                       shown(name.data()), only_here);
  }
  return "";
}

std::string foreign_filter(hid_t creation)
{
  const int n = H5Pget_nfilters(creation);
  for (int i = 0; i < n; ++i) {
    std::size_t n_values = 0;
    unsigned flags = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(creation, unsigned(i), &flags, &n_values, nullptr, 0, nullptr, nullptr);
    if (std::ranges::find(readable_filters, filter) != readable_filters.end()) continue;
    return fmt::format(
        "is packed with filter {}; deflate, shuffle and fletcher32 are unpacked, and no others: "
        "`h5repack -f NONE` takes them away",
        int(filter));
  }
  return "";
}

/// The file that an external link names.
std::string target_of(hid_t group, const char* name, std::size_t size)
{
  std::vector<char> value(size);
  const char *file = nullptr, *object = nullptr;
  unsigned flags = 0;
  if (H5Lget_val(group, name, value.data(), size, H5P_DEFAULT) < 0 ||
      H5Lunpack_elink_val(value.data(), size, &flags, &file, &object) < 0)
    return "?";
  return shown(file);
}

/// Stops at the first link that is neither hard nor soft.
herr_t find_foreign_link(hid_t group, const char* name, const H5L_info_t* info, void* found)
{
  if (info->type == H5L_TYPE_HARD || info->type == H5L_TYPE_SOFT) return 0;
  const std::string what =
      info->type == H5L_TYPE_EXTERNAL
          ? fmt::format("links to another file, '{}'", target_of(group, name, info->u.val_size))
          : std::string("is a link of a kind that is not followed");
  *static_cast<std::string*>(found) = fmt::format("{}: {}; {}", shown(name), what, only_here);
  return 1;
}

}  // namespace

std::string shown(std::string name)
{
  std::ranges::replace_if(
      name, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, '?');
  return name;
}

std::string foreign_part(hid_t creation)
{
  for (const auto& part : {external_storage, foreign_view, foreign_filter})
    if (std::string why = part(creation); !why.empty()) return why;
  return "";
}

bool is_view(hid_t creation)
{
  return H5Pget_layout(creation) == H5D_VIRTUAL;
}

std::string foreign_link(hid_t file)
{
  std::string found;
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, find_foreign_link, &found);
  return found;
}

}  // namespace chladni::files
