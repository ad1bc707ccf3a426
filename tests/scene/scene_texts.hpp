#pragma once

#include <string>

#include "common/error.hpp"
#include "scene/scene.hpp"

namespace chladni::scene::test {

/// `text` with the first `old_part` of it replaced, which must be there.
inline std::string replaced(const std::string& text, const std::string& old_part,
                            const std::string& new_part)
{
  const std::size_t at = text.find(old_part);
  if (at == std::string::npos) throw Error("the test replaces what is not there: " + old_part);
  return text.substr(0, at) + new_part + text.substr(at + old_part.size());
}

/// What reading the text as "scene.toml" complains of.
inline std::string error_of(const std::string& text)
{
  try {
    parse_scene(text, "scene.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace chladni::scene::test
