// docs/scene.md names the keys that the loader knows: all of them, and no others.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "model/scene_keys.h"
#include "scene_text.h"

namespace vibratory_alignment {
namespace {

using scene_text::faults;
using scene_text::full;
using scene_text::least;
using scene_text::least_si;

std::string page() {
  std::ifstream file(SCENE_PAGE);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The keys in the first column of the page's table.
std::set<std::string> documented_keys() {
  std::set<std::string> keys;
  std::istringstream lines(page());
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    std::istringstream cell(line.substr(1, line.find('|', 1) - 1));
    std::string word;
    while (std::getline(cell, word, '`') && std::getline(cell, word, '`')) keys.insert(word);
  }
  return keys;
}

/// Key paths of all that is no section; of a list, those of its entries.
void collect(const YAML::Node& node, const std::string& path, std::set<std::string>& keys) {
  if (node.IsMap())
    for (const auto& entry : node)
      collect(entry.second, (path.empty() ? "" : path + ".") + entry.first.as<std::string>(), keys);
  else if (node.IsSequence() && node.size() > 0 && node[0].IsMap())
    for (const auto& entry : node) collect(entry, path, keys);
  else
    keys.insert(path);
}

/// With the full dimensionless scene, whose excitation is a chirp, they use every key between them.
const char* const chirp =
    "excitation={amplitude: 1, frequency: 20, phase: 0, waveform: chirp, end_frequency: 30, sweep_time: 1, direction: "
    "y}";
const char* const si = R"(
units: si
part: {mass: 0.1, half_width: 1.0e-3, base_distance: 2.0e-3}
slot: {clearance: 1.0e-4}
gripper: {stiffness: {y: 4000}, anchor: {y: 2.1e-3}}
base: {stiffness: {y: 4.0e+6}}
contacts: [edges]
excitation:
  - {force: 8, frequency: 100}
  - {displacement: 1.0e-4, frequency: 50}
  - {moment: 1.0e-3, frequency: 70, direction: phi}
trial: {time_limit: 0.1}
initial: {y: 2.2e-3}
solver: {accuracy: 1.0e-4}
)";

TEST(ScenePage, names_every_key_of_the_loader) {
  std::set<std::string> keys;
  YAML::Node swept = YAML::Load(full);
  apply_setting(swept, chirp);
  for (const YAML::Node& tree : {swept, YAML::Load(si)}) {
    EXPECT_NO_THROW(load_scene(tree, "scene"));
    collect(tree, "", keys);
  }
  for (const char* other : {"excitation", "solver.step"}) keys.insert(other);
  EXPECT_EQ(documented_keys(), keys);
}

TEST(ScenePage, names_none_that_the_loader_does_not_know) {
  const std::set<std::string> keys = documented_keys();
  ASSERT_GT(keys.size(), 50u);
  for (const std::string& key : keys) {
    int unknown = 0;
    for (const std::string& text : {least, least_si})
      for (const std::string& fault : faults(text, {key + "=?!"}))
        unknown += fault.rfind(key + ": ", 0) == 0 && fault.find("unknown key") != std::string::npos;
    EXPECT_LT(unknown, 2) << key;
  }
}

TEST(ScenePage, names_the_keys_that_can_be_taken_out) {
  std::set<std::string> keys;
  for (std::string key : documented_keys()) {
    keys.insert(key);
    for (std::size_t dot; (dot = key.rfind('.')) != std::string::npos; keys.insert(key)) key.resize(dot);
  }
  EXPECT_EQ(std::set<std::string>(scene_keys().begin(), scene_keys().end()), keys);
}

TEST(ScenePage, shows_a_scene_that_can_be_run) {
  const std::string text = page();
  const std::size_t start = text.find("```yaml\n");
  ASSERT_NE(start, std::string::npos);
  const std::string example = text.substr(start + 8, text.find("```", start + 8) - start - 8);
  EXPECT_EQ(faults(example), std::vector<std::string>());
}

}  // namespace
}  // namespace vibratory_alignment
