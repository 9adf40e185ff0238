#include "cli/ledger_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/counted.h"

namespace vibratory_alignment {
namespace {

using nlohmann::json;

constexpr int kNameWidth = 64;

std::string rounded(double value, int digits = 4) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// As the facts file gives it.
std::string limit(double bound) { return rounded(bound, 6); }

std::string bound_text(const Bound& bound) {
  if (bound.at_least && bound.at_most)
    return *bound.at_least == *bound.at_most ? "= " + limit(*bound.at_least)
                                             : limit(*bound.at_least) + " to " + limit(*bound.at_most);
  return bound.at_least ? ">= " + limit(*bound.at_least) : "<= " + limit(*bound.at_most);
}

/// 5 and 95 % over resampled samples.
std::string range_text(const Reading& reading) {
  if (std::isnan(reading.low) || std::isnan(reading.high)) return "";
  return rounded(reading.low) + " to " + rounded(reading.high);
}

/// The text broken into lines of at most `width` characters.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines(1);
  std::size_t at = 0;
  while (at < text.size()) {
    std::size_t end = text.find(' ', at);
    if (end == std::string::npos) end = text.size();
    const std::string word = text.substr(at, end - at);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    at = end + 1;
  }
  return lines;
}

json number_or_null(double value) { return std::isnan(value) ? json(nullptr) : json(value); }

std::string count_text(const FactBook& book, const std::vector<FactResult>& results) {
  const auto met = std::count_if(results.begin(), results.end(), [](const FactResult& r) { return r.met; });
  return std::to_string(met) + " of " + counted(book.facts.size(), "fact") + " met";
}

/// Names of the facts that are met (or missed) and expected to be otherwise.
std::vector<std::string> against_expectation(const FactBook& book, const std::vector<FactResult>& results, bool met) {
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (results[i].met == met && book.facts[i].expected != met) ids.push_back(book.facts[i].id);
  return ids;
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += " " + word;
  return text;
}

}  // namespace

std::string ledger_text(const FactBook& book, const std::vector<FactResult>& results) {
  char line[256];
  std::snprintf(line, sizeof line, "%-5s         %-*s %8s  %-12s %s\n", "fact", kNameWidth - 1,
                "what the paper says, * missed", "value", "bound", "5 to 95 %");
  std::string text = line;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Fact& fact = book.facts[i];
    std::snprintf(line, sizeof line, "%-5s %-7s", fact.id.c_str(), results[i].met ? "met" : "MISSED");
    text += line;
    bool first = true;
    for (const std::string& words : wrapped(fact.says, 98)) {
      text += (first ? " " : "              ") + words + "\n";
      first = false;
    }
    for (const MeasureResult& measure : results[i].measures) {
      const std::vector<std::string> name = wrapped(measure.name, kNameWidth);
      for (std::size_t k = 0; k + 1 < name.size(); ++k) text += "        " + name[k] + "\n";
      std::snprintf(line, sizeof line, "      %c %-*s %8s  %-12s %s\n", measure.met ? ' ' : '*', kNameWidth,
                    name.back().c_str(), rounded(measure.reading.value).c_str(), bound_text(measure.bound).c_str(),
                    range_text(measure.reading).c_str());
      text += line;
    }
  }
  text += "\n" + count_text(book, results) + "\n";
  for (const bool met : {true, false}) {
    const std::vector<std::string> ids = against_expectation(book, results, met);
    if (!ids.empty())
      text += (met ? "Met, though not expected:" : "Missed, though expected to be met:") + list(ids) + "\n";
  }
  return text;
}

std::string ledger_markdown(const FactBook& book, const std::vector<FactResult>& results) {
  std::string text =
      "| fact | what the paper says | measure | value | 5 to 95 % | bound | |\n|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Fact& fact = book.facts[i];
    bool first = true;
    for (const MeasureResult& measure : results[i].measures) {
      const std::string met = results[i].met ? "**met**" : "**missed**";
      text += "| " + (first ? fact.id : "") + " | " + (first ? fact.says : "") + " | " + measure.name + " | " +
              rounded(measure.reading.value) + " | " + range_text(measure.reading) + " | " + bound_text(measure.bound) +
              " | " + (first ? met : "") + (measure.met || results[i].measures.size() == 1 ? "" : " (not this)") +
              " |\n";
      first = false;
    }
  }
  return text + "\n" + count_text(book, results) + ".\n";
}

std::string ledger_json(const FactBook& book, const std::vector<FactResult>& results) {
  json facts = json::array();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Fact& fact = book.facts[i];
    json measures = json::array();
    for (const MeasureResult& measure : results[i].measures) {
      json bound = json::object();
      if (measure.bound.at_least) bound["at_least"] = *measure.bound.at_least;
      if (measure.bound.at_most) bound["at_most"] = *measure.bound.at_most;
      measures.push_back({{"name", measure.name},
                          {"value", number_or_null(measure.reading.value)},
                          {"low", number_or_null(measure.reading.low)},
                          {"high", number_or_null(measure.reading.high)},
                          {"coverage", measure.reading.coverage},
                          {"bound", bound},
                          {"met", measure.met},
                          {"shortfall", measure.shortfall}});
    }
    facts.push_back({{"id", fact.id},
                     {"says", fact.says},
                     {"met", results[i].met},
                     {"expected", fact.expected},
                     {"shortfall", results[i].shortfall},
                     {"measures", measures}});
  }
  return json({{"facts", facts}}).dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::vector<std::string> missed_unexpectedly(const FactBook& book, const std::vector<FactResult>& results) {
  return against_expectation(book, results, false);
}

}  // namespace vibratory_alignment
