#include "files/foreign_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "files/hdf5_handle.hpp"

namespace chladni::files {
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
