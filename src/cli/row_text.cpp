#include "cli/row_text.h"

#include <cmath>
#include <cstdio>

#include "study/row_numbers.h"

namespace vibratory_alignment {
namespace {

std::string number_cell(double value) {
  if (std::isnan(value)) return "";
  if (value == 0.0) return "0";
  // results need all digits nearly always; to look for fewer takes three times as long
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string row_header(const std::vector<std::string>& varied) {
  std::string line = "trial";
  for (const std::string& name : varied) line += ',' + csv_cell(name);
  line += ",outcome,mode";
  for (const std::string& name : row_number_names()) line += ',' + name;
  return line + ",reason";
}

std::string row_text(const TrialRow& row, const std::vector<VariedValue>& values) {
  std::string line = std::to_string(row.index);
  for (const VariedValue& value : values) line += ',' + csv_cell(value.text);
  line += std::string(",") + outcome_word(row);
  if (row.refused) {
    line.append(1 + row_number_names().size(), ',');  // neither mode nor numbers
  } else {
    line += std::string(",") + to_string(row.mode);
    for (const double number : row_numbers(row)) line += ',' + number_cell(number);
  }
  return line + ',' + csv_cell(row.reason);
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
