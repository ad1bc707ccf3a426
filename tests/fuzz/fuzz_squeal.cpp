// Does a damaged *.squeal.h5 ever end in anything but a clear error, or in what it says?
#include "fuzz_file.hpp"
#include "read_results.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  using namespace chladni;
  fuzz::feed({bytes, size}, fuzz::golden_results, fuzz::read_results);
  return 0;
}
