// SPDX-License-Identifier: Apache-2.0
#include "tests/support/crash_disk.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <random>

namespace mapweld::test {

// SQLite's view of an open file; it allocates the memory.
struct CrashFile {
  sqlite3_file base;
  CrashDisk* disk;
  std::string* name;  // null: a file without a name, which lives until it is closed
  std::vector<std::uint8_t>* unnamed;

  static CrashFile* From(sqlite3_file* file) { return reinterpret_cast<CrashFile*>(file); }
  std::vector<std::uint8_t>& bytes() const { return name == nullptr ? *unnamed : disk->files_[*name]; }
  int Count(CrashDisk::Operation::Kind kind, std::uint64_t at = 0, const void* data = nullptr, int n = 0) const {
    if (name == nullptr) return SQLITE_OK;
    const auto* from = static_cast<const std::uint8_t*>(data);
    return disk->Count({kind, *name, at, data == nullptr ? std::vector<std::uint8_t>{} : std::vector(from, from + n)});
  }

  static int Close(sqlite3_file* file) {
    delete From(file)->name;
    delete From(file)->unnamed;
    return SQLITE_OK;
  }
  static int Read(sqlite3_file* file, void* out, int n, sqlite3_int64 at) {
    const std::vector<std::uint8_t>& bytes = From(file)->bytes();
    const auto begin = std::min(static_cast<std::size_t>(at), bytes.size());
    const auto got = std::min(static_cast<std::size_t>(n), bytes.size() - begin);
    std::memset(out, 0, static_cast<std::size_t>(n));
    if (got > 0) std::memcpy(out, bytes.data() + begin, got);
    return got == static_cast<std::size_t>(n) ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
  }
  static int Write(sqlite3_file* file, const void* data, int n, sqlite3_int64 at) {
    CrashFile* const self = From(file);
    if (const int code = self->Count(CrashDisk::Operation::kWrite, static_cast<std::uint64_t>(at), data, n))
      return code;
    std::vector<std::uint8_t>& bytes = self->bytes();
    const auto end = static_cast<std::size_t>(at) + static_cast<std::size_t>(n);
    if (bytes.size() < end) bytes.resize(end);
    std::memcpy(bytes.data() + at, data, static_cast<std::size_t>(n));
    return SQLITE_OK;
  }
  static int Truncate(sqlite3_file* file, sqlite3_int64 size) {
    CrashFile* const self = From(file);
    if (const int code = self->Count(CrashDisk::Operation::kTruncate, static_cast<std::uint64_t>(size))) return code;
    self->bytes().resize(static_cast<std::size_t>(size));
    return SQLITE_OK;
  }
  static int Sync(sqlite3_file* file, int) { return From(file)->Count(CrashDisk::Operation::kSync); }
  static int Size(sqlite3_file* file, sqlite3_int64* out) {
    *out = static_cast<sqlite3_int64>(From(file)->bytes().size());
    return SQLITE_OK;
  }
  static int Lock(sqlite3_file*, int) { return SQLITE_OK; }
  static int CheckLock(sqlite3_file*, int* out) {
    *out = 0;
    return SQLITE_OK;
  }
  static int Control(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }
  static int SectorSize(sqlite3_file*) { return 512; }
  static int Characteristics(sqlite3_file*) { return 0; }
};

struct CrashVfs {
  static CrashDisk* Disk(sqlite3_vfs* vfs) { return static_cast<CrashDisk*>(vfs->pAppData); }
  static int Open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out_flags) {
    static const sqlite3_io_methods kMethods = {1,
                                                CrashFile::Close,
                                                CrashFile::Read,
                                                CrashFile::Write,
                                                CrashFile::Truncate,
                                                CrashFile::Sync,
                                                CrashFile::Size,
                                                CrashFile::Lock,
                                                CrashFile::Lock,
                                                CrashFile::CheckLock,
                                                CrashFile::Control,
                                                CrashFile::SectorSize,
                                                CrashFile::Characteristics,
                                                nullptr,
                                                nullptr,
                                                nullptr,
                                                nullptr,
                                                nullptr,
                                                nullptr};
    CrashFile* const self = CrashFile::From(file);
    self->base.pMethods = nullptr;
    if (name != nullptr && (flags & SQLITE_OPEN_CREATE) == 0 && !Disk(vfs)->files_.contains(name)) {
      return SQLITE_CANTOPEN;
    }
    self->disk = Disk(vfs);
    self->name = name == nullptr ? nullptr : new std::string(name);
    self->unnamed = name == nullptr ? new std::vector<std::uint8_t> : nullptr;
    self->base.pMethods = &kMethods;
    if (name != nullptr) Disk(vfs)->files_.try_emplace(name);
    if (out_flags != nullptr) *out_flags = flags;
    return SQLITE_OK;
  }
  static int Delete(sqlite3_vfs* vfs, const char* name, int sync_directory) {
    if (!Disk(vfs)->files_.contains(name)) return SQLITE_IOERR_DELETE_NOENT;
    if (const int code = Disk(vfs)->Count({CrashDisk::Operation::kDelete, name, 0, {}})) return code;
    if (sync_directory != 0) {
      if (const int code = Disk(vfs)->Count({CrashDisk::Operation::kSync, name, 0, {}})) return code;
    }
    Disk(vfs)->files_.erase(name);
    return SQLITE_OK;
  }
  static int Access(sqlite3_vfs* vfs, const char* name, int, int* out) {
    *out = Disk(vfs)->files_.contains(name) ? 1 : 0;
    return SQLITE_OK;
  }
  static int FullPath(sqlite3_vfs*, const char* name, int n, char* out) {
    sqlite3_snprintf(n, out, "%s", name);
    return SQLITE_OK;
  }
  static int Randomness(sqlite3_vfs*, int n, char* out) {
    std::memset(out, 7, static_cast<std::size_t>(n));
    return n;
  }
  static int Sleep(sqlite3_vfs*, int microseconds) { return microseconds; }
  static int Now(sqlite3_vfs*, double* out) {
    *out = 2461000.5;
    return SQLITE_OK;
  }
  static int LastError(sqlite3_vfs*, int, char*) { return 0; }
};

