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

TEST(YamlNames, OfNoFolderAreNone) { EXPECT_TRUE(yaml_names("/no/such/folder").empty()); }

}  // namespace
}  // namespace vibratory_alignment
