// What the loader refuses: every row is one mistake in an otherwise good scene and must give exactly one fault, which
// begins with the key path and the value and says what is allowed.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <random>

#include "model/scene_loader.h"
#include "scene_text.h"

namespace vibratory_alignment {
namespace {

using scene_text::faults;
using scene_text::full;
using scene_text::least;
using scene_text::least_si;
using scene_text::TemporaryFile;

struct Mistake {
  const char* setting;
  const char* fault_start;    ///< key path and value
  const char* fault_content;  ///< part of what is allowed
};

std::ostream& operator<<(std::ostream& stream, const Mistake& mistake) { return stream << mistake.setting; }

void expect_one_fault(const std::string& text, const Mistake& mistake) {
  const std::vector<std::string> found = faults(text, {mistake.setting});
  ASSERT_EQ(found.size(), 1u) << mistake.setting << (found.empty() ? " was taken" : ": " + found[0] + " ...");
  EXPECT_EQ(found[0].find(std::string(mistake.fault_start) + ": "), 0u) << found[0];
  EXPECT_NE(found[0].find(mistake.fault_content), std::string::npos) << found[0];
}

TEST(Refusals, TheScenesOfThisTestAreGoodOnes) {
  EXPECT_EQ(faults(full), std::vector<std::string>());
  EXPECT_EQ(faults(least), std::vector<std::string>());
  EXPECT_EQ(faults(least_si), std::vector<std::string>());
}

// --- Each number of a scene ------------------------------------------------------------------------------------------

enum class Allowed { any, not_negative, positive };
struct NumberKey {
  const char* path;
  Allowed allowed;
};

std::ostream& operator<<(std::ostream& stream, const NumberKey& key) { return stream << key.path; }

class EveryNumber : public ::testing::TestWithParam<NumberKey> {
 protected:
  void expect_refused(const std::string& value) const {
    const std::string path = GetParam().path;
    expect_one_fault(full, {(path + "=" + value).c_str(), path.c_str(), "must be"});
  }
};

TEST_P(EveryNumber, MustBeAFiniteNumber) {
  for (const char* value : {".nan", "nan", "NaN", ".inf", "-.inf", "inf", "1e400", "1e101", "1e-101", "1e-400", "true",
                            "''", "0x10", "1.0e4abc", "1 2", "010", "1_0"})
    expect_refused(value);
}

TEST_P(EveryNumber, MustBeAScalar) {
  const std::string path = GetParam().path;
  expect_one_fault(full, {(path + "=[1]").c_str(), (path + ": (a list)").c_str(), "must be"});
  expect_one_fault(full, {(path + "={a: 1}").c_str(), (path + ": (a map)").c_str(), "must be"});
}

TEST_P(EveryNumber, MustBePossible) {
  if (GetParam().allowed == Allowed::any) return;
  expect_refused("-0.1");
  if (GetParam().allowed == Allowed::positive) expect_refused("0");
}

INSTANTIATE_TEST_SUITE_P(
    Refusals, EveryNumber,
    ::testing::Values(
        NumberKey{"scales.mass", Allowed::positive}, NumberKey{"scales.stiffness", Allowed::positive},
        NumberKey{"scales.force", Allowed::positive}, NumberKey{"part.half_width", Allowed::positive},
        NumberKey{"part.base_distance", Allowed::positive}, NumberKey{"part.inertia", Allowed::positive},
        NumberKey{"slot.clearance", Allowed::positive}, NumberKey{"slot.depth", Allowed::positive},
        NumberKey{"gripper.stiffness.x", Allowed::not_negative}, NumberKey{"gripper.stiffness.y", Allowed::positive},
        NumberKey{"gripper.stiffness.phi", Allowed::not_negative},
        NumberKey{"gripper.damping.x", Allowed::not_negative}, NumberKey{"gripper.damping.y", Allowed::not_negative},
        NumberKey{"gripper.damping.phi", Allowed::not_negative}, NumberKey{"gripper.anchor.x", Allowed::any},
        NumberKey{"gripper.anchor.phi", Allowed::any}, NumberKey{"gripper.pressing_force", Allowed::not_negative},
        NumberKey{"base.stiffness.x", Allowed::positive}, NumberKey{"base.stiffness.y", Allowed::positive},
        NumberKey{"base.damping.x", Allowed::not_negative}, NumberKey{"base.damping.y", Allowed::not_negative},
        NumberKey{"friction.coefficient", Allowed::not_negative},
        NumberKey{"friction.regularization", Allowed::positive}, NumberKey{"weight", Allowed::not_negative},
        NumberKey{"excitation.amplitude", Allowed::any}, NumberKey{"excitation.frequency", Allowed::positive},
        NumberKey{"excitation.phase", Allowed::any}, NumberKey{"initial.x", Allowed::any},
        NumberKey{"initial.y", Allowed::any}, NumberKey{"initial.phi", Allowed::any},
        NumberKey{"initial.vx", Allowed::any}, NumberKey{"initial.vy", Allowed::any},
        NumberKey{"initial.omega", Allowed::any}, NumberKey{"trial.time_limit", Allowed::positive},
        NumberKey{"trial.aligned_depth", Allowed::not_negative}, NumberKey{"trial.inserted_depth", Allowed::positive},
        NumberKey{"trial.force_limit", Allowed::positive}, NumberKey{"solver.tolerance", Allowed::positive},
        NumberKey{"solver.step_limit", Allowed::positive}));

// --- Each key that must be there, each section
// ------------------------------------------------------------------------

TEST(Refusals, MissingKeys) {
  for (const char* path :
       {"scales.mass", "scales.stiffness", "scales.force", "part.half_width", "part.base_distance", "slot.clearance",
        "base.stiffness.y", "friction.coefficient", "excitation.amplitude", "excitation.frequency", "initial.x",
        "trial.time_limit", "contacts", "gripper.pressing_force"})
    expect_one_fault(full,
                     {(std::string(path) + "=null").c_str(), (std::string(path) + ": missing").c_str(), "must be"});
}

TEST(Refusals, MissingKeysOfASiScene) {
  for (const char* path : {"part.mass", "gripper.stiffness.y", "excitation.force"})
    expect_one_fault(least_si,
                     {(std::string(path) + "=null").c_str(), (std::string(path) + ": missing").c_str(), "must be"});
}

TEST(Refusals, UnknownKeysInEverySection) {
  for (const char* section :
       {"", "scales.", "part.", "slot.", "gripper.", "gripper.stiffness.", "gripper.damping.", "gripper.anchor.",
        "base.", "base.stiffness.", "base.damping.", "friction.", "excitation.", "initial.", "trial.", "solver."})
    expect_one_fault(full, {(std::string(section) + "colour=red").c_str(),
                            (std::string(section) + "colour: red").c_str(), "unknown key"});
}

TEST(Refusals, SectionsThatAreNone) {
  for (const char* section :
       {"scales", "part", "slot", "gripper.stiffness", "gripper.damping", "gripper.anchor", "base", "base.stiffness",
        "base.damping", "friction", "excitation", "initial", "trial", "solver"}) {
    expect_one_fault(full,
                     {(std::string(section) + "=3").c_str(), (std::string(section) + ": 3").c_str(), "must be a map"});
    expect_one_fault(
        full, {(std::string(section) + "='null'").c_str(), (std::string(section) + ": null").c_str(), "must be a map"});
  }
}

// --- Everything else
// --------------------------------------------------------------------------------------------------

class DimensionlessMistake : public ::testing::TestWithParam<Mistake> {};
TEST_P(DimensionlessMistake, IsOneFault) { expect_one_fault(full, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Words, DimensionlessMistake,
    ::testing::Values(
        Mistake{"units=metric", "units: metric", "dimensionless or si"},
        Mistake{"units=SI", "units: SI", "dimensionless or si"}, Mistake{"name=''", "name: (empty text)", "one line"},
        Mistake{"name=[a]", "name: (a list)", "one line"},
        Mistake{"name=\"two\\nlines\"", "name: two?lines", "one line"},
        Mistake{"base.recovery=1", "base.recovery: 1", "true or false"},
        Mistake{"base.recovery=maybe", "base.recovery: maybe", "true or false"},
        Mistake{"contacts=edges", "contacts: edges", "must be a list"},
        Mistake{"contacts=[]", "contacts: (a list)", "at least one"},
        Mistake{"contacts=[edges, walls, faces]", "contacts.2: faces", "edges, corners or walls"},
        Mistake{"contacts=[edges, walls, edges]", "contacts.2: edges", "twice"},
        Mistake{"contacts=[walls, [edges]]", "contacts.1: (a list)", "edges, corners or walls"},
        Mistake{"excitation.waveform=sinus", "excitation.waveform: sinus", "sine, square, triangle or chirp"},
        Mistake{"excitation.direction=z", "excitation.direction: z", "x, y or phi"},
        Mistake{"solver.name=euler", "solver.name: euler", "event, implicit, rk4, semi_implicit, ode or auto"}));

INSTANTIATE_TEST_SUITE_P(UnitsAndScales, DimensionlessMistake,
                         ::testing::Values(Mistake{"part.mass=0.1", "part.mass: 0.1", "`units: si`"},
                                           Mistake{"gripper.stiffness.y=2", "gripper.stiffness.y: 2", "must be 1"},
                                           Mistake{"excitation.force=8", "excitation.force: 8", "`units: si`"},
                                           Mistake{"excitation.displacement=8", "excitation.displacement: 8",
                                                   "`units: si`"},
                                           Mistake{"excitation.moment=8", "excitation.moment: 8", "`units: si`"}));

INSTANTIATE_TEST_SUITE_P(
    KeysThatGoTogether, DimensionlessMistake,
    ::testing::Values(Mistake{"gripper.anchor.y=0.7", "gripper.pressing_force: 0.2", "exactly one"},
                      Mistake{"excitation.end_frequency=9", "excitation.end_frequency: 9", "chirp"},
                      Mistake{"excitation.sweep_time=9", "excitation.sweep_time: 9", "chirp"},
                      Mistake{"excitation={amplitude: 1, frequency: 2, waveform: chirp, sweep_time: 3}",
                              "excitation.end_frequency: missing", "> 0"},
                      Mistake{"excitation={amplitude: 1, frequency: 2, waveform: chirp, end_frequency: 3}",
                              "excitation.sweep_time: missing", "> 0"},
                      Mistake{"excitation=[]", "excitation: (a list)", "at least one"},
                      Mistake{"excitation=[{amplitude: 1, frequency: 2}, 7]", "excitation.1: 7", "must be a map"},
                      Mistake{"excitation=[{amplitude: 1, frequency: 2}, {amplitude: 1, frequency: -2}]",
                              "excitation.1.frequency: -2", "> 0"},
                      Mistake{"trial.inserted_depth=1.1", "trial.inserted_depth: 1.1", "slot.depth"},
                      Mistake{"trial.aligned_depth=0.95", "trial.aligned_depth: 0.95", "trial.inserted_depth"},
                      Mistake{"solver.tolerance=0.2", "solver.tolerance: 0.2", "<= 0.1"},
                      Mistake{"solver.step=0.1", "solver.step: 0.1", "does not use it"},
                      Mistake{"solver={name: rk4, tolerance: 0.1}", "solver.tolerance: 0.1", "does not use it"},
                      Mistake{"solver={name: rk4, step: 0}", "solver.step: 0", "> 0"},
                      Mistake{"solver.accuracy=1e-6", "solver.accuracy: 1e-6", "one of"},
                      Mistake{"solver={accuracy: 1e-6, step: 0.1}", "solver.step: 0.1", "does not use it"},
                      Mistake{"solver={name: rk4, accuracy: 1e-6}", "solver.accuracy: 1e-6", "no error control"},
                      Mistake{"solver={name: ode, accuracy: 1e-6, step: 1e-3}", "solver.accuracy: 1e-6", "`step`"},
                      Mistake{"solver={accuracy: 0}", "solver.accuracy: 0", "from 1e-9 to 0.1"},
                      Mistake{"solver={accuracy: -1e-6}", "solver.accuracy: -1e-6", "from 1e-9 to 0.1"},
                      Mistake{"solver={accuracy: .nan}", "solver.accuracy: .nan", "from 1e-9 to 0.1"},
                      Mistake{"solver={accuracy: .inf}", "solver.accuracy: .inf", "from 1e-9 to 0.1"},
                      Mistake{"solver={accuracy: 1}", "solver.accuracy: 1", "from 1e-9 to 0.1"},
                      Mistake{"solver={accuracy: 1e-12}", "solver.accuracy: 1e-12", "from 1e-9 to 0.1"},
                      Mistake{"solver={accuracy: high}", "solver.accuracy: high", "from 1e-9 to 0.1"},
                      Mistake{"solver.step_limit=1.5", "solver.step_limit: 1.5", "whole number"}));

TEST(Refusals, InsertedDepthNeedsWalls) {
  expect_one_fault(least, {"trial.inserted_depth=1", "trial.inserted_depth: 1", "walls"});
}

class SiMistake : public ::testing::TestWithParam<Mistake> {};
TEST_P(SiMistake, IsOneFault) { expect_one_fault(least_si, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Refusals, SiMistake,
    ::testing::Values(Mistake{"part.mass=-0.1", "part.mass: -0.1", "must be a number > 0 [kg]"},
                      Mistake{"part.mass=0", "part.mass: 0", "must be a number > 0 [kg]"},
                      Mistake{"part.inertia=0", "part.inertia: 0", "[kg m^2]"},
                      Mistake{"gripper.stiffness.y=0", "gripper.stiffness.y: 0", "must be a number > 0 [N/m]"},
                      Mistake{"gripper.damping.phi=-1", "gripper.damping.phi: -1", "[N m s/rad]"},
                      Mistake{"scales={mass: 1, stiffness: 1, force: 1}", "scales: (a map)", "`units: dimensionless`"},
                      Mistake{"excitation.amplitude=1", "excitation.amplitude: 1", "`units: dimensionless`"},
                      Mistake{"excitation.displacement=1e-3", "excitation.force: 8.0", "exactly one"},
                      Mistake{"excitation.moment=1", "excitation.moment: 1", "direction: phi"},
                      Mistake{"excitation.frequency=0", "excitation.frequency: 0", "[Hz]"},
                      Mistake{"excitation={direction: phi, frequency: 1}", "excitation.moment: missing", "[N m]"},
                      Mistake{"excitation={direction: phi, frequency: 1, moment: 1, force: 2}", "excitation.force: 2",
                              "moment"},
                      Mistake{"excitation={direction: phi, frequency: 1, moment: 1, displacement: 2}",
                              "excitation.displacement: 2", "moment"}));

// --- Several at once, messages, files
// -----------------------------------------------------------------------------------

TEST(Refusals, AllFaultsAtOnce) {
  const std::vector<std::string> found =
      faults(full, {"part.half_width=-1", "slot.clearance=nan", "contacts=[edgs, walls]", "frictoin={coefficient: 1}",
                    "units=imperial", "trial.time_limit=null", "initial.vx=fast"});
  for (const char* start :
       {"part.half_width: -1: ", "slot.clearance: nan: ", "contacts.0: edgs: ", "frictoin: (a map): ",
        "units: imperial: ", "trial.time_limit: missing: ", "initial.vx: fast: "})
    EXPECT_EQ(
        std::count_if(found.begin(), found.end(), [&](const std::string& fault) { return fault.find(start) == 0; }), 1)
        << start;
  EXPECT_EQ(found.size(), 7u) << "one mistake, one fault";
}

TEST(Refusals, MoreExcitationsThanAreSimulated) {
  const auto several = [](int count) {
    std::string list = "excitation=[";
    for (int i = 0; i < count; ++i) list += "{amplitude: 1, frequency: 2}, ";
    return list + "]";
  };
  EXPECT_EQ(faults(least, {several(kMostExcitations)}), std::vector<std::string>());
  EXPECT_EQ(
      faults(least, {several(17), "slot.clearance=0"}),
      (std::vector<std::string>{"slot.clearance: 0: must be a number > 0",
                                "excitation: (a list): must be a map or a list of at most 16 maps; there are 17"}));
}

TEST(Refusals, EmptySceneNamesAllThatIsRequired) {
  const std::vector<std::string> found = faults("{}");
  for (const char* path :
       {"part.half_width", "part.base_distance", "slot.clearance", "base.stiffness.y", "contacts",
        "excitation.frequency", "excitation.amplitude", "gripper.pressing_force", "trial.time_limit"})
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const std::string& fault) {
      return fault.find(std::string(path) + ": missing: ") == 0;
    })) << path;
  EXPECT_EQ(found.size(), 9u);
}

TEST(Refusals, MessageNamesTheSourceOnEveryLine) {
  try {
    load_scene(YAML::Load(least_si + "\nweight: -1\n"), "config/x.yaml");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(), "config/x.yaml: weight: -1: must be a number >= 0 [N]");
  }
  EXPECT_STREQ(SceneError("a.yaml", {"one", "two"}).what(), "a.yaml: one\na.yaml: two");
}

