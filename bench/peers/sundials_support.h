// What the SUNDIALS peers share: owners for its objects, error codes as exceptions, the two callbacks.
#pragma once

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_types.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "progress.h"

namespace vibratory_alignment::peers {

static_assert(std::is_same_v<realtype, double>, "SUNDIALS in double precision is needed");

// SUNDIALS' context, and a state vector in it that is the progress's own state.
class SundialsState {
 public:
  explicit SundialsState(Progress& progress) {
    if (SUNContext_Create(nullptr, &context_) != 0) throw std::runtime_error("SUNContext_Create failed");
    vector_ = N_VMake_Serial(6, progress.state.data(), context_);
  }
  ~SundialsState() {
    N_VDestroy(vector_);
    SUNContext_Free(&context_);
  }
  SundialsState(const SundialsState&) = delete;
  SundialsState& operator=(const SundialsState&) = delete;

  SUNContext context() const { return context_; }
  N_Vector vector() const { return vector_; }

 private:
  SUNContext context_ = nullptr;
  N_Vector vector_ = nullptr;
};

// Throws where a function of SUNDIALS reports an error.
inline int checked(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string(what) + " failed with " + std::to_string(flag));
  return flag;
}

inline int sundials_right_hand_side(double t, N_Vector y, N_Vector rate, void* progress) {
  static_cast<Progress*>(progress)->right_hand_side(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate));
  return 0;
}

inline int sundials_guards(double, N_Vector y, double* values, void* progress) {
  static_cast<Progress*>(progress)->guards(N_VGetArrayPointer(y), values);
  return 0;
}

// The guard that was found to rise, of those that GetRootInfo marked.
inline void pass_roots(const int* found, Progress& progress) {
  for (int g = 0; g < guard_count; ++g)
    if (found[g] > 0) progress.pass(g, progress.state.data());
}

constexpr long step_limit = 2'000'000;          // from one event to the next
inline int rising[guard_count] = {1, 1, 1, 1};  // SUNDIALS takes a pointer to non-constants

}  // namespace vibratory_alignment::peers
