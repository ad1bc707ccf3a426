#include "report/page/sound.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

#include "common/error.hpp"
#include "report/page/page.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;
using files::Reader;
using files::Shape;
using std::filesystem::path;

constexpr std::uintmax_t most_wav_bytes = 4'000'000;
constexpr int most_harmonics = 8;

std::vector<std::byte> bytes_of(const path& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::byte> bytes(file_size(file));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw Error(fmt::format("{}: cannot be read", file.string()));
  return bytes;
}

/// `wav` and what is said of it; both null without the file.
std::vector<Json::Member> wav_members(const SoundWav& wav)
{
  const path& file = wav.file;
  if (!exists(file)) return {{"wav", Json()}, {"wav_said", Json()}};
  const std::string name = file.filename().string();
  if (file_size(file) > most_wav_bytes) {
    return {{"wav", Json()},
            {"wav_said", fmt::format("{} has {:.1f} MB and is not in this page; play it from its "
                                     "folder.",
                                     name, static_cast<double>(file_size(file)) / 1e6)}};
  }
  return {{"wav", packed(bytes_of(file))},
          {"wav_said", fmt::format("{}: the pressure at the microphone '{}'. Its largest value is "
                                   "full scale, so the volume of your device sets how loud it is.",
                                   name, wav.microphone)}};
}

Json tone_json(const Reader& file, const std::string& group, int h)
{
  const bool is_estimated = file.contains(group + "/pressure_error");
  return Json::object(
      {{"harmonic", h},
       {"frequency_Hz", rounded(file.real(group + "/frequency"))},
       {"power", rounded(file.real(group + "/power"))},
       {"pressure_error", is_estimated ? rounded(file.real(group + "/pressure_error")) : Json()}});
}

Json tones_json(const Reader& file)
{
  std::vector<Json> tones;
  for (int h = 1; h <= most_harmonics; ++h) {
    const std::string group = fmt::format("tones/{}", h);
    if (file.contains(group)) tones.push_back(tone_json(file, group, h));
  }
  return Json::array(tones);
}

Json microphones_json(const Reader& file)
{
  std::vector<Json> microphones;
  if (!file.contains("microphones/names")) return Json::array(microphones);
  const std::vector<std::string> names = file.texts("microphones/names");
  const auto n = static_cast<Index>(names.size());
  const auto matrix = [&](const std::string& name, Index cols) {
    return file.matrix("microphones/" + name, Shape{n, cols});
  };
  const Eigen::MatrixXd x = matrix("positions", 3), levels = matrix("levels", 3),
                        around = matrix("around_axis", 2), re = matrix("pressure_re", files::any),
                        im = matrix("pressure_im", re.cols());
  for (Index i = 0; i < n; ++i) {
    const Eigen::VectorXd p = (re.row(i).array().square() + im.row(i).array().square()).sqrt();
    microphones.push_back(Json::object({{"name", names[static_cast<std::size_t>(i)]},
                                        {"position", rounded(Eigen::VectorXd(x.row(i)))},
                                        {"level_dB", rounded(levels(i, 0))},
                                        {"peak_dB", rounded(levels(i, 1))},
                                        {"level_A_dB", rounded(levels(i, 2))},
                                        {"around", rounded(Eigen::VectorXd(around.row(i)))},
                                        {"pressure", rounded(p)}}));
  }
  return Json::array(microphones);
}

Json directivity_json(const Reader& file)
{
  if (!file.contains("directivity/rms")) return Json();
  const Eigen::VectorXd polar = file.vector("directivity/polar"),
                        azimuth = file.vector("directivity/azimuth");
  return Json::object(
      {{"polar", rounded(polar)},
       {"azimuth", rounded(azimuth)},
       {"rms", rounded_rows(file.matrix("directivity/rms", {polar.size(), azimuth.size()}))}});
}

Json levels_json(const Reader& file, const std::string& group)
{
  const Eigen::VectorXd speeds = file.vector(group + "/speeds");
  const Index n = speeds.size();
  return Json::object({{"speeds", rounded(speeds)},
                       {"power", rounded(file.vector(group + "/power", n))},
                       {"levels", rounded_rows(file.matrix(group + "/levels", {n, files::any}))}});
}

Json loudness_json(const Reader& file)
{
  if (!file.contains("loudness")) return Json();
  return Json::object({{"without", levels_json(file, "loudness/without_radiation")},
                       {"with", levels_json(file, "loudness/with_radiation")}});
}

Json brake_json(const Reader& file, const std::string& group)
{
  const auto found = [&](const char* name) {
    return file.contains(group + name) ? rounded(file.real(group + name)) : Json();
  };
  return Json::object({{"growth", rounded(file.real(group + "/growth"))},
                       {"stability", file.text(group + "/stability")},
                       {"critical_speed", found("/critical_speed")},
                       {"frequency_Hz", found("/frequency")},
                       {"pad_velocity", found("/pad_velocity")}});
}

Json feedback_json(const Reader& file)
{
  if (!file.contains("feedback")) return Json();
  return Json::object({{"speed", rounded(file.real("feedback/speed"))},
                       {"without", brake_json(file, "feedback/without_radiation")},
                       {"with", brake_json(file, "feedback/with_radiation")}});
}

}  // namespace

Json sound_page(const Reader& file, const SoundWav& wav)
{
  file.expect_format("chladni-sound", 1);
  const auto found = [&](const char* name) {
    return file.contains(name) ? rounded(file.real(name)) : Json();
  };
  std::vector<Json::Member> members{
      {"speed", found("speed")},
      {"frequency_Hz", found("frequency")},
      {"tones", tones_json(file)},
      {"microphones", microphones_json(file)},
      {"directivity", directivity_json(file)},
      {"loudness", loudness_json(file)},
      {"feedback", feedback_json(file)},
      {"notes", texts(file.contains("notes") ? file.texts("notes") : std::vector<std::string>())}};
  for (Json::Member& member : wav_members(wav)) members.push_back(std::move(member));
  return Json::object(members);
}

}  // namespace chladni::report
