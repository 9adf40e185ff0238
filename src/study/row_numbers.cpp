#include "study/row_numbers.h"

namespace vibratory_alignment {
namespace {

/// A quantity of a trial, and of each spot of it.
struct TrialQuantity {
  const char* name;
  double (*value)(const TrialRow& row);
};
struct SpotQuantity {
  const char* name;
  double (*value)(const TrialRow& row, std::size_t spot);
};

constexpr TrialQuantity kTrialQuantities[] = {
    {"duration", [](const TrialRow& r) { return r.duration; }},
    {"end_time", [](const TrialRow& r) { return r.end_time; }},
    {"nonimpact_time", [](const TrialRow& r) { return r.nonimpact_time; }},
    {"x", [](const TrialRow& r) { return r.end.x; }},
    {"y", [](const TrialRow& r) { return r.end.y; }},
    {"phi", [](const TrialRow& r) { return r.end.phi; }},
    {"vx", [](const TrialRow& r) { return r.end.vx; }},
    {"vy", [](const TrialRow& r) { return r.end.vy; }},
    {"omega", [](const TrialRow& r) { return r.end.omega; }},
};

constexpr SpotQuantity kSpotQuantities[] = {
    {"impacts", [](const TrialRow& r, std::size_t s) { return static_cast<double>(r.impacts[s]); }},
    {"first_impact", [](const TrialRow& r, std::size_t s) { return r.first_impact[s]; }},
    {"last_impact", [](const TrialRow& r, std::size_t s) { return r.last_impact[s]; }},
    {"peak_force", [](const TrialRow& r, std::size_t s) { return r.peak_force[s]; }},
    {"normal_impulse", [](const TrialRow& r, std::size_t s) { return r.normal_impulse[s]; }},
    {"friction_impulse", [](const TrialRow& r, std::size_t s) { return r.friction_impulse[s]; }},
    {"impulse_x", [](const TrialRow& r, std::size_t s) { return r.impulse_x[s]; }},
    {"impulse_y", [](const TrialRow& r, std::size_t s) { return r.impulse_y[s]; }},
    {"contact_time", [](const TrialRow& r, std::size_t s) { return r.contact_time[s]; }},
};

}  // namespace

const std::vector<std::string>& row_number_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const TrialQuantity& quantity : kTrialQuantities) all.emplace_back(quantity.name);
    for (const SpotQuantity& quantity : kSpotQuantities)
      for (int spot = 0; spot < kSpotCount; ++spot)
        all.push_back(std::string(quantity.name) + '_' + to_string(static_cast<Spot>(spot)));
    return all;
  }();
  return names;
}

std::vector<double> row_numbers(const TrialRow& row) {
  std::vector<double> numbers;
  numbers.reserve(row_number_names().size());
  for (const TrialQuantity& quantity : kTrialQuantities) numbers.push_back(quantity.value(row));
  for (const SpotQuantity& quantity : kSpotQuantities)
    for (std::size_t spot = 0; spot < kSpotCount; ++spot) numbers.push_back(quantity.value(row, spot));
  return numbers;
}

}  // namespace vibratory_alignment
