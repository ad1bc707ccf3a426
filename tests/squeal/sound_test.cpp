#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/error.hpp"
#include "squeal/transient/resampling.hpp"
#include "squeal/transient/spectrum.hpp"
#include "squeal/transient/wav.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using files::test::ScratchFolder, files::test::bytes_of, files::test::error_of;

TEST(Spectrum, FindsFrequencyAndAmplitudeBetweenTheLines)
{
  std::vector<double> x;
  const double step = 1.0 / 44100.0;
  for (int i = 0; i < 4410; ++i) {
    const double t = i * step;
    x.push_back(3.0 * std::sin(2.0 * pi * 1696.853 * t + 0.3) +
                0.01 * std::cos(2.0 * pi * 5090.4 * t) + 0.5);
  }
  const Spectrum result = spectrum(x, step);
  ASSERT_GE(result.peaks.size(), 2u);
  // Lines are 10 Hz apart; the side lobes of other lines disturb by 1e-4 of a line.
  EXPECT_NEAR(result.peaks[0].frequency_Hz, 1696.853, 0.01);
  EXPECT_NEAR(result.peaks[0].amplitude, 3.0, 3e-3);
  EXPECT_NEAR(result.peaks[1].frequency_Hz, 5090.4, 0.1);
  EXPECT_NEAR(result.peaks[1].amplitude, 0.01, 3e-4);
  EXPECT_THROW(spectrum(std::vector<double>(10, 0.0), step), Error);
}

/// A sine of this frequency and of amplitude 1 through a resampler from 70 kHz to 44.1 kHz.
std::vector<float> resampled_sine(double f_Hz)
{
  Resampler resampler(1.0 / 70000.0, 44100);
  for (int i = 0; i < 7000; ++i) resampler.add(std::sin(2.0 * pi * f_Hz * (i + 0.5) / 70000.0));
  resampler.finish();
  return resampler.take();
}

TEST(Resampler, KeepsWhatTheNewRateCanHoldAndDropsTheRest)
{
  const std::vector<float> low = resampled_sine(1700.0), high = resampled_sine(30000.0);
  ASSERT_EQ(low.size(), 4410u);
  // Away from both ends: ripple of the Blackman window 2e-4; 30 kHz would fold down to 14.1 kHz.
  for (std::size_t i = 100; i + 100 < low.size(); ++i) {
    EXPECT_NEAR(low[i], std::sin(2.0 * pi * 1700.0 * double(i) / 44100.0), 5e-4) << i;
    EXPECT_NEAR(high[i], 0.0, 5e-4) << i;
  }
}

std::uint32_t number(const std::string& bytes, std::size_t at, int n)
{
  std::uint32_t x = 0;
  for (int i = n - 1; i >= 0; --i) x = 256 * x + static_cast<unsigned char>(bytes[at + i]);
  return x;
}

TEST(WavFile, HoldsTheSamplesAndWhatFullScaleMeans)
{
  const auto path = std::filesystem::temp_directory_path() /
                    ("analyses_test-" + std::to_string(getpid()) + ".wav");
  const std::vector<float> x{0.0F, 1.5F, -3.0F, 0.75F};
  EXPECT_EQ(write_wav(path, x, 48000), 3.0);
  std::stringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  std::filesystem::remove(path);
  const std::string bytes = content.str();
  EXPECT_EQ(bytes.substr(0, 4) + bytes.substr(8, 8), "RIFFWAVEfmt ");
  EXPECT_EQ(number(bytes, 4, 4), bytes.size() - 8);
  EXPECT_EQ(number(bytes, 20, 2), 1u);
  EXPECT_EQ(number(bytes, 24, 4), 48000u);
  EXPECT_NE(bytes.find("full scale = 3 m/s"), std::string::npos);
  const std::size_t data = bytes.find("data");
  ASSERT_EQ(number(bytes, data + 4, 4), 8u);
  const int expected[] = {0, 16384, -32767, 8192};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(static_cast<std::int16_t>(number(bytes, data + 8 + 2 * i, 2)), expected[i]);
  EXPECT_THROW(write_wav("/nowhere/at/all.wav", x, 48000), Error);
}

TEST(WavFile, BeyondFourGigabytesIsRefused)
{
  // The last file that 32 bits can hold, and one with a sample more.
  const WavFormat most{.n_samples = wav_samples_max, .rate_Hz = 48000, .full_scale = 3.0};
  const std::string head = wav_header(most);
  EXPECT_EQ(number(head, 4, 4), head.size() - 8 + 2 * static_cast<std::uint64_t>(most.n_samples));
  const std::string error = error_of(
      [] { wav_header({.n_samples = wav_samples_max + 1, .rate_Hz = 48000, .full_scale = 3.0}); });
  EXPECT_EQ(error, "a WAV file holds up to 4 GiB, 44739 s at 48000 Hz, and the sound has 44739 s");
}

TEST(WavRecording, IsTheFileOfAllItsSamples)
{
  const ScratchFolder folder;
  std::vector<float> x(300000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::sin(0.1F * float(i)) * float(i);
  write_wav(folder.file("whole.wav"), x, 48000);
  {
    WavRecording sound(folder.file("a.wav"), 48000);
    for (std::size_t i = 0; i < x.size(); i += 1000)
      sound.add({x.begin() + std::ptrdiff_t(i), x.begin() + std::ptrdiff_t(i) + 1000});
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.wav")));
    sound.finish();
    EXPECT_NEAR(sound.full_scale().value_or(0.0), 3e5,
                500.0);  // samples of a sine are up to 0.05 from its peak
    WavRecording silence(folder.file("silence.wav"), 48000);
    silence.finish();
    EXPECT_EQ(silence.full_scale(), 1.0);
    WavRecording unfinished(folder.file("whole.wav"), 48000);
    unfinished.add(x);
  }
  EXPECT_TRUE(bytes_of(folder.file("a.wav")) == bytes_of(folder.file("whole.wav")));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3);
}

TEST(WavFile, FollowsNoLinkThatWaitsUnderATemporaryName)
{
  const auto folder =
      std::filesystem::temp_directory_path() / ("wav_file_test-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::filesystem::create_symlink(folder / "victim", folder / "disc.wav.tmp");
  write_wav(folder / "disc.wav", std::vector<float>{1.0F}, 48000);
  EXPECT_FALSE(std::filesystem::exists(folder / "victim"));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder / "disc.wav"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace chladni::squeal
