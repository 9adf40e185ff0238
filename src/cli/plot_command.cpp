#include "cli/plot_command.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "cli/errors.h"
#include "cli/interrupt.h"
#include "cli/output_path.h"
#include "cli/output_roles.h"
#include "cli/picture_format.h"
#include "cli/script.h"
#include "model/yaml_file.h"

namespace vibratory_alignment {
namespace {

constexpr char kPlotFooter[] = R"(Examples:
  align plot run.csv run.png                 of `align trial --csv run.csv`
  align plot trial.bag trial.svg             of `align trial --bag`, or recorded from aligner_node
  align plot trial.bag trial.png --si        in ms, mm, mm/s, mrad and N

The panels are those of the paper's Fig. 2: x, y, their velocities, the tilt, and the reactions n1 and n2 at the slot's
edges. A CSV file is drawn in its own units and with the forces at its instants; a bag in dimensionless numbers, and with
the largest forces since the message before. Of a bag in which the trial was reset, the last run is drawn.
It needs python3-matplotlib, and for bags python3-rosbag.
Exit status: 0 it is drawn; 1 it failed while drawing; 2 bad usage, or a file that cannot be drawn.)";

struct PlotCommandOptions {
  std::string trial, picture, node, title;
  bool si = false;
};

void check_readable(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw UsageError("TRIAL: " + path + ": is a directory");
  errno = 0;
  if (!std::ifstream(path)) throw UsageError("TRIAL: " + path + ": cannot be read: " + std::strerror(errno));
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".csv" && ending != ".bag") throw UsageError("TRIAL: " + path + ": the name must end in .csv or .bag");
}

int run_plot(const PlotCommandOptions& options) {
  const std::string format = picture_format("PICTURE", options.picture);
  check_readable(options.trial);
  if (!options.node.empty() && std::filesystem::path(options.trial).extension() != ".bag")
    throw UsageError("--node: only a bag has nodes");
  if (!is_text(options.title)) throw UsageError("--title: is not text (UTF-8)");
  refuse_overwriting({{"the trial", options.trial}}, {{"PICTURE", options.picture}});
  const InterruptGuard interrupt;
  OutputPath picture("PICTURE", options.picture);
  std::vector<std::string> arguments = {path_word(options.trial), path_word(picture.temporary()), "--format", format};
  if (options.si) arguments.emplace_back("--si");
  if (!options.node.empty()) arguments.push_back("--node=" + options.node);
  if (!options.title.empty()) arguments.push_back("--title=" + options.title);
  const int status = run_script("plot_trial.py", arguments, "plot", interrupt);
  if (interrupt.signal() != 0) {
    std::fprintf(stderr, "align: interrupted; no picture is written\n");
    return 128 + interrupt.signal();
  }
  if (status != kExitRan && status != kExitFailed && status != kExitUsage)
    throw std::runtime_error("plot: plot_trial.py failed with exit status " + std::to_string(status));
  if (status == kExitRan) picture.commit();
  return status;
}

}  // namespace

std::function<int()> set_up_plot(CLI::App& app) {
  const auto options = std::make_shared<PlotCommandOptions>();
  app.footer(kPlotFooter);
  app.add_option("TRIAL", options->trial, "A CSV file (.csv) or a bag (.bag) of a trial")->required();
  app.add_option("PICTURE", options->picture, "The picture to write: .png, .svg or .pdf")->required();
  app.add_option("--node", options->node, "Which aligner of a bag that has several")->type_name("NAME");
  app.add_flag("--si", options->si,
               "SI units: of a bag whose scene has scales; of a CSV\nfile whose scene has `units: si`, which the file "
               "does\nnot tell: of another the numbers would be wrong");
  app.add_option("--title", options->title, "Title of the picture; else the outcome, or the file's name")
      ->type_name("TEXT");
  return [options] { return run_plot(*options); };
}

}  // namespace vibratory_alignment
