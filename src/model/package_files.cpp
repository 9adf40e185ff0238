#include "model/package_files.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "model/nearest_word.h"

namespace vibratory_alignment {
namespace {

namespace fs = std::filesystem;

constexpr char kPackage[] = "vibratory_alignment";

/// Folders that may lie between a folder of sources and a package.
constexpr int kDeepest = 2;

std::string read_text(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !is_folder(path);
}

/// True for the source directory of this package.
bool is_package(const fs::path& directory) {
  return is_file(directory / "package.xml") &&
         read_text(directory / "package.xml").find(std::string("<name>") + kPackage + "</name>") != std::string::npos;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, separator);) {
    if (!item.empty()) items.push_back(item);
  }
  return items;
}

/// Where this package may be.
struct Places {
  std::vector<fs::path> directories;  ///< with config/ in them, best first
  std::vector<fs::path> sources;      ///< folders below which source directories of packages are, anywhere
};

/// Around the executable (install prefix, source tree, devel space), then along ROS_PACKAGE_PATH. A devel space lists
/// its folders of source directories in ".catkin".
Places places() {
  Places found;
  std::vector<fs::path> roots;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  for (fs::path directory = executable.parent_path(); directory.has_relative_path();
       directory = directory.parent_path()) {
    found.directories.push_back(directory / "share" / kPackage);
    roots.push_back(directory);
    for (const std::string& source : split(read_text(directory / ".catkin"), ';')) found.sources.emplace_back(source);
  }
  const char* const package_path = std::getenv("ROS_PACKAGE_PATH");
  for (const std::string& item : split(package_path == nullptr ? "" : package_path, ':')) {
    found.sources.emplace_back(item);
    found.directories.push_back(fs::path(item) / kPackage);
  }
  roots.insert(roots.end(), found.sources.begin(), found.sources.end());
  for (const fs::path& root : roots) {
    for (const fs::path& directory : {root, root / kPackage}) {
      if (is_package(directory)) found.directories.push_back(directory);
    }
  }
  return found;
}

/// This package's source directory, whatever its name, in the folder or so many folders below it; empty when it is not
/// there. Other packages and hidden folders are not looked into.
fs::path package_below(const fs::path& folder, int depth) {
  std::error_code error;
  std::vector<fs::path> children;
  for (fs::directory_iterator child(folder, fs::directory_options::skip_permission_denied, error);
       !error && child != fs::directory_iterator(); child.increment(error))
    if (child->path().filename().string().front() != '.' && is_folder(child->path())) children.push_back(child->path());
  std::sort(children.begin(), children.end());
  for (const fs::path& child : children)
    if (is_package(child)) return child;
  for (const fs::path& child : children) {
    if (depth == 0 || is_file(child / "package.xml")) continue;
    const fs::path found = package_below(child, depth - 1);
    if (!found.empty()) return found;
  }
  return {};
}

/// The first such folder there is; empty when there is none.
fs::path directory_of(const PackageFileKind& kind) {
  const auto config_of = [&](const fs::path& directory) { return directory / "config" / kind.folder; };
  const Places where = places();
  for (const fs::path& directory : where.directories)
    if (is_folder(config_of(directory))) return config_of(directory);
  for (const fs::path& source : where.sources) {
    const fs::path directory = package_below(source, kDeepest);
    if (!directory.empty() && is_folder(config_of(directory))) return config_of(directory);
  }
  return {};
}

/// Names of those in `directory`, the one of this kind.
std::vector<std::string> shipped(const PackageFileKind& kind, const fs::path& directory) {
  if (directory.empty()) return {};
  if (kind.only != nullptr) return {kind.only};
  return yaml_names(directory.string());
}

/// As did_you_mean(); a name may also have been given without its folder: "grazing" is meant for "hard/grazing".
std::string meant_file(const std::string& name, const std::vector<std::string>& names) {
  const std::string whole = did_you_mean(name, names);
  if (!whole.empty()) return whole;
  std::vector<std::string> last_parts;
  for (const std::string& candidate : names) last_parts.push_back(fs::path(candidate).filename().string());
  const std::optional<std::string> last = nearest_word(name, last_parts);
  if (!last) return "";
  const auto place = std::find(last_parts.begin(), last_parts.end(), *last) - last_parts.begin();
  return ", did you mean " + names[static_cast<std::size_t>(place)] + "?";
}

}  // namespace

std::vector<std::string> yaml_names(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != ".yaml" || !is_file(entry->path())) continue;
    names.push_back(entry->path().lexically_relative(folder).replace_extension().generic_string());
  }
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    const auto depth = [](const std::string& name) { return std::count(name.begin(), name.end(), '/'); };
    return std::make_pair(depth(a), a) < std::make_pair(depth(b), b);
  });
  return names;
}

std::string find_package_file(const PackageFileKind& kind, const std::string& name) {
  if (name.empty()) throw NoSuchFile("the name is empty");
  if (is_file(name)) return name;
  const fs::path directory = directory_of(kind);
  if (!directory.empty() && fs::path(name).is_relative()) {
    for (const char* suffix : {"", ".yaml"}) {
      const fs::path file = directory / (name + suffix);
      if (is_file(file)) return file.string();
    }
  }
  const std::string word = kind.singular;
  if (is_folder(name)) throw NoSuchFile(name + ": is a directory; a " + word + " is a YAML file");
  const std::vector<std::string> names = shipped(kind, directory);
  std::string message =
      name + ": no such file, and no " + word + " of that name comes with the package" + meant_file(name, names);
  std::string separator = " (these do: ";
  for (const std::string& candidate : names) {
    message += separator + candidate;
    separator = ", ";
  }
  if (separator == ", ") message += ")";
  throw NoSuchFile(message);
}

}  // namespace vibratory_alignment
