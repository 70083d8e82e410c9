// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/boot_epoch.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <limits>

namespace mapweld::spool {
namespace {

constexpr const char* kNewFile = "epoch.new";
constexpr std::size_t kMaxBytes = 16;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    const int why = errno;
    if (fd_ >= 0) (void)::close(fd_);
    errno = why;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool ok() const { return fd_ >= 0; }

 private:
  int fd_;
};

Result<std::int32_t> ReadEpoch(int directory) {
  const Descriptor file(::openat(directory, kEpochFile, O_RDONLY | O_CLOEXEC));
  if (!file.ok()) return errno == ENOENT ? Result<std::int32_t>(0) : Result<std::int32_t>(Status::kIo);
  std::array<char, kMaxBytes> text{};
  const ssize_t got = ::read(file.get(), text.data(), text.size());
  if (got < 0) return Status::kIo;
  std::int32_t epoch = 0;
  const char* last = text.data() + got;
  const auto [end, error] = std::from_chars(text.data(), last, epoch);
  const bool whole = end == last || (end + 1 == last && *end == '\n');
  if (error != std::errc{} || !whole || epoch < 1) return Status::kBadInput;
  return epoch;
}

Status WriteEpoch(int directory, std::int32_t epoch) {
  std::array<char, kMaxBytes> text{};
  char* end = std::to_chars(text.data(), text.data() + text.size(), epoch).ptr;
  *end++ = '\n';
  const auto bytes = static_cast<std::size_t>(end - text.data());
  {
    const Descriptor file(::openat(directory, kNewFile, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (!file.ok() || ::write(file.get(), text.data(), bytes) != static_cast<ssize_t>(bytes)) return Status::kIo;
    if (::fsync(file.get()) != 0) return Status::kIo;
  }
  if (::renameat(directory, kNewFile, directory, kEpochFile) != 0) return Status::kIo;
  return ::fsync(directory) == 0 ? Status::kOk : Status::kIo;
}

}  // namespace

Result<std::int32_t> NextBootEpoch(const char* state_directory) {
  const Descriptor directory(::open(state_directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // The lock makes sure that two agents started at once on one directory do not get the same number.
  if (!directory.ok() || ::flock(directory.get(), LOCK_EX) != 0) return Status::kIo;
  const Result<std::int32_t> last = ReadEpoch(directory.get());
  if (!last.ok()) return last;
  if (last.value() == std::numeric_limits<std::int32_t>::max()) return Status::kOutOfRange;
  const std::int32_t epoch = last.value() + 1;
  if (const Status status = WriteEpoch(directory.get(), epoch); status != Status::kOk) return status;
  return epoch;
}

}  // namespace mapweld::spool
