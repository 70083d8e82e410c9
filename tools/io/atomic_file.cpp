// SPDX-License-Identifier: Apache-2.0
#include "tools/io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>

namespace mapweld::io {
namespace {

constexpr std::size_t kBufferBytes = 256U << 10U;

const char* Remedy(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another output folder";
    case EFBIG:
      return "raise the limit on file sizes (ulimit -f) or choose another file system";
    case ENOENT:
    case ENOTDIR:
      return "create the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to";
    case EISDIR:
      return "name a file, not a folder";
    default:
      return "check the disk and try again";
  }
}

// The file behind a chain of links, so that writing through a link replaces the file and keeps the link.
std::filesystem::path ResolveLinks(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  auto resolved = std::filesystem::canonical(path, error);
  return error ? path : resolved;
}

// The temporaries that exist now.
std::mutex g_temporaries_mutex;
std::set<std::filesystem::path> g_temporaries;

bool IsDevice(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(ResolveLinks(target)) {
  if (std::filesystem::is_directory(target_)) Fail(EISDIR);
  if (IsDevice(target_)) {
    written_ = target_;
    fd_ = ::open(written_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    const std::lock_guard lock(g_temporaries_mutex);
    // O_EXCL with the next free number: two writers of one target never share a temporary.
    for (int attempt = 0; attempt < 1000; ++attempt) {
      written_ = target_;
      written_ += fmt::format(".partial-{}-{}", ::getpid(), attempt);
      fd_ = ::open(written_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd_ >= 0 || errno != EEXIST) break;
    }
    if (fd_ >= 0) g_temporaries.insert(written_);
  }
  if (fd_ < 0) Fail(errno);
  buffer_.reserve(kBufferBytes);
}

AtomicFile::~AtomicFile() {
  Abandon();
}

void AtomicFile::Abandon() {
  if (fd_ < 0) return;
  ::close(fd_);
  fd_ = -1;
  if (written_ == target_) return;
  const std::lock_guard lock(g_temporaries_mutex);
  g_temporaries.erase(written_);
  ::unlink(written_.c_str());
}

void AtomicFile::RemoveTemporaries() {
  g_temporaries_mutex.lock();  // for good
  for (const std::filesystem::path& temporary : g_temporaries) ::unlink(temporary.c_str());
}

void AtomicFile::Fail(int error) {
  Abandon();
  throw std::runtime_error(
      fmt::format("cannot write {}: {}; {}", target_.string(), std::generic_category().message(error), Remedy(error)));
}

void AtomicFile::Write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferBytes) Flush();
}

void AtomicFile::Write(std::span<const std::uint8_t> bytes) {
  Write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void AtomicFile::Flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t n = ::write(fd_, rest.data(), rest.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) Fail(errno);
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
  buffer_.clear();
}

void AtomicFile::Commit() {
  Flush();
  const bool device = written_ == target_;
  if (!device && ::fsync(fd_) != 0) Fail(errno);
  const int fd = fd_;
  fd_ = -1;
  const std::lock_guard lock(g_temporaries_mutex);
  g_temporaries.erase(written_);
  // Network file systems report a full disk only here. The descriptor is gone either way.
  const bool closed = ::close(fd) == 0;
  if (closed && (device || ::rename(written_.c_str(), target_.c_str()) == 0)) return;
  const int error = errno;
  if (!device) ::unlink(written_.c_str());
  Fail(error);
}

void WriteFileAtomically(const std::filesystem::path& target, std::string_view text) {
  AtomicFile file(target);
  file.Write(text);
  file.Commit();
}

}  // namespace mapweld::io
