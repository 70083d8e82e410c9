// SPDX-License-Identifier: Apache-2.0
#include "tools/report/map_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/geom/between_factor.hpp"
#include "tests/unit/tools/io/temp_folder.hpp"
#include "tests/unit/tools/report/fake_town.hpp"
#include "tools/io/kitti.hpp"
#include "tools/io/pcd.hpp"
#include "tools/io/ply.hpp"
#include "tools/io/text_rows.hpp"
#include "tools/report/palette.hpp"

namespace mapweld::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::vector<MapPoint>> Maps(test::FakeTown* town) {
  std::vector<std::vector<MapPoint>> maps;
  for (std::size_t g = 0; g < town->result.groups.size(); ++g) {
    maps.push_back(BuildGroupMap(town->drives, town->result, static_cast<int>(g), town));
  }
  return maps;
}

// One keyframe with the given submap, merged at `merged_T_body`.
class OneKeyframe : public merge::SubmapSource {
 public:
  merge::SubmapCloud cloud;
  std::vector<merge::Drive> drives{1};
  merge::MergeResult result;
  bool present = true;

  OneKeyframe(const geom::Pose3& odom_T_body, const geom::Pose3& merged_T_body) {
    drives[0].keyframes.push_back({{}, odom_T_body, {}, 0, false});
    result.groups = {{0}};
    result.merged_T_body = {{merged_T_body}};
  }
  std::shared_ptr<const merge::SubmapCloud> Find(merge::SubmapKey) override {
    return present ? merge::Kept(&cloud) : nullptr;
  }
};

TEST(MergedMap, PutsSubmapPointsWhereTheTiltedBodySawThem) {
  // The body is rolled; its submap is level. A wall 10 m to the left in the level frame stays at that height.
  const geom::Pose3 odom_T_body = {{1, 2, 3}, geom::ExpSo3({0, 0, 0.5}) * geom::ExpSo3({0.3, 0, 0})};
  const geom::Pose3 merged_T_odom = {{100, 0, 0}, geom::ExpSo3({0, 0, 1.2})};
  OneKeyframe one(odom_T_body, merged_T_odom * odom_T_body);
  one.cloud.points = {{0, 10, 0}};
  const auto points = BuildGroupMap(one.drives, one.result, 0, &one, 0.4);
  ASSERT_EQ(points.size(), 1U);
  const geom::Vec3d expected = merged_T_odom * (geom::ExpSo3({0, 0, 0.5}) * geom::Vec3d(0, 10, 0) + odom_T_body.t);
  EXPECT_LT((points[0].p_merged.cast<double>() - expected).norm(), 1e-4);
}

TEST(MergedMap, KeepsOneMeanPerVoxelAlsoFarFromTheOrigin) {
  OneKeyframe one({}, {{100000, -50000, 0}, geom::Quatd::Identity()});
  one.cloud.points = {{0.05F, 0.1F, 0.1F}, {0.15F, 0.1F, 0.1F}, {0.45F, 0.1F, 0.1F}, {-0.1F, 0.1F, 0.1F}};
  const auto points = BuildGroupMap(one.drives, one.result, 0, &one, 0.4);
  ASSERT_EQ(points.size(), 3U);
  std::set<float> x;
  for (const MapPoint& p : points) x.insert(p.p_merged.x());
  EXPECT_NEAR(*std::next(x.begin()), 100000.1, 0.01);
}

