// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/sim/test_folder.hpp"

namespace mapweld::sim {
namespace {

using testing::HasSubstr;

constexpr const char* kGood =
    R"({"name":"n","town":"t.osm","origin":[50,11],"vehicles":[{"id":2,"route":[[50,11],[50.1,11]]},
        {"id":1,"route":[[50,11],[50.1,11]]}]})";

class ScenarioFile : public testing::Test {
 protected:
  Scenario Read(const std::string& text) {
    WriteText(folder_ / "s.json", text);
    return ReadScenario(folder_ / "s.json");
  }
  std::string Complaint(const std::string& from, const std::string& to) {
    std::string text = kGood;
    text.replace(text.find(from), from.size(), to);
    return MessageOf([&] { (void)Read(text); });
  }
  const TestFolder folder_;
};

TEST_F(ScenarioFile, SortsVehiclesAndFindsTheTownBesideItself) {
  const Scenario scenario = Read(kGood);
  ASSERT_EQ(scenario.vehicles.size(), 2U);
  EXPECT_EQ(scenario.vehicles[0].id, 1);
  EXPECT_EQ(scenario.vehicles[1].waypoints.size(), 2U);
  EXPECT_EQ(std::get<std::filesystem::path>(scenario.town), folder_ / "t.osm");
  EXPECT_EQ(scenario.seed, 1U);
}

TEST_F(ScenarioFile, NamesWhatIsWrong) {
  EXPECT_THAT(Complaint("\"name\":\"n\",", ""), HasSubstr("'name' is missing"));
  EXPECT_THAT(Complaint("\"name\"", "\"nmae\""), HasSubstr("unknown key 'nmae'"));
  EXPECT_THAT(Complaint("\"route\"", "\"path\""), HasSubstr("vehicle number 1: unknown key 'path'"));
  EXPECT_THAT(Complaint("\"id\":2", "\"id\":0"), HasSubstr("outside 1..32767"));
  EXPECT_THAT(Complaint("\"id\":2", "\"id\":1"), HasSubstr("two vehicles have id 1"));
  EXPECT_THAT(Complaint("\"id\":2", "\"id\":\"x\""), HasSubstr("'id' has the wrong kind of value"));
  EXPECT_THAT(Complaint("[50,11],\"v", "[500,11],\"v"), HasSubstr("is no [latitude, longitude]"));
  EXPECT_THAT(Complaint("{", ""), HasSubstr("no valid JSON"));
  EXPECT_THAT(MessageOf([] { (void)ReadScenario("missing.json"); }), HasSubstr("cannot open scenario missing.json"));
}

constexpr const char* kInvented =
    R"({"name":"n","town":{"style":"suburb","size_m":900,"seed":7},"survey":{"drives":1,"zones":1,"zone_radius_m":400,
        "min_length_m":500,"max_length_m":500,"total_length_m":500}})";

TEST_F(ScenarioFile, MayInventItsTown) {
  const Scenario scenario = Read(kInvented);
  const auto& plan = std::get<TownPlan>(scenario.town);
  EXPECT_EQ(plan.style, "suburb");
  EXPECT_EQ(plan.size_m, 900);
  EXPECT_EQ(plan.seed, 7U);
  EXPECT_EQ(plan.cellar_m, 0);
  std::string text = kInvented;
  text.replace(text.find("suburb"), 6, "desert");
  EXPECT_THAT(MessageOf([&] { (void)Read(text); }), HasSubstr("no style of town 'desert'"));
  text = kInvented;
  text.replace(text.find("900"), 3, R"(900,"cellar_m":2)");
  EXPECT_THAT(MessageOf([&] { (void)Read(text); }), HasSubstr("cellar_m 2 is neither 0 nor in 3.3..4.5"));
  text.replace(text.find("\"cellar_m\":2"), 12, "\"cellar_m\":4");
  EXPECT_THAT(MessageOf([&] { (void)Read(text); }), HasSubstr("suburb are not straight enough"));
}

TEST(Scenarios, ComeWithTheProgramTogetherWithTheirTowns) {
  for (const auto& entry : std::filesystem::directory_iterator(DataFolder())) {
    if (entry.path().extension() != ".json" || entry.path().stem().has_extension()) continue;  // NAME.city.json: a town
    const Scenario scenario = ReadScenario(ScenarioByName(entry.path().stem().string()));
    const auto* file = std::get_if<std::filesystem::path>(&scenario.town);
    EXPECT_TRUE(file == nullptr || std::filesystem::exists(*file)) << entry.path();
    const bool to_train_on = entry.path().stem().string().starts_with("train_");
    const bool bayreuth = file != nullptr && file->filename() == "north-bayreuth.osm.gz";
    EXPECT_FALSE(to_train_on && bayreuth) << "nobody trains on the town of the evaluation";
  }
}

}  // namespace
}  // namespace mapweld::sim
