// Does the reader of measured modes (universal files, datasets 15, 55, 164, 2411) end in anything
// but modes or an error that says what is wrong?
#include "common/error.hpp"
#include "mbs_export/measured/measured_modes.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const chladni::fuzz::MemoryFile file({bytes, size});
  for (const std::optional<double> metres : {std::optional<double>(), std::optional(1e-3)}) {
    try {
      chladni::mbs_export::read_measured_modes(file.path(), metres);
    } catch (const chladni::Error&) {
    }
  }
  return 0;
}
