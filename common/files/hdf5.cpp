#include "common/files/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "common/error.hpp"
#include "common/files/hdf5_objects.hpp"
#include "common/files/seal.hpp"

namespace chladni::files {

namespace {

/// How a dataset is made: without the time of the day, so that the same values are the same file.
Handle timeless_dataset()
{
  Handle creation{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_obj_track_times(creation.get(), false);
  return creation;
}

Handle create_dataset(hid_t file, const std::string& name, hid_t type,
                      const std::vector<std::uint64_t>& shape)
{
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  const Handle space{dims.empty() ? H5Screate(H5S_SCALAR)
                                  : H5Screate_simple(int(dims.size()), dims.data(), nullptr),
                     H5Sclose};
  const Handle links{H5Pcreate(H5P_LINK_CREATE), H5Pclose};
  H5Pset_create_intermediate_group(links.get(), 1);
  const Handle creation = timeless_dataset();
  return {
      H5Dcreate2(file, name.c_str(), type, space.get(), links.get(), creation.get(), H5P_DEFAULT),
      H5Dclose};
}

bool set_attribute(hid_t object, const std::string& name, hid_t type, const void* value)
{
  const Handle space{H5Screate(H5S_SCALAR), H5Sclose};
  const Handle attribute{
      H5Acreate2(object, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose};
  return attribute.valid() && H5Awrite(attribute.get(), type, value) >= 0;
}

bool set_text_attribute(hid_t object, const std::string& name, const std::string& text)
{
  const Handle type = text_type(text.size());
  // VTK reads no text that calls itself UTF-8, from 9.2 on.
  const bool is_ascii = std::ranges::all_of(text, [](char c) { return c > 0; });
  if (is_ascii) H5Tset_cset(type.get(), H5T_CSET_ASCII);
  return set_attribute(object, name, type.get(), text.c_str());
}

/// Where it is written and what it is measured in.
struct Target {
  hid_t file;
  const std::string& name;
  const std::string& unit;
};

bool write_dataset(const Target& target, hid_t type, const std::vector<std::uint64_t>& shape,
                   const void* values)
{
  const Handle dataset = create_dataset(target.file, target.name, type, shape);
  if (!dataset.valid()) return false;
  if (H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) return false;
  return set_text_attribute(dataset.get(), "unit", target.unit);
}

bool write_rows(const Handle& dataset, const RowMajorMatrix& rows, Eigen::Index first)
{
  const std::array start{hsize_t(first), hsize_t{0}};
  const std::array count{hsize_t(rows.rows()), hsize_t(rows.cols())};
  const Handle in_file{H5Dget_space(dataset.get()), H5Sclose};
  const Handle in_memory{H5Screate_simple(2, count.data(), nullptr), H5Sclose};
  return H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                             nullptr) >= 0 &&
         H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, in_memory.get(), in_file.get(), H5P_DEFAULT,
                  rows.data()) >= 0;
}

std::vector<std::uint64_t> extents(Eigen::Index rows, Eigen::Index cols)
{
  return {static_cast<std::uint64_t>(rows), static_cast<std::uint64_t>(cols)};
}

bool write_blocks(const Target& target, const RowBlocks& x)
{
  const Handle dataset =
      create_dataset(target.file, target.name, H5T_NATIVE_DOUBLE, extents(x.rows, x.cols));
  if (!dataset.valid()) return false;
  RowMajorMatrix rows;
  for (Eigen::Index first = 0; first < x.rows && x.cols > 0; first += rows.rows()) {
    rows = x.from(first);
    if (!write_rows(dataset, rows, first)) return false;
  }
  return set_text_attribute(dataset.get(), "unit", target.unit);
}

void require(bool done, const std::string& file, const std::string& name)
{
  if (!done)
    throw Error(fmt::format("{}: cannot write {} (disk full, or the name is taken)", file, name));
}

}  // namespace

void leave_nothing_to_exit()
{
  H5dont_atexit();
}

Writer::Writer(std::string target) : replacement_(std::move(target))
{
  silence_errors();
  const Handle creation{H5Pcreate(H5P_FILE_CREATE), H5Pclose};
  H5Pset_userblock(creation.get(), seal_size);
  errno = 0;
  file_ = H5Fcreate(replacement_.temporary().c_str(), H5F_ACC_TRUNC, creation.get(), H5P_DEFAULT);
  if (file_ < 0) {
    const std::string why = errno != 0 ? std::strerror(errno) : "libhdf5 does not say why";
    throw Error(fmt::format("{}: cannot be written ({}){}", path(), why, older_file_stays(path())));
  }
}

Writer::~Writer()
{
  if (file_ >= 0) H5Fclose(file_);
}

void Writer::commit()
{
  const bool flushed = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = H5Fclose(std::exchange(file_, -1)) >= 0;
  if (!flushed || !closed || !write_seal(replacement_.temporary())) replacement_.fail();
  replacement_.commit();
}

void Writer::group(const std::string& name)
{
  const Handle links{H5Pcreate(H5P_LINK_CREATE), H5Pclose};
  H5Pset_create_intermediate_group(links.get(), 1);
  const Handle created{H5Gcreate2(file_, name.c_str(), links.get(), H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose};
  require(created.valid(), path(), name);
}

void Writer::write(const std::string& name, const RowBlocks& x, const std::string& unit)
{
  require(write_blocks({file_, name, unit}, x), path(), name);
}

void Writer::write(const std::string& name, double x, const std::string& unit)
{
  write_reals(name, &x, {}, unit);
}

void Writer::write(const std::string& name, std::span<const double> x, const std::string& unit)
{
  write_reals(name, x.data(), {x.size()}, unit);
}

void Writer::write(const std::string& name, std::int64_t x, const std::string& unit)
{
  write_integers(name, &x, {}, unit);
}

void Writer::write(const std::string& name, std::span<const std::int64_t> x,
                   const std::string& unit)
{
  write_integers(name, x.data(), {x.size()}, unit);
}

void Writer::write(const std::string& name, std::span<const int> x, const std::string& unit)
{
  const std::vector<std::int64_t> wide(x.begin(), x.end());
  write_integers(name, wide.data(), {wide.size()}, unit);
}

void Writer::write(const std::string& name, const IntegerMatrix& x, const std::string& unit)
{
  write_integers(name, x.data(), extents(x.rows(), x.cols()), unit);
}

void Writer::write(const std::string& name, std::span<const std::uint8_t> x,
                   const std::string& unit)
{
  require(write_dataset({file_, name, unit}, H5T_NATIVE_UINT8, {x.size()}, x.data()), path(), name);
}

void Writer::write(const std::string& name, const std::string& text)
{
  const Handle type = text_type(text.size());
  require(write_dataset({file_, name, "text"}, type.get(), {}, text.c_str()), path(), name);
}

void Writer::write(const std::string& name, const std::vector<std::string>& texts)
{
  std::size_t size = 1;
  for (const std::string& text : texts) size = std::max(size, text.size());
  std::string padded;
  for (const std::string& text : texts) padded.append(text).append(size - text.size(), '\0');
  const Handle type = text_type(size);
  require(write_dataset({file_, name, "text"}, type.get(), {texts.size()}, padded.data()), path(),
          name);
}

void Writer::attribute(const std::string& object, const std::string& name, const std::string& text)
{
  const Handle owner{H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose};
  require(owner.valid() && set_text_attribute(owner.get(), name, text), path(),
          object + "@" + name);
}

void Writer::attribute(const std::string& object, const std::string& name, std::int64_t number)
{
  const Handle owner{H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose};
  require(owner.valid() && set_attribute(owner.get(), name, H5T_NATIVE_INT64, &number), path(),
          object + "@" + name);
}

void Writer::attribute(const std::string& object, const std::string& name,
                       std::span<const std::int64_t> numbers)
{
  const Handle owner{H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose};
  const hsize_t n = numbers.size();
  const Handle space{H5Screate_simple(1, &n, nullptr), H5Sclose};
  const Handle attribute{H5Acreate2(owner.get(), name.c_str(), H5T_NATIVE_INT64, space.get(),
                                    H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose};
  require(attribute.valid() && H5Awrite(attribute.get(), H5T_NATIVE_INT64, numbers.data()) >= 0,
          path(), object + "@" + name);
}

void Writer::link(const std::string& name, const std::string& target)
{
  require(H5Lcreate_soft(target.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0,
          path(), name);
}

void Writer::view_column(const std::string& name, const Column& column)
{
  const std::array matrix{hsize_t(column.rows), hsize_t(column.cols)};
  const std::array triples{hsize_t(column.rows / 3), hsize_t{3}};
  const std::array start{hsize_t{0}, hsize_t(column.column)},
      count{hsize_t(column.rows), hsize_t{1}};
  const Handle source{H5Screate_simple(2, matrix.data(), nullptr), H5Sclose};
  H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  const Handle view{H5Screate_simple(2, triples.data(), nullptr), H5Sclose};
  const Handle creation = timeless_dataset();
  // "." is the file itself, whatever its name will be.
  H5Pset_virtual(creation.get(), view.get(), ".", column.matrix.c_str(), source.get());
  const Handle made{H5Dcreate2(file_, name.c_str(), H5T_NATIVE_DOUBLE, view.get(), H5P_DEFAULT,
                               creation.get(), H5P_DEFAULT),
                    H5Dclose};
  require(made.valid(), path(), name);
}

void Writer::variable_attribute(const std::string& object, const std::string& name,
                                const std::string& text)
{
  const Handle owner{H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose};
  const Handle type = text_type(1);
  H5Tset_size(type.get(), H5T_VARIABLE);
  const char* const characters = text.c_str();
  require(owner.valid() && set_attribute(owner.get(), name, type.get(), &characters), path(),
          object + "@" + name);
}

void Writer::write_reals(const std::string& name, const double* x, const Extents& shape,
                         const std::string& unit)
{
  require(write_dataset({file_, name, unit}, H5T_NATIVE_DOUBLE, shape, x), path(), name);
}

void Writer::write_matrix(const std::string& name, const Eigen::Ref<const Eigen::MatrixXd>& x,
                          const std::string& unit)
{
  constexpr Eigen::Index piece = 1 << 18;  // numbers: 2 MiB
  const Eigen::Index most = std::max<Eigen::Index>(1, piece / std::max<Eigen::Index>(1, x.cols()));
  const auto from = [&](Eigen::Index row) -> Eigen::MatrixXd {
    return x.middleRows(row, std::min(most, x.rows() - row));
  };
  write(name, {.rows = x.rows(), .cols = x.cols(), .from = from}, unit);
}

void Writer::write_integers(const std::string& name, const std::int64_t* x, const Extents& shape,
                            const std::string& unit)
{
  require(write_dataset({file_, name, unit}, H5T_NATIVE_INT64, shape, x), path(), name);
}

}  // namespace chladni::files
