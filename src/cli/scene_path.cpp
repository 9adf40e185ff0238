#include "cli/scene_path.h"

#include "cli/errors.h"
#include "model/package_files.h"

namespace vibratory_alignment {
namespace {

/// `option`: what the file is on the command line.
std::string find(const PackageFileKind& kind, const std::string& argument, const std::string& option) {
  try {
    return find_package_file(kind, argument);
  } catch (const NoSuchFile& error) {
    throw UsageError(argument.empty() ? option + ": " + error.what() : error.what());
  }
}

}  // namespace

std::string find_scene(const std::string& argument) { return find(kSceneFile, argument, "SCENE"); }
std::string find_study(const std::string& argument) { return find(kStudyFile, argument, "STUDY"); }
std::string find_facts(const std::string& argument) { return find(kFactsFile, argument, "--facts"); }

}  // namespace vibratory_alignment
