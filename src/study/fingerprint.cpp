#include "study/fingerprint.h"

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>

#include "model/number_text.h"

namespace vibratory_alignment {
namespace {

YAML::Node described(const VariedKey& key) {
  YAML::Node node;
  node["key"] = key.key_path;
  node["offset"] = key.offset;
  node["logarithmic"] = key.logarithmic;
  node["from"] = number_text(key.from);
  node["to"] = number_text(key.to);
  for (const std::string& value : key.values) node["values"].push_back(value);
  return node;
}

}  // namespace

std::string fingerprint(const Study& study, const std::string& version) {
  YAML::Node all;
  all["version"] = version;
  all["scene"] = YAML::Clone(*study.scene);
  for (const Dimension& dimension : study.dimensions) {
    YAML::Node node;
    node["count"] = dimension.count;
    for (const VariedKey& key : dimension.keys) node["keys"].push_back(described(key));
    all["dimensions"].push_back(node);
  }
  if (study.samples) {
    all["method"] = static_cast<int>(study.samples->method);
    all["count"] = study.samples->count;
    all["seed"] = study.samples->seed;
  }
  return fingerprint(YAML::Dump(all));
}

std::string fingerprint(const std::string& text) {
  return boost::uuids::to_string(boost::uuids::name_generator_sha1(boost::uuids::ns::oid())(text));
}

}  // namespace vibratory_alignment
