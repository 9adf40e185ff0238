// What a scene means once it is loaded: defaults, effects called for by presence, numbers as text, settings, files.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <locale>
#include <set>

#include "model/scene_loader.h"
#include "model/setting.h"
#include "model/tree_reader.h"
#include "scene_text.h"

namespace vibratory_alignment {
namespace {

using scene_text::full;
using scene_text::least;
using scene_text::load;
using scene_text::TemporaryFile;

TEST(SceneDefaults, WhatIsNotGivenIsNotSimulated) {
  const Scene scene = load(least);
  EXPECT_EQ(scene.units, Units::dimensionless);
  EXPECT_FALSE(scene.scales);
  EXPECT_FALSE(scene.gripper.x.moves);
  EXPECT_TRUE(scene.gripper.y.moves);
  EXPECT_FALSE(scene.gripper.phi.moves);
  EXPECT_FALSE(scene.friction);
  EXPECT_FALSE(scene.base.recovery);
  EXPECT_FALSE(scene.slot.depth);
  EXPECT_TRUE(scene.contacts.edges);
  EXPECT_FALSE(scene.contacts.corners);
  EXPECT_FALSE(scene.contacts.walls);
  EXPECT_FALSE(scene.trial.force_limit);
  EXPECT_FALSE(scene.trial.inserted_depth);
}

TEST(SceneDefaults, AbsentNumbers) {
  const Scene scene = load(least);
  for (const GripperAxis& axis : {scene.gripper.x, scene.gripper.y, scene.gripper.phi}) {
    EXPECT_EQ(axis.damping, 0.0);
    EXPECT_EQ(axis.inertia, 1.0);
  }
  EXPECT_EQ(scene.gripper.y.stiffness, 1.0);
  EXPECT_EQ(scene.gripper.phi.stiffness, 0.0);
  EXPECT_EQ(scene.gripper.anchor_phi, 0.0);
  EXPECT_EQ(scene.base.damping_x, 0.0);
  EXPECT_EQ(scene.base.damping_y, 0.0);
  EXPECT_EQ(scene.weight, 0.0);
  ASSERT_EQ(scene.excitations.size(), 1u);
  EXPECT_EQ(scene.excitations[0].direction, Direction::y);
  EXPECT_EQ(scene.excitations[0].waveform, Waveform::sine);
  EXPECT_EQ(scene.excitations[0].phase, 0.0);
  EXPECT_EQ(scene.initial.x, 0.0);
  EXPECT_EQ(scene.initial.vx, 0.0);
  EXPECT_EQ(scene.initial.vy, 0.0);
  EXPECT_EQ(scene.initial.omega, 0.0);
  EXPECT_EQ(scene.trial.aligned_depth, 0.0);
  EXPECT_EQ(scene.solver.name, "event");
  EXPECT_EQ(scene.solver.tolerance, 1.0e-8);
  EXPECT_FALSE(scene.solver.step);
}

TEST(SceneDefaults, BaseIsAsStiffAcrossAsAlong) {
  EXPECT_EQ(load(least).base.stiffness_x, 2500.0);
  EXPECT_EQ(load(least, {"base.stiffness.x=7"}).base.stiffness_x, 7.0);
}

TEST(SceneDefaults, AnchorStandsAtTheStart) {
  EXPECT_EQ(load(least, {"initial.x=0.3"}).gripper.anchor_x, 0.3);
  EXPECT_EQ(load(least, {"initial.x=0.3", "gripper.anchor.x=0.1"}).gripper.anchor_x, 0.1);
}

TEST(SceneDefaults, NameComesFromTheFile) {
  EXPECT_EQ(load(least).name, "scene");
  EXPECT_EQ(load(least, {"name=other"}).name, "other");
  EXPECT_EQ(load_scene(YAML::Load(least), "/robot/aligner").name, "aligner");
}

TEST(SceneMotion, LateralStiffnessSetsThePartFree) {
  const Scene scene = load(least, {"gripper.stiffness.x=0.05", "gripper.damping.x=0.01", "initial.x=0.2"});
  EXPECT_TRUE(scene.gripper.x.moves);
  EXPECT_EQ(scene.gripper.x.stiffness, 0.05);
  EXPECT_EQ(scene.gripper.x.damping, 0.01);
  EXPECT_EQ(scene.gripper.x.inertia, 1.0);
  EXPECT_TRUE(load(least, {"gripper.stiffness.x=0", "initial.x=0.2"}).gripper.x.moves);
}

TEST(SceneMotion, InertiaLetsThePartTilt) {
  const Scene scene = load(least, {"part.inertia=0.3", "gripper.stiffness.phi=60"});
  EXPECT_TRUE(scene.gripper.phi.moves);
  EXPECT_EQ(scene.gripper.phi.inertia, 0.3);
  EXPECT_EQ(scene.gripper.phi.stiffness, 60.0);
  EXPECT_FALSE(scene.initial.phi) << "left to the static equilibrium";
  EXPECT_FALSE(scene.initial.y);
}

TEST(SceneMotion, LockedMotionKeepsItsKeys) {
  const Scene scene = load(least, {"gripper.stiffness.phi=60", "gripper.damping.phi=1", "gripper.damping.x=2",
                                   "initial.x=-0.2", "initial.phi=0.01", "initial.omega=3"});
  EXPECT_FALSE(scene.gripper.x.moves);
  EXPECT_FALSE(scene.gripper.phi.moves);
  EXPECT_EQ(scene.gripper.phi.stiffness, 60.0);
  EXPECT_EQ(scene.gripper.x.damping, 2.0);
  EXPECT_EQ(scene.initial.x, -0.2);
  EXPECT_EQ(scene.initial.phi, 0.01);
}

TEST(SceneMotion, LockedTiltStandsStraight) { EXPECT_EQ(load(least).initial.phi, 0.0); }

TEST(SceneEffects, PressingForceOrAnchor) {
  EXPECT_EQ(load(least).gripper.pressing_force, 0.2);
  EXPECT_FALSE(load(least).gripper.anchor_y);
  const Scene scene = load(least, {"gripper={anchor: {y: 0.7}}"});
  EXPECT_EQ(scene.gripper.anchor_y, 0.7);
  EXPECT_FALSE(scene.gripper.pressing_force);
}

TEST(SceneEffects, FrictionIsCalledForByItsSection) {
  const Scene dry = load(least, {"friction.coefficient=0.2"});
  ASSERT_TRUE(dry.friction);
  EXPECT_EQ(dry.friction->coefficient, 0.2);
  EXPECT_FALSE(dry.friction->regularization);
  EXPECT_EQ(load(least, {"friction={coefficient: 0.2, regularization: 2e-3}"}).friction->regularization, 2e-3);
}

TEST(SceneEffects, Walls) {
  const Scene scene = load(least, {"contacts=[walls, corners]", "slot.depth=1", "trial.inserted_depth=0.5"});
  EXPECT_FALSE(scene.contacts.edges);
  EXPECT_TRUE(scene.contacts.corners);
  EXPECT_TRUE(scene.contacts.walls);
  EXPECT_EQ(scene.slot.depth, 1.0);
  EXPECT_EQ(scene.trial.inserted_depth, 0.5);
}

// The depth of a slot whose walls are not simulated is kept and not used.
TEST(SceneEffects, DepthWithoutWalls) {
  const Scene scene = load(full, {"contacts=[edges]", "trial.inserted_depth=null", "trial.aligned_depth=1.5"});
  EXPECT_EQ(scene.slot.depth, 1.0);
  EXPECT_FALSE(scene.contacts.walls);
  EXPECT_EQ(scene.trial.aligned_depth, 1.5);
}

TEST(SceneEffects, SeveralExcitations) {
  const Scene scene = load(least, {"excitation=[{amplitude: 1, frequency: 20, phase: 0.5, waveform: square}, "
                                   "{amplitude: -0.1, frequency: 5, direction: x, waveform: triangle}, "
                                   "{amplitude: 2, frequency: 1, direction: phi, waveform: chirp, end_frequency: 9, "
                                   "sweep_time: 4}]"});
  ASSERT_EQ(scene.excitations.size(), 3u);
  EXPECT_EQ(scene.excitations[0].waveform, Waveform::square);
  EXPECT_EQ(scene.excitations[0].phase, 0.5);
  EXPECT_EQ(scene.excitations[1].waveform, Waveform::triangle);
  EXPECT_EQ(scene.excitations[1].direction, Direction::x);
  EXPECT_EQ(scene.excitations[1].amplitude, -0.1);
  EXPECT_EQ(scene.excitations[2].waveform, Waveform::chirp);
  EXPECT_EQ(scene.excitations[2].direction, Direction::phi);
  EXPECT_EQ(scene.excitations[2].end_frequency, 9.0);
  EXPECT_EQ(scene.excitations[2].sweep_time, 4.0);
}

TEST(SceneEffects, Solver) {
  const Scene scene = load(least, {"solver={name: rk4, step: 1e-4, step_limit: 5000}"});
  EXPECT_EQ(scene.solver.name, "rk4");
  EXPECT_EQ(scene.solver.step, 1e-4);
  EXPECT_EQ(scene.solver.step_limit, 5000);
  for (const char* name : {"event", "implicit", "auto"})
    EXPECT_EQ(load(least, {std::string("solver={tolerance: 0.1, name: ") + name + "}"}).solver.tolerance, 0.1);
  for (const char* name : {"rk4", "semi_implicit", "ode"})
    EXPECT_EQ(load(least, {std::string("solver={step: 0.1, name: ") + name + "}"}).solver.step, 0.1);
}

TEST(SceneEffects, RecoveryIsABoolean) {
  for (const char* word : {"true", "True", "yes", "on"})
    EXPECT_TRUE(load(least, {std::string("base.recovery=") + word}).base.recovery) << word;
  for (const char* word : {"false", "FALSE", "no", "off"})
    EXPECT_FALSE(load(least, {std::string("base.recovery=") + word}).base.recovery) << word;
}

TEST(Numbers, TextThatIsANumber) {
  const std::vector<std::pair<const char*, double>> numbers = {
      {"0", 0.0},       {"12", 12.0},    {"-0.5", -0.5},   {"+3", 3.0},
      {".5", 0.5},      {"-.5", -0.5},   {"5.", 5.0},      {"0.1", 0.1},
      {"1.0e4", 1.0e4}, {"5e-3", 5e-3},  {"1E+2", 100.0},  {"1.0e+4", 1.0e4},
      {"0e0", 0.0},     {"0.0e-9", 0.0}, {"1e-99", 1e-99}, {"0.8987614055187875", 0.8987614055187875}};
  for (const auto& [text, value] : numbers) {
    EXPECT_EQ(parse_number(text), value) << text;
    EXPECT_EQ(load(least, {std::string("initial.x=") + text}).initial.x, value) << text;
    EXPECT_EQ(load(least, {std::string("initial.x='") + text + "'"}).initial.x, value) << text << " in quotes";
  }
}

TEST(Numbers, TextThatIsNone) {
  for (const char* text :
       {"",    " ",     " 1",  "1 ",    "0x10", "0b11", "1.0e4abc", "1e",  "1e+", "e5",    ".",        "-",    "+-1",
        "1,5", "1_000", "010", "-00.5", "1:30", "nan",  ".nan",     "NaN", "inf", "-.inf", "Infinity", "true", "1f"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Numbers, TooLargeAndTooSmallOnesAreNeverTakenForOthers) {
  EXPECT_EQ(parse_number("1e999"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("-1e999"), -std::numeric_limits<double>::infinity());
  EXPECT_GT(parse_number("1e-999"), 0.0);
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Numbers, AreIndependentOfTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  EXPECT_EQ(parse_number("0.25"), 0.25);
  EXPECT_EQ(parse_number("1234.5"), 1234.5);
  EXPECT_FALSE(parse_number("0,25"));
  EXPECT_FALSE(parse_number("1.234,5"));
  std::locale::global(before);
}

TEST(Settings, ReplaceAddAndTakeOut) {
  const Scene scene = load(
      least, {"trial.time_limit=7", "friction.coefficient=0.3", "gripper.pressing_force=null", "gripper.anchor.y=0.7"});
  EXPECT_EQ(scene.trial.time_limit, 7.0);
  EXPECT_EQ(scene.friction->coefficient, 0.3);
  EXPECT_FALSE(scene.gripper.pressing_force);
  EXPECT_EQ(scene.gripper.anchor_y, 0.7);
}

TEST(Settings, WhatIsNotThereNeedNotBeTakenOut) {
  for (const char* key : {"friction", "friction.coefficient", "solver.step", "gripper.anchor.y", "part.mass"})
    EXPECT_EQ(scene_text::faults(least, {std::string(key) + "=null"}), std::vector<std::string>()) << key;
  const std::string two = "excitation=[{amplitude: 1, frequency: 2}, {amplitude: 3, frequency: 4}]";
  EXPECT_EQ(scene_text::faults(least, {two, "excitation.1.phase=null"}), std::vector<std::string>());
  const std::string empty_section = least + "\nfriction:\n";
  EXPECT_EQ(scene_text::faults(empty_section, {"friction.coefficient=null"}), scene_text::faults(empty_section));
}

TEST(Settings, TakenOutByAMisspeltNameAreRefusedWithAGuess) {
  YAML::Node tree = YAML::Load(least);
  try {
    apply_setting(tree, "solver.stepp=null");
    ADD_FAILURE() << "was taken";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean solver.step?"), std::string::npos) << error.what();
  }
}

TEST(Settings, ReachIntoLists) {
  const std::string two = "excitation=[{amplitude: 1, frequency: 2}, {amplitude: 3, frequency: 4}]";
  EXPECT_EQ(load(least, {two, "excitation.1.phase=0.5"}).excitations[1].phase, 0.5);
  const Scene one = load(least, {two, "excitation.0=null"});
  ASSERT_EQ(one.excitations.size(), 1u);
  EXPECT_EQ(one.excitations[0].amplitude, 3.0);
}

TEST(Settings, LeaveOtherHandlesAndAliasesAlone) {
  const YAML::Node base = YAML::Load(least);
  YAML::Node variant = base;
  apply_setting(variant, "part.half_width=2");
  EXPECT_EQ(load_scene(base, "").part.half_width, 0.7);
  EXPECT_EQ(load_scene(variant, "").part.half_width, 2.0);

  YAML::Node aliased = YAML::Load(least);
  apply_setting(aliased, "excitation=[&one {amplitude: 1, frequency: 2}, *one]");
  apply_setting(aliased, "excitation.1.frequency=9");
  EXPECT_EQ(load_scene(aliased, "").excitations[0].frequency, 2.0);
  EXPECT_EQ(load_scene(aliased, "").excitations[1].frequency, 9.0);
}

TEST(Settings, ThatMakeNoSenseAreRefused) {
  for (const char* assignment :
       {"", "=", "=1", "part", "part.half_width", "part.half_width=", "part.half_width= ", ".part=1", "part.=1",
        "part..half_width=1", "part.half_width.more=1", "contacts.edges=1", "contacts.1=walls", "contacts.-1=walls",
        "frction=null", "excitation.0.phase=null", "part={", "part=[*none]", "part=&a [*a]"}) {
    YAML::Node tree = YAML::Load(least);
    try {
      apply_setting(tree, assignment);
      ADD_FAILURE() << "'" << assignment << "' was taken";
    } catch (const SceneError& error) {
      EXPECT_EQ(std::string(error.what()).find("--set " + std::string(assignment) + ": "), 0u) << error.what();
    }
  }
}

TEST(SceneFiles, LoadWithSettings) {
  const TemporaryFile file(least);
  EXPECT_EQ(load_scene_file(file.path()).weight, 0.0);
  EXPECT_EQ(load_scene_file(file.path(), {"weight=0.1"}).weight, 0.1);
}

TEST(SceneFiles, ByteOrderMarkAndLineEndsOfOtherSystems) {
  std::string text = "\xef\xbb\xbf";
  for (const char c : least) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(load_scene_file(TemporaryFile(text).path()).part.half_width, 0.7);
}

TEST(ShippedScenes, AllLoadUnderTheirOwnNames) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SCENE_DIR)) {
    if (entry.path().extension() != ".yaml") continue;
    try {
      const Scene scene = load_scene_file(entry.path().string());
      EXPECT_EQ(scene.name, entry.path().stem().string());
      EXPECT_TRUE(scene.scales) << entry.path();
      names.insert(scene.name);
    } catch (const SceneError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  for (const char* name : {"fig2", "fig3", "r1", "r1_dry", "central", "insertion", "gripper_si"})
    EXPECT_EQ(names.count(name), 1u) << name;
}

TEST(ShippedScenes, FiguresHaveThePrintedValuesAndOneMaterial) {
  const Scene fig2 = load_scene_file(SCENE_DIR "/fig2.yaml");
  EXPECT_EQ(fig2.gripper.pressing_force, 0.2);
  EXPECT_EQ(fig2.slot.clearance, 0.09);
  EXPECT_EQ(fig2.excitations.at(0).frequency, 20.0);
  EXPECT_EQ(fig2.initial.x, 0.2);
  EXPECT_EQ(fig2.initial.y, 0.895);
  EXPECT_EQ(fig2.initial.phi, 0.025);

  const Scene fig3 = load_scene_file(SCENE_DIR "/fig3.yaml");
  EXPECT_EQ(fig3.gripper.pressing_force, 0.3);
  EXPECT_EQ(fig3.gripper.phi.stiffness, 60.0);
  EXPECT_EQ(fig3.slot.clearance, 0.02);
  EXPECT_EQ(fig3.excitations.at(0).frequency, 20.0);
  EXPECT_EQ(fig3.initial.x, 0.2);
  EXPECT_EQ(fig3.initial.y, 0.90);
  EXPECT_EQ(fig3.initial.phi, 0.003);

  EXPECT_EQ(fig2.part.half_width, fig3.part.half_width);
  EXPECT_EQ(fig2.part.base_distance, fig3.part.base_distance);
  EXPECT_EQ(fig2.gripper.phi.inertia, fig3.gripper.phi.inertia);
  EXPECT_EQ(fig2.base.stiffness_x, fig3.base.stiffness_x);
  EXPECT_EQ(fig2.base.stiffness_y, fig3.base.stiffness_y);
  EXPECT_EQ(fig2.base.damping_x, fig3.base.damping_x);
  EXPECT_EQ(fig2.base.damping_y, fig3.base.damping_y);
  EXPECT_EQ(fig2.friction->coefficient, fig3.friction->coefficient);
}

TEST(ShippedScenes, ReferenceStartsInBalance) {
  const Scene r1 = load_scene_file(SCENE_DIR "/r1.yaml");
  const double pressing_force = 0.2;
  const double lever = r1.slot_half_width() - r1.initial.x;
  const double phi = pressing_force * lever / r1.gripper.phi.stiffness;
  const double depth = pressing_force / r1.base.stiffness_y;
  const double y = (r1.part.base_distance - depth - lever * std::sin(phi)) / std::cos(phi);
  EXPECT_NEAR(*r1.initial.phi, phi, 1e-17);
  EXPECT_NEAR(*r1.initial.y, y, 4e-16);
  EXPECT_NEAR(*r1.gripper.anchor_y, y - pressing_force, 4e-16);
  EXPECT_EQ(r1.friction->regularization, 2.0e-3);

  Scene dry = load_scene_file(SCENE_DIR "/r1_dry.yaml");
  EXPECT_FALSE(dry.friction->regularization);
  EXPECT_EQ(dry.initial.y, r1.initial.y);
  EXPECT_EQ(dry.gripper.anchor_y, r1.gripper.anchor_y);
}

TEST(ShippedScenes, CentralImpactIsAxialOnly) {
  const Scene central = load_scene_file(SCENE_DIR "/central.yaml");
  EXPECT_FALSE(central.gripper.x.moves);
  EXPECT_FALSE(central.gripper.phi.moves);
  EXPECT_GT(central.initial.x, central.slot.clearance) << "the bottom face must cover an edge";
}

}  // namespace
}  // namespace vibratory_alignment