CrashDisk::CrashDisk(Files files) : initial_(std::move(files)), files_(initial_) {
  char name[64];
  std::snprintf(name, sizeof(name), "crash-disk-%p", static_cast<void*>(this));
  name_ = name;
  vfs_.iVersion = 1;
  vfs_.szOsFile = sizeof(CrashFile);
  vfs_.mxPathname = 512;
  vfs_.zName = name_.c_str();
  vfs_.pAppData = this;
  vfs_.xOpen = CrashVfs::Open;
  vfs_.xDelete = CrashVfs::Delete;
  vfs_.xAccess = CrashVfs::Access;
  vfs_.xFullPathname = CrashVfs::FullPath;
  vfs_.xRandomness = CrashVfs::Randomness;
  vfs_.xSleep = CrashVfs::Sleep;
  vfs_.xCurrentTime = CrashVfs::Now;
  vfs_.xGetLastError = CrashVfs::LastError;
  sqlite3_vfs_register(&vfs_, 0);
}

CrashDisk::~CrashDisk() {
  sqlite3_vfs_unregister(&vfs_);
}

void CrashDisk::FailAt(std::size_t n, int code, bool for_ever) {
  fail_at_ = calls_ + n;
  fail_code_ = code;
  for_ever_ = for_ever;
  has_failed_ = false;
}

int CrashDisk::Count(Operation operation) {
  const std::size_t call = calls_++;
  if (fail_code_ != SQLITE_OK && (call == fail_at_ || (for_ever_ && call > fail_at_))) {
    has_failed_ = true;
    return fail_code_;
  }
  log_.push_back(std::move(operation));
  return SQLITE_OK;
}

CrashDisk::Files CrashDisk::AfterCut(std::size_t n, Unsynced mode, std::uint32_t seed) const {
  std::mt19937 random(seed);
  std::map<std::string, std::size_t> synced;  // operations before this one are on the disk
  std::map<std::string, bool> deleted;
  for (std::size_t i = 0; i < n; ++i) {
    const Operation& operation = log_[i];
    if (operation.kind == Operation::kSync) synced[operation.file] = i + 1;
    // A directory keeps its order: what was deleted before the file was made anew is gone.
    bool& gone = deleted[operation.file];
    if (gone && operation.kind == Operation::kWrite) synced[operation.file] = i;
    gone = operation.kind == Operation::kDelete;
  }
  Files files = initial_;
  std::map<std::string, bool> torn;
  for (std::size_t i = 0; i < n; ++i) {
    const Operation& operation = log_[i];
    const bool unsynced = i >= synced[operation.file];
    bool& stopped = torn[operation.file];  // nothing after the write that the cut went through
    if (unsynced) {
      if (mode == Unsynced::kLost || stopped) continue;
      if (mode == Unsynced::kReordered && random() % 2 == 0) continue;
    }
    if (operation.kind == Operation::kDelete) {
      files.erase(operation.file);
      continue;
    }
    std::vector<std::uint8_t>& bytes = files[operation.file];
    if (operation.kind == Operation::kTruncate) bytes.resize(operation.at);
    if (operation.kind != Operation::kWrite) continue;
    if (bytes.size() < operation.at + operation.bytes.size()) bytes.resize(operation.at + operation.bytes.size());
    for (std::size_t k = 0; k < operation.bytes.size(); ++k) {
      constexpr std::uint64_t kSector = 512;
      const std::uint64_t sector = (operation.at + k) / kSector;
      const bool written = !unsynced || mode != Unsynced::kTorn || (sector * 2654435761U + seed) % 3 != 0;
      if (written) bytes[operation.at + k] = operation.bytes[k];
    }
    stopped = unsynced && mode == Unsynced::kTorn;
  }
  return files;
}

}  // namespace mapweld::test
