#include "squeal/brake/radiation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mbs_export/files/body_files.hpp"
#include "squeal/results/result_fields.hpp"

namespace chladni::squeal {

constexpr auto fields_of(std::type_identity<Radiation>)
{
  using T = Radiation;
  return std::tuple{
      Field{"mode_numbers", "1", &T::mode_numbers, "n", Presence::always, &check_modes},
      Field{"frequencies", "rad/s", &T::omega, "n"}, Field{"evaluated_at", "rad/s", &T::at, "n"},
      Field{"damping", "1/s", &T::damping, "n"}, Field{"added_mass", "1", &T::added_mass, "n"}};
}

namespace {

constexpr const char* radiation_format = "chladni-radiation";
constexpr std::int64_t radiation_version = 1;

/// Frequencies of the same body are equal but for rounding.
constexpr double same_mode_frequency = 1e-9;

}  // namespace

Disc with_radiation(Disc disc, const Radiation& radiation)
{
  const auto& numbers = radiation.mode_numbers;
  for (Eigen::Index i = 0; i < disc.n_modes(); ++i) {
    const int number = disc.mode_numbers[static_cast<std::size_t>(i)];
    const auto found = std::ranges::find(numbers, number);
    const auto at = static_cast<Eigen::Index>(found - numbers.begin());
    if (found == numbers.end() ||
        std::abs(radiation.omega[at] - disc.omega[i]) > same_mode_frequency * disc.omega[i]) {
      throw Error(fmt::format(
          "radiation: mode {} of the body ({:.6g} Hz) is not among those whose radiation is known; "
          "compute it again with `chladni sound`",
          number, disc.omega[i] / (2.0 * std::numbers::pi)));
    }
    disc.C(i, i) += radiation.damping[at];
  }
  return disc;
}

void write_radiation(const std::filesystem::path& file, const Radiation& radiation,
                     const std::string& title, const mbs_export::Provenance& provenance)
{
  files::Writer writer(file.string());
  writer.attribute("/", "format", radiation_format);
  writer.attribute("/", "version", radiation_version);
  writer.attribute("/", "title", title);
  files::write_fields(writer, "", radiation);
  mbs_export::file_parts::write_provenance(writer, provenance);
  writer.commit();
}

Radiation read_radiation(const std::filesystem::path& file)
{
  return read_radiation(files::Reader(file.string()));
}

Radiation read_radiation(const files::Reader& reader)
{
  reader.expect_format(radiation_format, radiation_version);
  return files::read_fields<Radiation>(reader, "");
}

}  // namespace chladni::squeal
