// A private parameter that dynamic_reconfigure overwrites with the setting of its name, but that the node reads when it
// starts: a node that is started again must find what the first one found.
#pragma once

#include <string>

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

namespace vibratory_alignment {

class StartValue {
 public:
  /// Before dynamic_reconfigure's server is made.
  StartValue(const ros::NodeHandle& private_handle, std::string name);
  ~StartValue() { restore(); }
  StartValue(const StartValue&) = delete;
  StartValue& operator=(const StartValue&) = delete;

  /// The server has written the setting, or is about to, as it does when it is made.
  void overwritten() { overwritten_ = true; }

  /// Puts back what was there, also if that was nothing.
  void restore();

 private:
  ros::NodeHandle handle_;
  std::string name_;
  XmlRpc::XmlRpcValue value_;
  bool overwritten_ = true;
};

}  // namespace vibratory_alignment
