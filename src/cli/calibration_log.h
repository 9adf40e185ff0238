// What a calibration has looked at, answer by answer, in a file: one that was interrupted goes on from it.
//
// JSON lines: the first names the calibration, each other is an answer (calibration.h). An answer is written as soon as
// it is known, and a line that is torn by the end of the process is written anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/calibration.h"

namespace vibratory_alignment {

class CalibrationLog {
 public:
  /// `fingerprint`: of the calibration. `resume`: reads the answers that the file has and goes on behind them; a file
  /// that is not there is begun. Throws UsageError for a file that cannot be read or written, that another process
  /// writes, that is not of this calibration (`resume`), or that has answers to be lost (not `resume`).
  CalibrationLog(const std::string& path, const std::string& fingerprint, bool resume);

  /// None if the file has not got it. Throws UsageError if it has it for other values.
  std::optional<CalibrationAnswer> known(const CalibrationPlace& place, const std::vector<double>& values) const;

  /// Throws OutputError.
  void keep(const CalibrationPlace& place, const std::vector<double>& values, const CalibrationAnswer& answer);

 private:
  struct Entry {
    std::vector<double> values;
    CalibrationAnswer answer;
  };

  std::uintmax_t take_over(const std::string& fingerprint, bool resume);
  void read_answer(const std::string& line, std::size_t number);
  void write(const std::string& line);

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::map<CalibrationPlace, Entry> known_;
};

}  // namespace vibratory_alignment