TEST(Refusals, SuggestTheNearestKeyAndListTheKnownOnes) {
  const auto found = faults(least, {"part.halfwidth=1", "part.zzz=1"});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0].find("did you mean half_width?"), std::string::npos) << found[0];
  EXPECT_NE(found[0].find("half_width, base_distance, inertia"), std::string::npos) << found[0];
  EXPECT_EQ(found[1].find("did you mean"), std::string::npos) << found[1];
}

TEST(Refusals, KeysGivenTwiceAndKeysThatAreNoNames) {
  const auto twice = faults(least + "\nweight: 1\nweight: 2\n");
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(twice[0], "weight: 1: is given twice");
  const auto no_name = faults(least + "\n[a, b]: 1\n");
  ASSERT_EQ(no_name.size(), 1u);
  EXPECT_EQ(no_name[0], "(a list): a key must be a name");
}

TEST(Refusals, TreesThatAreNoMap) {
  EXPECT_EQ(faults("[1, 2]").size(), 1u);
  EXPECT_EQ(faults("text").size(), 1u);
  EXPECT_THROW(load_scene(YAML::Node(), "empty"), SceneError);
  const YAML::Node none;
  EXPECT_THROW(load_scene(none["absent"], "absent"), SceneError);
}

TEST(Refusals, LongAndStrangeValuesAreShownOnOneShortLine) {
  const auto found = faults(least, {"weight=\"\\a" + std::string(5000, 'x') + "\""});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(found[0].size(), 200u);
  EXPECT_EQ(found[0].find("weight: ?xxx"), 0u) << found[0];
}

