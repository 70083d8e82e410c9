// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/roadside.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/osm_town.hpp"

namespace mapweld::sim {
namespace {

class Roadside : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const LocalFrame frame({49.987244, 11.503882});
    town_ = new Town(ReadOsmTown(DataFolder() / "north-bayreuth.osm.gz", frame));
    mesh_ = new TownMesh;
    AddTo(*mesh_);
  }
  static void TearDownTestSuite() {
    delete town_;
    delete mesh_;
  }
  static void AddTo(TownMesh& mesh) {
    const Polyline diagonal{{-200, -200}, {200, 200}};
    const Sight sight({&diagonal}, 200);
    AddRoadside(PlotsAlongStreets(*town_, sight), Clearance(*town_, sight), mesh);
  }
  static Town* town_;
  static TownMesh* mesh_;
};
Town* Roadside::town_ = nullptr;
TownMesh* Roadside::mesh_ = nullptr;

TEST_F(Roadside, LinesTheStreetsWithEveryKindOfThing) {
  // Triangles of one tree trunk: 14, of a lamp post: 16, of a garden wall or a hedge: 10.
  EXPECT_GT(Of(*mesh_, Surface::kTrunk).triangles.size(), 14U * 50);
  EXPECT_GT(Of(*mesh_, Surface::kPole).triangles.size(), 16U * 30);
  EXPECT_GT(Of(*mesh_, Surface::kHedge).triangles.size(), 10U * 50);
  EXPECT_GT(Of(*mesh_, Surface::kGardenWall).triangles.size(), 10U * 50);
  EXPECT_GT(Of(*mesh_, Surface::kFoliage).triangles.size(), 140U * 50);
}

TEST_F(Roadside, KeepsEveryCarriagewayFree) {
  for (const Mesh& mesh : *mesh_) {
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      const Vec2d p = vertex.head<2>().cast<double>();
      if (vertex.z() > 2.2F) continue;  // branches may reach over it
      for (const Road& road : town_->roads) {
        for (std::size_t i = 1; i < road.line.size(); ++i) {
          ASSERT_GT(DistanceToSegment(p, road.line[i - 1], road.line[i]), road.half_width_m)
              << p.transpose() << " on way " << road.id;
        }
      }
    }
  }
}

TEST_F(Roadside, StaysOutOfTheHouses) {
  for (const Surface kind : {Surface::kTrunk, Surface::kGardenWall, Surface::kHedge, Surface::kPole}) {
    for (const Eigen::Vector3f& vertex : Of(*mesh_, kind).vertices) {
      const Vec2d p = vertex.head<2>().cast<double>();
      for (const Building& building : town_->buildings) {
        if ((building.footprint.front() - p).norm() > 100) continue;
        ASSERT_FALSE(Inside(building.footprint, p)) << p.transpose() << " in way " << building.id;
      }
    }
  }
}

TEST_F(Roadside, IsTheSameEveryTime) {
  TownMesh again;
  AddTo(again);
  for (std::size_t i = 0; i < kSurfaces; ++i) EXPECT_EQ(again[i].vertices, (*mesh_)[i].vertices);
}

}  // namespace
}  // namespace mapweld::sim
