#include "files/hdf5_contents.hpp"

#include <hdf5.h>

#include <optional>

#include "files/hdf5_dataset.hpp"
#include "files/hdf5_handle.hpp"
#include "files/regular_file.hpp"

namespace chladni::files {
namespace {

herr_t add_name(hid_t /*file*/, const char* name, const H5L_info_t* link, void* names)
{
  if (link->type == H5L_TYPE_HARD) static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

std::optional<Item::Kind> kind_of(hid_t dataset)
{
  const std::optional<Handle> type = memory_type(dataset);
  if (!type) return std::nullopt;
  switch (H5Tget_class(type->get())) {
    case H5T_FLOAT:
      return Item::Kind::reals;
    case H5T_INTEGER:
      return Item::Kind::integers;
    default:
      return Item::Kind::texts;
  }
}

/// Nothing for what is no dataset of the file's own values.
std::optional<Item> item_of(const Reader& reader, hid_t object, const std::string& name)
{
  if (H5Iget_type(object) != H5I_DATASET) return std::nullopt;
  const Handle creation{H5Dget_create_plist(object), H5Pclose};
  const std::optional<Item::Kind> kind = kind_of(object);
  if (!kind || H5Pget_layout(creation.get()) == H5D_VIRTUAL) return std::nullopt;
  const auto shape =
      plausible_shape(object, creation.get(), hsize_t(regular_file_size(reader.path())));
  if (!shape) reader.fail(name, "claims more values than the file can hold");
  const bool has_unit = H5Aexists(object, "unit") > 0;
  return Item{.name = name,
              .kind = *kind,
              .rank = shape->size(),
              .unit = has_unit ? reader.text_attribute(name, "unit") : std::string()};
}

}  // namespace

std::vector<Item> contents(const Reader& reader)
{
  // The reader has tried the file; while it has it open, libhdf5 gives the same one again.
  const Handle file{H5Fopen(reader.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  std::vector<std::string> names;
  H5Lvisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, add_name, &names);
  std::vector<Item> items;
  for (const std::string& name : names) {
    const Handle object{H5Oopen(file.get(), name.c_str(), H5P_DEFAULT), H5Oclose};
    if (!object.valid()) continue;
    if (auto item = item_of(reader, object.get(), name)) items.push_back(std::move(*item));
  }
  return items;
}

}  // namespace chladni::files
