// A library that libhdf5 loads where it looks for filters. Being loaded is what must not happen: it
// then leaves a file whose name the environment holds.
#include <cstdlib>
#include <fstream>

namespace {

[[gnu::constructor]] void leave_a_trace()
{
  if (const char* trace = std::getenv("CHLADNI_TEST_TRACE")) std::ofstream(trace) << "loaded";
}

}  // namespace
