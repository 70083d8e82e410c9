// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/record_spool.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "core/base/crc32.hpp"

namespace mapweld::spool {
namespace {

constexpr std::uint32_t kLastUse = 0x7FFF'FFFF;  // never reached; a larger number is not ours

bool ReadAt(int fd, std::span<std::uint8_t> out, std::uint64_t at) {
  return ::pread(fd, out.data(), out.size(), static_cast<off_t>(at)) == static_cast<ssize_t>(out.size());
}

bool WriteAt(int fd, std::span<const std::uint8_t> bytes, std::uint64_t at) {
  return ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(at)) == static_cast<ssize_t>(bytes.size());
}

}  // namespace

void RecordSpool::Close() {
  if (fd_ >= 0) (void)::close(fd_);
  fd_ = -1;
  file_bytes_ = segment_bytes_ = end_ = 0;
  use_ = {};
  active_ = 0;
  index_.clear();
}

Status RecordSpool::Open(const char* path, std::uint64_t bytes) {
  Close();
  const std::uint64_t segment_bytes = bytes / kSegments / 8 * 8;
  if (segment_bytes < SegmentHeader::kBytes + RecordBytes(1) || bytes > kMaxFileBytes) return Status::kOutOfRange;
  file_bytes_ = bytes;
  segment_bytes_ = segment_bytes;
  fd_ = ::open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd_ < 0) return Status::kIo;
  Status status = ::flock(fd_, LOCK_EX | LOCK_NB) == 0 ? Status::kOk : Status::kIo;
  if (status == Status::kOk && !Recover()) status = Start();
  if (status != Status::kOk) {
    const int why = errno;
    Close();
    errno = why;
  }
  return status;
}

// An empty spool. Cutting to nothing first makes the file read as zeros.
Status RecordSpool::Start() {
  use_ = {};
  index_.clear();
  if (::ftruncate(fd_, 0) != 0) return Status::kIo;
  if (const int why = ::posix_fallocate(fd_, 0, static_cast<off_t>(file_bytes_)); why != 0) {
    errno = why;
    return Status::kIo;
  }
  if (::fsync(fd_) != 0) return Status::kIo;  // the size, too
  return BeginSegment(0, 1);
}

// false when there is no segment to go on with.
bool RecordSpool::Recover() {
  struct stat info {};
  if (::fstat(fd_, &info) != 0 || info.st_size != static_cast<off_t>(file_bytes_)) return false;
  std::uint32_t newest = 0;
  for (std::size_t segment = 0; segment < kSegments; ++segment) {
    SegmentHeaderBytes raw;
    SegmentHeader header;
    if (!ReadAt(fd_, raw, Begin(segment)) || DecodeSegmentHeader(raw, &header) != Status::kOk) continue;
    if (header.file_bytes != file_bytes_ || header.use > kLastUse) continue;
    use_[segment] = header.use;
    newest = std::max(newest, header.use);
  }
  for (std::uint32_t done = 0; done < newest; done = use_[active_]) {
    active_ = FirstAfter(done);
    end_ = SegmentHeader::kBytes;
    while (RecoverRecord(use_[active_] == newest)) ++counters_.recovered;
  }
  return newest > 0;
}

// The segment that was begun next after use `done`; there is one.
std::size_t RecordSpool::FirstAfter(std::uint32_t done) const {
  std::size_t first = kSegments;
  for (std::size_t i = 0; i < kSegments; ++i) {
    if (use_[i] > done && (first == kSegments || use_[i] < use_[first])) first = i;
  }
  return first;
}

bool RecordSpool::ContentIsWhole(std::uint64_t at, const RecordHeader& header) const {
  std::uint32_t crc = 0;
  std::array<std::uint8_t, 4096> piece;
  for (std::uint64_t done = 0; done < header.length;) {
    const std::size_t now = std::min<std::uint64_t>(piece.size(), header.length - done);
    if (!ReadAt(fd_, std::span(piece).first(now), at + RecordHeader::kBytes + done)) return false;
    crc = Crc32(std::span(piece).first(now), crc);
    done += now;
  }
  return crc == header.crc;
}

// Takes the record at end_ of the active segment into the index; false at the first place that does not hold a whole
// one.
bool RecordSpool::RecoverRecord(bool may_be_torn) {
  RecordHeaderBytes raw;
  RecordHeader header;
  const std::uint64_t at = Begin(active_) + end_;
  if (Room() < RecordBytes(1) || !ReadAt(fd_, raw, at)) return false;
  if (DecodeRecordHeader(raw, &header) != Status::kOk || header.use != use_[active_]) return false;
  if (header.length == 0 || header.length > kMaxContentBytes || RecordBytes(header.length) > Room()) return false;
  if ((may_be_torn && !ContentIsWhole(at, header)) || !MakeRoomInIndex()) return false;
  Remember(at, header);
  return true;
}

// The segment is empty from now on. What lies in the others is on the disk before, and that this one is empty is before
// anything is written into it: so only the newest segment can hold torn contents, and no old record half overwritten.
Status RecordSpool::BeginSegment(std::size_t segment, std::uint32_t use) {
  const SegmentHeaderBytes header = EncodeSegmentHeader({.use = use, .file_bytes = file_bytes_});
  if (::fdatasync(fd_) != 0) return Status::kIo;
  Forget(segment);
  if (!WriteAt(fd_, header, Begin(segment)) || ::fdatasync(fd_) != 0) return Status::kIo;
  use_[segment] = use;
  active_ = segment;
  end_ = SegmentHeader::kBytes;
  return Status::kOk;
}

