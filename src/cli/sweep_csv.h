// The CSV file of a sweep: grows row by row, survives the end of the process at any moment, and can be continued.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>

#include "cli/output_path.h"
#include "cli/sweep_head.h"

namespace vibratory_alignment {

/// Until it is whole the file is "PATH.part", and stays when the sweep ends early. Devices and pipes are written
/// directly and cannot be continued.
class SweepCsv {
 public:
  using SeeRow = std::function<void(const std::string& line)>;

  /// `header` names the columns. `resume`: hands the rows that PATH.part has of the same sweep, or PATH itself if it is
  /// whole, to `see_row`, cuts off a last line that is torn and continues behind it; a file that is not there is begun.
  /// Throws UsageError: for a file that cannot be written or read, that another process is writing, that is not of this
  /// sweep (`resume`), or that has rows to be lost, also those of another shard (not `resume`).
  SweepCsv(const std::string& path, const SweepHead& head, const std::string& header, bool resume,
           const SeeRow& see_row);
  ~SweepCsv();
  SweepCsv(const SweepCsv&) = delete;
  SweepCsv& operator=(const SweepCsv&) = delete;

  /// A device or pipe.
  bool is_direct() const { return output_.is_direct(); }
  /// Where the rows are now.
  const std::string& file() const { return output_.temporary(); }

  /// Throws OutputError, as the following do.
  void write(const std::string& row);
  /// What has been written survives the end of the process.
  void flush();
  /// All rows are written: the file gets its name.
  void finish();

 private:
  std::string begin() const;
  void begin_anew();
  void begin_or_continue(const std::string& path, bool resume, const SeeRow& see_row);
  void refuse_other_shard(const std::string& path) const;
  void close();
  std::uintmax_t take_over(const std::string& path, const SeeRow& see_row);
  [[noreturn]] void refuse(const std::string& path, const std::string& reason) const;

  OutputPath output_;
  SweepHead head_;
  std::string header_;
  std::FILE* file_ = nullptr;
  std::size_t rows_ = 0;
  bool was_whole_ = false;
};

}  // namespace vibratory_alignment
