// SPDX-License-Identifier: Apache-2.0
#include "tools/store/fsck.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace mapweld::store {
namespace {

class Checker {
 public:
  explicit Checker(CityStore* store) : store_(store) {}

  FsckReport Run() {
    Step([&] { report_.structure = store_->database().CheckStructure(); });
    Step([&] {
      for (const StoredDrive& drive : store_->Drives()) names_.emplace(drive.key, drive.info.name);
    });
    report_.drives = Check<DriveInfo>(Table::kDrives, [](const Record&, const DriveInfo&) { return ""; });
    report_.keyframes = Check<merge::Keyframe>(Table::kKeyframes, [&](const Record& record, const merge::Keyframe&) {
      keyframes_.insert(record.key);
      return HasDrive(HighOf(record.key)) ? "" : "its drive is not there";
    });
    report_.submaps = Check<merge::SubmapCloud>(Table::kSubmaps, [&](const Record& record, const merge::SubmapCloud&) {
      return HasDrive(HighOf(record.key)) ? "" : "its drive is not there";
    });
    Check<ScanTrajectory>(Table::kTrajectories, [&](const Record& record, const ScanTrajectory&) {
      return HasDrive(record.key) ? "" : "its drive is not there";
    });
    Check<PairRecord>(Table::kPairs, [&](const Record& record, const PairRecord& pair) {
      const bool drives = HasDrive(HighOf(record.key)) && HasDrive(LowOf(record.key));
      if (!drives) return "one of its drives is not there";
      return HasKeyframes(HighOf(record.key), pair.keyframes_a) && HasKeyframes(LowOf(record.key), pair.keyframes_b)
                 ? ""
                 : "keyframes that it saw are not there";
    });
    report_.merges = Check<MergeRecord>(Table::kMerges, [&](const Record&, const MergeRecord& merge) {
      for (std::size_t d = 0; d < merge.drives.size(); ++d) {
        const DriveKey drive = KeyOf(merge.drives[d]);
        if (drive == 0) return "one of its drives is not there";
        if (!HasKeyframes(drive, merge.keyframes[d])) return "keyframes that it placed are not there";
      }
      return "";
    });
    Check<Ruling>(Table::kRulings, [&](const Record&, const Ruling& ruling) {
      const bool drives = KeyOf(ruling.drive_a) != 0 && (ruling.drive_b.empty() || KeyOf(ruling.drive_b) != 0);
      return drives ? "" : "one of its drives is not there";
    });
    return std::move(report_);
  }

 private:
  template <class F>
  void Step(const F& f) {
    try {
      f();
    } catch (const StoreError& error) {
      report_.structure.emplace_back(error.what());
    }
  }

  // Every record of a table; `refers` gives what is wrong with what it names, or nothing.
  template <class T, class Refers>
  std::int64_t Check(Table table, const Refers& refers) {
    std::int64_t good = 0;
    Step([&] {
      store_->database().ForEach(table, INT64_MIN, INT64_MAX, [&](const Record& record) {
        T value;
        if (record.damaged || !Decode(record.body, &value)) {
          report_.damaged.push_back(RecordName(table, record.key, names_));
          return;
        }
        ++good;
        const std::string wrong = refers(record, value);
        if (!wrong.empty()) {
          report_.dangling.push_back(fmt::format("{}: {}", RecordName(table, record.key, names_), wrong));
        }
      });
    });
    return good;
  }

  [[nodiscard]] bool HasDrive(DriveKey drive) const { return names_.contains(drive); }
  [[nodiscard]] DriveKey KeyOf(const std::string& name) const {
    for (const auto& [key, known] : names_) {
      if (known == name) return key;
    }
    return 0;
  }
  [[nodiscard]] bool HasKeyframes(DriveKey drive, std::int32_t count) const {
    const auto first = keyframes_.lower_bound(PairKey(drive, 0));
    const auto last = keyframes_.lower_bound(PairKey(drive, count));
    return std::distance(first, last) == count;
  }

  CityStore* store_;
  FsckReport report_;
  std::map<DriveKey, std::string> names_;
  std::set<std::int64_t> keyframes_;
};

}  // namespace

FsckReport Fsck(CityStore* store) {
  return Checker(store).Run();
}

std::string ToJson(const FsckReport& report) {
  const nlohmann::ordered_json json = {{"clean", report.Clean()},       {"drives", report.drives},
                                       {"keyframes", report.keyframes}, {"submaps", report.submaps},
                                       {"merges", report.merges},       {"structure", report.structure},
                                       {"damaged", report.damaged},     {"dangling", report.dangling}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string ToText(const FsckReport& report, const std::string& path) {
  std::string text;
  for (const std::string& line : report.structure) text += fmt::format("structure: {}\n", line);
  for (const std::string& name : report.damaged) text += fmt::format("damaged:   {}\n", name);
  for (const std::string& name : report.dangling) text += fmt::format("dangling:  {}\n", name);
  const std::size_t problems = report.structure.size() + report.damaged.size() + report.dangling.size();
  text += fmt::format("{}: {} drives, {} keyframes, {} submaps, {} merges; ", path, report.drives, report.keyframes,
                      report.submaps, report.merges);
  text += problems == 0 ? "clean\n" : fmt::format("{} problem{}\n", problems, problems == 1 ? "" : "s");
  return text;
}

}  // namespace mapweld::store
