#pragma once

#include <filesystem>
#include <string>

namespace chladni::mesh {

/// True if the name of a file is that of a universal file of I-deas: .unv.
inline bool is_unv(const std::string& file)
{
  return std::filesystem::path(file).extension() == ".unv";
}

/// True if the name of a file is that of a MED file of Salome and Code_Aster: .med, .mmed.
inline bool is_med(const std::string& file)
{
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".med" || extension == ".mmed";
}

/// True if the name of a file is that of an unstructured grid of VTK in XML: .vtu.
inline bool is_vtu(const std::string& file)
{
  return std::filesystem::path(file).extension() == ".vtu";
}

/// True if the name of a file is that of a format that carries meshes with groups between programs.
/// Such files give no reliable unit of length and no sections.
inline bool is_exchange(const std::string& file)
{
  return is_unv(file) || is_med(file) || is_vtu(file);
}

}  // namespace chladni::mesh
