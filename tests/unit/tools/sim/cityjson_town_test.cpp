// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/cityjson_town.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/road_graph.hpp"

namespace mapweld::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// A house of 10 x 8 m with eaves at 3 m and a ridge at 5 m, 8 m north of a street of 6 x 100 m.
std::string House(const std::string& version, const std::string& lod, const std::string& semantics) {
  return R"({"type":"CityJSON","version":")" + version + R"(","transform":{"scale":[0.001,0.001,0.001],)" +
         R"("translate":[85000,447000,-1]},"CityObjects":{"house":{"type":"Building","geometry":[{"type":"Solid",)" +
         R"("lod":)" + lod + R"(,"boundaries":[[[[0,3,2,1]],[[0,1,5,4]],[[1,2,6,9,5]],[[2,3,7,6]],[[3,0,4,8,7]],)" +
         R"([[4,5,9,8]],[[8,9,6,7]]]])" + semantics + R"(}]},"way":{"type":"Road","attributes":)" +
         R"({"function":"Residential street"},"geometry":[{"type":"MultiSurface","lod":)" + lod +
         R"(,"boundaries":[[[10,11,12,13]]]}]},"pavement":{"type":"Road","attributes":{"function":"Footpath"},)" +
         R"("geometry":[{"type":"MultiSurface","lod":)" + lod + R"(,"boundaries":[[[13,12,1]]]}]}},"vertices":[)" +
         "[40000,14000,0],[50000,14000,0],[50000,22000,0],[40000,22000,0],"
         "[40000,14000,3000],[50000,14000,3000],[50000,22000,3000],[40000,22000,3000],"
         "[40000,18000,5000],[50000,18000,5000],"
         "[0,0,0],[100000,0,0],[100000,6000,0],[0,6000,0]]}";
}

Town Read(const std::string& text) {
  const TestFolder folder;
  WriteText(folder / "t.city.json", text);
  return ReadCityJsonTown(folder / "t.city.json");
}

TEST(CityJsonTown, BuildsAHouseAsHighAsItsRidge) {
  for (const std::string& semantics :
       {std::string(), std::string(R"(,"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"WallSurface"},)"
                                   R"({"type":"RoofSurface"}],"values":[[0,1,1,1,1,2,2]]})")}) {
    const Town town = Read(House("2.0", R"("2.2")", semantics));
    ASSERT_EQ(town.buildings.size(), 1U);
    const Building& house = town.buildings.front();
    EXPECT_EQ(house.footprint.size(), 4U);
    EXPECT_NEAR(SignedArea(house.footprint), 80, 1e-6);
    EXPECT_DOUBLE_EQ(house.height_m, 5);
    EXPECT_EQ(house.roof, RoofShape::kGable) << "level of detail 2: the roof is sloped";
    // The middle of 100 x 22 m is the origin.
    double west = 1e9;
    for (const Vec2d& p : house.footprint) west = std::min(west, p.x());
    EXPECT_NEAR(west, -10, 1e-6);
  }
  const std::string whole_shell_unknown = R"(,"semantics":{"surfaces":[{"type":"GroundSurface"}],"values":[null]})";
  EXPECT_NEAR(SignedArea(Read(House("2.0", "2", whole_shell_unknown)).buildings.front().footprint), 80, 1e-6);
  EXPECT_EQ(Read(House("1.0", "1", "")).buildings.front().roof, RoofShape::kFlat) << "level of detail 1: boxes";
}

TEST(CityJsonTown, DrivesInTheMiddleOfTheCarriagewayAndNotOnFootpaths) {
  const Town town = Read(House("1.1", R"("1.2")", ""));
  ASSERT_EQ(town.roads.size(), 1U);
  const Road& street = town.roads.front();
  EXPECT_NEAR(street.half_width_m, 3, 0.3);
  EXPECT_GT(Length(street.line), 90);
  for (const Vec2d& p : street.line) EXPECT_NEAR(p.y(), -11 + 3, 0.5);
}

TEST(CityJsonTown, ReadsAWholeQuarterWithItsBlockOfStreets) {
  const Town town = ReadCityJsonTown(DataFolder() / "delft.city.json");
  EXPECT_GT(town.buildings.size(), 140U);
  EXPECT_LE(town.buildings.size(), 160U);
  std::set<std::int64_t> ids;
  for (const Building& building : town.buildings) {
    ASSERT_TRUE(ids.insert(building.id).second) << "ids differ";
    ASSERT_GT(SignedArea(building.footprint), 0);
    ASSERT_LE(building.height_m, 20) << "the model reaches to 17 m";
  }
  // From the western canal to the eastern one, and to the north along it.
  const RoadGraph graph(town.roads);
  for (const Vec2d& goal : {Vec2d(160, -80), Vec2d(55, 30)}) {
    EXPECT_GT(graph.ShortestPath(graph.NearestNode({-50, -40}), graph.NearestNode(goal)).size(), 30U);
  }
}

TEST(CityJsonTown, SaysWhatIsWrongWithAFile) {
  const std::string good = House("2.0", "1", "");
  const auto message = [](const std::string& text) { return MessageOf([&] { (void)Read(text); }); };
  const auto with = [&](const std::string& old, const std::string& made) {
    std::string text = good;
    text.replace(text.find(old), old.size(), made);
    return message(text);
  };
  EXPECT_THAT(MessageOf([] { (void)ReadCityJsonTown("nowhere.json"); }), HasSubstr("nowhere.json"));
  EXPECT_THAT(message(good.substr(0, good.size() / 2)), AllOf(HasSubstr("t.city.json"), HasSubstr("parse error")));
  EXPECT_THAT(message("{}"), HasSubstr("no CityJSON"));
  EXPECT_THAT(with("2.0", "3.0"), HasSubstr("version 3.0"));
  EXPECT_THAT(with("[0,3,2,1]", "[0,3,2,99]"), AllOf(HasSubstr("'house'"), HasSubstr("vertex 99 of 14")));
  EXPECT_THAT(with("[0,3,2,1]", "[0,3,2,-1]"), HasSubstr("vertex -1 of 14"));
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  EXPECT_THAT(with("[0,3,2,1]", "[0,3,2," + deep + "]"), HasSubstr("vertex array of 14"));
  EXPECT_THAT(message(House("2.0", "2", R"(,"semantics":{"surfaces":[],"values":)" + deep + "}")), testing::IsEmpty());
  EXPECT_THAT(with("[100000,0,0]", "[1e12,0,0]"), HasSubstr("reach over more than 400 km"));
  EXPECT_THAT(with("[[[10,11,12,13]]]", "[10]"), AllOf(HasSubstr("'way'"), HasSubstr("nested")));
  EXPECT_THAT(with("[0.001,0.001,0.001]", "[1e-9,1e-9,1e-9]"), testing::Not(HasSubstr("degrees")));
  EXPECT_THAT(message(R"({"type":"CityJSON","version":"2.0","CityObjects":{},"vertices":[[4.1,52,0],[4.2,52.1,0]]})"),
              HasSubstr("degrees"));
  EXPECT_THAT(with("\"Building\"", "\"Bridge\""), HasSubstr("0 buildings and 1 streets"));
}

}  // namespace
}  // namespace mapweld::sim
