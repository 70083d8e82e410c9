// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/osm_town.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/house_clearance.hpp"

namespace mapweld::sim {
namespace {

using testing::HasSubstr;

const LocalFrame kFrame({50.0, 11.5});

TEST(OsmTown, ReadsTheWholeDemoExtract) {
  const Town town = ReadOsmTown(DataFolder() / "north-bayreuth.osm.gz", kFrame);
  EXPECT_GT(town.buildings.size(), 4200U);  // of 4269 building ways; some are open or tiny
  EXPECT_LE(town.buildings.size(), 4269U);
  EXPECT_GT(town.roads.size(), 600U);
  EXPECT_EQ(town.trees.size(), 20U);
  for (const Building& building : town.buildings) {
    ASSERT_GT(SignedArea(building.footprint), 0) << building.id;
    ASSERT_GE(building.height_m, 2) << building.id;
    ASSERT_LE(building.height_m, 60) << building.id;
  }
  for (const Road& road : town.roads) ASSERT_EQ(road.nodes.size(), road.line.size());
}

TEST(OsmTown, PutsPointsWhereTheyAreOnEarth) {
  // One minute of latitude is a nautical mile; at 50 degrees, one of longitude is about cos 50 of it.
  EXPECT_NEAR(kFrame.ToLocal({50.0 + 1.0 / 60, 11.5}).y(), 1852, 3);
  EXPECT_NEAR(kFrame.ToLocal({50.0, 11.5 + 1.0 / 60}).x(), 1855.3 * 0.64279 * 1.00197, 2);
  const GeoPoint back = kFrame.ToGeo(kFrame.ToLocal({50.01, 11.49}));
  EXPECT_NEAR(back.lat_deg, 50.01, 1e-12);
  EXPECT_NEAR(back.lon_deg, 11.49, 1e-12);
}

constexpr const char* kHead = "<?xml version='1.0'?><osm version='0.6'>";
constexpr const char* kNodes =
    "<node id='1' lat='50.0' lon='11.5'/><node id='2' lat='50.001' lon='11.5'/><node id='3' lat='50.001' "
    "lon='11.501'/>";

TEST(OsmTown, ReadsWaysThatComeBeforeTheirNodes) {
  const TestFolder folder;
  WriteText(folder / "t.osm", std::string(kHead) +
                                  "<way id='9'><nd ref='1'/><nd ref='2'/><tag k='highway' v='residential'/></way>"
                                  "<way id='8'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='1'/>"
                                  "<tag k='building' v='yes'/><tag k='building:levels' v='4'/></way>" +
                                  kNodes + "</osm>");
  const Town town = ReadOsmTown(folder / "t.osm", kFrame);
  ASSERT_EQ(town.buildings.size(), 1U);
  EXPECT_EQ(town.buildings[0].footprint.size(), 3U);
  EXPECT_EQ(town.buildings[0].height_m, 13);
  ASSERT_EQ(town.roads.size(), 1U);
  EXPECT_NEAR(Length(town.roads[0].line), 111.2, 0.2);
}

TEST(HouseClearance, MovesAHouseOffTheStreetAndLeavesOthersAlone) {
  Town town;
  town.roads.push_back({1, {1, 2}, {{0, 0}, {100, 0}}, 3, true});
  const Polyline square{{0, 0}, {10, 0}, {10, 8}, {0, 8}};
  const auto at = [&](double x, double y) {
    Polyline house = square;
    for (Vec2d& p : house) p += Vec2d(x, y);
    town.buildings.push_back({static_cast<std::int64_t>(town.buildings.size()), house, 6});
  };
  at(20, 2.1);    // a metre and a half too close
  at(40, 4);      // free
  at(60, -4);     // an archway
  at(102, -2.5);  // behind the street's end, too close
  MoveHousesOffStreets(town);
  EXPECT_NEAR(town.buildings[0].footprint[0].y(), 3.6, 1e-9);
  EXPECT_NEAR(town.buildings[0].footprint[0].x(), 20, 1e-9);
  EXPECT_EQ(town.buildings[1].footprint[0], Vec2d(40, 4));
  EXPECT_EQ(town.buildings[2].footprint[0], Vec2d(60, -4));
  EXPECT_NEAR(town.buildings[3].footprint[0].x(), 103.6, 1e-9);
}

TEST(OsmTown, NamesTheFileWhenItIsMissing) {
  EXPECT_THAT(MessageOf([] { (void)ReadOsmTown("nowhere.osm.gz", kFrame); }),
              testing::AllOf(HasSubstr("nowhere.osm.gz"), HasSubstr("does not exist")));
}

TEST(OsmTown, NamesTheFileWhenItIsDamaged) {
  const TestFolder folder;
  const std::string whole = ReadText(DataFolder() / "north-bayreuth.osm.gz");
  WriteText(folder / "cut.osm.gz", whole.substr(0, whole.size() / 2));
  WriteText(folder / "noise.osm.gz", "this is no gzip");
  WriteText(folder / "cut.osm", std::string(kHead) + "<node id='1' lat='50.0'");
  WriteText(folder / "other.xml.osm", "<html></html>");
  for (const char* name : {"cut.osm.gz", "noise.osm.gz", "cut.osm", "other.xml.osm"}) {
    const std::string message = MessageOf([&] { (void)ReadOsmTown(folder / name, kFrame); });
    EXPECT_THAT(message, testing::AllOf(HasSubstr(name), HasSubstr("damaged"))) << name;
  }
}

TEST(OsmTown, SaysWhatAnEmptyExtractLacks) {
  const TestFolder folder;
  WriteText(folder / "empty.osm", std::string(kHead) + kNodes + "</osm>");
  EXPECT_THAT(MessageOf([&] { (void)ReadOsmTown(folder / "empty.osm", kFrame); }),
              HasSubstr("0 buildings and 0 roads"));
}

TEST(BuildingHeight, PrefersTagsAndRefusesNonsense) {
  EXPECT_EQ(BuildingHeight_m("12.5", "2", 100, 1), 12.5);
  EXPECT_EQ(BuildingHeight_m("12 m", "", 100, 1), 12);
  EXPECT_EQ(BuildingHeight_m("low", "2", 100, 1), 7);
  const double invented = BuildingHeight_m("low", "", 100, 1);
  EXPECT_GE(invented, 5.5);
  EXPECT_EQ(BuildingHeight_m("-3", "1e9", 100, 1), invented);
  EXPECT_NE(BuildingHeight_m("", "", 100, 2), invented);
}

}  // namespace
}  // namespace mapweld::sim
