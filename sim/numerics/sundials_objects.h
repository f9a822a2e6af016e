// SPDX-License-Identifier: MIT
#pragma once

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

#include <Eigen/Core>
#include <exception>
#include <memory>
#include <string>
#include <type_traits>

// Only the files of this folder that call SUNDIALS include this header.
namespace beamgyro::internal {

static_assert(std::is_same_v<sunrealtype, double>);

struct FreeContext {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
struct FreeVector {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
struct FreeMatrix {
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
};
struct FreeSolver {
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};

template <class Handle, class Free>  // every SUNDIALS handle is a pointer
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;
using OwnedContext = Owned<SUNContext, FreeContext>;
using OwnedVector = Owned<N_Vector, FreeVector>;
using OwnedMatrix = Owned<SUNMatrix, FreeMatrix>;
using OwnedSolver = Owned<SUNLinearSolver, FreeSolver>;

/// Returns `absolute` expanded to one entry for each component. Throws
/// std::invalid_argument when a tolerance is negative or their number does not
/// fit.
Eigen::VectorXd full_tolerances(double relative,
                                const Eigen::VectorXd& absolute,
                                Eigen::Index size);

/// Throws SimulationFailure naming `what` and the time unless `finite`.
void require_finite(bool finite, const char* what, double t);

/// Carries exceptions of callbacks across C frames, and SUNDIALS' own messages.
class CallErrors {
 public:
  /// Runs a callback and keeps its exception. Returns 0, or -1 (unrecoverable)
  /// when it threw.
  template <class Work>
  int guarded(const Work& work) {
    try {
      work();
      return 0;
    } catch (...) {
      thrown_ = std::current_exception();
      return -1;
    }
  }

  /// Checks the flag that a call of SUNDIALS returned. Rethrows what a callback
  /// threw. For a negative flag throws SimulationFailure, or std::runtime_error
  /// where memory or the call itself is at fault.
  void check(int flag, const char* call);

  /// SUNErrHandlerFn; `user` is the CallErrors.
  static void on_error(int, const char*, const char*, char* text, void* user);

 private:
  std::exception_ptr thrown_;
  std::string message_;
};

// Serial vectors, dense matrices and their solver with the operations that
// integrators spend their time in replaced by our own: Debian's SUNDIALS is
// built without optimisation, which costs a factor of three (bench/README.md).
// All throw std::runtime_error when SUNDIALS has no memory.

OwnedContext make_context();

/// A vector over `values`, which must outlive it and keep its size.
OwnedVector make_vector(Eigen::VectorXd& values, SUNContext context);

OwnedMatrix make_dense_matrix(Eigen::Index size, SUNContext context);

/// LU with partial pivoting.
OwnedSolver make_dense_solver(Eigen::Index size, SUNContext context);

}  // namespace beamgyro::internal
