// Does a damaged MED file end in anything but a mesh or an error that says what is wrong? What is
// damaged is what libhdf5 reads; its own metadata are left to the process that reads meshes.
#include <filesystem>

#include "common/error.hpp"
#include "damage.hpp"
#include "memory_file.hpp"
#include "mesh/exchange/med.hpp"

/// As in fuzz_file.cpp.
extern "C" const char* __asan_default_options()  // NOLINT: the name is the sanitizer's
{
  return "allocator_may_return_null=1:max_allocation_size_mb=64";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  using namespace chladni;
  static const std::string golden =
      fuzz::bytes_of(CHLADNI_SOURCE_DIR "/tests/data/three_by_two.med");
  static const mesh::MeshOptions options{.line_groups = {"root"}, .shell_groups = {"plate", "far"}};
  const fuzz::MemoryFile file(
      {reinterpret_cast<const std::uint8_t*>(golden.data()), golden.size()});
  fuzz::damage(file.path(), {bytes, size});
  constexpr std::uintmax_t most = 1 << 20;  // of the file: some damage writes long datasets
  if (std::filesystem::file_size(file.path()) > most) return 0;
  try {
    mesh::mesh_of(mesh::med_mesh(fuzz::bytes_of(file.path())), options);
  } catch (const Error&) {
  }
  return 0;
}
