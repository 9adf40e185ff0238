#include "cli/figure_files.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cli/whole_file.h"
#include "model/number_text.h"
#include "model/scaling.h"
#include "study/trial_scenes.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

using nlohmann::json;

constexpr double kSamplesPerPeriod = 60.0;  ///< of the fastest excitation

/// Curves in the paper's order and pairing: the panels a to f, with the rate of the tilt a to g.
const json kPanels = {{"x"}, {"y"}, {"vx"}, {"vy"}, {"phi"}, {"n1", "n2"}};
const json kPanelsWithRate = {{"x"}, {"y"}, {"vx"}, {"vy"}, {"phi"}, {"omega"}, {"n1", "n2"}};

class CsvFile {
 public:
  CsvFile(const std::filesystem::path& path, const std::string& header) : file_("--output", path.string()) {
    file_.text() << header << '\n';
  }

  void line(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      file_.text() << (i == 0 ? "" : ",") << (std::isnan(values[i]) ? "" : number_text(values[i]));
    file_.text() << '\n';
  }

  void finish() { file_.finish(); }

 private:
  WholeFile file_;
};

/// Of the first trial of the study. Without a file when it is not to go on.
void write_motion(const std::filesystem::path& path, const Study& study, const std::function<bool()>& go_on) {
  const Scene scene = TrialScenes(study).at(0);
  const OutputUnits units = output_units(scene);
  SimulationOptions options;
  options.energy = false;
  Simulation simulation(scene, options);
  Sampler sampler(simulation, scene.shortest_period() / kSamplesPerPeriod, true);
  CsvFile file(path, "t,x,y,phi,vx,vy,omega,n1,n2");
  Sample sample;
  while (go_on() && sampler.next(sample, go_on)) {
    const State& s = sample.state;
    const auto force = [&](Site site) {
      return sample.contacts[static_cast<std::size_t>(site)].normal_force * units.force;
    };
    file.line({sample.time * units.time, s.x * units.length, s.y * units.length, s.phi, s.vx * units.velocity,
               s.vy * units.velocity, s.omega * units.angular_velocity, force(Site::a1), force(Site::a2)});
  }
  if (!sampler.finished()) return;
  if (simulation.result().outcome == Outcome::failed)
    throw std::runtime_error(study.name + ": the trial failed: " + simulation.result().failure);
  file.finish();
}

void write_curves(const std::filesystem::path& path, const Figure& figure, const Tables& tables) {
  const std::vector<Curve> curves = curves_of(figure.measure, tables);
  std::vector<Curve> marks;
  if (!figure.mark.empty()) marks = curves_of(marks_of(figure), tables);
  std::string header;
  for (const std::string& name : figure.measure.curves.each) header += name + ",";
  CsvFile file(path, header + figure.measure.curves.along + ",median,low,high,share,mark");
  for (std::size_t c = 0; c < curves.size(); ++c) {
    for (std::size_t p = 0; p < curves[c].points.size(); ++p) {
      const CurvePoint& point = curves[c].points[p];
      std::vector<double> values = curves[c].each;
      const double mark = marks.empty() ? 1.0 : marks[c].points[p].value;
      for (const double value : {point.at, point.value, point.low, point.high, point.share, mark})
        values.push_back(value);
      file.line(values);
    }
  }
  file.finish();
}

void write_region(const std::filesystem::path& path, const Figure& figure, const Tables& tables) {
  const Field field = field_of(figure.measure, tables);
  CsvFile file(path, figure.measure.region.x + "," + figure.measure.region.y + ",share");
  for (std::size_t i = 0; i < field.x.size(); ++i)
    for (std::size_t j = 0; j < field.y.size(); ++j) file.line({field.x[i], field.y[j], field.at(i, j)});
  file.finish();
}

json description(const Figure& figure) {
  json text = {{"name", figure.name}, {"title", figure.title}};
  switch (figure.kind) {
    case Figure::Kind::motion:
      text["kind"] = "motion";
      text["panels"] = figure.with_tilt_rate ? kPanelsWithRate : kPanels;
      break;
    case Figure::Kind::curves:
      text["kind"] = "curves";
      text["of"] = figure.measure.of;
      text["along"] = figure.measure.curves.along;
      text["each"] = figure.measure.curves.each;
      text["point"] = point_statistic_words().at(static_cast<std::size_t>(figure.measure.curves.point));
      text["share"] = figure.measure.curves.share;
      if (!figure.mark.empty()) text["mark"] = figure.mark;
      break;
    case Figure::Kind::region:
      text["kind"] = "region";
      text["of"] = figure.measure.of;
      text["x"] = figure.measure.region.x;
      text["y"] = figure.measure.region.y;
      text["share"] = figure.measure.region.share;
      break;
  }
  return text;
}

}  // namespace

bool write_figure_files(const std::filesystem::path& folder, const FactBook& book,
                        const std::map<std::string, Study>& studies, const Tables& tables,
                        const std::function<bool()>& go_on) {
  json descriptions = json::array();
  for (const Figure& figure : book.figures) {
    const std::filesystem::path path = folder / (figure.name + ".csv");
    switch (figure.kind) {
      case Figure::Kind::motion: write_motion(path, studies.at(figure.measure.table.study), go_on); break;
      case Figure::Kind::curves: write_curves(path, figure, tables); break;
      case Figure::Kind::region: write_region(path, figure, tables); break;
    }
    if (!go_on()) return false;
    descriptions.push_back(description(figure));
  }
  WholeFile file("--output", (folder / "figures.json").string());
  file.text() << descriptions.dump(2) << '\n';
  file.finish();
  return true;
}

}  // namespace vibratory_alignment
