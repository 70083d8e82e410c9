// SPDX-License-Identifier: Apache-2.0
#include "tools/store/database.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/small_city.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tools/store/schema.hpp"

namespace mapweld::store {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Stores : public testing::Test {
 protected:
  // The sentence with which opening fails; empty when it does not.
  static std::string OpenError(const std::string& path, Database::Mode mode = Database::Mode::kCreate) {
    try {
      const Database database(path, mode);
    } catch (const StoreError& error) {
      return error.what();
    }
    return "";
  }
  static void Execute(const std::string& path, const std::string& sql) {
    sqlite3* sqlite = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &sqlite), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(sqlite, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(sqlite);
    sqlite3_close(sqlite);
  }
  const test::TemporaryDirectory directory_;
  const std::string path_ = directory_.File("city.db");
};

TEST_F(Stores, GiveBackWhatWasPutAfterTheyWereClosed) {
  const Bytes body{1, 2, 3};
  {
    Database database(path_, Database::Mode::kCreate);
    database.Put(Table::kKeyframes, PairKey(3, 17), body);
    database.Put(Table::kMerges, 1, {});
  }
  Database database(path_, Database::Mode::kExisting);
  const auto record = database.Get(Table::kKeyframes, PairKey(3, 17));
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->body, body);
  EXPECT_FALSE(record->damaged);
  EXPECT_TRUE(database.Get(Table::kMerges, 1).has_value());
  EXPECT_FALSE(database.Get(Table::kMerges, 2).has_value());
  EXPECT_EQ(HighOf(record->key), 3);
  EXPECT_EQ(LowOf(record->key), 17);
}

TEST_F(Stores, KeepAllOfATransactionOrNothing) {
  Database database(path_, Database::Mode::kCreate);
  EXPECT_THROW(database.Transaction([&] {
    database.Put(Table::kDrives, 1, {});
    database.Transaction([&] { database.Put(Table::kDrives, 2, {}); });
    throw std::runtime_error("in the middle");
  }),
               std::runtime_error);
  EXPECT_TRUE(database.Keys(Table::kDrives).empty());
  database.Transaction([&] { database.Put(Table::kDrives, 3, {}); });
  EXPECT_EQ(database.Keys(Table::kDrives).size(), 1U);
}

TEST_F(Stores, RefuseASecondProcessAndNameTheFirst) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    char go = 0;
    if (::read(ends[0], &go, 1) == 1) std::ofstream(directory_.File("error")) << OpenError(path_);
    ::_exit(0);
  }
  const Database database(path_, Database::Mode::kCreate);
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  std::ifstream file(directory_.File("error"));
  const std::string error{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(error, AllOf(HasSubstr(path_), HasSubstr("in use by another program"),
                           HasSubstr("process " + std::to_string(::getpid()))));
  EXPECT_THAT(OpenError(path_), HasSubstr("in use")) << "also in the same process";
}

TEST_F(Stores, RefuseANewerSchemaAndNameBothVersions) {
  { const Database database(path_, Database::Mode::kCreate); }
  Execute(path_, "PRAGMA user_version=17");
  EXPECT_THAT(OpenError(path_), AllOf(HasSubstr("version 17"), HasSubstr("up to " + std::to_string(kSchemaVersion)),
                                      HasSubstr("use the newer mapweld")));
}

// A store of version 1 as it was: its drives and keyframes are kept, the new tables are there.
TEST_F(Stores, BringAnOlderSchemaUpToDate) {
  std::string tables;
  for (const char* name : {"drives", "keyframes", "submaps", "trajectories", "merges"}) {
    tables +=
        "CREATE TABLE " + std::string(name) + "(id INTEGER PRIMARY KEY, body BLOB NOT NULL, crc INTEGER NOT NULL);";
  }
  const std::uint32_t crc = RecordChecksum(Table::kDrives, 1, Bytes{'x'});
  Execute(path_, tables + "INSERT INTO drives VALUES(1, x'78', " + std::to_string(crc) +
                     ");PRAGMA application_id=1297565004;PRAGMA user_version=1;PRAGMA journal_mode=WAL;");
  for (int times = 0; times < 2; ++times) {
    Database database(path_, Database::Mode::kExisting);
    const auto record = database.Get(Table::kDrives, 1);
    ASSERT_TRUE(record.has_value());
    EXPECT_FALSE(record->damaged);
    database.Put(Table::kRulings, 1, {});
    EXPECT_EQ(database.Keys(Table::kRulings).size(), 1U);
  }
}

TEST_F(Stores, RefuseWhatIsNoStore) {
  std::ofstream(directory_.File("text")) << std::string(5000, 'x');
  EXPECT_THAT(OpenError(directory_.File("text")), HasSubstr("not a Mapweld store"));
  Execute(directory_.File("other"), "CREATE TABLE other(x)");
  EXPECT_THAT(OpenError(directory_.File("other")), HasSubstr("not a Mapweld store"));
  EXPECT_THAT(OpenError(directory_.File("none"), Database::Mode::kExisting), HasSubstr("there is no store"));
  EXPECT_THAT(OpenError("/no/such/folder/city.db"), HasSubstr("choose a folder"));
  EXPECT_FALSE(std::filesystem::exists(directory_.File("none")));
}

}  // namespace
}  // namespace mapweld::store
