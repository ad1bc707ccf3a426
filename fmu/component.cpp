#include "fmu/component.hpp"

#include <fstream>
#include <iterator>

#include "common/error.hpp"

namespace chladni::fmu {
namespace {

int hexadecimal_digit(char c)
{
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// %20 and the like as the characters that they stand for.
std::string decoded(const std::string& text)
{
  std::string path;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_code = text[i] == '%' && i + 2 < text.size() &&
                         hexadecimal_digit(text[i + 1]) >= 0 && hexadecimal_digit(text[i + 2]) >= 0;
    if (!is_code) {
      path += text[i];
      continue;
    }
    path += static_cast<char>(16 * hexadecimal_digit(text[i + 1]) + hexadecimal_digit(text[i + 2]));
    i += 2;
  }
  return path;
}

/// "file:///a", "file:/a" and "file://localhost/a" are the path /a (RFC 8089).
std::string path_of(const std::string& location)
{
  constexpr std::string_view scheme = "file:";
  if (!location.starts_with(scheme)) return location;
  std::string path = location.substr(scheme.size());
  if (path.starts_with("//")) path.erase(0, path.find('/', 2));
  return decoded(path);
}

}  // namespace

ModalModel model_at(const std::string& location, const std::string& token)
{
  const std::string path = path_of(location) + "/" + model_file;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error("cannot open " + path + ", the body of this FMU");
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  ModalModel model = unpacked(bytes);
  if (model.token == token) return model;
  throw Error(path + " is of another export than modelDescription.xml: its token is " +
              model.token + ", not " + token);
}

void check_states(const Instance& instance, std::size_t n)
{
  if (n == static_cast<std::size_t>(2 * instance.model().n_modes())) return;
  throw Error("the FMU has " + std::to_string(2 * instance.model().n_modes()) +
              " continuous states, not " + std::to_string(n));
}

void keep_state(const Instance& instance, void** state)
{
  if (*state == nullptr)
    *state = new State(instance.state());
  else
    *static_cast<State*>(*state) = instance.state();
}

}  // namespace chladni::fmu
