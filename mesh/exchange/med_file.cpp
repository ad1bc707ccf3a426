#include "mesh/exchange/med_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/error.hpp"
#include "files/foreign_parts.hpp"
#include "files/hdf5_dataset.hpp"

namespace chladni::mesh {
namespace {

using files::Handle;

[[noreturn]] void refuse(const std::string& name, const std::string& why)
{
  throw Error(fmt::format("{}: {}", files::shown(name), why));
}

Handle opened(const std::string& bytes)
{
  files::prepare_to_read();
  const Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  constexpr std::size_t increment = 1 << 16;
  std::string image = bytes;  // libhdf5 takes no const, and copies it
  H5Pset_fapl_core(access.get(), increment, 0);
  H5Pset_file_image(access.get(), image.data(), image.size());
  const char* no_file = "/dev/null/mesh";  // libhdf5 takes no image for a file that is there
  Handle file{H5Fopen(no_file, H5F_ACC_RDONLY, access.get()), H5Fclose};
  if (!file.valid()) throw Error("it is no HDF5 file, as MED files are, or is cut off");
  const std::string link = files::foreign_link(file.get());
  if (!link.empty()) throw Error(link);
  return file;
}

/// A dataset whose values stand in the file.
struct Dataset {
  Handle id, space;
  hsize_t n;  ///< values, of all extents together
};

Dataset open_dataset(hid_t file, const std::string& name)
{
  Handle id{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!id.valid()) refuse(name, "there is no such dataset");
  const Handle creation{H5Dget_create_plist(id.get()), H5Pclose};
  const std::string foreign = files::foreign_part(creation.get());
  if (!foreign.empty()) refuse(name, foreign);
  Handle space{H5Dget_space(id.get()), H5Sclose};
  const hssize_t n = H5Sget_simple_extent_npoints(space.get());
  hsize_t file_size = 0;
  H5Fget_filesize(file, &file_size);
  if (n != 0 && !files::plausible_shape(id.get(), creation.get(), file_size))
    refuse(name, "claims more values than the file can hold; the file is damaged or cut off");
  return {std::move(id), std::move(space), static_cast<hsize_t>(n)};
}

template <class T>
std::vector<T> values(hid_t file, const std::string& name, H5T_class_t expected, hid_t memory_type)
{
  const Dataset dataset = open_dataset(file, name);
  const Handle type{H5Dget_type(dataset.id.get()), H5Tclose};
  if (H5Tget_class(type.get()) != expected) {
    refuse(name,
           expected == H5T_INTEGER ? "does not hold whole numbers" : "does not hold real numbers");
  }
  std::vector<T> read(dataset.n);
  if (H5Dread(dataset.id.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()) < 0)
    refuse(name, "cannot be read; the file is damaged");
  return read;
}

}  // namespace

MedFile::MedFile(const std::string& bytes) : file_(opened(bytes)) {}

bool MedFile::has(const std::string& name) const
{
  for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
    if (H5Lexists(file_.get(), name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> MedFile::members(const std::string& name) const
{
  if (!has(name)) return {};
  const Handle group{H5Gopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Gclose};
  H5G_info_t info{};
  if (!group.valid() || H5Gget_info(group.get(), &info) < 0) refuse(name, "is no group");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto name_of = [&](char* text, std::size_t size) {
      return H5Lget_name_by_idx(group.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, text, size,
                                H5P_DEFAULT);
    };
    const ssize_t length = name_of(nullptr, 0);
    if (length < 0) refuse(name, "has a member without a name; the file is damaged");
    std::string member(static_cast<std::size_t>(length), '\0');
    name_of(member.data(), member.size() + 1);
    names.push_back(std::move(member));
  }
  return names;
}

std::int64_t MedFile::integer_attribute(const std::string& name, const std::string& attribute) const
{
  const Handle id{
      H5Aopen_by_name(file_.get(), name.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose};
  const Handle type{id.valid() ? H5Aget_type(id.get()) : -1, H5Tclose};
  const Handle space{id.valid() ? H5Aget_space(id.get()) : -1, H5Sclose};
  std::int64_t value = 0;
  if (!id.valid() || H5Tget_class(type.get()) != H5T_INTEGER ||
      H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(id.get(), H5T_NATIVE_INT64, &value) < 0)
    refuse(name, fmt::format("has no whole number as attribute {}", attribute));
  return value;
}

std::vector<std::int64_t> MedFile::integers(const std::string& name) const
{
  return values<std::int64_t>(file_.get(), name, H5T_INTEGER, H5T_NATIVE_INT64);
}

std::vector<double> MedFile::reals(const std::string& name) const
{
  std::vector<double> read = values<double>(file_.get(), name, H5T_FLOAT, H5T_NATIVE_DOUBLE);
  for (const double x : read)
    if (!std::isfinite(x)) refuse(name, "holds what is no finite number");
  return read;
}

/// An array of bytes for each text, or all texts in rows of bytes.
std::vector<std::string> MedFile::texts(const std::string& name, std::size_t length) const
{
  const Dataset dataset = open_dataset(file_.get(), name);
  const Handle type{H5Dget_type(dataset.id.get()), H5Tclose};
  const std::size_t n_bytes = dataset.n * H5Tget_size(type.get());
  const bool is_of_bytes = H5Tget_class(type.get()) == H5T_INTEGER ||
                           H5Tget_class(type.get()) == H5T_ARRAY ||
                           H5Tget_class(type.get()) == H5T_STRING;
  if (!is_of_bytes || H5Tis_variable_str(type.get()) > 0 || n_bytes % length != 0)
    refuse(name, fmt::format("does not hold texts of {} characters", length));
  std::string bytes(n_bytes, '\0');
  if (H5Dread(dataset.id.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
    refuse(name, "cannot be read; the file is damaged");
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < n_bytes; at += length) {
    std::string text = bytes.substr(at, length);
    text.erase(std::min(text.find('\0'), text.size()));
    text.erase(text.find_last_not_of(' ') + 1);
    texts.push_back(std::move(text));
  }
  return texts;
}

}  // namespace chladni::mesh
