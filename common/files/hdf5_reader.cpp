#include "common/files/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/error.hpp"
#include "common/files/hdf5_objects.hpp"
#include "common/files/input_file.hpp"
#include "common/files/seal.hpp"
#include "common/files/trial_reading.hpp"

namespace chladni::files {

namespace {

template <class T>
std::vector<T> values_of(const Source& source, const std::string& name, const Dataset& dataset)
{
  std::vector<T> values(dataset.n_bytes() / sizeof(T));
  if (!read_values(dataset, values.data()))
    source.reader.fail(name, "cannot be read; the file is damaged");
  return values;
}

std::vector<double> read_reals(const Source& source, const std::string& name,
                               const Dataset& dataset)
{
  const auto values = values_of<double>(source, name, dataset);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) {
      source.reader.fail(name, fmt::format("value {} of {} is {}, expected finite numbers", i + 1,
                                           values.size(), values[i]));
    }
  return values;
}

/// Cuts n texts of `size` bytes each at their padding.
std::vector<std::string> split_texts(const std::vector<char>& padded, std::size_t size)
{
  std::vector<std::string> texts;
  for (auto text = padded.begin(); text != padded.end(); text += std::ptrdiff_t(size))
    texts.emplace_back(text, std::find(text, text + std::ptrdiff_t(size), '\0'));
  return texts;
}

std::vector<std::string> read_texts(const Source& source, const std::string& name,
                                    const Dataset& dataset)
{
  return split_texts(values_of<char>(source, name, dataset), H5Tget_size(dataset.type.get()));
}

Handle open_attribute(const Source& source, const std::string& object, const std::string& name)
{
  Handle id{H5Aopen_by_name(source.file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
            H5Aclose};
  if (!id.valid()) source.reader.fail(object, fmt::format("has no attribute '{}'", name));
  return id;
}

/// Throws unless the attribute is one value of this kind.
Handle attribute_type(const Source& source, hid_t attribute, const std::string& name,
                      H5T_class_t expected)
{
  Handle type{H5Aget_type(attribute), H5Tclose};
  const Handle space{H5Aget_space(attribute), H5Sclose};
  const bool is_text = expected == H5T_STRING;
  if (H5Tget_class(type.get()) != expected || H5Sget_simple_extent_npoints(space.get()) != 1 ||
      (is_text && H5Tis_variable_str(type.get()) != 0) || H5Tget_size(type.get()) == 0 ||
      H5Tget_size(type.get()) > source.size)
    source.reader.fail("attribute " + name,
                       fmt::format("expected one value, {}{}", class_name(expected),
                                   is_text ? " of fixed length" : ""));
  return type;
}

}  // namespace

Reader::Reader(std::string path) : path_(std::move(path))
{
  prepare_to_read();
  size_ = regular_file_size(path_);
  memory_left_ = most_memory(size_);
  check_seal(path_);
  // A seal tells what was damaged, and not who made the file: with one or without, it is tried.
  if (const auto refusal = refusal_of_trial(path_, limits_of_trial(size_)))
    throw Error(fmt::format("{}: {}", path_, *refusal));
  file_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) throw Error(fmt::format("{}: not an HDF5 file, or cut short", path_));
}

Reader::~Reader()
{
  H5Fclose(file_);
}

void Reader::fail(const std::string& name, const std::string& what) const
{
  throw Error(fmt::format("{}: {}: {}", path_, name, what));
}

bool Reader::contains(const std::string& name) const
{
  for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
    if (H5Lexists(file_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

void Reader::expect_format(const std::string& format, std::int64_t version) const
{
  const std::string found = text_attribute("/", "format");
  if (found != format) fail("/", fmt::format("has format '{}', expected '{}'", found, format));
  const std::int64_t number = integer_attribute("/", "version");
  if (number != version) {
    fail("/", fmt::format("has version {} of format '{}'; this program reads version {}", number,
                          format, version));
  }
}

Eigen::MatrixXd Reader::matrix(const std::string& name, Shape shape) const
{
  const Source source{*this, file_, size_, memory_left_};
  const Dataset dataset = open_dataset(source, name, {H5T_FLOAT, {shape.rows, shape.cols}});
  const auto values = read_reals(source, name, dataset);
  return Eigen::Map<const RowMajorMatrix>(values.data(), dataset.shape[0], dataset.shape[1]);
}

Eigen::VectorXd Reader::vector(const std::string& name, Eigen::Index size) const
{
  const Source source{*this, file_, size_, memory_left_};
  const auto values = read_reals(source, name, open_dataset(source, name, {H5T_FLOAT, {size}}));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
}

double Reader::real(const std::string& name) const
{
  const Source source{*this, file_, size_, memory_left_};
  return read_reals(source, name, open_dataset(source, name, {H5T_FLOAT, {}})).front();
}

std::int64_t Reader::integer(const std::string& name) const
{
  const Source source{*this, file_, size_, memory_left_};
  const Dataset dataset = open_dataset(source, name, {H5T_INTEGER, {}});
  return values_of<std::int64_t>(source, name, dataset).front();
}

std::vector<std::int64_t> Reader::integers(const std::string& name, Eigen::Index size) const
{
  const Source source{*this, file_, size_, memory_left_};
  const Dataset dataset = open_dataset(source, name, {H5T_INTEGER, {size}});
  return values_of<std::int64_t>(source, name, dataset);
}

IntegerMatrix Reader::integer_matrix(const std::string& name, Shape shape) const
{
  const Source source{*this, file_, size_, memory_left_};
  const Dataset dataset = open_dataset(source, name, {H5T_INTEGER, {shape.rows, shape.cols}});
  const auto values = values_of<std::int64_t>(source, name, dataset);
  return Eigen::Map<const IntegerMatrix>(values.data(), dataset.shape[0], dataset.shape[1]);
}

std::string Reader::text(const std::string& name) const
{
  const Source source{*this, file_, size_, memory_left_};
  return read_texts(source, name, open_dataset(source, name, {H5T_STRING, {}})).front();
}

std::vector<std::string> Reader::texts(const std::string& name) const
{
  const Source source{*this, file_, size_, memory_left_};
  return read_texts(source, name, open_dataset(source, name, {H5T_STRING, {any}}));
}

std::string Reader::text_attribute(const std::string& object, const std::string& name) const
{
  const Source source{*this, file_, size_, memory_left_};
  const Handle attribute = open_attribute(source, object, name);
  const Handle type = attribute_type(source, attribute.get(), name, H5T_STRING);
  std::vector<char> padded(H5Tget_size(type.get()));
  if (H5Aread(attribute.get(), type.get(), padded.data()) < 0)
    fail(object, fmt::format("attribute '{}' cannot be read", name));
  return split_texts(padded, padded.size()).front();
}

std::int64_t Reader::integer_attribute(const std::string& object, const std::string& name) const
{
  const Source source{*this, file_, size_, memory_left_};
  const Handle attribute = open_attribute(source, object, name);
  const Handle type = attribute_type(source, attribute.get(), name, H5T_INTEGER);
  std::int64_t number = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_INT64, &number) < 0)
    fail(object, fmt::format("attribute '{}' cannot be read", name));
  return number;
}

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
