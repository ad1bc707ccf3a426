#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "common/files/hdf5_objects.hpp"
#include "scratch_folder.hpp"

/// Files that are made to deceive.
namespace chladni::files::test {

enum class Sealed { not_at_all, inside };
inline constexpr std::array all_seals{Sealed::not_at_all, Sealed::inside};

inline constexpr std::size_t MiB = std::size_t{1} << 20;

bool contains(const std::string& text, const std::string& part);

/// A file of HDF5 that `fill` makes, and its seal, as whoever knows the format can write it.
void make_file(const std::string& path, Sealed sealed, const std::function<void(hid_t file)>& fill);

Handle dataset_properties();

/// An empty dataset "x" of n doubles, made with these properties.
Handle make_x(hid_t file, hsize_t n, const Handle& creation);

/// Expects `part` in what reading "x" says of a file that `fill` makes, for each kind of seal, and
/// that it cannot be sealed.
void expect_refusal(const ScratchFolder& folder, const std::string& part,
                    const std::function<void(hid_t file)>& fill);

}  // namespace chladni::files::test
