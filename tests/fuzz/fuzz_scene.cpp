// Does any text ever make the reader of scenes do anything but return a scene or a clear error?
#include "common/error.hpp"
#include "scene/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size)
{
  try {
    chladni::scene::parse_scene({reinterpret_cast<const char*>(bytes), size}, "scene.toml");
  } catch (const chladni::Error&) {
  }
  return 0;
}