class BadFile : public ::testing::Test {
 protected:
  static void expect_refused(const std::string& path, const std::string& content) {
    try {
      load_scene_file(path);
      ADD_FAILURE() << path << " was taken; should be: " << content;
    } catch (const SceneError& error) {
      EXPECT_EQ(std::string(error.what()).find(path + ": "), 0u) << error.what();
      EXPECT_NE(std::string(error.what()).find(content), std::string::npos) << error.what();
    }
  }
  static void expect_text_refused(const std::string& text, const std::string& content) {
    expect_refused(TemporaryFile(text).path(), content);
  }
};

TEST_F(BadFile, NotAFile) {
  expect_refused("no/such/file.yaml", "no such file");
  expect_refused("", "no such file");
  expect_refused(::testing::TempDir(), "directory");
  expect_refused("/dev/null", "cannot be read");
}

TEST_F(BadFile, Empty) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "---\n", "null\n", "~"})
    expect_text_refused(text, "empty");
}

TEST_F(BadFile, NotYaml) {
  expect_text_refused("part: {half_width: 1\nslot: 2\n", "line ");
  expect_text_refused("a: 1\nb: 2\n\t- c: [\n", "line 3");
  expect_text_refused("a: *nowhere\n", "line 1");
  expect_text_refused(least + "\n---\n" + least, "one YAML document");
  for (const char* stray : {",", ", f\n", "a: 1\n...\n,", "a: {b: 1}\n,"}) expect_text_refused(stray, "YAML");
  expect_text_refused("a: 1\nb: {c:] 2}\n", "line 2: there must be a blank between : and ]");
  for (const char* unfinished : {"{:", "[:", "{a:", "a: {b:", "{# ke\ny{:"}) expect_text_refused(unfinished, "");
}

