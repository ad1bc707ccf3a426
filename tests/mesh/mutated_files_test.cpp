// Mesh files with a few words or bytes changed, by Gmsh's readers of each format: refused, or a
// mesh.
#include <gmsh.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::add_rectangle;
using testing::error_of;
using testing::MeshFile;

constexpr int n_of_each_format = 25;
constexpr double most_seconds = 10.0;  // two hundred times what the whole files take

class MutatedFile : public MeshFile {
 protected:
  static std::string bytes_of(const std::string& path)
  {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::string plate(double version, int binary) const
  {
    return bytes_of(save("golden.msh", [=] {
      add_rectangle(0, 6, "plate");
      gmsh::model::mesh::generate(2);
      gmsh::model::mesh::setOrder(2);
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
      gmsh::option::setNumber("Mesh.Binary", binary);
    }));
  }

  /// Each mutation of the file ends in a mesh or in one error that names it.
  /// @param trust  of the owner: read in this process, which what we wrote must not end
  void expect_sentences(const std::string& name, const std::string& golden,
                        std::string (*mutated)(std::string, std::mt19937&),
                        Trust trust = Trust::stranger) const
  {
    std::mt19937 dice(1);
    for (int i = 0; i < n_of_each_format; ++i) {
      const std::string error = error_of({.file = write(name, mutated(golden, dice)),
                                          .trust = trust,
                                          .most_seconds = most_seconds});
      EXPECT_TRUE(error == "no error" || error.find(name) != std::string::npos) << error;
      RecordProperty(name + std::to_string(i), error);
    }
  }
};

/// Another number in the place of one or two, behind the header.
std::string with_other_numbers(std::string text, std::mt19937& dice)
{
  const std::vector<std::string> numbers{"-1", "0", "1", "7", "99999999", "4294967297", "1e308"};
  for (unsigned n = 1 + dice() % 2; n > 0; --n) {
    std::size_t at = 0;
    while (at < 40) at = text.find_first_of("0123456789", dice() % (text.size() - 20));
    const std::size_t end = text.find_first_not_of("0123456789.eE+-", at);
    text.replace(at, end - at, numbers[dice() % numbers.size()]);
  }
  return text;
}

std::string with_other_bytes(std::string bytes, std::mt19937& dice)
{
  for (unsigned n = 1 + dice() % 4; n > 0; --n)
    bytes[60 + dice() % (bytes.size() - 60)] = static_cast<char>(dice());
  return bytes;
}

TEST_F(MutatedFile, OfVersion22EndsInASentence)
{
  expect_sentences("a.msh", plate(2.2, 0), with_other_numbers);
}

TEST_F(MutatedFile, OfVersion41EndsInASentence)
{
  expect_sentences("b.msh", plate(4.1, 0), with_other_numbers);
}

TEST_F(MutatedFile, OfVersion41BinaryEndsInASentence)
{
  expect_sentences("c.msh", plate(4.1, 1), with_other_bytes);
}

TEST_F(MutatedFile, OfStepEndsInASentence)
{
  const std::string golden = bytes_of(save("golden.step", [] {
    gmsh::model::occ::addDisk(0, 0, 0, 100, 100);
    gmsh::model::occ::synchronize();
  }));
  expect_sentences("d.step", golden, with_other_numbers);
}

TEST_F(MutatedFile, OfAbaqusEndsInASentence)
{
  const std::string golden = bytes_of(CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/deck/plate.inp");
  expect_sentences("g.inp", golden, with_other_numbers, Trust::owner);
  expect_sentences("h.inp", golden, with_other_bytes, Trust::owner);
}

TEST_F(MutatedFile, OfAUniversalFileEndsInASentence)
{
  const std::string golden = bytes_of(CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/exchange/plate.unv");
  expect_sentences("i.unv", golden, with_other_numbers, Trust::owner);
  expect_sentences("j.unv", golden, with_other_bytes, Trust::owner);
}

TEST_F(MutatedFile, OfMedEndsInASentence)
{
  const std::string golden = bytes_of(CHLADNI_SOURCE_DIR "/tests/data/three_by_two.med");
  expect_sentences("m.med", golden, with_other_bytes);
}

TEST_F(MutatedFile, OfNastranEndsInASentence)
{
  const std::string golden = bytes_of(CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/deck/plate.bdf");
  expect_sentences("e.bdf", golden, with_other_numbers, Trust::owner);
  expect_sentences("f.bdf", golden, with_other_bytes, Trust::owner);
}

TEST_F(MutatedFile, OfSolidsEndsInASentence)
{
  const std::string corpus = CHLADNI_SOURCE_DIR "/tests/fuzz/corpus/";
  for (const char* name :
       {"deck/block.cdb", "deck/solids.bdf", "deck/solids.inp", "exchange/solids.unv"}) {
    const std::string file = name, extension = file.substr(file.size() - 4);
    const std::string golden = bytes_of(corpus + file);
    expect_sentences("k" + extension, golden, with_other_numbers, Trust::owner);
    expect_sentences("l" + extension, golden, with_other_bytes, Trust::owner);
  }
}

}  // namespace
}  // namespace chladni::mesh
