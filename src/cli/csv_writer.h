// The motion of a trial as comma-separated values, one line a sample.
#pragma once

#include <cstdio>
#include <string>

#include "cli/output_path.h"
#include "model/scaling.h"
#include "trial/sampler.h"

namespace vibratory_alignment {

/// Columns, in the scene's own units: t,x,y,phi,vx,vy,omega as in MODEL.md; n1,n2 normal and t1,t2 tangential force at
/// the edges a1, a2; nb1,nb2,tb1,tb2 the same at the corners b1, b2; nf1,nf2,tf1,tf2 of the corners on the slot's
/// floor; event: 1 at an event instant between the regular samples, else 0. Numbers have the fewest digits that give
/// back the same double.
class CsvWriter {
 public:
  /// Throws UsageError when `path` cannot be written.
  CsvWriter(const std::string& path, const OutputUnits& units);
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  /// Throws OutputError, also for what an earlier call left in a buffer (a full disk).
  void write(const Sample& sample);

  /// All samples are written: the file gets its name. Throws OutputError.
  void finish();

 private:
  void put(const std::string& text);

  OutputPath output_;
  OutputUnits units_;
  std::FILE* file_ = nullptr;
  std::string line_;
};

}  // namespace vibratory_alignment
