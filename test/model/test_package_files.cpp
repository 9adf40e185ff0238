// The names under which the files of a folder are known.
#include "model/package_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace vibratory_alignment {
namespace {

namespace fs = std::filesystem;

/// A folder with empty files, gone at the end.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::vector<std::string>& files)
      : path_(fs::temp_directory_path() / ("package_files_" + std::to_string(::getpid()))) {
    for (const std::string& file : files) {
      fs::create_directories((path_ / file).parent_path());
      std::ofstream(path_ / file).flush();
    }
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

TEST(YamlNames, AreSortedWithThoseInFoldersLast) {
  const TemporaryFolder folder({"r1.yaml", "fig2.yaml", "hard/two.yaml", "hard/one.yaml", "hard/more/a.yaml",
                                "README.md", "fig3.yaml.part", "old.yaml/notes"});
  EXPECT_EQ(yaml_names(folder.path()), (std::vector<std::string>{"fig2", "r1", "hard/one", "hard/two", "hard/more/a"}));
}

std::string refusal(const std::string& name) {
  try {
    find_package_file(kSceneFile, name);
  } catch (const NoSuchFile& error) {
    return error.what();
  }
  return "found";
}

TEST(SceneName, ThatIsMisspeltIsTakenForTheNearestOne) {
  EXPECT_NE(refusal("fig22").find("fig22: no such file"), std::string::npos);
  EXPECT_NE(refusal("fig22").find("did you mean fig2?"), std::string::npos) << refusal("fig22");
  EXPECT_NE(refusal("hard/jaming").find("did you mean hard/jamming?"), std::string::npos) << refusal("hard/jaming");
}

TEST(SceneName, WithoutItsFolderIsTakenForTheOneInIt) {
  EXPECT_NE(refusal("grazing").find("did you mean hard/grazing?"), std::string::npos) << refusal("grazing");
}

TEST(SceneName, LikeNoneIsTakenForNone) {
  EXPECT_EQ(refusal("something_else").find("did you mean"), std::string::npos) << refusal("something_else");
}

TEST(YamlNames, OfNoFolderAreNone) { EXPECT_TRUE(yaml_names("/no/such/folder").empty()); }

}  // namespace
}  // namespace vibratory_alignment
