#include "mesh/gmsh/silent_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace chladni::mesh {

SilentOutput::SilentOutput() : saved_{dup(STDOUT_FILENO), dup(STDERR_FILENO)}
{
  std::fflush(nullptr);
  // Once: a process that reads a stranger's file opens nothing for writing later.
  static const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
}

SilentOutput::~SilentOutput()
{
  std::fflush(nullptr);
  constexpr std::array outputs{STDOUT_FILENO, STDERR_FILENO};
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (saved_[i] < 0) continue;
    ::dup2(saved_[i], outputs[i]);
    ::close(saved_[i]);
  }
}

}  // namespace chladni::mesh
