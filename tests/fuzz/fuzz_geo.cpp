// Does what is asked of the text of a .geo before Gmsh reads it end, whatever the text is?
#include "mesh/gmsh_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size)
{
  using namespace chladni::mesh;
  const auto code = geo_statements({reinterpret_cast<const char*>(bytes), size});
  has_word(code, "width");
  has_mesh_command(code);
  sets_algorithm_8(code);
  return 0;
}
