// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace mapweld::report {
namespace {

TEST(HtmlText, EscapesWhatHtmlWouldRead) {
  EXPECT_EQ(EscapeHtml("<b> & \"x\"\n"), "&lt;b&gt; &amp; &quot;x&quot; ");
}

TEST(HtmlText, KeepsUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(EscapeHtml("Z\xC3\xBCrich \xE2\x82\xAC \xF0\x9F\x9A\x97"), "Z\xC3\xBCrich \xE2\x82\xAC \xF0\x9F\x9A\x97");
  EXPECT_EQ(EscapeHtml("caf\xE9!"), "caf\xEF\xBF\xBD!");
  EXPECT_EQ(EscapeHtml("\xE2\x82"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(EscapeHtml("\xE2<a"), "\xEF\xBF\xBD&lt;a") << "a cut character must not swallow the bracket behind it";
}

TEST(HtmlText, GroupsDigits) {
  EXPECT_EQ(Count(0), "0");
  EXPECT_EQ(Count(999), "999");
  EXPECT_EQ(Count(1000),
            "1\xE2\x80\xAF"
            "000");
  EXPECT_EQ(Count(1234567),
            "1\xE2\x80\xAF"
            "234\xE2\x80\xAF"
            "567");
}

TEST(HtmlText, ChoosesUnitsThatReadWell) {
  EXPECT_EQ(Length(0.123), "12 cm");
  EXPECT_EQ(Length(0.999), "1.0 m");
  EXPECT_EQ(Length(1.25), "1.2 m");
  EXPECT_EQ(Length(845.4), "845 m");
  EXPECT_EQ(Length(999.7), "1.0 km");
  EXPECT_EQ(Length(12345), "12.3 km");
  EXPECT_EQ(Length(123456), "123 km");
  EXPECT_EQ(Length(NAN), "\xE2\x80\x93");
  EXPECT_EQ(Bytes(0), "0 B");
  EXPECT_EQ(Bytes(999), "999 B");
  EXPECT_EQ(Bytes(999.9), "1.00 kB");
  EXPECT_EQ(Bytes(1234567), "1.23 MB");
  EXPECT_EQ(Bytes(45.6e9), "45.6 GB");
  EXPECT_EQ(Duration(0.4249), "0.42 s");
  EXPECT_EQ(Duration(12.84), "12.8 s");
  EXPECT_EQ(Duration(185), "3 min 05 s");
  EXPECT_EQ(Duration(3720), "1 h 02 min");
}

TEST(HtmlText, SpeaksEnglish) {
  EXPECT_EQ(Plural(1, "drive"), "1 drive");
  EXPECT_EQ(Plural(3, "drive"), "3 drives");
  EXPECT_EQ(Enumerate(std::vector<std::string>{"a"}), "a");
  EXPECT_EQ(Enumerate(std::vector<std::string>{"a", "b", "c"}), "a, b and c");
}

}  // namespace
}  // namespace mapweld::report
