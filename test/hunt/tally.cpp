#include "tally.h"

#include <cinttypes>
#include <cstdarg>
#include <cstdio>

namespace vibratory_alignment::hunt {
namespace {

std::string line(const char* format, ...) {
  char text[160];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

std::string row(const char* what, long count, long scenes) {
  return line("  %-34s %10ld  %8.4f %%\n", what, count,
              scenes > 0 ? 100.0 * static_cast<double>(count) / static_cast<double>(scenes) : 0.0);
}

}  // namespace

void Tally::add(std::uint64_t seed, const Verdict& verdict) {
  ++scenes;
  without_start += verdict.has_start ? 0 : 1;
  sensitive += verdict.sensitive ? 1 : 0;
  open += verdict.open ? 1 : 0;
  failed += verdict.faults.empty() ? 0 : 1;
  if (!verdict.refusal.empty())
    ++refusals[verdict.refusal];
  else if (verdict.has_start)
    ++outcomes[static_cast<std::size_t>(verdict.outcome)];
  for (int i = 0; i < kInvariantCount; ++i)
    if (verdict.breaks(static_cast<Invariant>(i))) ++faults[static_cast<std::size_t>(i)];
  digest += (verdict.digest ^ (seed * 0x9E3779B97F4A7C15u)) * 0xBF58476D1CE4E5B9u;
}

std::string summary(const Tally& t, Range range) {
  std::string text = line("\n%ld %s scenes\n", t.scenes, to_string(range));
  for (const Outcome outcome :
       {Outcome::aligned, Outcome::inserted, Outcome::jammed, Outcome::stalled, Outcome::time_limit})
    text += row(to_string(outcome), t.outcomes[static_cast<std::size_t>(outcome)], t.scenes);
  text += row("refused: no start", t.without_start, t.scenes);
  for (const auto& [reason, count] : t.refusals) text += row(("refused: " + reason).c_str(), count, t.scenes);
  text += row("too sensitive to compare", t.sensitive, t.scenes);
  text += row("open faults", t.open, t.scenes);
  text += "invariants broken\n";
  for (int i = 0; i < kInvariantCount; ++i)
    text += row(to_string(static_cast<Invariant>(i)), t.faults[static_cast<std::size_t>(i)], t.scenes);
  text += line("digest of all answers: %016" PRIx64 "\n", t.digest);
  text += line("%ld scenes failed\n", t.failed);
  return text;
}

}  // namespace vibratory_alignment::hunt
