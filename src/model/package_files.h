// Finds the files that come with the package: scenes, studies, facts.
#pragma once

#include <stdexcept>
#include <string>

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

}  // namespace vibratory_alignment
