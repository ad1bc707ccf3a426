#include "mesh/exchange/read_exchange.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "mesh/check_msh.hpp"
#include "mesh/exchange/med.hpp"
#include "mesh/exchange/unv.hpp"
#include "mesh/exchange/vtu.hpp"

namespace chladni::mesh {

Mesh exchange_mesh(const MeshOptions& options)
{
  const std::string& file = *options.file;
  try {
    const std::string bytes = read_all(file);
    const MeshSource source = mesh_source(file).value();
    if (source == MeshSource::med) return mesh_of(med_mesh(bytes), options);
    if (source == MeshSource::vtu) return mesh_of(vtu_mesh(bytes), options);
    return mesh_of(unv_mesh(bytes, options.length_unit), options);
  } catch (const Error& error) {
    throw Error(fmt::format("mesh file {}: {}", file, error.what()));
  }
}

}  // namespace chladni::mesh
