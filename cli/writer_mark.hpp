#pragma once

#include <filesystem>
#include <string>

#include "cli/arguments.hpp"

/// Files of text that keep in mind which scene wrote them.
namespace chladni::cli {

/// A comment of XML and HTML for the end of a file, with the scene's file as seen from the output
/// folder.
std::string writer_mark(const SceneArguments& arguments);

/// The scene's file in the comment at the end of a file; empty where there is none.
std::string marked_writer(const std::filesystem::path& file);

}  // namespace chladni::cli
