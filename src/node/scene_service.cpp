#include "node/scene_service.h"

#include <exception>
#include <utility>

#include <vibratory_alignment/LoadScene.h>
#include <boost/function.hpp>

#include "model/package_files.h"
#include "model/scene_loader.h"

namespace vibratory_alignment {

ros::ServiceServer advertise_load_scene(ros::NodeHandle private_handle,
                                        std::function<std::string(const Scene&)> put_on) {
  const boost::function<bool(LoadScene::Request&, LoadScene::Response&)> load =
      [put_on = std::move(put_on)](LoadScene::Request& request, LoadScene::Response& response) {
        try {
          response.message = put_on(load_scene_file(find_package_file(kSceneFile, request.scene)));
          response.success = true;
        } catch (const std::exception& error) {
          response.message = error.what();
        }
        return true;
      };
  return private_handle.advertiseService("load_scene", load);
}

}  // namespace vibratory_alignment
