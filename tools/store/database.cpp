// SPDX-License-Identifier: Apache-2.0
#include "tools/store/database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/base/byte_io.hpp"
#include "core/base/crc32.hpp"
#include "tools/store/schema.hpp"

namespace mapweld::store {
namespace {

constexpr int kLockWait_ms = 500;  // for the one before, which may be about to end

const char* Name(Table table) {
  return kTableNames[static_cast<std::size_t>(table)];
}

// The process that holds a lock on the file, 0 if that cannot be told. Never opens it: to close it again would drop the
// locks of this process.
int Holder(const std::filesystem::path& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return 0;
  const std::string inode = fmt::format(":{}", file.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream fields(line);
    std::string number, kind, advice, access, process, where;
    fields >> number >> kind >> advice >> access >> process >> where;
    if (access == "WRITE" && where.ends_with(inode)) return std::atoi(process.c_str());
  }
  return 0;
}

std::string Reason(int code) {
  switch (code & 0xFF) {
    case SQLITE_FULL:
      return "the disk is full; free some space. Nothing that was stored before is lost";
    case SQLITE_IOERR:
      return "the disk refuses to read or write; check it. Nothing that was stored before is lost";
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return "it cannot be opened for writing; choose a folder that exists and that you may write to";
    case SQLITE_NOTADB:
      return "it is not a Mapweld store; name another file";
    case SQLITE_CORRUPT:
      return "the file is damaged; 'mapweld fsck' says where";
    default:
      return sqlite3_errstr(code);
  }
}

}  // namespace

std::uint32_t RecordChecksum(Table table, std::int64_t key, std::span<const std::uint8_t> body) {
  std::array<std::uint8_t, 9> head{};
  ByteWriter writer(head);
  writer.Little(static_cast<std::uint8_t>(table));
  writer.Little(key);
  return Crc32(body, Crc32(head));
}

// A prepared statement in use; ready for the next one when it goes.
class Database::Statement {
 public:
  Statement(Database* database, const std::string& sql) : database_(database), statement_(database->Prepared(sql)) {}
  ~Statement() {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
  }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void Bind(int at, std::int64_t value) { Check(sqlite3_bind_int64(statement_, at, value)); }
  void Bind(int at, std::span<const std::uint8_t> bytes) {
    static constexpr std::uint8_t kNothing = 0;  // a null pointer would bind NULL
    Check(sqlite3_bind_blob64(statement_, at, bytes.empty() ? &kNothing : bytes.data(), bytes.size(), SQLITE_STATIC));
  }
  // true: there is a row.
  bool Step() {
    const int code = sqlite3_step(statement_);
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) database_->Fail(code);
    return false;
  }
  [[nodiscard]] std::int64_t Integer(int column) const { return sqlite3_column_int64(statement_, column); }
  [[nodiscard]] Bytes Blob(int column) const {
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return data == nullptr ? Bytes{} : Bytes(data, data + size);
  }
  [[nodiscard]] std::string Text(int column) const {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return text == nullptr ? "" : text;
  }

 private:
  void Check(int code) {
    if (code != SQLITE_OK) database_->Fail(code);
  }
  Database* database_;
  sqlite3_stmt* statement_;
};

Database::Database(const std::filesystem::path& path, Mode mode, const char* vfs) : path_(path) {
  try {
    Open(mode, vfs);
  } catch (...) {
    Close();
    throw;
  }
}

void Database::Open(Mode mode, const char* vfs) {
  const bool own_disk = vfs == nullptr;
  if (own_disk && mode == Mode::kExisting && !std::filesystem::exists(path_)) {
    throw StoreError(fmt::format("there is no store {}", path_.string()));
  }
  const int code =
      sqlite3_open_v2(path_.c_str(), &sqlite_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, vfs);
  if (code != SQLITE_OK) Fail(code);
  sqlite3_extended_result_codes(sqlite_, 1);
  sqlite3_busy_timeout(sqlite_, kLockWait_ms);
  Execute("PRAGMA locking_mode=EXCLUSIVE; PRAGMA trusted_schema=OFF; PRAGMA cell_size_check=ON;");
  const std::int64_t application = Number("PRAGMA application_id");
  const std::int64_t version = Number("PRAGMA user_version");
  const bool empty = Number("SELECT count(*) FROM sqlite_schema") == 0 && application == 0 && version == 0;
  if (!empty && application != kApplicationId) Fail(SQLITE_NOTADB);
  if (empty && mode == Mode::kExisting) {
    throw StoreError(fmt::format("the store {} is empty: nothing was ever put into it", path_.string()));
  }
  if (version > kSchemaVersion) {
    throw StoreError(
        fmt::format("the store {} has schema version {} and this program knows up to {}; use the newer mapweld",
                    path_.string(), version, kSchemaVersion));
  }
  if (!empty && version < 1) Fail(SQLITE_CORRUPT);
  // EXTRA until the file is in WAL mode: a rollback journal whose deletion a power cut took back would undo even what
  // was committed after it.
  Execute("PRAGMA synchronous=EXTRA; PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;");
  Execute("BEGIN EXCLUSIVE; COMMIT;");  // takes the lock, for good
  if (version < kSchemaVersion) {
    Transaction([&] { Execute(UpgradeFrom(empty ? 0 : version)); });
  }
}

