// Files that are cut short, damaged, from the future, or whose writer is killed.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <thread>

#include "common/files/seal.hpp"
#include "hard_case.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/make_body.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/study/study.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/mbs_export/bending_beam.hpp"
#include "tests/mbs_export/wheel.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::hard_cases {
namespace {

using namespace mbs_export;
using files::test::ScratchFolder, files::test::bytes_of;

ModalBody wheel_body(int n_modes)
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = n_modes;
  return make_body(test::wheel(), options);
}

void put_bytes(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary) << bytes;
}

/// The bytes of a body file.
std::string body_bytes()
{
  const ScratchFolder folder;
  write_body(folder.file("sound.h5"), wheel_body(12));
  return bytes_of(folder.file("sound.h5"));
}

/// As the first releases wrote it: libhdf5 sees the damage.
std::string body_bytes_without_seal()
{
  return body_bytes().substr(files::seal_size);
}

struct Ends {
  double read = 0.0;        ///< as if nothing had happened
  double unexpected = 0.0;  ///< neither read nor refused with a chladni::Error
};

/// How the reading of n damaged copies ends. (A crash would end the program.)
template <class Damage>
Ends ends_of(int n, const std::string& sound, Damage damage)
{
  const ScratchFolder folder;
  Ends ends;
  for (int i = 0; i < n; ++i) {
    std::string bytes = sound;
    damage(bytes, i);
    put_bytes(folder.file("damaged.h5"), bytes);
    try {
      read_body(folder.file("damaged.h5"));
      ++ends.read;
    } catch (const Error&) {
    } catch (...) {
      ++ends.unexpected;
    }
  }
  return ends;
}

Ends ends_of_cut_files(const std::string& sound)
{
  return ends_of(300, sound, [](std::string& bytes, int i) {
    bytes.resize(bytes.size() * static_cast<std::size_t>(i) / 300);
  });
}

Ends ends_of_flipped_files(const std::string& sound)
{
  std::mt19937 generator(2);
  return ends_of(2000, sound, [&](std::string& bytes, int) {
    bytes[generator() % bytes.size()] ^= static_cast<char>(1u << (generator() % 8));
  });
}

/// Two contents that a file may have: how each is written, and which of them, 0 or 1, is read;
/// another number, or an error, for a file that is neither.
struct Contents {
  std::function<void(const std::string& path, int which)> write;
  std::function<int(const std::string& path)> read;
};

/// Kills a writer that writes both in turn, at random moments, later and later where a busy machine
/// lets it finish neither; how often the file is neither, and one more for each content that was
/// never found.
double half_files(int n_kills, const Contents& contents)
{
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  contents.write(path, 0);
  std::mt19937 generator(1);
  std::uniform_int_distribution<int> microseconds(5000, 25000);
  double half = 0.0;
  std::set<int> found;
  for (int i = 0; i < n_kills || (i < 4 * n_kills && found.size() < 2); ++i) {
    const pid_t writer = fork();
    if (writer == 0)
      for (int which = i % 2;; which = 1 - which) contents.write(path, which);
    std::this_thread::sleep_for((1 + i / n_kills) *
                                std::chrono::microseconds(microseconds(generator)));
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    try {
      const int which = contents.read(path);
      half += which != 0 && which != 1;
      found.insert(which);
    } catch (const Error&) {
      ++half;
    }
  }
  return half + double(!found.contains(0)) + double(!found.contains(1));
}

/// Bodies of 6 and 60 modes.
Contents bodies()
{
  const std::vector<ModalBody> both{wheel_body(6), wheel_body(60)};
  return {
      [both](const std::string& path, int which) { write_body(path, both[std::size_t(which)]); },
      [](const std::string& path) {
        const auto n = read_body(path).n_modes();
        return n == 6 ? 0 : n == 60 ? 1 : -1;
      }};
}

/// The wheel and the beam.
Contents reduced_systems()
{
  const std::vector<ReducedSystem> both{test::wheel(), test::regression_beam()};
  return {
      [both](const std::string& path, int which) { write_reduced(path, both[std::size_t(which)]); },
      [sizes = std::pair{both[0].K.rows(), both[1].K.rows()}](const std::string& path) {
        const auto n = read_reduced(path).K.rows();
        return n == sizes.first ? 0 : n == sizes.second ? 1 : -1;
      }};
}

/// Eigenvalues at 5 and at 50 speeds.
Contents squeal_results()
{
  std::vector<squeal::SquealResults> both;
  for (const int n_speeds : {5, 50}) {
    squeal::SquealOptions options = squeal::test::reference_options();
    options.study.speeds.count = n_speeds;
    options.study.analyses = {"eigenvalues"};
    both.push_back(
        run(squeal::FlexibleDisc(squeal::test::disc_of({squeal::test::kirchhoff_3()}), options),
            options.study));
  }
  return {[both](const std::string& path, int which) {
            squeal::write_results(path, both[std::size_t(which)], {});
          },
          [](const std::string& path) {
            const auto n = squeal::read_results(path).eigenvalues->speeds.size();
            return n == 5 ? 0 : n == 50 ? 1 : -1;
          }};
}

}  // namespace

std::vector<HardCase> file_cases()
{
  const std::string area = "files", read = "files not refused",
                    unexpected = "files neither read nor refused",
                    half = "files neither old nor new, or never old or never new";
  return {
      {area, "body file cut at 300 places", "lengths and offsets point beyond its end", read, 0.0,
       [] {
         const Ends ends = ends_of_cut_files(body_bytes());
         return ends.read + ends.unexpected;
       }},
      {area, "body file with 2000 flipped bits, one at a time",
       "most of them in numbers that stay numbers", read, 0.0,
       [] {
         const Ends ends = ends_of_flipped_files(body_bytes());
         return ends.read + ends.unexpected;
       }},
      {area, "the same 300 without seal", "lengths and offsets point beyond its end", unexpected,
       0.0, [] { return ends_of_cut_files(body_bytes_without_seal()).unexpected; }},
      {area, "the same 2000 without seal", "sizes that overflow, types and shapes that do not fit",
       unexpected, 0.0, [] { return ends_of_flipped_files(body_bytes_without_seal()).unexpected; }},
      {area, "writer of bodies killed 200 times at random moments", "a file may be half written",
       half, 0.0, [] { return half_files(200, bodies()); }},
      {area, "writer of reduced systems killed 200 times", "the same", half, 0.0,
       [] { return half_files(200, reduced_systems()); }},
      {area, "writer of squeal's results killed 200 times", "the same", half, 0.0,
       [] { return half_files(200, squeal_results()); }},
      {area, "body with NaN", "poisons every later result in silence",
       "words missing in the refusal", 0.0,
       [] {
         const ScratchFolder folder;
         ModalBody body = wheel_body(12);
         body.attachment_modes(3, 3) = std::nan("");
         write_body(folder.file("nan.h5"), body);
         return words_missing([&] { read_body(folder.file("nan.h5")); },
                              {"nan.h5", "attachment_displacements", "finite"});
       }},
      {area, "text file with the name of a body", "not HDF5 at all", "words missing in the refusal",
       0.0,
       [] {
         const ScratchFolder folder;
         put_bytes(folder.file("text.body.h5"), "GRID,1,,0.,0.,0.\n");
         return words_missing([&] { read_body(folder.file("text.body.h5")); }, {"text.body.h5"});
       }},
  };
}

}  // namespace chladni::hard_cases
