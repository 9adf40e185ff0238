#include "model/yaml_file.h"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace vibratory_alignment {
namespace {

// A scene is some 50 lines and 4 levels deep; these bounds keep hostile files from exhausting stack and time.
constexpr std::size_t most_bytes = 64 * 1024;
constexpr std::size_t most_marks = 4000;
constexpr int most_levels = 20;
constexpr int most_nodes = 20'000;

/// Upper bound of the depth to which yaml-cpp recurses: the marks that can open a level. (Its own guard is as late as
/// 0.7.)
std::size_t count_marks(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool before_blank = i + 1 == text.size() || std::isspace(static_cast<unsigned char>(text[i + 1])) != 0;
    if (c == '[' || c == '{' || (before_blank && (c == '-' || c == '?' || c == ':'))) ++count;
  }
  return count;
}

/// False if the tree contains itself, or grows huge, by way of aliases.
bool has_sane_extent(const YAML::Node& node, int levels_left, int& nodes_left) {
  if (levels_left == 0 || --nodes_left < 0) return false;
  for (const auto& entry : node) {
    if (node.IsSequence()) {
      if (!has_sane_extent(entry, levels_left - 1, nodes_left)) return false;
    } else if (!has_sane_extent(entry.first, levels_left - 1, nodes_left) ||
               !has_sane_extent(entry.second, levels_left - 1, nodes_left)) {
      return false;
    }
  }
  return true;
}

/// Counts documents up to 2, and nothing else. YAML::LoadAll cannot be asked: stray text makes it fill the memory.
class DocumentCounter : public YAML::EventHandler {
 public:
  explicit DocumentCounter(const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (count_ < 2 && parser.HandleNextDocument(*this)) ++count_;
  }
  int count() const { return count_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  int count_ = 0;
};

}  // namespace

bool is_text(const std::string& bytes) {
  std::size_t continuation_bytes = 0;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (continuation_bytes > 0) {
      if ((byte & 0xc0) != 0x80) return false;
      --continuation_bytes;
    } else if (byte < 0x20 || byte == 0x7f) {
      if (c != '\t' && c != '\n' && c != '\r') return false;
    } else if (byte >= 0x80) {
      if (byte < 0xc2 || byte > 0xf4) return false;
      continuation_bytes = byte < 0xe0 ? 1 : byte < 0xf0 ? 2 : 3;
    }
  }
  return continuation_bytes == 0;
}

YAML::Node parse_yaml(const std::string& text, const std::string& source) {
  if (text.size() > most_bytes) throw SceneError(source, {"is too large: at most 64 KiB are read"});
  if (!is_text(text)) throw SceneError(source, {"is not text (UTF-8)"});
  if (count_marks(text) > most_marks)
    throw SceneError(
        source, {"is too large: at most " + std::to_string(most_marks) + " keys, list entries and brackets are read"});
  // yaml-cpp 0.6 hangs on these, and on a colon at the very end
  const std::size_t hangs = text.find(":]");
  if (hangs != std::string::npos)
    throw SceneError(source, {"line " + std::to_string(1 + std::count(text.begin(), text.begin() + hangs, '\n')) +
                              ": there must be a blank between : and ]"});
  YAML::Node tree;
  int documents = 0;
  try {
    documents = DocumentCounter(text + "\n").count();
    if (documents == 1) tree.reset(YAML::Load(text + "\n"));
  } catch (const YAML::Exception& error) {
    const std::string place = error.mark.is_null() ? ""
                                                   : "line " + std::to_string(error.mark.line + 1) + ", column " +
                                                         std::to_string(error.mark.column + 1) + ": ";
    throw SceneError(source, {place + "is not YAML: " + error.msg});
  }
  if (documents == 0) throw SceneError(source, {"is empty"});
  if (documents > 1) throw SceneError(source, {"must be one YAML document, with nothing before or after it"});
  int nodes_left = most_nodes;
  if (!has_sane_extent(tree, most_levels, nodes_left))
    throw SceneError(source, {"is nested too deeply or too large (an alias inside what it stands for?)"});
  return tree;
}

YAML::Node read_yaml_file(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw SceneError(path, {"there is no such file"});
  if (std::filesystem::is_directory(status)) throw SceneError(path, {"is a directory: name a file in it"});
  if (!std::filesystem::is_regular_file(status)) throw SceneError(path, {"cannot be read: is not a regular file"});
  std::ifstream file(path, std::ios::binary);
  if (!file) throw SceneError(path, {"cannot be read"});
  std::string text(most_bytes + 1, '\0');
  file.read(&text[0], static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw SceneError(path, {"cannot be read"});
  text.resize(static_cast<std::size_t>(file.gcount()));
  const YAML::Node tree = parse_yaml(text, path);
  if (tree.IsNull()) throw SceneError(path, {"is empty"});
  return tree;
}

}  // namespace vibratory_alignment
