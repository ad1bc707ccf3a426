#include "mbs_export/formats/fmu_archive.hpp"

#include <gtest/gtest.h>

namespace chladni::mbs_export::formats {
namespace {

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
