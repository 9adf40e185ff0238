#include "cli/csv_writer.h"

#include <cerrno>
#include <cstring>

#include "cli/errors.h"
#include "model/number_text.h"

namespace vibratory_alignment {
namespace {

constexpr char kHeader[] = "t,x,y,phi,vx,vy,omega,n1,n2,t1,t2,nb1,nb2,tb1,tb2,nf1,nf2,tf1,tf2,event\n";

void append(std::string& line, double value) {
  line += number_text(value);
  line += ',';
}

}  // namespace

CsvWriter::CsvWriter(const std::string& path, const OutputUnits& units) : output_("--csv", path), units_(units) {
  file_ = std::fopen(output_.temporary().c_str(), "wb");
  if (file_ == nullptr) throw UsageError("--csv: " + path + ": cannot be written: " + std::strerror(errno));
  put(kHeader);
}

CsvWriter::~CsvWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

void CsvWriter::put(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) {
    throw OutputError(output_.path(), std::strerror(errno));
  }
}

void CsvWriter::write(const Sample& sample) {
  const State& state = sample.state;
  line_.clear();
  append(line_, sample.time * units_.time);
  append(line_, state.x * units_.length);
  append(line_, state.y * units_.length);
  append(line_, state.phi);
  append(line_, state.vx * units_.velocity);
  append(line_, state.vy * units_.velocity);
  append(line_, state.omega * units_.angular_velocity);
  constexpr Site kPairs[][2] = {{Site::a1, Site::a2}, {Site::b1, Site::b2}, {Site::b1_floor, Site::b2_floor}};
  for (const auto& pair : kPairs) {
    for (const Site site : pair) append(line_, sample.contacts[static_cast<size_t>(site)].normal_force * units_.force);
    for (const Site site : pair)
      append(line_, sample.contacts[static_cast<size_t>(site)].tangential_force * units_.force);
  }
  line_ += sample.is_event ? "1\n" : "0\n";
  put(line_);
}

void CsvWriter::finish() {
  std::FILE* const file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) throw OutputError(output_.path(), std::strerror(errno));
  output_.commit();
}

}  // namespace vibratory_alignment
