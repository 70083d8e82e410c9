// SPDX-License-Identifier: Apache-2.0
#include "drivers/messages/validate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/config/capacity.hpp"
#include "tests/support/sample_messages.hpp"

namespace mapweld::messages {
namespace {

using test::SampleMessage;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

// Whether the sample is still good after `change`.
template <class T, class Change>
bool Good(Change change) {
  T message = SampleMessage<T>();
  change(&message);
  return Validate(message) == Status::kOk;
}

template <class T>
class AnyMessage : public testing::Test {};
using WithEpoch = testing::Types<mapweldlcm::keyframe_t, mapweldlcm::submap_chunk_t, mapweldlcm::pose_t,
                                 mapweldlcm::health_t, mapweldlcm::global_pose_t, mapweldlcm::request_t>;
TYPED_TEST_SUITE(AnyMessage, WithEpoch);

TYPED_TEST(AnyMessage, NamesItsAgentAndEpoch) {
  using T = TypeParam;
  EXPECT_TRUE(Good<T>([](T*) {}));
  EXPECT_TRUE(Good<T>([](T* m) { m->agent_id = 32767; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->agent_id = 0; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->agent_id = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->epoch = 0; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->epoch = -5; }));
}

TEST(Keyframe, HasAFinitePoseWithAUnitQuaternion) {
  using T = mapweldlcm::keyframe_t;
  for (const double bad : {kNan, kInf, -kInf, 1e8, -1e8}) {
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(Good<T>([&](T* m) { m->odom_t_body[i] = bad; }));
    for (int i = 0; i < 4; ++i) EXPECT_FALSE(Good<T>([&](T* m) { m->odom_q_body[i] = bad; }));
  }
  EXPECT_FALSE(Good<T>([](T* m) { m->odom_q_body[3] = 0.0; })) << "length 0.6";
  EXPECT_FALSE(Good<T>([](T* m) { m->odom_q_body[0] = 0.1; })) << "length 1.005";
  EXPECT_TRUE(Good<T>([](T* m) { m->odom_q_body[0] = 0.01; })) << "length 1.00005: rounding";
}

TEST(Keyframe, KeepsToTheCapacities) {
  using T = mapweldlcm::keyframe_t;
  EXPECT_TRUE(Good<T>([](T* m) { m->submap_points = static_cast<std::int32_t>(kCap.submap_points); }));
  EXPECT_FALSE(Good<T>([](T* m) { m->submap_points = static_cast<std::int32_t>(kCap.submap_points) + 1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->submap_bytes = static_cast<std::int32_t>(kCap.submap_encoded_bytes) + 1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->submap_bytes = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->index = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->t_ns = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->flushed = 2; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->path_m = kNanF; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->descriptor_scale = kNanF; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->descriptor_scale = -0.1F; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->orientation_scale = std::numeric_limits<float>::infinity(); }));
}

TEST(SubmapChunk, LiesInsideItsSubmap) {
  using T = mapweldlcm::submap_chunk_t;
  const auto at = [](std::int32_t total, std::int32_t offset, std::int16_t n) {
    return Good<T>([&](T* m) {
      m->total_bytes = total;
      m->offset = offset;
      m->n = n;
    });
  };
  EXPECT_TRUE(at(1280, 0, 1280));
  EXPECT_TRUE(at(1, 0, 1));
  EXPECT_TRUE(at(2000, 1280, 720));
  EXPECT_FALSE(at(2000, 1280, 721));
  EXPECT_FALSE(at(2000, -1, 10));
  EXPECT_FALSE(at(2000, 0, 0));
  EXPECT_FALSE(at(2000, 0, -1));
  EXPECT_FALSE(at(2000, 0, 1281));
  EXPECT_FALSE(at(100, 0, 101));
  EXPECT_FALSE(at(0, 0, 1));
  EXPECT_FALSE(at(-1, 0, 1));
  EXPECT_FALSE(at(std::numeric_limits<std::int32_t>::min(), 0, 1));
  EXPECT_FALSE(at(2000, std::numeric_limits<std::int32_t>::max(), 1280));
  EXPECT_FALSE(at(static_cast<std::int32_t>(kCap.submap_encoded_bytes) + 1, 0, 1));
}

TEST(GlobalPose, IsFiniteAndBelongsToAGroupOrNone) {
  using T = mapweldlcm::global_pose_t;
  EXPECT_TRUE(Good<T>([](T* m) { m->group = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->group = -2; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->revision = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->keyframe = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->merged_t_body[2] = kNan; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->merged_q_body[1] = 0.0; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->sigma_m = -1.0F; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->sigma_rad = kNanF; }));
}

TEST(Request, AsksForAtMost64KnownThings) {
  using T = mapweldlcm::request_t;
  EXPECT_TRUE(Good<T>([](T* m) { m->n = 0; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->n = 65; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->n = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->kind = 2; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->kind = -1; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->index[63] = -1; }));
  EXPECT_TRUE(Good<T>([](T* m) {
    m->n = 63;
    m->index[63] = -1;
  })) << "beyond n nothing is read";
}

TEST(Command, IsOneWeKnow) {
  using T = mapweldlcm::command_t;
  EXPECT_TRUE(Good<T>([](T*) {}));
  EXPECT_FALSE(Good<T>([](T* m) { m->command = 0; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->command = 2; }));
  EXPECT_FALSE(Good<T>([](T* m) { m->agent_id = 0; }));
}

TEST(PoseAndHealth, RefuseNonsense) {
  using P = mapweldlcm::pose_t;
  EXPECT_FALSE(Good<P>([](P* m) { m->odom_q_body[3] = -kInf; }));
  EXPECT_FALSE(Good<P>([](P* m) { m->merged_t_body[0] = kNan; }));
  EXPECT_FALSE(Good<P>([](P* m) { m->degenerate = 2; }));
  EXPECT_FALSE(Good<P>([](P* m) { m->sigma_m = kNanF; }));
  using H = mapweldlcm::health_t;
  EXPECT_FALSE(Good<H>([](H* m) { m->mode = 5; }));
  EXPECT_FALSE(Good<H>([](H* m) { m->mode = -1; }));
  EXPECT_FALSE(Good<H>([](H* m) { m->bus_rejected = -1; }));
  EXPECT_FALSE(Good<H>([](H* m) { m->scan_ms_max = kNanF; }));
}

}  // namespace
}  // namespace mapweld::messages
