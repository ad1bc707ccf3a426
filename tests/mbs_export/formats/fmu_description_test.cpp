#include "mbs_export/formats/fmu_archive.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "mbs_export/make_body.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/mbs_export/wheel.hpp"

namespace chladni::mbs_export::formats {
namespace {

std::uint32_t number_at(const std::string& bytes, std::size_t at, std::size_t n_bytes)
{
  std::uint32_t number = 0;
  for (std::size_t i = n_bytes; i-- > 0;) number = 256 * number + std::uint8_t(bytes.at(at + i));
  return number;
}

std::string inflated(const std::string& packed, std::size_t size)
{
  z_stream stream{};
  std::string bytes(size, '\0'), from = packed;
  inflateInit2(&stream, -MAX_WBITS);
  stream.next_in = reinterpret_cast<Bytef*>(from.data());
  stream.avail_in = static_cast<uInt>(from.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(size);
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  inflateEnd(&stream);
  return bytes;
}

/// The entries of a zip archive, found by its directory as the format has it: sections 4.3.16, its
/// end, 4.3.12, its entries, and 4.3.7, what stands before each.
std::map<std::string, std::string> unzipped(const std::string& archive)
{
  std::map<std::string, std::string> entries;
  const std::size_t end = archive.size() - 22;
  EXPECT_EQ(archive.substr(end, 4), "PK\5\6");
  const std::uint32_t n = number_at(archive, end + 10, 2);
  std::size_t at = number_at(archive, end + 16, 4);
  EXPECT_EQ(at + number_at(archive, end + 12, 4), end);
  for (std::uint32_t i = 0; i < n; ++i) {
    EXPECT_EQ(archive.substr(at, 4), "PK\1\2");
    EXPECT_EQ(number_at(archive, at + 10, 2), 8u);  // deflated
    const std::uint32_t crc = number_at(archive, at + 16, 4),
                        n_packed = number_at(archive, at + 20, 4),
                        size = number_at(archive, at + 24, 4),
                        n_name = number_at(archive, at + 28, 2),
                        offset = number_at(archive, at + 42, 4);
    const std::string name = archive.substr(at + 46, n_name);
    EXPECT_EQ(archive.substr(offset, 4), "PK\3\4");
    EXPECT_EQ(archive.substr(offset + 4, 26), archive.substr(at + 6, 26));  // told twice
    EXPECT_EQ(archive.substr(offset + 30, n_name), name);
    entries[name] = inflated(archive.substr(offset + 30 + n_name, n_packed), size);
    EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(entries[name].data()), size), crc) << name;
    at += 46 + n_name;
  }
  EXPECT_EQ(at, end);
  return entries;
}

TEST(FmuArchive, HasItsThreeFilesAndOneTokenOfTheExport)
{
  const files::test::ScratchFolder folder;
  const std::string library = "the library of this machine";
  std::ofstream(folder.file("chladni-fmu.so")) << library;
  const char* before = std::getenv("CHLADNI_FMU_LIBRARIES");
  const std::string kept = before == nullptr ? "" : before;
  setenv("CHLADNI_FMU_LIBRARIES", folder.path().c_str(), 1);
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 4;
  const ModalBody body = make_body(test::wheel(), options);
  options.keep.count = 8;
  const Fmu made = fmu(body, {.version = FmiVersion::v3, .identifier = "wheel"}),
            again = fmu(body, {.version = FmiVersion::v3, .identifier = "wheel"}),
            other = fmu(make_body(test::wheel(), options),
                        {.version = FmiVersion::v3, .identifier = "wheel"});
  kept.empty() ? unsetenv("CHLADNI_FMU_LIBRARIES")
               : setenv("CHLADNI_FMU_LIBRARIES", kept.c_str(), 1);
  EXPECT_EQ(made.archive, again.archive);
  const auto token_of = [&](const Fmu& one) {
    const std::map<std::string, std::string> files = unzipped(one.archive);
    EXPECT_EQ(files.size(), 3u);
    std::string model, description;
    for (const auto& [name, bytes] : files) {
      if (name == "modelDescription.xml") description = bytes;
      if (name == std::string("resources/") + chladni::fmu::model_file) model = bytes;
      if (name.ends_with("/wheel.so")) {
        EXPECT_EQ(bytes, library);
      }
    }
    const std::string token = chladni::fmu::unpacked(model).token;
    EXPECT_NE(description.find("instantiationToken=\"" + token + "\""), std::string::npos);
    return token;
  };
  EXPECT_EQ(token_of(made).size(), 16u);
  EXPECT_NE(token_of(made), token_of(other));
}

/// Texts of users are values of attributes: what XML reads as its own is written by its number, and
/// what no attribute may have is a blank.
TEST(FmuDescription, WritesAnyTextAsTheValueOfAnAttribute)
{
  const std::vector<FmuVariable> variables{
      {.name = "time", .description = "t", .kind = FmuVariable::Kind::independent, .unit = "s"},
      {.name = "hub.fx",
       .description = "a < b & \"c\"\nd > 0 \u00e4",
       .kind = FmuVariable::Kind::input,
       .unit = "N"}};
  const FmuDescription description{
      .name = "disc <1> & \"pad\"\t2", .identifier = "disc", .token = "t"};
  for (const FmiVersion version : {FmiVersion::v2, FmiVersion::v3}) {
    const std::string xml = fmu_description(variables, description, version);
    for (const char* text : {"\"disc &#60;1&#62; &#38; &#34;pad&#34; 2\"",
                             "\"a &#60; b &#38; &#34;c&#34; d &#62; 0 \u00e4\"", "\"hub.fx\""})
      EXPECT_NE(xml.find(text), std::string::npos) << text << " is not in " << xml;
  }
}

}  // namespace
}  // namespace chladni::mbs_export::formats
