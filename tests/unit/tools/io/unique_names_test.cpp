// SPDX-License-Identifier: Apache-2.0
#include "tools/io/unique_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mapweld::io {
namespace {

using ::testing::ElementsAre;

TEST(UniqueNames, AreTheFolderNamesWhenTheseDiffer) {
  EXPECT_THAT(UniqueNames({"/data/run1", "/data/run2/", "/data/x/../run3/."}), ElementsAre("run1", "run2", "run3"));
}

TEST(UniqueNames, TakeTheParentWhereTwoFoldersShareAName) {
  EXPECT_THAT(UniqueNames({"/monday/run1", "/monday/run2", "/tuesday/run1"}),
              ElementsAre("monday_run1", "run2", "tuesday_run1"));
}

TEST(UniqueNames, NumberWhatIsStillTheSame) {
  EXPECT_THAT(UniqueNames({"/a/x/run", "/b/x/run", "/b/x/run"}), ElementsAre("x_run", "x_run_2", "x_run_3"));
}

TEST(UniqueNames, NeverMeetTheNameOfAnotherFolder) {
  EXPECT_THAT(UniqueNames({"/a/run", "/b/run", "/c/a_run"}), ElementsAre("a_run", "b_run", "a_run_2"));
}

TEST(UniqueNames, NeverAreEmpty) {
  for (const std::string& name : UniqueNames({"/", ".", ""})) EXPECT_FALSE(name.empty());
}

TEST(UniqueFileNames, CannotLeaveTheirFolder) {
  EXPECT_THAT(UniqueFileNames({"a/b", "a_b", "../x", "tab\there", ""}),
              ElementsAre("a_b", "a_b_2", "_.._x", "tab_here", "_"));
}

}  // namespace
}  // namespace mapweld::io