Database::~Database() {
  Close();
}

void Database::Close() {
  for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
  statements_.clear();
  sqlite3_close(sqlite_);
  sqlite_ = nullptr;
}

void Database::Fail(int code) {
  if ((code & 0xFF) == SQLITE_BUSY || (code & 0xFF) == SQLITE_LOCKED) {
    const int holder = Holder(path_);
    throw StoreError(fmt::format("the store {} is in use by another program{}; stop that one first", path_.string(),
                                 holder > 0 ? fmt::format(" (process {})", holder) : ""));
  }
  throw StoreError(fmt::format("store {}: {}", path_.string(), Reason(code)));
}

void Database::Execute(const std::string& sql) {
  const std::lock_guard lock(mutex_);
  const int code = sqlite3_exec(sqlite_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) Fail(code);
}

std::int64_t Database::Number(const std::string& sql) {
  const std::lock_guard lock(mutex_);
  Statement statement(this, sql);
  return statement.Step() ? statement.Integer(0) : 0;
}

sqlite3_stmt* Database::Prepared(const std::string& sql) {
  const auto known =
      std::find_if(statements_.begin(), statements_.end(), [&](const auto& entry) { return entry.first == sql; });
  if (known != statements_.end()) return known->second;
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(sqlite_, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) Fail(code);
  statements_.emplace_back(sql, statement);
  return statement;
}

void Database::Transaction(const std::function<void()>& writes) {
  const std::lock_guard lock(mutex_);
  if (depth_ == 0) Execute("BEGIN IMMEDIATE");
  ++depth_;
  try {
    writes();
    if (depth_ == 1) Execute("COMMIT");
    --depth_;
  } catch (...) {
    --depth_;
    // Some errors have already rolled back.
    if (depth_ == 0 && sqlite3_get_autocommit(sqlite_) == 0) {
      sqlite3_exec(sqlite_, "ROLLBACK", nullptr, nullptr, nullptr);
    }
    throw;
  }
}

void Database::Put(Table table, std::int64_t key, std::span<const std::uint8_t> body) {
  const std::lock_guard lock(mutex_);
  Statement statement(this, fmt::format("INSERT OR REPLACE INTO {}(id, body, crc) VALUES(?1, ?2, ?3)", Name(table)));
  statement.Bind(1, key);
  statement.Bind(2, body);
  statement.Bind(3, static_cast<std::int64_t>(RecordChecksum(table, key, body)));
  statement.Step();
}

void Database::Remove(Table table, std::int64_t key) {
  const std::lock_guard lock(mutex_);
  Statement statement(this, fmt::format("DELETE FROM {} WHERE id = ?1", Name(table)));
  statement.Bind(1, key);
  statement.Step();
}

std::optional<Record> Database::Get(Table table, std::int64_t key) {
  std::optional<Record> found;
  ForEach(table, key, key, [&](Record record) { found = std::move(record); });
  return found;
}

void Database::ForEach(Table table, std::int64_t first, std::int64_t last, const std::function<void(Record)>& take) {
  const std::lock_guard lock(mutex_);
  Statement statement(this,
                      fmt::format("SELECT id, body, crc FROM {} WHERE id BETWEEN ?1 AND ?2 ORDER BY id", Name(table)));
  statement.Bind(1, first);
  statement.Bind(2, last);
  while (statement.Step()) {
    Record record{statement.Integer(0), statement.Blob(1), false};
    record.damaged = statement.Integer(2) != static_cast<std::int64_t>(RecordChecksum(table, record.key, record.body));
    take(std::move(record));
  }
}

std::vector<std::int64_t> Database::Keys(Table table, std::int64_t first, std::int64_t last) {
  const std::lock_guard lock(mutex_);
  std::vector<std::int64_t> keys;
  Statement statement(this, fmt::format("SELECT id FROM {} WHERE id BETWEEN ?1 AND ?2 ORDER BY id", Name(table)));
  statement.Bind(1, first);
  statement.Bind(2, last);
  while (statement.Step()) keys.push_back(statement.Integer(0));
  return keys;
}

std::vector<std::string> Database::CheckStructure() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> problems;
  Statement statement(this, "PRAGMA integrity_check");
  while (statement.Step()) {
    const std::string line = statement.Text(0);
    if (line != "ok") problems.push_back(line);
  }
  // A changed letter of a definition can make SQLite read other keys than were written.
  Statement tables(this, "SELECT name, sql FROM sqlite_schema");
  while (tables.Step()) {
    const std::string name = tables.Text(0);
    if (tables.Text(1) != TableDefinition(name)) problems.push_back("table " + name + " is defined in another way");
  }
  return problems;
}

}  // namespace mapweld::store
