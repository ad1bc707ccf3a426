// Does a damaged *.radiation.h5, the file of `chladni sound` that `squeal run` reads, ever end in
// anything but a clear error?
#include "fuzz_file.hpp"
#include "read_results.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  using namespace chladni;
  fuzz::feed({bytes, size}, fuzz::golden_radiation, fuzz::read_radiation);
  return 0;
}
