// SPDX-License-Identifier: Apache-2.0
// A folder of its own for one test, gone afterwards, and helpers to look at what throws.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace mapweld::test {

class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mapweld-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TempFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  // Writes a file, with its folders.
  std::filesystem::path Put(std::string_view name, std::string_view text) const {
    const auto path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  // Names of everything below, sorted, folders left out.
  [[nodiscard]] std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) {
      if (!entry.is_directory()) names.push_back(entry.path().lexically_relative(path_).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path path_;
};

// The sentence that `action` throws; empty when it throws none.
template <class Action>
std::string ErrorOf(const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

// The first `size` bytes of a reader's input must give a result or a sentence, for every size.
template <class Reader>
void ExpectErrorForEveryTruncation(const TempFolder& folder, const std::string& name, const std::string& bytes,
                                   std::size_t shortest_valid, const Reader& reader) {
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto path = folder.Put(name, std::string_view(bytes).substr(0, size));
    const std::string error = ErrorOf([&] { reader(path); });
    if (size < shortest_valid) {
      EXPECT_NE(error.find(name), std::string::npos) << size << " of " << bytes.size() << " bytes: '" << error << "'";
    }
  }
}

}  // namespace mapweld::test
