#include "cli/sweep_csv.h"

#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cli/counted.h"
#include "cli/errors.h"
#include "cli/row_text.h"
#include "cli/whole_lines.h"

namespace vibratory_alignment {
namespace {

namespace fs = std::filesystem;

WholeLines lines_of(const std::string& path) { return WholeLines("--csv: " + path, path); }

/// Whether a sweep, and nothing else, may have begun it.
bool may_be_of_a_sweep(const std::string& path) {
  const std::string mark = "# align sweep ", found = lines_of(path).take(mark.size());
  return found == mark.substr(0, found.size());
}

/// The first line of a sweep's file; none if it is none.
std::optional<SweepHead> head_of(const std::string& path) {
  std::string line;
  return lines_of(path).next(line) ? parse_head(line) : std::nullopt;
}

bool holds_rows_of_a_sweep(const std::string& path) {
  WholeLines lines = lines_of(path);
  std::string line;
  return lines.next(line) && parse_head(line) && lines.next(line) && lines.next(line);
}

}  // namespace

SweepCsv::SweepCsv(const std::string& path, const SweepHead& head, const std::string& header, bool resume,
                   const SeeRow& see_row)
    : output_("--csv", path, Unfinished::kept), head_(head), header_(header) {
  if (resume && output_.is_direct()) throw UsageError("--resume: " + path + ": is no file that could be continued");
  file_ = std::fopen(file().c_str(), "ab");
  if (file_ == nullptr) refuse(file(), std::string("cannot be written: ") + std::strerror(errno));
  if (output_.is_direct()) {
    begin_anew();
    return;
  }
  // where the file system has no locks the file is written without one
  if (flock(fileno(file_), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    std::fclose(file_);
    refuse(file(), "another `align sweep` is writing it");
  }
  try {
    begin_or_continue(path, resume, see_row);
  } catch (...) {
    close();
    throw;
  }
}

SweepCsv::~SweepCsv() { close(); }

/// A file in which there is nothing goes.
void SweepCsv::close() {
  std::fclose(file_);
  std::error_code error;
  if (!output_.is_direct() && fs::file_size(file(), error) == 0) fs::remove(file(), error);
}

void SweepCsv::begin_or_continue(const std::string& path, bool resume, const SeeRow& see_row) {
  if (!resume) {
    if (!may_be_of_a_sweep(file())) refuse(file(), "is in the way: rows come into a file of this name; remove it");
    if (holds_rows_of_a_sweep(file()))
      refuse(file(), "has rows of a sweep that did not end: continue it with --resume, or remove the file");
    refuse_other_shard(path);
    fs::resize_file(file(), 0);
    begin_anew();
  } else if (fs::file_size(file()) == 0 && fs::exists(path)) {
    was_whole_ = take_over(path, see_row) == fs::file_size(path) && rows_ == shard_size(head_.shard, head_.trials);
    if (!was_whole_) refuse(path, "is not whole, and there is no " + file() + " that could be continued");
  } else {
    fs::resize_file(file(), take_over(file(), see_row));
    if (fs::file_size(file()) == 0) begin_anew();
  }
}

void SweepCsv::refuse(const std::string& path, const std::string& reason) const {
  throw UsageError("--csv: " + path + ": " + reason);
}

/// The whole file of another shard of the same study is no older result.
void SweepCsv::refuse_other_shard(const std::string& path) const {
  if (!fs::exists(path)) return;
  const std::optional<SweepHead> old = head_of(path);
  if (old && old->fingerprint == head_.fingerprint && shard_text(old->shard) != shard_text(head_.shard))
    refuse(path,
           "has shard " + shard_text(old->shard) + " of this study: give each shard a file of its own, or remove it");
}

std::string SweepCsv::begin() const { return head_text(head_) + "\n" + header_ + "\n"; }

void SweepCsv::begin_anew() {
  const std::string text = begin();
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) throw OutputError(file(), std::strerror(errno));
  flush();
}

/// Reads what the file has of this sweep; returns the length of it, 0 if not even the first lines are whole.
std::uintmax_t SweepCsv::take_over(const std::string& path, const SeeRow& see_row) {
  const std::string expected = begin(), found = lines_of(path).take(expected.size());
  if (found != expected.substr(0, found.size()))
    refuse(path,
           "is of another study or shard, or the study, its scene or `align` has changed: it cannot be continued. "
           "To begin anew, remove it");
  if (found.size() < expected.size()) return 0;
  WholeLines lines = lines_of(path);
  std::string line;
  lines.next(line);
  lines.next(line);
  const std::size_t count = shard_size(head_.shard, head_.trials), columns = cells_of(header_).size();
  while (lines.next(line)) {
    const std::string trial = std::to_string(head_.shard.number + rows_ * head_.shard.count);
    if (rows_ == count || line.substr(0, line.find(',')) != trial)
      refuse(path, "line " + std::to_string(rows_ + 3) + " is not that of trial " + trial + ": the file was changed");
    const std::size_t cells = cells_of(line).size();
    if (cells != columns)
      refuse(path, "line " + std::to_string(rows_ + 3) + " has " + counted(cells, "cell") + ", not " +
                       std::to_string(columns) + ": the file was changed");
    see_row(line);
    ++rows_;
  }
  return lines.bytes();
}

void SweepCsv::write(const std::string& row) {
  ++rows_;
  if (std::fwrite(row.data(), 1, row.size(), file_) != row.size() || std::fputc('\n', file_) == EOF)
    throw OutputError(file(), std::strerror(errno));
}

void SweepCsv::flush() {
  if (std::fflush(file_) != 0) throw OutputError(file(), std::strerror(errno));
}

void SweepCsv::finish() {
  flush();
  if (was_whole_) return;
  output_.commit();
}

}  // namespace vibratory_alignment
