#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/packing.hpp"

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

/// Programs that work for others in a process of their own: how they are found, asked, and answer.

namespace chladni::confinement {

/// The helper that works with Gmsh.
inline constexpr const char* mesher = "chladni-mesher";

/// The path of a helper such as `mesher`: where the environment says (CHLADNI_MESHER), else beside
/// this program as both are built and installed, where this library was to be installed, or beside
/// the programs of PATH.
/// @throws chladni::Error when there is none.
std::filesystem::path helper(const std::string& name);

/// Sends a helper on an errand and hands its answer to `unpack`.
/// @param explain  what to say of an end without an answer
/// @throws chladni::Error with the message of the helper's own error, or with that of `explain`.
void ask(const Errand& errand, const std::function<std::string(const Outcome&)>& explain,
         const std::function<void(Unpacker&)>& unpack);

/// The whole work of a helper: takes the question from stdin, and answers with what `work` packs or
/// with the message of the chladni::Error that it throws. Ends this process, without destructors at
/// exit, and earlier when its caller ends.
[[noreturn]] void serve(const std::function<void(Unpacker& question, Packer& answer)>& work);

}  // namespace chladni::confinement
