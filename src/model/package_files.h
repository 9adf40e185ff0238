// Finds the files that come with the package: scenes, studies, facts.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace vibratory_alignment {

/// A kind of file that comes with the package.
struct PackageFileKind {
  const char* folder;          ///< below config/
  const char* singular;        ///< as messages name it
  const char* only = nullptr;  ///< the one file of the kind, where the folder has others
};

constexpr PackageFileKind kSceneFile = {"scenes", "scene"};
constexpr PackageFileKind kStudyFile = {"studies", "study"};
constexpr PackageFileKind kFactsFile = {"paper", "facts file", "facts"};

/// what() is the message for the user.
class NoSuchFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The file that `name` means: a path to an existing file, or the name of a file of that kind that comes with the
/// package ("fig2", "hard/grazing", with or without ".yaml"). Throws NoSuchFile, with the names there are, if it is
/// neither.
std::string find_package_file(const PackageFileKind& kind, const std::string& name);

/// The YAML files in the folder and below it, as find_package_file() takes their names: sorted, without ".yaml", those
/// in folders ("hard/grazing") last. None where there is no such folder.
std::vector<std::string> yaml_names(const std::string& folder);

}  // namespace vibratory_alignment
