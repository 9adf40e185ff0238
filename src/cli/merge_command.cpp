#include "cli/merge_command.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/counted.h"
#include "cli/errors.h"
#include "cli/interrupt.h"
#include "cli/output_path.h"
#include "cli/output_roles.h"
#include "cli/row_text.h"
#include "cli/sweep_head.h"
#include "cli/whole_file.h"
#include "cli/whole_lines.h"

namespace vibratory_alignment {
namespace {

constexpr char kMergeFooter[] = R"(Examples:
  align sweep map --csv 1.csv --shard 1/2     here
  align sweep map --csv 2.csv --shard 2/2     and there
  align merge map.csv 1.csv 2.csv             the file that `align sweep map --csv map.csv` would have made

All shards of one sweep are needed, in any order, each whole and once.
Exit status: 0 the file is there; 1 it could not be written; 2 bad usage, or shards that do not belong together.)";

struct MergeCommandOptions {
  std::string out;
  std::vector<std::string> shards;
};

/// One shard's file, read line by line.
class ShardFile {
 public:
  /// Reads the two lines before the rows. Throws UsageError.
  explicit ShardFile(const std::string& path) : path_(path), file_(path, path) {
    std::string line;
    const std::optional<SweepHead> head = next(line) ? parse_head(line) : std::nullopt;
    if (!head || !next(header_)) refuse("is no file of `align sweep --csv`");
    head_ = *head;
    column_count_ = cells_of(header_).size();
  }

  const std::string& path() const { return path_; }
  const SweepHead& head() const { return head_; }
  const std::string& header() const { return header_; }

  /// The next whole line.
  bool next(std::string& line) {
    ++line_number_;
    return file_.next(line);
  }

  /// The row of a trial, which must be the next. Throws UsageError.
  void read_row(std::size_t trial, std::string& line) {
    if (!next(line))
      refuse("ends before trial " + std::to_string(trial) + ": the sweep did not end; continue it with --resume");
    if (line.substr(0, line.find(',')) != std::to_string(trial))
      refuse("has another line where that of trial " + std::to_string(trial) + " should be: the file was changed");
    const std::size_t cells = cells_of(line).size();
    if (cells != column_count_)
      refuse("line " + std::to_string(line_number_) + " has " + counted(cells, "cell") + ", not " +
             std::to_string(column_count_) + ": the file was changed");
  }

  /// Throws UsageError unless all has been read.
  void check_end() {
    if (!file_.take(1).empty()) refuse("has more lines than the shard has trials: the file was changed");
  }

  [[noreturn]] void refuse(const std::string& reason) const { throw UsageError(path_ + ": " + reason); }

 private:
  std::string path_;
  WholeLines file_;
  SweepHead head_;
  std::string header_;
  std::size_t column_count_ = 0;
  std::size_t line_number_ = 0;  ///< of the line read last
};

using ShardFiles = std::vector<std::unique_ptr<ShardFile>>;

/// The files in the order of the shards. Throws UsageError unless they are all shards of one sweep.
ShardFiles open_shards(const std::vector<std::string>& paths) {
  ShardFiles files;
  for (const std::string& path : paths) files.push_back(std::make_unique<ShardFile>(path));
  const ShardFile& first = *files.front();
  const std::size_t count = first.head().shard.count;
  for (const auto& file : files) {
    const SweepHead& head = file->head();
    if (head.fingerprint != first.head().fingerprint || head.trials != first.head().trials ||
        file->header() != first.header())
      file->refuse("is of another sweep than " + first.path());
    if (head.shard.count != count)
      file->refuse("is shard " + shard_text(head.shard) + ", but " + first.path() + " is shard " +
                   shard_text(first.head().shard));
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return a->head().shard.number < b->head().shard.number; });
  for (std::size_t i = 1; i < files.size(); ++i)
    if (files[i]->head().shard.number == files[i - 1]->head().shard.number)
      files[i]->refuse("is shard " + shard_text(files[i]->head().shard) + ", and so is " + files[i - 1]->path());
  std::string missing;
  std::size_t at = 0, missing_count = 0;
  for (std::size_t number = 0; number < count; ++number) {
    if (at < files.size() && files[at]->head().shard.number == number)
      ++at;
    else if (++missing_count <= 20)
      missing += (missing.empty() ? "" : ", ") + shard_text({number, count});
  }
  if (missing_count > 0)
    throw UsageError("missing: shard " + missing + (missing_count > 20 ? ", ..." : "") + " of the sweep that " +
                     files.front()->path() + " is of");
  return files;
}

int run_merge(const MergeCommandOptions& options) {
  std::vector<NamedFile> inputs;
  for (const std::string& shard : options.shards) inputs.push_back({"one of the shards", shard});
  refuse_overwriting(inputs, {{"OUT", options.out}});
  const ShardFiles shards = open_shards(options.shards);
  const SweepHead whole = {shards.front()->head().fingerprint, shards.front()->head().trials, Shard()};

  const InterruptGuard interrupt;
  OutputPath output("OUT", options.out);
  std::ofstream file(output.temporary(), std::ios::binary);
  file << head_text(whole) << '\n' << shards.front()->header() << '\n';
  std::string line;
  for (std::size_t trial = 0; trial < whole.trials && file && interrupt.signal() == 0; ++trial) {
    shards[trial % shards.size()]->read_row(trial, line);
    file << line << '\n';
  }
  if (interrupt.signal() != 0) {
    std::fprintf(stderr, "align: interrupted; nothing is written\n");
    return 128 + interrupt.signal();
  }
  close_written(file, output.path());
  for (const auto& shard : shards) shard->check_end();
  output.commit();
  std::fprintf(is_stdout(options.out) ? stderr : stdout, "%s of %s\n", counted(whole.trials, "trial").c_str(),
               counted(shards.size(), "shard").c_str());
  return kExitRan;
}

}  // namespace

std::function<int()> set_up_merge(CLI::App& app) {
  const auto options = std::make_shared<MergeCommandOptions>();
  app.footer(kMergeFooter);
  app.add_option("OUT", options->out, "The file to write")->required();
  app.add_option("SHARDS", options->shards, "Files that `align sweep --shard I/N --csv FILE` has written")->required();
  return [options] { return run_merge(*options); };
}

}  // namespace vibratory_alignment
