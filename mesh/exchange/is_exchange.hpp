#pragma once

#include <filesystem>
#include <string>

namespace chladni::mesh {

/// Whether a file is a universal file of I-deas, by its name.
inline bool is_unv(const std::string& file)
{
  return std::filesystem::path(file).extension() == ".unv";
}

/// Whether a file is a MED file of Salome and Code_Aster, by its name.
inline bool is_med(const std::string& file)
{
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".med" || extension == ".mmed";
}

/// Whether a file is an unstructured grid of VTK in XML, by its name.
inline bool is_vtu(const std::string& file)
{
  return std::filesystem::path(file).extension() == ".vtu";
}

/// Whether a file carries a mesh and its groups between programs, by its name; such files tell no
/// unit that could be relied upon, and no sections.
inline bool is_exchange(const std::string& file)
{
  return is_unv(file) || is_med(file) || is_vtu(file);
}

}  // namespace chladni::mesh
