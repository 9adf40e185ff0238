#include "node/scene_service.h"

#include <exception>
#include <filesystem>
#include <utility>

#include <ros/package.h>
#include <vibratory_alignment/LoadScene.h>
#include <boost/function.hpp>

#include "model/scene_loader.h"

namespace vibratory_alignment {
namespace {

/// A path that is there, or a scene of the package.
std::string find_scene_file(const std::string& name) {
  if (name.empty()) throw SceneError("~load_scene", {"the name of the scene is empty"});
  if (std::filesystem::is_regular_file(name)) return name;
  const std::filesystem::path folder = std::filesystem::path(ros::package::getPath("vibratory_alignment")) / "config/scenes";
  const std::filesystem::path file = folder / (name + ".yaml");
  if (std::filesystem::is_regular_file(file)) return file.string();
  throw SceneError(name, {"no such file where the node runs, and no scene of that name in " + folder.string()});
}

}  // namespace

ros::ServiceServer advertise_load_scene(ros::NodeHandle private_handle,
                                        std::function<std::string(const Scene&)> put_on) {
  const boost::function<bool(LoadScene::Request&, LoadScene::Response&)> load =
      [put_on = std::move(put_on)](LoadScene::Request& request, LoadScene::Response& response) {
        try {
          response.message = put_on(load_scene_file(find_scene_file(request.scene)));
          response.success = true;
        } catch (const std::exception& error) {
          response.message = error.what();
        }
        return true;
      };
  return private_handle.advertiseService("load_scene", load);
}

}  // namespace vibratory_alignment
