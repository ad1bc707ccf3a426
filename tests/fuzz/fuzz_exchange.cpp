// Do the readers of universal files and of grids of VTK end in anything but a mesh or an error that
// says what is wrong? MED files have a fuzzer of their own.
#include <string>

#include "common/error.hpp"
#include "mesh/exchange/unv.hpp"
#include "mesh/exchange/vtu.hpp"

namespace {

using namespace chladni::mesh;

const MeshOptions options{.line_groups = {"root"}, .shell_groups = {"plate", "far"}};

void feed_unv(const std::string& text)
{
  mesh_of(unv_mesh(text, 1e-3), options);
}

void feed_vtu(const std::string& text)
{
  mesh_of(vtu_mesh(text), options);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  for (void (*feed)(const std::string&) : {feed_unv, feed_vtu}) {
    try {
      feed(text);
    } catch (const chladni::Error&) {
    }
  }
  return 0;
}
