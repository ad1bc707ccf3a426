#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/packing.hpp"
#include "confinement/errand.hpp"

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
