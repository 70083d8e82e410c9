// SPDX-License-Identifier: Apache-2.0
#include "core/base/status.hpp"

namespace mapweld {

const char* StatusName(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kFull:
      return "full";
    case Status::kEmpty:
      return "empty";
    case Status::kOutOfRange:
      return "out of range";
    case Status::kBadInput:
      return "bad input";
    case Status::kStale:
      return "stale";
    case Status::kNotReady:
      return "not ready";
    case Status::kDegenerate:
      return "degenerate";
    case Status::kTimeout:
      return "timeout";
    case Status::kIo:
      return "i/o error";
    case Status::kCrc:
      return "checksum mismatch";
    case Status::kVersion:
      return "wrong version";
  }
  return "unknown";
}

}  // namespace mapweld
