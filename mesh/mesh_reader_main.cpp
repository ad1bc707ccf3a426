// Reads one mesh file for `chladni`, which starts it: nothing to be started by hand.
#include "mesh/mesh_reader.hpp"

int main()
{
  return chladni::mesh::answer_with_mesh();
}
