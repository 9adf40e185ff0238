#include "cli/scene_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <vector>

#include "cli/errors.h"

namespace vibratory_alignment {
namespace {

namespace fs = std::filesystem;

constexpr char kPackage[] = "vibratory_alignment";

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

/// Places where config/ may be, best first: around the executable (install prefix, source tree, devel space),
/// then along ROS_PACKAGE_PATH. A devel space lists its source directories in ".catkin".
std::vector<fs::path> package_directories() {
  std::vector<fs::path> found;
  std::vector<fs::path> roots;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  for (fs::path directory = executable.parent_path(); directory.has_relative_path();
       directory = directory.parent_path()) {
    found.push_back(directory / "share" / kPackage);
    roots.push_back(directory);
    for (const std::string& source : split(read_text(directory / ".catkin"), ';')) roots.emplace_back(source);
  }
  const char* const package_path = std::getenv("ROS_PACKAGE_PATH");
  for (const std::string& item : split(package_path == nullptr ? "" : package_path, ':')) {
    roots.emplace_back(item);
    found.push_back(fs::path(item) / kPackage);
  }
  for (const fs::path& root : roots) {
    for (const fs::path& directory : {root, root / kPackage}) {
      if (is_package(directory)) found.push_back(directory);
    }
  }
  return found;
}

/// A kind of file that comes with the package.
struct Kind {
  const char* folder;    ///< below config/
  const char* singular;  ///< as messages name it
  const char* argument;  ///< on the command line
};

constexpr Kind kScene = {"scenes", "scene", "SCENE"};
constexpr Kind kStudy = {"studies", "study", "STUDY"};
constexpr Kind kFacts = {"paper", "facts file", "--facts"};

/// The first such folder there is; empty when there is none.
fs::path directory_of(const Kind& kind) {
  for (const fs::path& directory : package_directories()) {
    if (is_folder(directory / "config" / kind.folder)) return directory / "config" / kind.folder;
  }
  return {};
}

/// Sorted.
std::vector<std::string> shipped(const Kind& kind) {
  std::vector<std::string> names;
  const fs::path directory = directory_of(kind);
  if (directory.empty()) return names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory, error)) {
    if (entry.path().extension() != ".yaml") continue;
    names.push_back(entry.path().lexically_relative(directory).replace_extension().generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string find(const Kind& kind, const std::string& argument) {
  if (argument.empty()) throw UsageError(std::string(kind.argument) + ": the name is empty");
  if (is_file(argument)) return argument;
  const fs::path directory = directory_of(kind);
  if (!directory.empty() && fs::path(argument).is_relative()) {
    for (const char* suffix : {"", ".yaml"}) {
      const fs::path file = directory / (argument + suffix);
      if (is_file(file)) return file.string();
    }
  }
  const std::string word = kind.singular;
  if (is_folder(argument)) throw UsageError(argument + ": is a directory; a " + word + " is a YAML file");
  std::string message = argument + ": no such file, and no " + word + " of that name comes with the package";
  std::string separator = " (these do: ";
  for (const std::string& name : shipped(kind)) {
    message += separator + name;
    separator = ", ";
  }
  if (separator == ", ") message += ")";
  throw UsageError(message);
}

}  // namespace

std::string find_scene(const std::string& argument) { return find(kScene, argument); }
std::string find_study(const std::string& argument) { return find(kStudy, argument); }
std::string find_facts(const std::string& argument) { return find(kFacts, argument); }

}  // namespace vibratory_alignment
