#include "report/page/sound.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.hpp"

namespace chladni::report {
namespace {

using std::filesystem::path;

/// A file of one tone that two microphones hear, as `chladni sound` writes it.
path write_sound(const path& folder)
{
  const path file = folder / "disc.sound.h5";
  files::Writer writer(file.string());
  writer.attribute("/", "format", "chladni-sound");
  writer.attribute("/", "version", std::int64_t{1});
  writer.write("speed", 18.85, "rad/s");
  writer.write("frequency", 1672.5, "Hz");
  writer.write("tones/1/frequency", 1672.5, "Hz");
  writer.write("tones/1/power", 1e-3, "W");
  writer.write("microphones/names", std::vector<std::string>{"above", "plane"});
  writer.write("microphones/positions", Eigen::MatrixXd::Constant(2, 3, 0.5), "m");
  writer.write("microphones/pressure_re", Eigen::MatrixXd(Eigen::Vector2d(3.0, 0.0)), "Pa");
  writer.write("microphones/pressure_im", Eigen::MatrixXd(Eigen::Vector2d(4.0, 0.0)), "Pa");
  writer.write("microphones/levels", Eigen::MatrixXd::Constant(2, 3, 90.0), "dB");
  writer.write("microphones/around_axis", Eigen::MatrixXd::Constant(2, 2, 0.1), "Pa");
  writer.commit();
  return file;
}

struct SoundPage : testing::Test {
  SoundPage() { std::filesystem::create_directories(folder); }
  ~SoundPage() override { std::filesystem::remove_all(folder); }
  path folder = path(testing::TempDir()) / "sound_page_test";
};

TEST_F(SoundPage, ShowsTheAmplitudeOfEachToneAtEachMicrophone)
{
  const files::Reader reader(write_sound(folder).string());
  const std::string text = sound_page(reader, {folder / "disc.sound.wav", "above"}).text();
  EXPECT_NE(text.find(R"("name": "above")"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("pressure": [5])"), std::string::npos) << "|3 + 4i|: " << text;
  EXPECT_NE(text.find(R"("wav": null)"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("directivity": null)"), std::string::npos) << text;
}

TEST_F(SoundPage, HoldsTheWavFileWhereItIsSmall)
{
  const files::Reader reader(write_sound(folder).string());
  const path wav = folder / "disc.sound.wav";
  std::ofstream(wav) << "RIFF";
  EXPECT_NE(sound_page(reader, {wav, "above"}).text().find(R"("wav": "UklGRg==")"),
            std::string::npos);
  resize_file(wav, 5'000'000);
  const std::string text = sound_page(reader, {wav, "above"}).text();
  EXPECT_NE(text.find("disc.sound.wav has 5.0 MB and is not in this page"), std::string::npos);
  EXPECT_LT(text.size(), 10'000U);
}

TEST_F(SoundPage, RefusesAFileOfAnotherKind)
{
  const path file = folder / "other.h5";
  files::Writer writer(file.string());
  writer.attribute("/", "format", "chladni-body");
  writer.attribute("/", "version", std::int64_t{1});
  writer.commit();
  const files::Reader reader(file.string());
  EXPECT_THROW(sound_page(reader, {}), Error);
}

}  // namespace
}  // namespace chladni::report
