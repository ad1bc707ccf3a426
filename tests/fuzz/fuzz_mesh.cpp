// Does the check that a .msh is whole, which stands before Gmsh's own reader, end in anything but a
// verdict?
#include "common/error.hpp"
#include "memory_file.hpp"
#include "mesh/gmsh_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const chladni::fuzz::MemoryFile file({bytes, size});
  try {
    chladni::mesh::check_msh_is_whole(file.path());
  } catch (const chladni::Error&) {
  }
  return 0;
}