void RecordSpool::Forget(std::size_t segment) {
  const auto* kept =
      std::remove_if(index_.begin(), index_.end(), [&](const Entry& entry) { return SegmentOf(entry) == segment; });
  const auto left = static_cast<std::size_t>(kept - index_.begin());
  counters_.given_up += index_.size() - left;
  index_.resize(left);
  use_[segment] = 0;
}

// An empty segment, else the one that was begun first.
std::size_t RecordSpool::Next() const {
  return static_cast<std::size_t>(std::ranges::min_element(use_) - use_.begin());
}

// Gives up the oldest segment when the index is full; false when the active one alone fills it.
bool RecordSpool::MakeRoomInIndex() {
  if (!index_.full()) return true;
  const std::size_t oldest = SegmentOf(index_[0]);
  if (oldest == active_) return false;
  Forget(oldest);
  return true;
}

void RecordSpool::Remember(std::uint64_t at, const RecordHeader& header) {
  end_ += RecordBytes(header.length);
  (void)index_.TryPush({.epoch = header.epoch,
                        .index = header.index,
                        .offset8 = static_cast<std::uint32_t>(at / 8),
                        .length_kind = header.length << 8U | header.kind});
}

Status RecordSpool::Append(const Key& key, std::span<const std::uint8_t> content) {
  if (fd_ < 0) return Status::kIo;
  if (content.empty()) return Status::kOutOfRange;
  const bool too_large =
      content.size() > kMaxContentBytes || SegmentHeader::kBytes + RecordBytes(content.size()) > segment_bytes_;
  if (too_large || !MakeRoomInIndex()) {
    ++counters_.full;
    return Status::kFull;
  }
  if (RecordBytes(content.size()) > Room()) {
    if (const Status status = BeginSegment(Next(), use_[active_] + 1); status != Status::kOk) {
      ++counters_.io_errors;
      return status;
    }
  }
  const RecordHeader header{.use = use_[active_],
                            .kind = key.kind,
                            .index = key.index,
                            .epoch = key.epoch,
                            .length = static_cast<std::uint32_t>(content.size()),
                            .crc = Crc32(content)};
  RecordHeaderBytes raw = EncodeRecordHeader(header);
  // pwritev does not write through these pointers; the interface is older than const.
  const std::array<iovec, 2> iov{{{.iov_base = raw.data(), .iov_len = raw.size()},
                                  {.iov_base = const_cast<std::uint8_t*>(content.data()), .iov_len = content.size()}}};
  const auto bytes = static_cast<ssize_t>(raw.size() + content.size());
  const std::uint64_t at = Begin(active_) + end_;
  if (::pwritev(fd_, iov.data(), static_cast<int>(iov.size()), static_cast<off_t>(at)) != bytes) {
    ++counters_.io_errors;
    return Status::kIo;
  }
  Remember(at, header);
  ++counters_.appended;
  counters_.appended_bytes += content.size();
  return Status::kOk;
}

// From the newest to the oldest, so that a repeated key gives its last record.
const RecordSpool::Entry* RecordSpool::Find(const Key& key) const {
  for (std::size_t i = index_.size(); i > 0; --i) {
    if (index_[i - 1].key() == key) return &index_[i - 1];
  }
  return nullptr;
}

Status RecordSpool::LastBefore(std::int32_t epoch, std::uint8_t kind, Key* last) const {
  bool found = false;
  for (const Entry& entry : index_) {
    const Key key = entry.key();
    if (key.kind != kind || key.epoch >= epoch) continue;
    if (found && (key.epoch < last->epoch || (key.epoch == last->epoch && key.index <= last->index))) continue;
    *last = key;
    found = true;
  }
  return found ? Status::kOk : Status::kEmpty;
}

Result<std::size_t> RecordSpool::Read(const Key& key, std::span<std::uint8_t> out) {
  const Entry* entry = Find(key);
  if (entry == nullptr) return Status::kEmpty;
  if (out.size() < entry->length()) return Status::kFull;
  const std::uint64_t at = std::uint64_t{entry->offset8} * 8;
  const std::span<std::uint8_t> content = out.first(entry->length());
  RecordHeaderBytes raw;
  RecordHeader header;
  if (!ReadAt(fd_, raw, at) || !ReadAt(fd_, content, at + RecordHeader::kBytes)) {
    ++counters_.io_errors;
    return Status::kIo;
  }
  const bool whole = DecodeRecordHeader(raw, &header) == Status::kOk &&
                     Key{header.epoch, header.kind, header.index} == key && header.length == entry->length() &&
                     Crc32(content) == header.crc;
  if (!whole) {
    ++counters_.crc_errors;
    return Status::kCrc;
  }
  return content.size();
}

Status RecordSpool::Sync() {
  if (fd_ >= 0 && ::fdatasync(fd_) == 0) return Status::kOk;
  ++counters_.io_errors;
  return Status::kIo;
}

}  // namespace mapweld::spool
