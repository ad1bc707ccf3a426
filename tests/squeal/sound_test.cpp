#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "common/error.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "squeal/transient/resampling.hpp"
#include "squeal/transient/spectrum.hpp"
#include "squeal/transient/wav.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

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

std::uint64_t number_64(const std::string& bytes, std::size_t at)
{
  return number(bytes, at, 4) + (std::uint64_t{number(bytes, at + 4, 4)} << 32U);
}

TEST(WavFile, BeyondFourGigabytesIsRF64)
{
  // The last file that 32 bits can hold, and one with a sample more.
  const std::size_t head = wav_header({.n_samples = 0, .rate_Hz = 48000, .full_scale = 3.0}).size();
  const std::int64_t most = ((1LL << 32) - 1 - static_cast<std::int64_t>(head) + 8) / 2;
  const std::string small = wav_header({.n_samples = most, .rate_Hz = 48000, .full_scale = 3.0});
  EXPECT_EQ(small.substr(0, 4), "RIFF");
  EXPECT_EQ(number(small, 4, 4), head - 8 + 2 * static_cast<std::uint64_t>(most));
  EXPECT_EQ(small.size(), head);

  const std::int64_t n = most + 1;
  const std::string large = wav_header({.n_samples = n, .rate_Hz = 48000, .full_scale = 3.0});
  EXPECT_EQ(large.substr(0, 4), "RF64");
  EXPECT_EQ(number(large, 4, 4), 0xFFFFFFFFU);
  EXPECT_EQ(large.substr(8, 8), "WAVEds64");  // the first chunk
  EXPECT_EQ(number(large, 16, 4), 28u);
  const auto n_bytes = 2 * static_cast<std::uint64_t>(n);
  EXPECT_EQ(number_64(large, 20), large.size() - 8 + n_bytes);
  EXPECT_EQ(number_64(large, 28), n_bytes);
  EXPECT_EQ(number_64(large, 36), static_cast<std::uint64_t>(n));
  EXPECT_EQ(number(large, 44, 4), 0u);
  EXPECT_EQ(large.substr(48, 4), "fmt ");
  const std::size_t data = large.find("data");
  EXPECT_EQ(number(large, data + 4, 4), 0xFFFFFFFFU);
  EXPECT_EQ(data + 8, large.size());
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
