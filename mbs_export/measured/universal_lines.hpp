#pragma once

#include <filesystem>
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

}  // namespace chladni::mbs_export
