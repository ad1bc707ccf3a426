// Does a damaged *.body.h5 ever end in anything but a clear error? Inputs that begin as HDF5 files
// do are files; all others say what to do to the golden file of version 1.
#include <cstring>

#include "common/error.hpp"
#include "damage.hpp"
#include "mbs_export/body_file.hpp"
#include "mbs_export/check_body.hpp"
#include "memory_file.hpp"

namespace {

void read(const std::string& path)
{
  using namespace chladni::mbs_export;
  try {
    check_body(read_body(path));
  } catch (const chladni::Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  using namespace chladni::fuzz;
  static const std::string golden = bytes_of(CHLADNI_SOURCE_DIR "/tests/data/version_1.body.h5");
  if (size > 8 && std::memcmp(bytes, golden.data(), 8) == 0) {
    const MemoryFile file({bytes, size});
    read(file.path());
    return 0;
  }
  const MemoryFile file({reinterpret_cast<const std::uint8_t*>(golden.data()), golden.size()});
  damage(file.path(), {bytes, size});
  read(file.path());
  return 0;
}
