// SPDX-License-Identifier: MIT
#include "sim/numerics/sundials_objects.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "linear_algebra/linear_systems.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

using Vector = Eigen::Map<Eigen::VectorXd>;
using Matrix = Eigen::Map<Eigen::MatrixXd>;

Vector view(N_Vector v) { return {NV_DATA_S(v), NV_LENGTH_S(v)}; }

Matrix view(SUNMatrix m) {
  return {SM_DATA_D(m), SM_ROWS_D(m), SM_COLUMNS_D(m)};
}

template <class Handle>
Handle created(Handle handle, const char* call) {
  if (!handle) throw std::runtime_error(std::string(call) + " failed");
  return handle;
}

// z may be x or y in all of these: coefficient by coefficient that is safe.
void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  view(z) = a * view(x) + b * view(y);
}

void scale(double a, N_Vector x, N_Vector z) { view(z) = a * view(x); }

void constant(double a, N_Vector z) { view(z).setConstant(a); }

void absolute(N_Vector x, N_Vector z) { view(z) = view(x).cwiseAbs(); }

void inverse(N_Vector x, N_Vector z) { view(z) = view(x).cwiseInverse(); }

void add_constant(N_Vector x, double b, N_Vector z) {
  view(z).array() = view(x).array() + b;
}

double weighted_norm(N_Vector x, N_Vector weight) {
  return std::sqrt(view(x).cwiseProduct(view(weight)).squaredNorm() /
                   static_cast<double>(NV_LENGTH_S(x)));
}

int linear_combination(int count, double* a, N_Vector* x, N_Vector z) {
  // z may be x[0] only.
  view(z) = a[0] * view(x[0]);
  for (int k = 1; k < count; ++k) view(z) += a[k] * view(x[k]);
  return 0;
}

int add_identity(double a, SUNMatrix m) {
  view(m) *= a;
  view(m).diagonal().array() += 1;
  return SUNMAT_SUCCESS;
}

int copy(SUNMatrix from, SUNMatrix to) {
  view(to) = view(from);
  return SUNMAT_SUCCESS;
}

SUNMatrix dense_matrix(Eigen::Index size, SUNContext context);

SUNMatrix clone(SUNMatrix matrix) {
  return dense_matrix(SM_ROWS_D(matrix), matrix->sunctx);
}

// A clone made by SUNDIALS would have SUNDIALS' own operations again.
SUNMatrix dense_matrix(Eigen::Index size, SUNContext context) {
  SUNMatrix matrix = SUNDenseMatrix(size, size, context);
  if (matrix) {
    matrix->ops->clone = clone;
    matrix->ops->scaleaddi = add_identity;
    matrix->ops->copy = copy;
  }
  return matrix;
}

LuFactors& lu_factors(SUNLinearSolver solver) {
  return *static_cast<LuFactors*>(solver->content);
}

SUNLinearSolver_Type solver_type(SUNLinearSolver) {
  return SUNLINEARSOLVER_DIRECT;
}

int factorise(SUNLinearSolver solver, SUNMatrix matrix) {
  return lu_factors(solver).factorise(view(matrix)) ? SUNLS_SUCCESS
                                                    : SUNLS_LUFACT_FAIL;
}

int solve(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double) {
  view(x) = lu_factors(solver).solve(view(b));
  return SUNLS_SUCCESS;
}

int free_solver(SUNLinearSolver solver) {
  delete static_cast<LuFactors*>(solver->content);
  solver->content = nullptr;
  SUNLinSolFreeEmpty(solver);
  return SUNLS_SUCCESS;
}

}  // namespace

Eigen::VectorXd full_tolerances(double relative,
                                const Eigen::VectorXd& absolute,
                                Eigen::Index size) {
  if (absolute.size() != 1 && absolute.size() != size) {
    throw std::invalid_argument(
        "absolute_tolerance has " + std::to_string(absolute.size()) +
        " entries for " + std::to_string(size) + " components");
  }
  if (!(relative >= 0) || !(absolute.array() >= 0).all()) {
    throw std::invalid_argument("a tolerance is negative or not a number");
  }
  if (absolute.size() == size) return absolute;
  return Eigen::VectorXd::Constant(size, absolute(0));
}

void require_finite(bool finite, const char* what, double t) {
  if (!finite) {
    throw SimulationFailure(std::string(what) + " is not finite at t = " +
                            std::to_string(t) + " s");
  }
}

void CallErrors::check(int flag, const char* call) {
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  if (flag >= 0) return;
  const std::string text = std::string(call) + " failed (flag " +
                           std::to_string(flag) + "): " + message_;
  // CVODE and ARKODE number alike: from here on down memory and wrong calls.
  if (flag <= CV_MEM_FAIL) throw std::runtime_error(text);
  throw SimulationFailure(text);
}

void CallErrors::on_error(int, const char*, const char*, char* text,
                          void* user) {
  static_cast<CallErrors*>(user)->message_ = text;
}

OwnedContext make_context() {
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  return OwnedContext(created(context, "SUNContext_Create"));
}

OwnedVector make_vector(Eigen::VectorXd& values, SUNContext context) {
  OwnedVector vector(created(
      N_VMake_Serial(values.size(), values.data(), context), "N_VMake_Serial"));
  vector->ops->nvlinearsum = linear_sum;
  vector->ops->nvscale = scale;
  vector->ops->nvconst = constant;
  vector->ops->nvabs = absolute;
  vector->ops->nvinv = inverse;
  vector->ops->nvaddconst = add_constant;
  vector->ops->nvwrmsnorm = weighted_norm;
  vector->ops->nvlinearcombination = linear_combination;
  return vector;
}

OwnedMatrix make_dense_matrix(Eigen::Index size, SUNContext context) {
  return OwnedMatrix(created(dense_matrix(size, context), "SUNDenseMatrix"));
}

OwnedSolver make_dense_solver(Eigen::Index size, SUNContext context) {
  OwnedSolver solver(created(SUNLinSolNewEmpty(context), "SUNLinSolNewEmpty"));
  solver->ops->gettype = solver_type;
  solver->ops->setup = factorise;
  solver->ops->solve = solve;
  solver->ops->free = free_solver;
  solver->content = new LuFactors(size);
  return solver;
}

}  // namespace beamgyro::internal
