#include "mbs_export/fmu/component.hpp"

#include <cstring>
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

std::string resource(const std::string& location, const std::string& file)
{
  std::string path = path_of(location);
  path += "/" + file;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error("cannot open " + path + ", the model of this FMU");
  return {std::istreambuf_iterator<char>(stream), {}};
}

void check_token(const std::string& of_model, const std::string& of_description)
{
  if (of_model == of_description) return;
  throw Error(
      "the model of this FMU is of another export than modelDescription.xml: its token is " +
      of_model + ", not " + of_description);
}

void check_states(const Simulation& simulation, std::size_t n)
{
  const auto n_states = simulation.continuous_states().size();
  if (n == static_cast<std::size_t>(n_states)) return;
  throw Error("the FMU has " + std::to_string(n_states) + " continuous states, not " +
              std::to_string(n));
}

void keep_state(const Simulation& simulation, void** state)
{
  if (*state == nullptr)
    *state = new Eigen::VectorXd(simulation.snapshot());
  else
    *static_cast<Eigen::VectorXd*>(*state) = simulation.snapshot();
}

std::size_t size_of_state(const Simulation& simulation)
{
  return static_cast<std::size_t>(simulation.snapshot().size()) * sizeof(double);
}

void state_to_bytes(const Simulation& simulation, const void* state, void* bytes, std::size_t n)
{
  if (n < size_of_state(simulation))
    throw Error("the buffer is too small for a serialized FMU state");
  std::memcpy(bytes, static_cast<const Eigen::VectorXd*>(state)->data(), size_of_state(simulation));
}

void* state_from_bytes(const Simulation& simulation, const void* bytes, std::size_t n)
{
  if (n != size_of_state(simulation)) throw Error("the serialized state belongs to another FMU");
  auto state = std::make_unique<Eigen::VectorXd>(simulation.snapshot().size());
  std::memcpy(state->data(), bytes, n);
  if (!state->allFinite())
    throw Error("the serialized state contains a value that is no finite number");
  return state.release();
}

}  // namespace chladni::fmu
