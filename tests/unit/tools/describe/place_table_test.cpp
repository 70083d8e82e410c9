// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/place_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::describe {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<PlaceRow> SomeRows() {
  std::vector<PlaceRow> rows(3);
  for (int i = 0; i < 3; ++i) {
    PlaceRow& row = rows[static_cast<std::size_t>(i)];
    row.scan = 7 * i;
    row.position = {1.5 * i, -2.25, 0.125};
    row.place.descriptor.scale = 0.003F;
    row.place.descriptor.q[0] = -128;
    row.place.descriptor.q[1023] = static_cast<std::int8_t>(i);
    row.place.orientation.q[191] = 127;
  }
  return rows;
}

TEST(PlaceTable, ComesBackAsItWasWritten) {
  const test::TempFolder folder;
  WritePlaceTable(folder / "places.csv", SomeRows());
  const std::vector<PlaceRow> rows = ReadPlaceTable(folder / "places.csv");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[2].scan, 14);
  EXPECT_EQ(rows[2].position, SomeRows()[2].position);
  EXPECT_EQ(rows[2].place.descriptor.q, SomeRows()[2].place.descriptor.q);
  EXPECT_EQ(rows[2].place.descriptor.scale, 0.003F);
  EXPECT_EQ(rows[2].place.orientation.q, SomeRows()[2].place.orientation.q);
}

TEST(PlaceTable, HasTheHeaderThatOthersRead) {
  const test::TempFolder folder;
  WritePlaceTable(folder / "places.csv", SomeRows());
  const std::string text = io::ReadFile(folder / "places.csv");
  EXPECT_THAT(text, StartsWith("scan,x,y,z,scale,d0,d1,d2,"));
  EXPECT_THAT(text, HasSubstr(",d1023,o0,o1,"));
  EXPECT_THAT(text, HasSubstr(",o191\n0,0.0000,-2.2500,0.1250,0.003,-128,0,"));
}

TEST(PlaceTable, RefusesWhatIsNoTableWithFileAndLine) {
  const test::TempFolder folder;
  WritePlaceTable(folder / "places.csv", SomeRows());
  const std::string good = io::ReadFile(folder / "places.csv");
  const std::string header = good.substr(0, good.find('\n') + 1);
  const auto error_of = [&](const std::string& text) {
    const auto file = folder.Put("bad.csv", text);
    return test::ErrorOf([&] { ReadPlaceTable(file); });
  };
  EXPECT_THAT(error_of(""), HasSubstr("bad.csv does not begin with 'scan,x,y,z,scale"));
  EXPECT_THAT(error_of("a,b,c\n1,2,3\n"), HasSubstr("does not begin with"));
  EXPECT_THAT(error_of(header), HasSubstr("bad.csv has a header but no rows"));
  EXPECT_THAT(error_of(good + "5,0,0,0,0.1,1\n"), HasSubstr("bad.csv:5"));
  std::string huge = good;
  huge.replace(huge.find("-128"), 4, "-129");
  EXPECT_THAT(error_of(huge), HasSubstr("'-129' in column 6 is not an integer from -128 to 127"));
  std::string nan = good;
  nan.replace(nan.find("-2.2500"), 7, "nan");
  EXPECT_THAT(error_of(nan), HasSubstr("bad.csv:2"));
}

TEST(PlaceTable, IsReadOrRefusedWhereverItIsCutOff) {
  const test::TempFolder folder;
  WritePlaceTable(folder / "places.csv", SomeRows());
  const std::string good = io::ReadFile(folder / "places.csv");
  for (std::size_t size = 0; size < good.size(); size += 61) {
    const auto file = folder.Put("cut.csv", good.substr(0, size));
    std::size_t rows = 0;
    const std::string error = test::ErrorOf([&] { rows = ReadPlaceTable(file).size(); });
    EXPECT_TRUE(!error.empty() || rows > 0) << size;
  }
}

}  // namespace
}  // namespace mapweld::describe
