#pragma once

#include <filesystem>
#include <string>

namespace chladni::mesh {

/// Whether a file is a deck of bulk data of Nastran, by its name.
inline bool is_nastran(const std::string& file)
{
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".bdf" || extension == ".nas" || extension == ".dat";
}

/// Whether a file is an input file of Abaqus, by its name.
inline bool is_abaqus(const std::string& file)
{
  return std::filesystem::path(file).extension() == ".inp";
}

/// Whether a file is a deck of another FE program, by its name; such files tell no unit.
inline bool is_deck(const std::string& file)
{
  return is_nastran(file) || is_abaqus(file);
}

}  // namespace chladni::mesh
