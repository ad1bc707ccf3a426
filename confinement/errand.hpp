#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace chladni::confinement {

/// A program that is started to give one answer.
struct Errand {
  std::filesystem::path program;
  std::vector<char> question;  ///< its stdin
  double most_seconds;         ///< it is killed after this time
  std::size_t most_bytes;      ///< it is killed if its answer is longer
};

enum class End { exited, killed_by_signal, took_too_long, said_too_much };

/// How the program ended, and its answer up to then.
struct Outcome {
  End end;
  int code;  ///< exit code, or number of the signal
  std::vector<char> answer;
};

/// The file descriptor to which a program on an errand writes its answer.
inline constexpr int answer_descriptor = 3;

/// Starts the program with no open files of this process except question and answer, and waits for
/// its end.
/// @throws chladni::Error when it cannot be started.
Outcome run(const Errand& errand);

}  // namespace chladni::confinement
