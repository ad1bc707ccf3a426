// Does the reader of universal files end in anything but a mesh or an error that says what is
// wrong? MED files have a fuzzer of their own.
#include <string>

#include "common/error.hpp"
#include "mesh/exchange/unv.hpp"

namespace {

using namespace chladni::mesh;

const MeshOptions options{.line_groups = {"root"}, .shell_groups = {"plate", "far"}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  try {
    mesh_of(unv_mesh({reinterpret_cast<const char*>(bytes), size}, 1e-3), options);
  } catch (const chladni::Error&) {
  }
  return 0;
}
