// Studies for the tests: YAML text and a scene, written to files of their own.
#pragma once

#include <stdlib.h>  // POSIX: mkdtemp

#include <filesystem>
#include <fstream>
#include <string>

#include "../support/scenes.h"
#include "study/study_file.h"

namespace vibratory_alignment::test {

/// A folder that is gone at the end.
class Folder {
 public:
  Folder() {
    std::string name = std::filesystem::temp_directory_path() / "va_study_XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

/// The study of the text; its scene is `scene_text`, named "scene.yaml".
inline Study study_of(const std::string& text, const std::string& scene_text = plain) {
  static const Folder folder;
  folder.write("scene.yaml", scene_text);
  return load_study(folder.write("study.yaml", "scene: scene.yaml\n" + text),
                    [](const std::string& name) { return std::string(SCENE_DIR) + "/" + name + ".yaml"; });
}

}  // namespace vibratory_alignment::test
