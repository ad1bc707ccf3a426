#include "files/text_file.hpp"

#include "files/replacement.hpp"

namespace chladni::files {

void write_text(const std::string& path, std::string_view text)
{
  Replacement file(path);
  file.write(text);
  file.commit();
}

}  // namespace chladni::files
