// Do the readers of measured modes and functions (universal files, datasets 15, 55, 58, 58b, 164,
// 2411) end in anything but modes, functions or an error that says what is wrong?
#include "common/error.hpp"
#include "mbs_export/measured/measured_functions.hpp"
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
    try {
      const auto functions = chladni::mbs_export::read_measured_functions(file.path(), metres);
      chladni::mbs_export::within(functions, 10.0, 1000.0);
    } catch (const chladni::Error&) {
    }
  }
  return 0;
}