TEST_F(BadFile, NotText) {
  expect_text_refused(std::string("a\0b", 3), "not text");
  expect_text_refused("name: \xff\xfe\n", "not text");
  expect_text_refused(
      "\x7f"
      "ELF\x01\x02",
      "not text");
  expect_text_refused("name: \xc3", "not text");
}

TEST_F(BadFile, HugeOrDeep) {
  expect_text_refused(std::string(70'000, ' '), "too large");
  expect_text_refused(std::string(60'000, '['), "too large");
  expect_text_refused("a: [" + std::string(3'000, '{'), "");
  std::string dashes, levels;
  for (int i = 0; i < 30'000; ++i) dashes += "- ";
  expect_text_refused(dashes, "too large");
  for (std::size_t i = 0; i < 100; ++i) levels += std::string(i, ' ') + "a:\n";
  expect_text_refused(levels, "nested too deeply");
}

TEST_F(BadFile, AliasesThatContainThemselvesOrExplode) {
  expect_text_refused("part: &a [*a]\n", "nested too deeply");
  expect_text_refused("&a part: &b {half_width: *b}\n", "nested too deeply");
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 15; ++i) {
    const std::string below = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + below;
    for (int j = 0; j < 7; ++j) bomb += ", " + below;
    bomb += "]\n";
  }
  expect_text_refused(bomb, "too large");
}

// Argument: whatever the bytes are, loading ends in a scene or in a SceneError. Anything else (a crash, a hang, another
// exception) fails the test. The mutations keep most of a good scene, so that they reach deep into the loader.
TEST(RandomScenes, LoadOrAreRefused) {
  std::mt19937 random(1);
  const auto below = [&random](std::size_t bound) { return random() % bound; };
  const std::vector<std::string> pieces = {
      ": ",  "- ",    "[",   "]",     "{",        "}",        ",",     "\n",  "&a ", "*a",   "null", "nan",
      "-1",  "0",     "1e9", "'",     "\"",       "#",        "? ",    "!!x", "|",   ">",    "\t",   "x",
      "phi", "---\n", "si",  "1e-99", "\xc3\xa9", "force: 1", "walls", "~",   "<<",  "chirp"};
  int loaded = 0;
  for (int run = 0; run < 1000; ++run) {
    std::string text = run % 2 == 0 ? full : least_si;
    for (std::size_t change = 0, changes = 1 + below(4); change < changes; ++change) {
      const std::size_t at = below(text.size());
      const std::size_t length = std::min(below(12), text.size() - at);
      if (below(3) == 0)
        text.erase(at, length);
      else if (below(2) == 0)
        text.insert(at, pieces[below(pieces.size())]);
      else
        text.insert(at, text.substr(below(text.size()), length));
    }
    try {
      load_scene_file(TemporaryFile(text).path());
      ++loaded;
    } catch (const SceneError& error) {
      EXPECT_FALSE(error.faults().empty());
    }
  }
  EXPECT_GT(loaded, 10) << "harmless mutations exist";
}

}  // namespace
}  // namespace vibratory_alignment
