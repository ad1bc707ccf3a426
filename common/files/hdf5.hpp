#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/files/output_file.hpp"

/// A thin layer over the HDF5 C library: atomic writing, sealed files (seal.hpp), strict reading.
/// Paths of datasets are relative to the root ("rings/track/W"); groups on the way are created.

namespace chladni::files {

using IntegerMatrix = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Makes libhdf5 do nothing at exit, where it would flush again what it could not write to a full
/// disk, and crash. For programs, to be called before any other function of HDF5.
void leave_nothing_to_exit();

/// The extents that a dataset must have; `any` allows every extent.
constexpr Eigen::Index any = -1;
struct Shape {
  Eigen::Index rows = any;
  Eigen::Index cols = any;
};

/// A column of a matrix that a file holds.
struct Column {
  std::string matrix;
  Eigen::Index rows, cols;  ///< of the matrix
  Eigen::Index column;
};

/// A matrix that is written in blocks of rows and never held as a whole.
struct RowBlocks {
  Eigen::Index rows, cols;
  std::function<Eigen::MatrixXd(Eigen::Index row)> from;  ///< returns some rows from this one on
};

/// Writes a file under a temporary name beside the target; only `commit` gives it its name.
class Writer {
 public:
  /// @throws chladni::Error when the folder does not exist or cannot be written.
  explicit Writer(std::string target);
  /// Removes the temporary file if there was no commit.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Closes, seals, flushes to disk and renames the file. Afterwards the writer must not be used.
  void commit();

  void group(const std::string& name);

  /// Writes a vector as [n] and a matrix as [rows x cols] in the order of h5py (by rows).
  /// @param unit  "m", "rad/s", ...; "1" for a pure number
  template <class Derived>
  void write(const std::string& name, const Eigen::MatrixBase<Derived>& x, const std::string& unit)
  {
    if constexpr (Derived::IsVectorAtCompileTime) {
      const auto& values = x.template cast<double>().eval();
      write_reals(name, values.data(), {static_cast<std::uint64_t>(values.size())}, unit);
    } else {
      write_matrix(name, x.template cast<double>(), unit);
    }
  }
  void write(const std::string& name, const RowBlocks& x, const std::string& unit);
  void write(const std::string& name, double x, const std::string& unit);
  void write(const std::string& name, std::span<const double> x, const std::string& unit);
  void write(const std::string& name, std::int64_t x, const std::string& unit);
  void write(const std::string& name, std::span<const std::int64_t> x, const std::string& unit);
  void write(const std::string& name, std::span<const int> x, const std::string& unit);
  void write(const std::string& name, const IntegerMatrix& x, const std::string& unit);
  void write(const std::string& name, std::span<const std::uint8_t> x, const std::string& unit);
  void write(const std::string& name, const std::string& text);
  void write(const std::string& name, const std::vector<std::string>& texts);

  /// Adds another name for a dataset of the file.
  void link(const std::string& name, const std::string& target);
  /// Adds a dataset [rows / 3 x 3] that stores nothing and shows the column by rows of three.
  void view_column(const std::string& name, const Column& column);

  /// Adds an attribute to a dataset or group; "/" is the root.
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, std::int64_t number);
  void attribute(const std::string& object, const std::string& name,
                 std::span<const std::int64_t> numbers);
  /// Adds a text of variable length, which h5py returns as text, not as bytes. Reader refuses it.
  void variable_attribute(const std::string& object, const std::string& name,
                          const std::string& text);

 private:
  using Extents = std::vector<std::uint64_t>;
  void write_reals(const std::string& name, const double* x, const Extents& shape,
                   const std::string& unit);
  void write_matrix(const std::string& name, const Eigen::Ref<const Eigen::MatrixXd>& x,
                    const std::string& unit);
  void write_integers(const std::string& name, const std::int64_t* x, const Extents& shape,
                      const std::string& unit);

  const std::string& path() const { return replacement_.path(); }

  Replacement replacement_;
  std::int64_t file_ = -1;  ///< hid_t; negative once closed
};

/// Reads a file that need not be trusted. Every dataset must exist, hold the right kind of value,
/// have the rank and the extents that are asked for, fit into the file, and be finite. The memory
/// for unpacked values is limited by the size of the file. Parts in other files, or that need
/// external code, are not read (foreign_parts.hpp), with a seal or without. Every function throws
/// chladni::Error that names the file, the dataset and what was expected.
class Reader {
 public:
  /// Checks the seal and tries the file in another process, before libhdf5 opens it in this one.
  explicit Reader(std::string path);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool contains(const std::string& name) const;
  /// Throws unless the root attributes `format` and `version` have these values.
  void expect_format(const std::string& format, std::int64_t version) const;

  Eigen::MatrixXd matrix(const std::string& name, Shape shape = {}) const;
  Eigen::VectorXd vector(const std::string& name, Eigen::Index size = any) const;
  double real(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  std::vector<std::int64_t> integers(const std::string& name, Eigen::Index size = any) const;
  IntegerMatrix integer_matrix(const std::string& name, Shape shape = {}) const;
  std::string text(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  std::string text_attribute(const std::string& object, const std::string& name) const;
  std::int64_t integer_attribute(const std::string& object, const std::string& name) const;

  const std::string& path() const { return path_; }
  /// Throws chladni::Error "PATH: NAME: WHAT", for checks of the caller.
  [[noreturn]] void fail(const std::string& name, const std::string& what) const;

 private:
  std::string path_;
  std::int64_t file_ = -1;                 ///< hid_t
  std::uint64_t size_ = 0;                 ///< of the file, bytes
  mutable std::uint64_t memory_left_ = 0;  ///< that further values may take, bytes
};

}  // namespace chladni::files

/// The contents of a file, for programs that show them unchanged.

namespace chladni::files {

/// A dataset that is stored in the file itself.
struct Item {
  enum class Kind { reals, integers, texts };
  std::string name;
  Kind kind;
  std::size_t rank;  ///< number of extents
  std::string unit;  ///< its attribute; empty if there is none
};

/// All datasets except views of others, by their names.
/// @throws chladni::Error naming file and dataset for one that claims more than the file can hold.
std::vector<Item> contents(const Reader& reader);

}  // namespace chladni::files
