#pragma once

#include <filesystem>
#include <string>

namespace chladni::mesh {

/// True if the name of a file is that of Nastran bulk data: .bdf, .nas, .dat.
inline bool is_nastran(const std::string& file)
{
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".bdf" || extension == ".nas" || extension == ".dat";
}

/// True if the name of a file is that of an Abaqus input file: .inp.
inline bool is_abaqus(const std::string& file)
{
  return std::filesystem::path(file).extension() == ".inp";
}

/// True if the name of a file is that of a deck of another FE program. Such files do not give their
/// unit of length.
inline bool is_deck(const std::string& file)
{
  return is_nastran(file) || is_abaqus(file);
}

}  // namespace chladni::mesh
