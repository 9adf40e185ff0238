#include "node/scene_from_params.h"

#include <cmath>
#include <cstdio>

#include "model/scene_loader.h"

namespace vibratory_alignment {
namespace {

YAML::Node number(double value) {
  if (std::isnan(value)) return YAML::Node(".nan");
  if (std::isinf(value)) return YAML::Node(value > 0.0 ? ".inf" : "-.inf");
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return YAML::Node(text);
}

}  // namespace

YAML::Node to_yaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& [key, entry] : value) map[key] = to_yaml(entry);
      return map;
    }
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) list.push_back(to_yaml(value[i]));
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeBoolean: return YAML::Node(static_cast<bool>(value) ? "true" : "false");
    case XmlRpc::XmlRpcValue::TypeInt: return YAML::Node(std::to_string(static_cast<int>(value)));
    case XmlRpc::XmlRpcValue::TypeDouble: return number(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString: return YAML::Node(static_cast<std::string>(value));
    default: return YAML::Node();  // date, binary: null, which no key allows
  }
}

Scene scene_from_params(const ros::NodeHandle& private_handle) {
  const std::string tree_name = private_handle.resolveName("scene");
  const std::string file_name = private_handle.resolveName("scene_file");
  const bool has_tree = private_handle.hasParam("scene");
  const bool has_file = private_handle.hasParam("scene_file");
  if (has_tree && has_file) {
    throw SceneError(tree_name, {"both " + tree_name + " and " + file_name + " are set: delete one (rosparam delete)"});
  }
  if (has_file) {
    std::string path;
    if (!private_handle.getParam("scene_file", path) || path.empty())
      throw SceneError(file_name, {"must be the path of a scene file"});
    return load_scene_file(path);
  }
  if (!has_tree) {
    throw SceneError(tree_name, {"no scene, or an empty file was loaded: load one with `rosparam load SCENE.yaml " +
                                 tree_name + "` or set the parameter " + file_name + " to the path of one"});
  }
  XmlRpc::XmlRpcValue tree;
  private_handle.getParam("scene", tree);
  return load_scene(to_yaml(tree), tree_name);
}

}  // namespace vibratory_alignment
