#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace chladni::mbs_export {

/// What follows the lines of a binary dataset.
struct UniversalBytes {
  bool is_little_endian;
  std::string bytes;
};

/// A dataset of a universal file, between two lines of -1: records in fixed columns.
struct UniversalDataset {
  int number;
  std::size_t first_line;  ///< line number in the file of the first of `lines`, from 1
  std::vector<std::string> lines;
  std::optional<UniversalBytes> binary = {};  ///< of a dataset such as 58b
};

/// The datasets of a file, in their order. Lines are counted where they end with a line feed, which
/// the bytes of binary datasets are not searched for.
/// @throws chladni::Error naming the file and the line when it is no universal file, a binary
///         dataset has other numbers than those of IEEE 754 or ends elsewhere than it says, or the
///         file ends within a dataset.
std::vector<UniversalDataset> read_universal_datasets(const std::filesystem::path& path);

/// Columns of a line.
struct Columns {
  std::size_t first;  ///< from 0
  std::size_t width;
};

/// Reads a dataset line by line. Errors name file, line and dataset.
class RecordReader {
 public:
  RecordReader(const std::filesystem::path& path, const UniversalDataset& dataset)
      : path_(path), dataset_(dataset)
  {}

  bool at_end() const { return next_ == dataset_.lines.size(); }
  /// The next line.
  /// @param what  name of the record, for errors
  const std::string& line(const char* what);
  /// The next line as `n` integers of `width` columns each.
  std::vector<std::int64_t> integers(const char* what, std::size_t n, std::size_t width = 10);
  /// The integers in some columns of the next line; 0 where these are blank.
  std::vector<std::int64_t> fields(const char* what, std::initializer_list<Columns> columns);
  /// The next `n` numbers of `width` columns each, `per_line` in each line; exponents with E or D.
  std::vector<double> reals(const char* what, std::size_t n, std::size_t width,
                            std::size_t per_line);
  /// The next line as numbers, which stand in as many words, or in these numbers of columns where
  /// no blanks part them.
  std::vector<double> line_of_reals(const char* what, const std::vector<std::size_t>& widths);
  /// Throws chladni::Error "FILE:LINE: dataset N: WHAT" for the line that was read last.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  const std::filesystem::path& path_;
  const UniversalDataset& dataset_;
  std::size_t next_ = 0;
};

/// A node as a universal file gives it.
struct UniversalNode {
  Eigen::Vector3d position;               ///< in the unit of the file
  std::int64_t defined_in, displaced_in;  ///< numbers of coordinate systems
};

/// SI units of what a universal file has in 1 (dataset 164).
struct UniversalUnits {
  double metres;   ///< m per unit of length
  double newtons;  ///< N per unit of force
};

/// Nodes (datasets 15 and 2411), units (164), and whether there are coordinate systems (18, 2420).
class UniversalGeometry {
 public:
  /// Reads a dataset that is one of these; returns whether it was.
  /// @throws chladni::Error naming file, line and record for a violation of the format.
  bool take(RecordReader& records, const UniversalDataset& dataset);

  const std::map<std::int64_t, UniversalNode>& nodes() const { return nodes_; }
  const std::optional<UniversalUnits>& units() const { return units_; }
  /// Whether position and directions of the node are in the axes of the model: those of system 0,
  /// and of system 1 unless dataset 18, where tests have the axes of sensors, gives systems.
  bool is_in_global_axes(const UniversalNode& node) const;

 private:
  void add(RecordReader& records, const std::vector<std::int64_t>& label,
           const std::vector<double>& x);
  void read_nodes_15(RecordReader& records, const UniversalDataset& dataset);
  void read_nodes_2411(RecordReader& records);

  std::map<std::int64_t, UniversalNode> nodes_;
  std::optional<UniversalUnits> units_;
  bool has_systems_18_ = false, has_systems_2420_ = false;
};

}  // namespace chladni::mbs_export

/// Fields of a line of a universal file.

namespace chladni::mbs_export {

/// The text without blanks, tabulators and carriage returns around it.
std::string trimmed(const std::string& text);

/// A field in fixed columns, without blanks; empty where the line is shorter.
std::string field_of(const std::string& line, std::size_t first, std::size_t width);

/// A field as a whole number; nothing where it is none.
std::optional<std::int64_t> integer_in(const std::string& field);
/// A field as a finite number, with an exponent of E or D; nothing where it is none.
std::optional<double> real_in(const std::string& field);

/// Throws chladni::Error "FILE:LINE: WHAT".
[[noreturn]] void fail_at(const std::filesystem::path& path, std::size_t line,
                          const std::string& what);

}  // namespace chladni::mbs_export
