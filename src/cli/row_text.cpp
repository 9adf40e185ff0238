#include "cli/row_text.h"

#include <cmath>
#include <cstdio>

namespace vibratory_alignment {
namespace {

constexpr char kBefore[] = "outcome,mode,duration,end_time,x,y,phi,vx,vy,omega";

struct SpotColumns {
  const char* name;
  TrialRow::Spots<double> TrialRow::*values;
};

constexpr SpotColumns kSpotColumns[] = {
    {"first_impact", &TrialRow::first_impact},
    {"last_impact", &TrialRow::last_impact},
    {"peak_force", &TrialRow::peak_force},
    {"normal_impulse", &TrialRow::normal_impulse},
    {"friction_impulse", &TrialRow::friction_impulse},
    {"impulse_x", &TrialRow::impulse_x},
    {"impulse_y", &TrialRow::impulse_y},
    {"contact_time", &TrialRow::contact_time},
};

/// Text as a cell: with quotation marks where it has a comma or such a mark.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string cell(double value) {
  if (std::isnan(value)) return "";
  if (value == 0.0) return "0";
  // results need all digits nearly always; to look for fewer takes three times as long
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace

std::string row_header(const std::vector<std::string>& varied) {
  std::string line = "trial";
  for (const std::string& name : varied) line += ',' + cell(name);
  line += std::string(",") + kBefore;
  const auto add_spots = [&](const std::string& name) {
    for (int spot = 0; spot < kSpotCount; ++spot) line += ',' + name + '_' + to_string(static_cast<Spot>(spot));
  };
  add_spots("impacts");
  for (const SpotColumns& columns : kSpotColumns) add_spots(columns.name);
  return line + ",reason";
}

std::string row_text(const TrialRow& row, const std::vector<VariedValue>& values) {
  std::string line = std::to_string(row.index);
  for (const VariedValue& value : values) line += ',' + cell(value.text);
  line += std::string(",") + outcome_word(row);
  if (row.refused) {
    // mode, duration, end_time, six of the state, and what there is of every spot
    line.append(9 + kSpotCount * (1 + std::size(kSpotColumns)), ',');
  } else {
    line += std::string(",") + to_string(row.mode);
    const State& end = row.end;
    for (const double value : {row.duration, row.end_time, end.x, end.y, end.phi, end.vx, end.vy, end.omega})
      line += ',' + cell(value);
    for (const long impacts : row.impacts) line += ',' + std::to_string(impacts);
    for (const SpotColumns& columns : kSpotColumns)
      for (const double value : row.*(columns.values)) line += ',' + cell(value);
  }
  return line + ',' + cell(row.reason);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quoted && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  return cells;
}

}  // namespace vibratory_alignment
