#include "cli/calibration_log.h"

#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/errors.h"
#include "cli/whole_lines.h"

namespace vibratory_alignment {
namespace {

constexpr char kHead[] = "align calibrate";

std::string head_line(const std::string& fingerprint) { return nlohmann::json{{kHead, fingerprint}}.dump(); }

nlohmann::json to_json(const CalibrationPlace& place, const std::vector<double>& values,
                       const CalibrationAnswer& answer) {
  nlohmann::json parts = nlohmann::json::array();
  for (const CalibrationAnswer::Part& part : answer.parts)
    parts.push_back({{"shortfall", part.shortfall}, {"met", part.met}});
  return {{"reading", place.reading}, {"seed", place.seed},      {"number", place.number},
          {"values", values},         {"trials", answer.trials}, {"parts", parts}};
}

CalibrationAnswer answer_of(const nlohmann::json& line) {
  CalibrationAnswer answer;
  answer.trials = line.at("trials");
  for (const nlohmann::json& part : line.at("parts")) answer.parts.push_back({part.at("shortfall"), part.at("met")});
  return answer;
}

}  // namespace

CalibrationLog::CalibrationLog(const std::string& path, const std::string& fingerprint, bool resume)
    : path_(path), file_(nullptr, std::fclose) {
  const auto size = [&path] {
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
    return unknown ? 0 : bytes;
  };
  const std::uintmax_t size_before = size(), whole = take_over(fingerprint, resume);
  file_.reset(std::fopen(path.c_str(), "ab"));
  if (!file_) throw UsageError("--log: " + path + ": cannot be written: " + std::strerror(errno));
  // where the file system has no locks the file is written without one
  const bool is_locked = flock(fileno(file_.get()), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (is_locked || size() != size_before)
    throw UsageError("--log: " + path + ": another `align calibrate` is writing it");
  // a last line without an end
  if (size() > whole) std::filesystem::resize_file(path, whole);
  if (whole == 0) write(head_line(fingerprint));
}

/// Reads what the file has. Returns the bytes of its whole lines.
std::uintmax_t CalibrationLog::take_over(const std::string& fingerprint, bool resume) {
  const std::string name = "--log: " + path_, head = head_line(fingerprint);
  const auto refuse_other = [&] {
    throw UsageError(name + (resume ? ": is of another calibration (its files or this version differ)"
                                    : ": is a file already; give another name, or --resume to go on with it"));
  };
  std::error_code none;
  if (!std::filesystem::exists(path_, none)) return 0;
  if (!std::filesystem::is_regular_file(path_, none)) throw UsageError(name + ": is no file");
  WholeLines lines(name, path_);
  std::string line;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (number == 1 && line != head) refuse_other();
    if (number > 1 && !resume)
      throw UsageError(name + ": has answers of this calibration already; --resume goes on with them");
    if (number > 1) read_answer(line, number);
  }
  // of what is cut off, not even the first line may be whole
  const std::string start = WholeLines(name, path_).take(head.size() + 1);
  const bool is_torn_head = resume && head.compare(0, start.size(), start) == 0;
  if (lines.bytes() == 0 && !start.empty() && !is_torn_head) refuse_other();
  return lines.bytes();
}

void CalibrationLog::read_answer(const std::string& line, std::size_t number) {
  try {
    const nlohmann::json answer = nlohmann::json::parse(line);
    known_[{answer.at("reading"), answer.at("seed"), answer.at("number")}] = {answer.at("values"), answer_of(answer)};
  } catch (const nlohmann::json::exception&) {
    throw UsageError("--log: " + path_ + ": line " + std::to_string(number) + " is not one of a calibration's log");
  }
}

std::optional<CalibrationAnswer> CalibrationLog::known(const CalibrationPlace& place,
                                                       const std::vector<double>& values) const {
  const auto entry = known_.find(place);
  if (entry == known_.end()) return std::nullopt;
  if (entry->second.values != values)
    throw UsageError("--log: " + path_ + ": was written by a search that goes another way (another machine?)");
  return entry->second.answer;
}

void CalibrationLog::keep(const CalibrationPlace& place, const std::vector<double>& values,
                          const CalibrationAnswer& answer) {
  write(to_json(place, values, answer).dump());
}

void CalibrationLog::write(const std::string& line) {
  if (std::fputs((line + "\n").c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)
    throw OutputError(path_, std::strerror(errno));
}

}  // namespace vibratory_alignment
