// `align`, the command line of the package: picks the subcommand, turns exceptions into messages and exit status.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "cli/accuracy_command.h"
#include "cli/calibrate_command.h"
#include "cli/command.h"
#include "cli/errors.h"
#include "cli/merge_command.h"
#include "cli/plot_command.h"
#include "cli/reproduce_command.h"
#include "cli/set_option.h"
#include "cli/sweep_command.h"
#include "cli/trial_command.h"
#include "model/nearest_word.h"
#include "model/scene_error.h"

namespace vibratory_alignment {
namespace {

constexpr Command kCommands[] = {
    {"accuracy", "Show what accuracy costs in time: every solver on one scene", set_up_accuracy},
    {"calibrate", "Search for values such that given facts hold", set_up_calibrate},
    {"merge", "Put the files of a sweep's shards together", set_up_merge},
    {"plot", "Draw a trial's CSV file or bag as the paper draws its Fig. 2", set_up_plot},
    {"reproduce", "Draw the paper's figures, and check what it states against them", set_up_reproduce},
    {"sweep", "Run the trials of a study: many, with varied values", set_up_sweep},
    {"trial", "Run one trial of a scene, without ROS, as fast as it goes", set_up_trial},
};

constexpr char kDescription[] =
    "Vibratory alignment of a part over a slot: simulates a part that a compliant gripper presses on a base and "
    "shakes\n"
    "until it slips into its slot.";

constexpr char kFooter[] =
    "`align COMMAND --help` explains a command. To begin with: align trial fig2\n"
    "Exit status: 0 it ran, whatever the outcome; 1 it failed while running; 2 bad usage or bad scene.";

constexpr std::size_t kOptionColumn = 28;

/// True when whoever read stdout has closed it.
bool stdout_is_closed() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

/// Ends as a process does that writes to a pipe which nobody reads: without a word.
[[noreturn]] void end_by_closed_pipe() {
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
  std::abort();
}

int fail(int status, const char* message) {
  std::fprintf(stderr, "align: %s\n", message);
  return status;
}

/// What was printed, help or version, has arrived.
int told(int status) {
  std::cout << std::flush;
  if (!std::cout) throw OutputError("stdout", "the help is lost");
  return status;
}

/// Throws UsageError for a first word that should be a command and is none.
void check_command(const char* word) {
  std::string list;
  std::vector<std::string> names;
  for (const Command& command : kCommands) {
    if (command.name == std::string(word)) return;
    names.emplace_back(command.name);
    list += (list.empty() ? "" : ", ") + names.back();
  }
  throw UsageError(std::string(word) + ": there is no such command" + did_you_mean(word, names) + "; there are " +
                   list);
}

/// The first option given to a command that it does not have, as a message; empty when there is none.
std::string unknown_option(const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (std::string word : command.remaining_for_passthrough()) {
    word = word.substr(0, word.find('='));
    if (word.size() > 1 && word.front() == '-') return word + ": there is no such option" + did_you_mean(word, known);
  }
  return "";
}

int run(int argc, char** argv) {
  CLI::App app(kDescription, "align");
  app.footer(kFooter);
  app.get_formatter()->column_width(kOptionColumn);
  app.set_version_flag("--version", std::string("align ") + VIBRATORY_ALIGNMENT_VERSION);
  app.require_subcommand(0, 1);

  std::vector<std::pair<const CLI::App*, std::function<int()>>> runners;
  for (const Command& command : kCommands) {
    CLI::App* const subcommand = app.add_subcommand(command.name, command.summary);
    runners.emplace_back(subcommand, command.set_up(*subcommand));
  }

  if (argc > 1 && argv[1][0] != '-') check_command(argv[1]);
  try {
    // CLI11 takes the last word first
    std::vector<std::string> words = with_set_before_each({argv + 1, argv + argc});
    std::reverse(words.begin(), words.end());
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return told(app.exit(error));
    std::string command = "align", unknown;
    for (const CLI::App* subcommand : app.get_subcommands()) {
      command += " " + subcommand->get_name();
      unknown = unknown_option(*subcommand);
    }
    std::fprintf(stderr, "align: %s\nTry `%s --help`.\n", unknown.empty() ? error.what() : unknown.c_str(),
                 command.c_str());
    return kExitUsage;
  }
  for (const auto& [subcommand, runner] : runners) {
    if (subcommand->parsed()) return runner();
  }
  std::fprintf(stderr, "%s\nalign: name a command\n", app.help().c_str());
  return kExitUsage;
}

}  // namespace
}  // namespace vibratory_alignment

int main(int argc, char** argv) {
  using namespace vibratory_alignment;
  // A file that may not grow and a pipe that nobody reads are errors of the write: what is unfinished is tidied up.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const SceneError& error) {
    std::fprintf(stderr, "align: the scene is refused:\n%s\n", error.what());
    return kExitUsage;
  } catch (const UsageError& error) {
    return fail(kExitUsage, error.what());
  } catch (const OutputError& error) {
    if (stdout_is_closed()) end_by_closed_pipe();
    return fail(kExitFailed, error.what());
  } catch (const std::exception& error) {
    return fail(kExitFailed, error.what());
  }
}
