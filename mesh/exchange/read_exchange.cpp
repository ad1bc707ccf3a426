#include "mesh/exchange/read_exchange.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "mesh/check_msh.hpp"
#include "mesh/exchange/is_exchange.hpp"
#include "mesh/exchange/med.hpp"
#include "mesh/exchange/unv.hpp"
#include "mesh/exchange/vtu.hpp"

namespace chladni::mesh {

Mesh exchange_mesh(const MeshOptions& options)
{
  const std::string& file = *options.file;
  try {
    const std::string bytes = read_all(file);
    const ExchangeMesh mesh = is_med(file)   ? med_mesh(bytes)
                              : is_unv(file) ? unv_mesh(bytes, options.length_unit)
                                             : vtu_mesh(bytes);
    return mesh_of(deck_of(mesh, options), options.line_groups);
  } catch (const Error& error) {
    throw Error(fmt::format("mesh file {}: {}", file, error.what()));
  }
}

}  // namespace chladni::mesh
