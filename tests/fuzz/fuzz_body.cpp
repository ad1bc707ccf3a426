// Does a damaged *.body.h5 ever end in anything but a clear error?
#include "fuzz_file.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/files/body_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  using namespace chladni;
  fuzz::feed({bytes, size}, CHLADNI_SOURCE_DIR "/tests/data/version_1.body.h5",
             [](const std::string& path) { mbs_export::check_body(mbs_export::read_body(path)); });
  return 0;
}