TEST(MergedMap, LeavesOutMissingSubmapsAndPointsThatAreNone) {
  OneKeyframe one({}, {});
  one.cloud.points = {{NAN, 0, 0}, {0, INFINITY, 0}, {1e9F, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(BuildGroupMap(one.drives, one.result, 0, &one).size(), 1U);
  one.present = false;
  EXPECT_TRUE(BuildGroupMap(one.drives, one.result, 0, &one).empty());
}

TEST(MapWriter, WritesTheFilesOfEveryGroup) {
  const test::TempFolder folder;
  test::FakeTown town(3, 20);
  const auto maps = Maps(&town);
  WriteMergeOutput(folder.path(), town.drives, town.result, maps);
  EXPECT_THAT(folder.Files(),
              ElementsAre("group_1/map.pcd", "group_1/map.ply", "group_1/pose_graph.g2o", "group_2/map.pcd",
                          "group_2/map.ply", "group_2/pose_graph.g2o", "groups.json", "overlaps.json",
                          "trajectory_2024-05-03_car_a.kitti.txt", "trajectory_2024-05-03_car_a.tum",
                          "trajectory_2024-05-04_car_b.kitti.txt", "trajectory_2024-05-04_car_b.tum",
                          "trajectory_2024-05-05_car_c.kitti.txt", "trajectory_2024-05-05_car_c.tum"));
  const io::PointCloud ply = io::ReadPly(folder / "group_1/map.ply");
  const io::PointCloud pcd = io::ReadPcd(folder / "group_1/map.pcd");
  EXPECT_EQ(ply.points.size(), maps[0].size());
  EXPECT_EQ(ply.points, pcd.points);
  EXPECT_EQ(ply.colors, pcd.colors);
  EXPECT_EQ(std::set<io::Rgb>(ply.colors.begin(), ply.colors.end()), (std::set<io::Rgb>{DriveColor(0), DriveColor(1)}));
  const auto tum = io::ReadTum(folder / "trajectory_2024-05-04_car_b.tum");
  ASSERT_EQ(tum.size(), 20U);
  EXPECT_EQ(tum[7].t, town.drives[1].keyframes[7].t);
  EXPECT_LT(geom::LocalCoordinates(tum[7].world_T_body, town.result.merged_T_body[1][7]).norm(), 1e-5);
  EXPECT_EQ(io::ReadKittiPoses(folder / "trajectory_2024-05-04_car_b.kitti.txt").size(), 20U);
}

TEST(MapWriter, WritesDensePosesWhereItIsGivenSome) {
  const test::TempFolder folder;
  test::FakeTown town(2, 5);
  std::vector<std::vector<io::StampedPose>> dense(2);
  for (int i = 0; i < 33; ++i) dense[1].push_back({{i}, {}});
  WriteMergeOutput(folder.path(), town.drives, town.result, Maps(&town), dense);
  EXPECT_EQ(io::ReadTum(folder / "trajectory_2024-05-03_car_a.tum").size(), 5U);
  EXPECT_EQ(io::ReadTum(folder / "trajectory_2024-05-04_car_b.tum").size(), 33U);
}

TEST(MapWriter, WritesTheSameBytesTwice) {
  const test::TempFolder one;
  const test::TempFolder two;
  for (const test::TempFolder* folder : {&one, &two}) {
    test::FakeTown town(3, 10);
    WriteMergeOutput(folder->path(), town.drives, town.result, Maps(&town));
  }
  ASSERT_EQ(one.Files(), two.Files());
  for (const std::string& file : one.Files()) EXPECT_EQ(io::ReadFile(one / file), io::ReadFile(two / file)) << file;
}

TEST(MapWriter, RemovesWhatAnEarlierMergeLeftAndNothingElse) {
  const test::TempFolder folder;
  test::FakeTown three(3, 5);
  WriteMergeOutput(folder.path(), three.drives, three.result, Maps(&three));
  folder.Put("group_2/notes.txt", "mine");
  folder.Put("group_7/map.ply", "old");
  folder.Put("group_photo/map.ply", "mine");
  test::FakeTown one(1, 5);
  WriteMergeOutput(folder.path(), one.drives, one.result, Maps(&one));
  EXPECT_THAT(folder.Files(), ElementsAre("group_1/map.pcd", "group_1/map.ply", "group_1/pose_graph.g2o",
                                          "group_2/notes.txt", "group_photo/map.ply", "groups.json", "overlaps.json",
                                          "trajectory_2024-05-03_car_a.kitti.txt", "trajectory_2024-05-03_car_a.tum"));
  EXPECT_FALSE(std::filesystem::exists(folder / "group_7"));
}

TEST(MapWriter, SaysWhereItCannotWrite) {
  const test::TempFolder folder;
  test::FakeTown town(1, 2);
  folder.Put("taken", "a file");
  EXPECT_THAT(test::ErrorOf([&] { WriteMergeOutput(folder / "taken", town.drives, town.result, Maps(&town)); }),
              HasSubstr("taken"));
}

TEST(GroupsJson, ListsTheRecordingsOfEachGroup) {
  const test::FakeTown town(3, 5);
  const auto json = nlohmann::json::parse(GroupsJson(town.drives, town.result));
  ASSERT_EQ(json["groups"].size(), 2U);
  EXPECT_THAT(json["groups"][0]["recordings"].get<std::vector<std::string>>(),
              ElementsAre("2024-05-03_car_a", "2024-05-04_car_b"));
  EXPECT_EQ(json["groups"][1]["recordings"][0], "2024-05-05_car_c");
}

TEST(GroupsJson, SurvivesNamesThatAreNoUtf8) {
  test::FakeTown town(1, 2);
  town.drives[0].name = "caf\xE9";
  EXPECT_TRUE(nlohmann::json::accept(GroupsJson(town.drives, town.result)));
}

TEST(OverlapsJson, KeepsEveryDecisionAndItsReason) {
  const test::FakeTown town(3, 130);
  const auto json = nlohmann::json::parse(OverlapsJson(town.drives, town.result));
  ASSERT_EQ(json["overlaps"].size(), town.result.overlaps.size());
  const auto& first = json["overlaps"][0];
  const merge::Overlap& overlap = town.result.overlaps[0];
  EXPECT_EQ(first["pair"][0], "2024-05-03_car_a");
  EXPECT_EQ(first["pair"][1], "2024-05-04_car_b");
  EXPECT_EQ(first["verdict"], "accepted");
  EXPECT_EQ(first["test"], "registration");
  EXPECT_EQ(first["group"], 1);
  EXPECT_EQ(first["matches"].size(), overlap.matches.size());
  EXPECT_EQ(first["loops"][0]["keyframe_b"], overlap.loops[0].keyframe_b);
  EXPECT_EQ(first["transform"][0][3], overlap.a_T_b.t.x());
  EXPECT_EQ(first["transform"][3], (nlohmann::json{0, 0, 0, 1}));
  const auto& last = json["overlaps"].back();
  EXPECT_EQ(last["verdict"], "rejected");
  EXPECT_TRUE(last["group"].is_null());
}

TEST(PoseGraph, HoldsTheGroupWithEdgesThatAgreeWithItsPoses) {
  const test::TempFolder folder;
  const test::FakeTown town(3, 130);
  WritePoseGraph(folder / "a.g2o", town.drives, town.result, 0);
  const io::TextRows file(folder / "a.g2o");
  std::map<std::string, geom::Pose3> vertices;
  std::size_t loops = 0;
  std::size_t fixed = 0;
  const auto pose_at = [&](const io::TextRow& row, std::size_t c) {
    const auto v = [&](std::size_t i) { return file.Number(row, c + i); };
    return geom::Pose3{{v(0), v(1), v(2)}, geom::Quatd(v(6), v(3), v(4), v(5))};
  };
  for (const io::TextRow& row : file.rows()) {
    if (row.words[0] == "VERTEX_SE3:QUAT") vertices[std::string(row.words[1])] = pose_at(row, 2);
    if (row.words[0] == "FIX") ++fixed;
    if (row.words[0] != "EDGE_SE3:QUAT") continue;
    const geom::Pose3& a = vertices.at(std::string(row.words[1]));
    const geom::Pose3& b = vertices.at(std::string(row.words[2]));
    const double error = geom::BetweenResidual(a, b, pose_at(row, 3)).norm();
    EXPECT_LT(error, 1e-4) << row.line;
    if (file.Number(row, 2) - file.Number(row, 1) != 1) ++loops;
  }
  EXPECT_EQ(vertices.size(), 260U);
  EXPECT_EQ(fixed, 1U);
  EXPECT_EQ(loops, town.result.overlaps[0].loops.size());
}

}  // namespace
}  // namespace mapweld::report
