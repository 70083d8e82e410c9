// SPDX-License-Identifier: Apache-2.0
#include "tools/io/unique_names.hpp"

#include <map>
#include <set>

namespace mapweld::io {
namespace {

namespace fs = std::filesystem;

fs::path Normalized(const fs::path& folder) {
  const fs::path full = fs::absolute(folder.empty() ? fs::path(".") : folder).lexically_normal();
  return full.has_filename() ? full : full.parent_path();  // "run1/" and "." included
}

std::string SafeFileName(std::string safe) {
  for (char& c : safe) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '/' || c == '\\' || u <= ' ' || u == 0x7F) c = '_';
  }
  if (safe.empty() || safe.front() == '.') safe.insert(0, 1, '_');
  return safe;
}

void NumberDoubles(std::vector<std::string>* names) {
  std::set<std::string> taken;
  for (std::string& name : *names) {
    std::string candidate = name;
    for (int n = 2; !taken.insert(candidate).second; ++n) candidate = name + '_' + std::to_string(n);
    name = candidate;
  }
}

}  // namespace

std::vector<std::string> UniqueNames(const std::vector<fs::path>& folders) {
  std::vector<std::string> names;
  std::map<std::string, int> uses;
  for (const fs::path& folder : folders) {
    std::string name = Normalized(folder).filename().string();
    if (name.empty()) name = "root";
    ++uses[name];
    names.push_back(std::move(name));
  }
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const std::string parent = Normalized(folders[i]).parent_path().filename().string();
    if (uses[names[i]] > 1 && !parent.empty()) names[i] = parent + '_' + names[i];
  }
  NumberDoubles(&names);
  return names;
}

std::vector<std::string> UniqueFileNames(const std::vector<std::string>& names) {
  std::vector<std::string> safe;
  for (const std::string& name : names) safe.push_back(SafeFileName(name));
  NumberDoubles(&safe);
  return safe;
}

}  // namespace mapweld::io
