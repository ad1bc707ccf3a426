#pragma once

#include <filesystem>
#include <string>

#include "cli/arguments.hpp"

/// Text files that record which scene wrote them.
namespace chladni::cli {

/// An XML or HTML comment for the end of a file, which names the scene's file relative to the
/// output folder.
std::string writer_mark(const SceneArguments& arguments);

/// The scene's file named by the comment at the end of a file; empty if there is none.
std::string marked_writer(const std::filesystem::path& file);

}  // namespace chladni::cli
