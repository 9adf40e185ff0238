// The parameter server's tree as YAML: the same scene as from a file, to the last bit.
#include <limits>

#include <gtest/gtest.h>

#include "model/scene_loader.h"
#include "model/yaml_file.h"
#include "node/scene_from_params.h"
#include "small_scene.h"

namespace vibratory_alignment {
namespace {

using XmlRpc::XmlRpcValue;

/// The tree as roslaunch puts it on the server: numbers and words with their types.
XmlRpcValue to_params(const YAML::Node& node) {
  XmlRpcValue value;
  if (node.IsMap()) {
    for (const auto& entry : node) value[entry.first.as<std::string>()] = to_params(entry.second);
  } else if (node.IsSequence()) {
    value.setSize(static_cast<int>(node.size()));
    for (std::size_t i = 0; i < node.size(); ++i) value[static_cast<int>(i)] = to_params(node[i]);
  } else {
    double number = 0.0;
    value = YAML::convert<double>::decode(node, number) ? XmlRpcValue(number) : XmlRpcValue(node.as<std::string>());
  }
  return value;
}

TEST(SceneFromParams, IsTheSceneOfTheFile) {
  XmlRpcValue params = to_params(read_yaml_file(small_scene::si_path));
  const Scene scene = load_scene(to_yaml(params), "/aligner/scene");
  const Scene expected = small_scene::load(small_scene::si_path);
  EXPECT_EQ(scene.name, expected.name);
  EXPECT_EQ(scene.part.half_width, expected.part.half_width);
  EXPECT_EQ(scene.gripper.phi.inertia, expected.gripper.phi.inertia);
  EXPECT_EQ(scene.gripper.pressing_force, expected.gripper.pressing_force);
  EXPECT_EQ(scene.base.stiffness_y, expected.base.stiffness_y);
  EXPECT_EQ(scene.excitations[0].frequency, expected.excitations[0].frequency);
  EXPECT_TRUE(scene.contacts.edges);
  EXPECT_FALSE(scene.contacts.corners);
}

TEST(SceneFromParams, NumbersKeepEveryDigit) {
  for (const double number : {0.1, 1.0 / 3.0, 1e-300, 123456789.123456789}) {
    XmlRpcValue value(number);
    EXPECT_EQ(to_yaml(value).as<double>(), number);
  }
}

TEST(SceneFromParams, TypesAreKept) {
  XmlRpcValue flag(true), whole(7), text(std::string("1.0e4"));
  EXPECT_TRUE(to_yaml(flag).as<bool>());
  EXPECT_EQ(to_yaml(whole).as<int>(), 7);
  EXPECT_EQ(to_yaml(text).as<double>(), 1e4) << "PyYAML takes this number for text";
}

TEST(SceneFromParams, AccuracyChoosesTheSolver) {
  XmlRpcValue params = to_params(read_yaml_file(small_scene::path));
  XmlRpcValue solver;
  solver["accuracy"] = 1e-6;
  params["solver"] = solver;
  const Scene scene = load_scene(to_yaml(params), "/aligner/scene");
  EXPECT_EQ(scene.solver.accuracy, 1e-6);
  EXPECT_EQ(scene.solver.tolerance, 1e-8);
}

TEST(SceneFromParams, NanAndInfinityReachTheLoaderAndAreRefused) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    XmlRpcValue params = to_params(read_yaml_file(small_scene::path));
    params["part"]["half_width"] = bad;
    try {
      load_scene(to_yaml(params), "/aligner/scene");
      FAIL() << "must be refused";
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find("/aligner/scene: part.half_width"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace vibratory_alignment
