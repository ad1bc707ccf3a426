// Files of version 1 stay readable for ever, down to the last bit.
#include "version_1.hpp"

#include <gtest/gtest.h>

#include "expect_equal.hpp"
#include "mbs_export/files/body_files.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::mbs_export {
namespace {

using test::expect_equal;

TEST(Version1, OfAReducedSystemIsReadBitByBit)
{
  const ReducedSystem a = test::version_1_reduced();
  const ReducedSystem b = read_reduced(CHLADNI_SOURCE_DIR "/tests/data/version_1.reduced.h5");
  ASSERT_EQ(b.attachment_nodes.size(), 2u);
  expect_equal(a, b);
}

TEST(Version1, OfABodyIsReadBitByBit)
{
  const ModalBody a = test::version_1_body();
  const ModalBody b = read_body(CHLADNI_SOURCE_DIR "/tests/data/version_1.body.h5");
  ASSERT_EQ(b.attachment_nodes.size(), 3u);
  expect_equal(a, b);
}

TEST(Version1, IsWhatIsStillWritten)
{
  const files::test::ScratchFolder folder;
  write_reduced(folder.file("a.reduced.h5"), test::version_1_reduced());
  expect_equal(read_reduced(folder.file("a.reduced.h5")), test::version_1_reduced());
  write_body(folder.file("a.body.h5"), test::version_1_body());
  expect_equal(read_body(folder.file("a.body.h5")), test::version_1_body());
}

}  // namespace
}  // namespace chladni::mbs_export
