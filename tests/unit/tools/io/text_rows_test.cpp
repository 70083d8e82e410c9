// SPDX-License-Identifier: Apache-2.0
#include "tools/io/text_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/tools/io/temp_folder.hpp"

namespace mapweld::io {
namespace {

using ::testing::HasSubstr;

TEST(TextRows, SkipsCommentsBlanksAndCarriageReturnsButCountsTheirLines) {
  const test::TempFolder folder;
  const TextRows file(folder.Put("a.txt", "\xEF\xBB\xBF# head\r\n\r\n1 2\r\n  3,\t4"));
  ASSERT_EQ(file.rows().size(), 2U);
  EXPECT_EQ(file.rows()[0].line, 3);
  EXPECT_EQ(file.rows()[1].line, 4);
  EXPECT_EQ(file.Number(file.rows()[1], 1), 4.0);
}

TEST(TextRows, NamesFileAndLineOfWhatIsNoFiniteNumber) {
  const test::TempFolder folder;
  const TextRows file(folder.Put("a.txt", "1\nnan\n1.5x\n1e999\n"));
  EXPECT_EQ(file.Number(file.rows()[0], 0), 1.0);
  for (const std::size_t row : {1U, 2U, 3U}) {
    EXPECT_THAT(test::ErrorOf([&] { (void)file.Number(file.rows()[row], 0); }),
                HasSubstr("a.txt:" + std::to_string(row + 1) + ": "));
  }
}

TEST(TextRows, SaysThatAFileIsMissing) {
  EXPECT_THAT(test::ErrorOf([] { const TextRows file("/no/such/file.txt"); }),
              HasSubstr("cannot read /no/such/file.txt"));
}

TEST(Seconds, KeepEveryNanosecondAlsoSince1970) {
  TimeNs t;
  ASSERT_TRUE(ParseSeconds("1673400472.138016708", &t));
  EXPECT_EQ(t.ns, 1673400472138016708);
  EXPECT_EQ(FormatSeconds(t), "1673400472.138016708");
  ASSERT_TRUE(ParseSeconds("1326030975.736588", &t));
  EXPECT_EQ(t.ns, 1326030975736588000);
}

TEST(Seconds, ReadEveryWayOfWritingThem) {
  TimeNs t;
  ASSERT_TRUE(ParseSeconds("1.036224e-01", &t));
  EXPECT_EQ(t.ns, 103622400);
  ASSERT_TRUE(ParseSeconds("-0.5", &t));
  EXPECT_EQ(t.ns, -500000000);
  EXPECT_EQ(FormatSeconds(t), "-0.500000000");
  ASSERT_TRUE(ParseSeconds("7", &t));
  EXPECT_EQ(t.ns, 7000000000);
  ASSERT_TRUE(ParseSeconds("0.00000000051", &t));  // rounds at the tenth decimal
  EXPECT_EQ(t.ns, 1);
}

TEST(Seconds, RefuseWhatIsNoneOrDoesNotFit) {
  TimeNs t;
  for (const char* word : {"", "x", "1.2.3", "nan", "inf", "1e300", "99999999999"}) {
    EXPECT_FALSE(ParseSeconds(word, &t)) << word;
  }
  EXPECT_EQ(FormatSeconds({std::numeric_limits<std::int64_t>::min()}), "-9223372036.854775808");
}

}  // namespace
}  // namespace mapweld::io
