#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace chladni::squeal {

/// A mono WAV file of 16-bit samples, the largest of which is full scale. What full scale means
/// stands in it as a comment (chunk LIST, INFO, ICMT): "full scale = 6.73 m/s".
/// @return full scale, the largest |x|; 1 for silence
/// @throws chladni::Error when the file cannot be written; an old one is left as it was.
double write_wav(const std::filesystem::path& path, std::span<const float> x, int rate_Hz,
                 const std::string& unit = "m/s");

}  // namespace chladni::squeal
