#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace chladni::confinement {

/// A program that is started for one answer.
struct Errand {
  std::filesystem::path program;
  std::vector<char> question;  ///< what it reads from stdin
  double most_seconds;         ///< until it is killed
  std::size_t most_bytes;      ///< of its answer, else it is killed
};

enum class End { exited, killed_by_signal, took_too_long, said_too_much };

/// How it ended, and what it had said until then.
struct Outcome {
  End end;
  int code;  ///< exit code or number of the signal
  std::vector<char> answer;
};

/// The descriptor that a program on an errand answers through.
inline constexpr int answer_descriptor = 3;

/// Starts the program, without any file of this process but the question and the answer, and waits
/// for its end.
/// @throws chladni::Error when it cannot be started.
Outcome run(const Errand& errand);

}  // namespace chladni::confinement
